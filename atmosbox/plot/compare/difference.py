"""The headline numbers of several runs, and their differences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import xarray as xr

from atmosbox.errors import FileError, UnitError
from atmosbox.plot.caption import stated
from atmosbox.scene.conversion import from_si

__all__ = ["Compared", "Measured", "compared"]


@dataclass(frozen=True)
class Measured:
    """A headline number of one run.

    Parameters
    ----------
    value, error : float
        The measurement and its standard error [unit]; NaN where the run has none.
    theory : float
        The value of the textbook [unit]; NaN where there is none.

    Examples
    --------
    >>> Measured(15.0, 0.3, math.nan).value
    15.0
    """

    value: float
    error: float
    theory: float


@dataclass(frozen=True)
class Compared:
    """A headline number of several runs.

    Parameters
    ----------
    name, label : str
        Its name in the file, and its name in a table.
    unit : str
        The unit of all numbers; differences of numbers in degC are in K.
    runs : tuple of Measured
        The number of each run.

    Examples
    --------
    The second run is 20 K warmer; the standard error is 0.5 K, so the difference is 40 standard errors:

    >>> warm = Compared("t", "temperature", "degC", (Measured(5.0, 0.3, 5.1), Measured(25.0, 0.4, 24.9)))
    >>> warm.difference(1), warm.error(1), warm.sigma(1)
    (20.0, 0.5, 40.0)
    """

    name: str
    label: str
    unit: str
    runs: tuple[Measured, ...]

    def difference(self, run: int) -> float:
        """Return the number of a run minus that of the first run."""
        return self.runs[run].value - self.runs[0].value

    def error(self, run: int) -> float:
        """Return the standard error of the difference, for runs that are statistically independent."""
        return math.hypot(self.runs[run].error, self.runs[0].error)

    def sigma(self, run: int) -> float:
        """Return the difference in units of its standard error; NaN where that is not known."""
        error = self.error(run)
        return self.difference(run) / error if error > 0.0 else math.nan

    def expected(self, run: int) -> float:
        """Return the difference between the theories of a run and of the first; NaN where there is no theory."""
        return self.runs[run].theory - self.runs[0].theory


def compared(datasets: Sequence[xr.Dataset]) -> tuple[Compared, ...]:
    """Return the headline numbers that at least two runs have measured.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs.

    Returns
    -------
    tuple of Compared
        The numbers, in the units in which tables show them.

    Raises
    ------
    FileError
        If the attribute ``atmosbox_headlines`` of a file cannot be read, or names a variable that no file has.

    Examples
    --------
    >>> import xarray as xr
    >>> def run(value):
    ...     numbers = {"t": ((), value, {"units": "K", "display_units": "degC"}), "t_se": 0.5}
    ...     return xr.Dataset(numbers, attrs={"atmosbox_headlines": '["t"]'})
    >>> (found,) = compared([run(278.15), run(298.15)])
    >>> found.unit, found.difference(1)
    ('degC', 20.0)
    """
    named = [name for dataset in datasets for name in stated(dataset, "atmosbox_headlines", list)]
    found = [_compared(datasets, name) for name in dict.fromkeys(map(str, named))]
    return tuple(each for each in found if sum(math.isfinite(run.value) for run in each.runs) > 1)


def _compared(datasets: Sequence[xr.Dataset], name: str) -> Compared:
    """Return one headline number of all runs, in the unit of the first run that has it."""
    attrs = next((dataset[name].attrs for dataset in datasets if name in dataset.variables), None)
    if attrs is None:
        raise FileError(
            f"No file has the variable {name!r} that its results name: it was changed; run the scene again."
        )
    unit = str(attrs.get("display_units", attrs.get("units", "1")))
    label = str(attrs.get("long_name", name.replace("_", " ")))
    return Compared(name, label, unit, tuple(_measured(dataset, name, unit) for dataset in datasets))


def _measured(dataset: xr.Dataset, name: str, unit: str) -> Measured:
    def shown(part: str, *, difference: bool = False) -> float:
        if part not in dataset.variables:
            return math.nan
        try:
            return from_si(float(dataset[part].values), unit, difference=difference)
        except UnitError:
            return math.nan

    return Measured(shown(name), shown(f"{name}_se", difference=True), shown(f"{name}_theory"))
