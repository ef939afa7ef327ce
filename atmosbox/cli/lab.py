"""The command ``lab``: an HTML page in which a scene runs, or a folder with the pages of all scenes and an index."""

from __future__ import annotations

import base64
import html
import io
import json
from collections.abc import Callable, Collection
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from atmosbox import scenarios
from atmosbox.cli.application import command
from atmosbox.cli.option import Language, Output, PageTheme, Sought, for_scene, switch
from atmosbox.cli.request import checked, gather, with_fewer_molecules
from atmosbox.cli.terminal import prints_to_stderr, say
from atmosbox.errors import FileError
from atmosbox.text.progress import progress

if TYPE_CHECKING:
    from atmosbox.simulation.preparation import Prepared


@command(
    "atmosbox lab temperature",
    "atmosbox lab temperature --set temperature=50degC --out warm.html",
    "atmosbox lab --all --out labs/",
    out="The page, or the folder of all.  [default: SCENE-lab.html in this folder, or labs]",
    quiet="Print only the path of the page.",
)
def lab(
    sought: Sought,
    to: Output,
    every: Annotated[
        bool, switch("--all", "Write all scenes and an index of them into a folder, for a course.")
    ] = False,
    theme: PageTheme = "auto",
    language: Language = "auto",
) -> None:
    """Write a page in which a scene runs: the engine itself, in the browser.

    The page is one HTML file, which needs neither Python nor a network. It begins with the settings and the seed given
    here. Its numbers are those of `atmosbox run` with the same settings and --engine exact. Its sliders act at once;
    other settings have a few values to choose from. With `atmosbox live`, more settings can be changed.
    """
    if every:
        from atmosbox.simulation.link import check_nothing_changes

        check_nothing_changes("what --all writes", {"scene": sought.scene, **sought.changes()})
        with prints_to_stderr(), progress("lab", quiet=to.quiet) as show:
            made = save_all(Path(to.out or "labs"), theme=theme, language=language, force=to.force, progress=show)
        return say(str(made[0]))
    asked = with_fewer_molecules(gather(sought, False))
    with progress("lab", quiet=to.quiet) as show:
        prepared = checked(asked)
        from atmosbox.file.output_path import check_writable

        path = check_writable(to.path(for_scene(prepared.scene, "-lab.html")), to.force)
        show(0.0, "building the box")
        from atmosbox.lab import save_lab

        with prints_to_stderr():
            written = save_lab(prepared, path, theme=theme, language=language, force=to.force, progress=show)
    say(str(written))


_FRAMES = 12  # after which the still picture is drawn


def save_all(
    folder: Path,
    *,
    theme: str,
    language: str,
    force: bool,
    progress: Callable[[float, str], None] = lambda share, name: None,
    scenes: Collection[str] = (),
) -> list[Path]:
    """Write the pages of some scenes, or of all, and ``index.html``; return the paths, index first."""
    from atmosbox.file.output_path import check_writable, write_whole
    from atmosbox.lab import save_lab
    from atmosbox.lab.wasm_module import SCENES
    from atmosbox.page.document import packaged
    from atmosbox.simulation.preparation import prepare
    from atmosbox.version import __version__

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder} cannot be made ({error.strerror}): give another folder.") from error
    wanted = set(SCENES) & set(scenes or SCENES)
    found = {name: each for name, each in scenarios.summaries().items() if name in wanted}
    pages = {name: check_writable(folder / f"{name}-lab.html", force) for name in found}
    index = check_writable(folder / "index.html", force)
    cards = []
    for number, (name, told) in enumerate(found.items()):
        progress(number / len(found), name)
        prepared = prepare(name, SCENES[name], engine="exact")
        save_lab(prepared, pages[name], theme=theme, language=language, force=force)
        title = html.escape(str(getattr(prepared.module, "title", name)))
        about = " · ".join(filter(None, [told.level, f"{told.minutes} minutes" if told.minutes else ""]))
        cards.append(
            f'<a href="{pages[name].name}"><img alt="" src="data:image/png;base64,{_still(prepared)}">'
            f"<h2>{title}</h2><p>{html.escape(told.sentence)}</p><small>{html.escape(about)}</small></a>"
        )
    text = packaged("web", "index.html").replace("@@SCENES@@", "\n".join(cards)).replace("@@VERSION@@", __version__)
    write_whole(index, text.encode("utf-8"))
    return [index, *pages.values()]


def _still(prepared: Prepared) -> str:
    """Return the picture of a box after a few frames: PNG, in base64."""
    from matplotlib.figure import Figure

    from atmosbox.file.molecules import molecules
    from atmosbox.plot.box_picture import box_picture
    from atmosbox.plot.theme import find, style
    from atmosbox.simulation.preparation import build
    from atmosbox.simulation.recording import Recording

    prepared = replace(prepared, save_molecules=True)
    setup = build(prepared)
    recording = Recording(prepared, setup, {"atmosbox_parameters": json.dumps(prepared.parameters)})
    for _ in range(min(_FRAMES, setup.frames)):
        recording.advance(lambda now: None)
    run, _ = recording.dataset("partial", judged=False)
    look = find("notes")
    with style(look):
        figure = Figure((4.0, 3.0), dpi=120)  # inches
        picture = box_picture(figure.add_axes((0.04, 0.04, 0.92, 0.92)), run, molecules(run), look)
        picture.show(recording.frames - 1)
        content = io.BytesIO()
        figure.savefig(content, format="png", metadata={"Software": None})
    return base64.b64encode(content.getvalue()).decode("ascii")
