"""A run as Python prints it: first its results with theory beside them, then the variables of its dataset."""

from __future__ import annotations

import numpy as np
import xarray as xr

from atmosbox.interface.notebook import preformatted

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
    from atmosbox.simulation.verification import LEDGER_LIMIT, headlines_of
    from atmosbox.text.report import headline_lines, ledger_line

    if "atmosbox_headlines" not in dataset.attrs or {"member", "rung"} & set(dataset.dims):
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
        notes.append(ledger_line(float(np.max(dataset["ledger_residual"].values)), LEDGER_LIMIT))
    return [head, "", *headline_lines(headlines, _WIDTH), "", *notes, ""]
