"""A run as Python shows it: first what came out, with theory beside it, then the variables of its dataset."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["RunDataset", "as_run"]

_WIDTH = 100


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
        """Return the headline table, then what xarray says of the dataset."""
        said = _said(self)
        dataset = xr.Dataset.__repr__(self).replace("<xarray.RunDataset>", "<xarray.Dataset>", 1)
        return "\n".join([*said, "", dataset]) if said else dataset

    def _repr_html_(self) -> str:
        """Return the same for a notebook."""
        said = _said(self)
        dataset = xr.Dataset._repr_html_(self).replace("xarray.RunDataset", "xarray.Dataset")
        if not said:
            return dataset
        head, *lines = said
        text = html.escape("\n".join(lines).strip("\n"))
        pre = f'<pre style="line-height:1.35;overflow-x:auto">{text}</pre>'
        return f"<div><strong>{html.escape(head)}</strong>{pre}</div>{dataset}"


def as_run(dataset: xr.Dataset) -> RunDataset:
    """Return a dataset that begins with its headline table; variables and attributes are the same."""
    made = dataset.copy()
    made.__class__ = RunDataset
    return made  # type: ignore[return-value]


def _said(dataset: xr.Dataset) -> Sequence[str]:
    """Return what a run says of itself, one line each; nothing for what is not a single run."""
    from atmosbox.errors import AtmosboxError
    from atmosbox.file.provenance import parameters
    from atmosbox.simulation.verification import LEDGER_LIMIT, headlines_of
    from atmosbox.text.report import headline_lines, ledger_line

    if "atmosbox_headlines" not in dataset.attrs or {"member", "rung"} & set(dataset.dims):
        return ()
    try:
        made, headlines = parameters(dataset), headlines_of(dataset)
    except AtmosboxError:  # a part of a run, such as a single variable of it, has no headlines
        return ()
    settings = made.get("settings", {})
    facts = [f"{settings['molecules']:,} molecules"] if isinstance(settings.get("molecules"), int) else []
    facts += [f"seed {settings['seed']}"] if "seed" in settings else []
    facts += [f"engine {made['engine']}"] if "engine" in made else []
    head = f"{made.get('scene', 'run')}: {dataset.attrs.get('title', '')} ({', '.join(facts)})"
    status = str(dataset.attrs.get("atmosbox_status", "complete"))
    notes = [] if status == "complete" else [f"the run is {status}"]
    if dataset.sizes.get("elapsed_time", 0) and "ledger_residual" in dataset:
        notes.append(ledger_line(float(np.max(dataset["ledger_residual"].values)), LEDGER_LIMIT))
    return [head, "", *headline_lines(headlines, _WIDTH), "", *notes]
