"""What ``atmosbox animate`` does: film a run, and say how far it is."""

from __future__ import annotations

from pathlib import Path

from atmosbox.cli.progress import progress
from atmosbox.cli.terminal import say


def animate(
    file: str,
    *,
    out: str | None,
    format: str | None,
    seconds: float | None,
    fps: float | None,
    graphs: bool,
    theme: str,
    force: bool,
    quiet: bool,
) -> None:
    """Film the run in a file.

    Parameters
    ----------
    file
        The file of the run.
    out, format, seconds, fps, graphs, theme, force, quiet
        The options of these names.

    Raises
    ------
    AtmosboxError
        If something is refused or fails.
    """
    from atmosbox.file.netcdf import read

    dataset = read(file)
    path = Path(file).with_suffix(f".{format or 'gif'}") if out is None else Path(out)

    from atmosbox.film import save

    with progress(Path(file).name, quiet=quiet) as show:
        path, _ = save(
            dataset,
            path,
            format,
            theme=theme,
            seconds=seconds,
            fps=fps,
            graphs=graphs,
            force=force,
            progress=lambda done: show(done, "running"),
        )
    say(str(path))
