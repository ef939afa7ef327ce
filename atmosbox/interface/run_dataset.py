"""A run as Python prints it: first its results with theory beside them; and its progress in a notebook."""

import contextlib
import html
import sys
import time
from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

_WIDTH = 110


class RunDataset(xr.Dataset):  # type: ignore[no-untyped-call]
    """An `xarray.Dataset` of a run, which prints its headline table before its variables.

    >>> import atmosbox
    >>> run = atmosbox.run("elastic-collisions", duration="2 s")
    >>> print(repr(run).splitlines()[2].split()[0], isinstance(run, xr.Dataset))
    quantity True
    """

    __slots__ = ()

    def __repr__(self) -> str:
        """Return the headline table, followed by the text of xarray for the dataset."""
        dataset = xr.Dataset.__repr__(self).replace("<xarray.RunDataset>", "<xarray.Dataset>", 1)
        return "\n".join([*_results(self), dataset])

    def _repr_html_(self) -> str:
        """Return the same for a notebook."""
        dataset = str(xr.Dataset._repr_html_(self)).replace("xarray.RunDataset", "xarray.Dataset")
        results = _results(self)
        return (preformatted("\n".join(results)) if results else "") + dataset


def as_run(dataset: xr.Dataset) -> RunDataset:
    """Return the dataset as a `RunDataset`, with the same variables and attributes."""
    made = dataset.copy()
    made.__class__ = RunDataset
    return made  # type: ignore[return-value]


def _results(dataset: xr.Dataset) -> list[str]:
    """Return the lines that are shown above the variables of a run; none if the dataset is not a single run."""
    from atmosbox.errors import AtmosboxError
    from atmosbox.file.provenance import parameters
    from atmosbox.simulation.verification import headlines_of
    from atmosbox.text.report import headline_lines, ledger_line

    if "atmosbox_headlines" not in dataset.attrs or {"member", "configuration"} & set(dataset.dims):
        return []
    try:
        made, headlines = parameters(dataset), headlines_of(dataset)
    except AtmosboxError:  # a part of a run, such as a single variable of it, has no headlines
        return []
    settings = made.get("settings", {})
    facts = [f"{settings['molecules']:,} molecules"] if isinstance(settings.get("molecules"), int) else []
    facts += [f"seed {settings['seed']}"] if "seed" in settings else []
    facts += [f"engine {made['engine']}"] if "engine" in made else []
    head = f"{made.get('scene', 'run')}: {dataset.attrs.get('title', '')} ({', '.join(facts)})"
    status = str(dataset.attrs.get("atmosbox_status", "complete"))
    notes = [] if status == "complete" else [f"the run is {status}"]
    if dataset.sizes.get("elapsed_time", 0) and "ledger_residual" in dataset:
        notes.append(ledger_line(float(np.max(dataset["ledger_residual"].values))))
    return [head, "", *headline_lines(headlines, _WIDTH), "", *notes, ""]


Show = Callable[[float, str], None]


def in_notebook() -> bool:
    """Return whether this program runs in a notebook, whose cells show HTML."""
    ipython = sys.modules.get("IPython")  # a notebook has imported IPython
    shell = ipython.get_ipython() if ipython is not None else None
    return getattr(shell, "kernel", None) is not None


def preformatted(text: str) -> str:
    """Return text as HTML that keeps its columns.

    >>> preformatted("p < 1 bar").partition(">")[2]
    'p &lt; 1 bar</pre>'
    """
    return f'<pre style="line-height:1.35;font-size:90%;overflow-x:auto">{html.escape(text)}</pre>'


@contextlib.contextmanager
def progress_bar(name: str, progress: Show | bool | None = None) -> Iterator[Show | None]:
    """Show the progress of a run: in a notebook below its cell, on a terminal in the last line, elsewhere not at all.

    `progress` is a function to call instead, with the share that is done and the name of the present step; False to
    show nothing; True to show progress elsewhere too. Yields the function that the run calls; None if nothing is shown.
    """
    if callable(progress):
        yield progress
    elif progress is False:
        yield None
    elif in_notebook():
        with _notebook_bar(name) as show:
            yield show
    elif progress or (sys.stderr is not None and sys.stderr.isatty()):
        from atmosbox.text.progress import progress as terminal_bar

        with terminal_bar(name, quiet=False) as show:
            yield show
    else:
        yield None


@contextlib.contextmanager
def _notebook_bar(name: str) -> Iterator[Show]:
    """Show a bar below the cell until the run ends."""
    from IPython.display import HTML, display

    began = time.monotonic()
    handle = display(HTML(""), display_id=True)

    def show(share: float, doing: str) -> None:
        said = html.escape(name if doing in ("running", "done") else f"{name}: {doing}")
        seconds = time.monotonic() - began
        left = f"{seconds * (1.0 - share) / share:.0f} s to go" if share > 0.02 and seconds > 1.0 else ""
        bar = f'<progress max="1" value="{share:.3f}"></progress> {100.0 * share:.0f} % {left}'
        handle.update(HTML(f"<label>{said} {bar}</label>"))

    try:
        yield show
    finally:
        handle.update(HTML(""))
