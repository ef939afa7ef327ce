"""The command ``lab``: an HTML page in which a scene runs, without a server and without Python."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atmosbox.cli import option
from atmosbox.cli.application import command
from atmosbox.cli.output_name import chosen, for_scene
from atmosbox.cli.request import checked, gather, with_fewer_molecules
from atmosbox.cli.terminal import prints_to_stderr, say
from atmosbox.text.progress import progress


@command(
    "atmosbox lab temperature",
    "atmosbox lab temperature --set molecules=800 --out warm.html",
    "atmosbox lab --all --out labs/",
)
def lab(
    scene: Annotated[str | None, option.SceneName] = None,
    values: option.Values = None,
    config: option.Config = None,
    source: option.Source = None,
    seed: option.Seed = None,
    engine: option.Engine = None,
    accuracy: option.Accuracy = None,
    every: Annotated[
        bool, typer.Option("--all", help="Write all scenes and an index of them into a folder, for a course.")
    ] = False,
    out: Annotated[
        str | None,
        option.out_option("The page, or the folder of all.  [default: SCENE-lab.html in this folder, or labs]"),
    ] = None,
    theme: option.PageTheme = "auto",
    language: option.Language = "auto",
    force: option.Force = False,
    quiet: Annotated[bool, option.quiet_option("Print the path of the page, no more.")] = False,
    verbose: option.Verbose = False,
) -> None:
    """Write a page in which a scene runs: the engine itself, in the browser.

    The page is one HTML file, which needs neither Python nor a network. It begins with the settings and the seed that
    it was written with, and gives the same numbers as run. Its knobs act at once; of other settings it offers as many
    values as fit into it. In the page that live opens, all settings can be changed.
    """
    if every:
        from atmosbox.cli.lab_folder import save_all
        from atmosbox.simulation.link import check_nothing_changes

        given = {"scene": scene, "--set": values, "--config": config, "--from": source, "--seed": seed}
        given |= {"--engine": engine, "--accuracy": accuracy}
        check_nothing_changes("what --all writes", given)

        with prints_to_stderr(), progress("lab", quiet=quiet) as show:
            made = save_all(Path(out or "labs"), theme=theme, language=language, force=force, progress=show)
        return say(str(made[0]))
    asked = with_fewer_molecules(gather(scene, values or (), config, source, seed, False, engine, accuracy))
    with progress("lab", quiet=quiet) as show:
        prepared = checked(asked)
        path = chosen(out, for_scene(prepared.scene, "-lab.html"), force=force, quiet=quiet)
        from atmosbox.file.output_path import check_writable

        check_writable(path, force)
        show(0.0, "building the box")
        from atmosbox.lab import save_lab

        with prints_to_stderr():
            written = save_lab(prepared, path, theme=theme, language=language, force=force, progress=show)
    say(str(written))
