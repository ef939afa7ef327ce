"""A run as Python prints it: first its results with theory beside them, then the variables of its dataset."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

if TYPE_CHECKING:
    from atmosbox.scene.headline import Headline

__all__ = ["RunDataset", "as_run"]

_WIDTH = 110


class RunDataset(xr.Dataset):  # type: ignore[no-untyped-call]
    """The dataset of a run, which prints its headline table before its variables.

    In everything else it is an `xarray.Dataset`.

    Examples
    --------
    >>> import atmosbox
    >>> run = atmosbox.run("elastic-collisions", duration="2 s")
    >>> print(repr(run).splitlines()[2].split()[0], isinstance(run, xr.Dataset))
    quantity True
    """

    __slots__ = ()

    def __repr__(self) -> str:
        """Return the headline table, followed by the text of xarray for the dataset."""
        from atmosbox.text.report import headline_lines

        dataset = xr.Dataset.__repr__(self).replace("<xarray.RunDataset>", "<xarray.Dataset>", 1)
        said = _said(self)
        if said is None:
            return dataset
        return "\n".join([said.head, "", *headline_lines(said.headlines, _WIDTH), "", *said.notes, "", dataset])

    def _repr_html_(self) -> str:
        """Return the same for a notebook."""
        from atmosbox.text.report import headline_tables

        dataset = str(xr.Dataset._repr_html_(self)).replace("xarray.RunDataset", "xarray.Dataset")
        said = _said(self)
        if said is None:
            return dataset
        tables = "".join(_table(*each) for each in headline_tables(said.headlines))
        below = "<br>".join(map(html.escape, said.notes))
        return f"<div><strong>{html.escape(said.head)}</strong>{tables}<small>{below}</small></div>{dataset}"


class _Said(NamedTuple):
    """The texts that are shown above the variables of a run."""

    head: str
    headlines: tuple[Headline, ...]
    notes: list[str]


def as_run(dataset: xr.Dataset) -> RunDataset:
    """Return the dataset as a `RunDataset`, with the same variables and attributes."""
    made = dataset.copy()
    made.__class__ = RunDataset
    return made  # type: ignore[return-value]


def _table(header: list[str], rows: list[list[str]], notes: list[str]) -> str:
    """Return a table as HTML, with its sentences below."""
    lines = [_row("th", header), *(_row("td", row) for row in rows)] if rows else []
    below = "<br>".join(map(html.escape, notes))
    return f'<table style="text-align:left;font-size:90%">{"".join(lines)}</table><small>{below}<br></small>'


def _row(tag: str, cells: list[str]) -> str:
    """Return a row of a table as HTML; only the first column may be broken into lines."""
    made = []
    for number, cell in enumerate(cells):
        style = "text-align:left" + (";white-space:nowrap" if number else "")
        made.append(f'<{tag} style="{style}">{html.escape(cell)}</{tag}>')
    return f"<tr>{''.join(made)}</tr>"


def _said(dataset: xr.Dataset) -> _Said | None:
    """Return the texts to show above the variables of a run; None if the dataset is not a single run."""
    from atmosbox.errors import AtmosboxError
    from atmosbox.file.provenance import parameters
    from atmosbox.simulation.verification import LEDGER_LIMIT, headlines_of
    from atmosbox.text.report import ledger_line

    if "atmosbox_headlines" not in dataset.attrs or {"member", "rung"} & set(dataset.dims):
        return None
    try:
        made, headlines = parameters(dataset), headlines_of(dataset)
    except AtmosboxError:  # a part of a run, such as a single variable of it, has no headlines
        return None
    settings = made.get("settings", {})
    facts = [f"{settings['molecules']:,} molecules"] if isinstance(settings.get("molecules"), int) else []
    facts += [f"seed {settings['seed']}"] if "seed" in settings else []
    facts += [f"engine {made['engine']}"] if "engine" in made else []
    head = f"{made.get('scene', 'run')}: {dataset.attrs.get('title', '')} ({', '.join(facts)})"
    status = str(dataset.attrs.get("atmosbox_status", "complete"))
    notes = [] if status == "complete" else [f"the run is {status}"]
    if dataset.sizes.get("elapsed_time", 0) and "ledger_residual" in dataset:
        notes.append(ledger_line(float(np.max(dataset["ledger_residual"].values)), LEDGER_LIMIT))
    return _Said(head, tuple(headlines), notes)
