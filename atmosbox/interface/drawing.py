"""The figure of a run, several runs side by side, and the page of a run in a notebook."""

from __future__ import annotations

import base64
import html
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from atmosbox.errors import SettingError
from atmosbox.interface.run_dataset import in_notebook, preformatted

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DPI = 110  # dots per inch of a picture in a notebook
_WIDTH = 120


def opened(run: xr.Dataset | str | os.PathLike[str]) -> xr.Dataset:
    """Return a run; if a path is given, read the run from its file."""
    if isinstance(run, str | os.PathLike):
        from atmosbox.file.netcdf import read

        return read(run)
    return run


def _shown(drawing: Figure, theme: str) -> Figure:
    """Make a notebook show the figure as it would be saved, and return the figure."""
    from atmosbox.plot.figure_file import render

    def picture() -> bytes:
        return render(drawing, "png", theme, title="", parameters="", dpi=_DPI)

    drawing._repr_png_ = picture  # type: ignore[attr-defined]
    return drawing


def plot(
    run: xr.Dataset | str | os.PathLike[str],
    *,
    theme: Literal["notes", "slides"] = "notes",
    with_box: bool = False,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
) -> Figure:
    """Draw the figure of a run, of a sweep or of a measured tradeoff, and return it: a notebook shows it.

    Parameters
    ----------
    run
        The dataset, or the path of its file.
    theme
        ``"notes"``: a figure for a page; ``"slides"``: one for a screen of 16:9 with large type.
    with_box
        Whether to draw the molecules at the start, half-way and at the end, above the graphs; the run must have been
        made with ``save_molecules=True``.
    out
        A file to write as well: PNG, SVG or PDF, as its suffix says.
    force
        Whether a file of that name may be replaced.

    Raises
    ------
    FileError
        If the run has nothing to draw, or the file cannot be written.
    SettingError
        If the theme or the format is unknown.

    Examples
    --------
    >>> import atmosbox as ab
    >>> figure = ab.plot(ab.run("elastic-collisions", duration="2 s"))
    >>> len(figure.axes) > 1
    True
    """
    from atmosbox.plot.figure_file import drawn, save
    from atmosbox.plot.theme import find

    find(theme)
    dataset = opened(run)
    if out is not None:
        save(dataset, out, theme=theme, force=force, with_box=with_box)
    return _shown(drawn(dataset, theme, with_box=with_box), theme)


class Comparison:
    """The comparison of several runs: a table of their results, and one figure with all of them.

    A notebook shows both; ``print`` shows the table.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    table : str
        The headlines of all runs, with the difference of each run from the first and its standard error.
    """

    def __init__(self, figure: Figure, table: str) -> None:
        self.figure = figure
        self.table = table

    def __repr__(self) -> str:
        """Return the table."""
        return self.table

    def _repr_html_(self) -> str:
        """Return table and figure."""
        picture = base64.b64encode(self.figure._repr_png_()).decode()  # type: ignore[attr-defined]
        drawn = f'<img alt="The graphs of the runs, laid over each other." src="data:image/png;base64,{picture}">'
        return preformatted(self.table) + drawn


def compare(
    *runs: xr.Dataset | str | os.PathLike[str],
    theme: Literal["notes", "slides"] = "notes",
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
) -> Comparison:
    """Compare runs: draw them in one figure, and tabulate by how much their results differ.

    The table also lists what differs between the runs, such as settings.

    Parameters
    ----------
    *runs
        Two to six runs: datasets, or paths of files.
    theme
        ``"notes"``: a figure for a page; ``"slides"``: one for a screen.
    out
        A file for the figure: PNG, SVG or PDF, as its suffix says.
    force
        Whether a file of that name may be replaced.

    Raises
    ------
    SettingError
        If there are fewer than two runs or more than six.
    FileError
        If the runs have no graph in common, or the file cannot be written.

    Examples
    --------
    >>> import atmosbox as ab
    >>> one, other = (ab.run("elastic-collisions", duration="2 s", seed=seed) for seed in (1, 2))
    >>> print(ab.compare(one, other).table.splitlines()[0])
    elastic-collisions: seed 1 / 2
    """
    from atmosbox.plot.compare import MOST, compared, drawn, naming, save
    from atmosbox.plot.theme import find
    from atmosbox.text.report import comparison_lines

    if not 2 <= len(runs) <= MOST:
        raise SettingError("runs", None, f"are {len(runs)}", "give two to six")
    find(theme)
    ordinals = ("first", "second", "third", "fourth", "fifth", "sixth")
    called = [
        Path(run).stem if isinstance(run, str | os.PathLike) else word
        for run, word in zip(runs, ordinals, strict=False)
    ]
    datasets = [opened(run) for run in runs]
    names = naming(datasets, called)
    if out is not None:
        save(datasets, names, out, theme=theme, force=force)
    drawing = _shown(drawn(datasets, names, theme), theme)
    return Comparison(drawing, "\n".join(comparison_lines(called, names, compared(datasets), _WIDTH)))


class InlinePage:
    """A page that a notebook shows in a frame of its own; it needs no network.

    Attributes
    ----------
    text : str
        The complete HTML of the page.
    height : int
        Height of the frame in pixels.
    """

    def __init__(self, text: str, height: int) -> None:
        self.text = text
        self.height = height

    def __repr__(self) -> str:
        """Return a line that says how large the page is and how to save it."""
        return f'page of {len(self.text) / 1e6:.1f} MB; page.save("page.html") keeps it'

    def _repr_html_(self) -> str:
        """Return the frame that shows the page."""
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" title="The molecules of the run in their box, and its graphs"'
            f' style="width:100%;height:{self.height}px;border:0" allow="fullscreen" loading="lazy"></iframe>'
        )

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Write the page to a file, which a browser can open from the disk.

        Parameters
        ----------
        path
            The file; it should end in ``.html``.
        force
            Whether a file of that name may be replaced.

        Raises
        ------
        FileError
            If the file exists or cannot be written.
        """
        from atmosbox.file.output_path import check_writable, write_whole

        target = check_writable(path, force, example="page.html")
        write_whole(target, self.text.encode("utf-8"))
        return target


def show(
    *runs: xr.Dataset | str | os.PathLike[str],
    height: int = 720,
    theme: Literal["auto", "light", "dark"] = "auto",
    language: Literal["auto", "en", "de", "es"] = "auto",
) -> InlinePage:
    """Show the molecules of a run in three dimensions, with its graphs on the same clock.

    In a notebook the page is shown below the cell; elsewhere it opens in the browser. The ``save`` of the page
    writes it to a file to hand out.

    Parameters
    ----------
    *runs
        One run, or two to be shown side by side with one clock: datasets or paths of files, made with
        ``save_molecules=True``.
    height
        Height of the page in a notebook, in pixels.
    theme
        Colours of the page; ``"auto"`` takes those that the reader's computer prefers.
    language
        Language of the page; ``"auto"`` takes the first language of the reader's browser that the page has.

    Raises
    ------
    FileError
        If a run holds no molecules.
    SettingError
        If there is no run or more than two, or the theme or the language is unknown.

    >>> import atmosbox as ab
    >>> ab.show(ab.run("temperature", molecules=50, duration="5 ns", save_molecules=False))
    Traceback (most recent call last):
    atmosbox.errors.FileError: The run holds no molecules: type atmosbox.run("temperature", save_molecules=True).
    """
    from atmosbox.page.saved_run import page_text

    if not 1 <= len(runs) <= 2:
        raise SettingError("runs", None, f"are {len(runs)}", "give one run, or two to stand side by side")
    page = InlinePage(page_text([opened(run) for run in runs], theme=theme, language=language), height)
    if not in_notebook():
        folder = Path(tempfile.mkdtemp(prefix="atmosbox-page-"))  # until the temporary files are cleared
        webbrowser.open(page.save(folder / "page.html").as_uri())
    return page
