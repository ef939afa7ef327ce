"""A sweep, prepared for a figure: the settings that were varied, with units and labels, and the headlines."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.plot.unit import convert, spelled

__all__ = ["Varied"]

_UNEVEN = 4.0
"""An axis is logarithmic if both ratios exceed this: largest step to smallest step, last value to first value."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Varied:
    """A sweep that is ready to be drawn.

    Parameters
    ----------
    dataset : xarray.Dataset
        The sweep; its dimensions are the settings that were varied.
    across : str
        The setting on the horizontal axis: a numeric one if there is any, and of these the one with the most values.
    other : str or None
        The second setting that was varied, if there is one.
    names : tuple of str
        Names of the headlines, those with a theory first.
    members : int
        Number of runs at each point.

    Examples
    --------
    >>> import xarray as xr
    >>> data = xr.Dataset(coords={"height": ("height", [0.0, 500.0], {"units": "m", "display_units": "km"})})
    >>> swept = Varied(data, "height", None, (), 1)
    >>> swept.words("height"), swept.label("height", 60)
    (['0 km', '0.5 km'], 'height')
    """

    dataset: xr.Dataset
    across: str
    other: str | None
    names: tuple[str, ...]
    members: int

    @classmethod
    def read(cls, dataset: xr.Dataset) -> Varied:
        """Prepare a dataset that `atmosbox sweep` has written.

        Raises
        ------
        FileError
            If more than two settings were varied, one of them is missing, or no run has measured anything.
        """
        about = json.loads(dataset.attrs["atmosbox_parameters"])["sweep"]
        dims = [str(name) for name in about["dimensions"].values()]
        if len(dims) > 2:
            raise FileError(
                f"A figure shows at most two settings that vary, and this sweep varies {', '.join(dims)}: "
                "sweep over two of them, or draw parts of the file yourself."
            )
        dataset = dataset.swap_dims({dim: name for dim, name in about["dimensions"].items() if dim != name})
        missing = [dim for dim in dims if dim not in dataset.sizes]
        if missing:
            raise FileError(f"The file lacks {missing[0]}, the setting that varies: type the sweep again.")
        names = [
            str(name) for name in about["headlines"] if name in dataset and np.isfinite(dataset[name].values).any()
        ]
        if not names:
            raise FileError(
                "The file has nothing to draw: no run of this sweep has measured anything; see member_reason."
            )
        across = max(dims, key=lambda dim: (dataset[dim].dtype.kind in "fi", dataset.sizes[dim], -dims.index(dim)))
        other = next((dim for dim in dims if dim != across), None)
        made = cls(dataset, across, other, (), int(about["members"]))
        names.sort(key=lambda name: made.theory(name) is None)
        return cls(dataset, across, other, tuple(names), made.members)

    def theory(self, name: str) -> Floats | None:
        """Return the theory of a headline in SI units; None where there is none, or only zero."""
        if f"{name}_theory" not in self.dataset:
            return None
        answer = np.asarray(self.dataset[f"{name}_theory"].values, dtype=np.float64)
        return answer if np.any(np.nan_to_num(answer)) else None

    def numeric(self, dim: str) -> bool:
        """Tell whether the values of a setting are numbers."""
        return self.dataset[dim].dtype.kind in "fi"

    def name(self, dim: str) -> str:
        """Return the name of a setting for a legend."""
        return dim.removesuffix("_setting").replace("_", " ")

    def label(self, dim: str, longest: int) -> str:
        """Return the description of a numeric setting if it is no longer than the given length, else its name."""
        text = str(self.dataset[dim].attrs.get("long_name", ""))
        return text if self.numeric(dim) and 0 < len(text) <= longest else self.name(dim)

    def units(self, dim: str) -> tuple[str, str]:
        """Return the unit of a setting in the file and the unit that is shown.

        The unit of the file is shown, too, if the file names no other or one into which it cannot be converted.
        """
        unit = str(self.dataset[dim].attrs.get("units", "1"))
        shown = str(self.dataset[dim].attrs.get("display_units", "")) or unit
        try:
            convert(1.0, unit, shown, name=dim)
        except FileError:
            return unit, unit
        return unit, shown

    def places(self, dim: str) -> Floats:
        """Return the positions of the values of a setting on an axis: words are at 0, 1, 2 and so on."""
        if not self.numeric(dim):
            return np.arange(self.dataset.sizes[dim], dtype=float)
        return convert(self.dataset[dim].values, *self.units(dim), name=dim)

    def words(self, dim: str) -> list[str]:
        """Return the values of a setting as text with their unit, for a legend."""
        if not self.numeric(dim):
            return [str(word) for word in np.char.decode(self.dataset[dim].values.astype("S"))]
        shown = self.units(dim)[1]
        unit = "" if shown == "1" else f" {spelled(shown)}"
        return [f"{value:.6g}".replace("-", "−") + unit for value in self.places(dim)]

    def geometric(self, dim: str) -> bool:
        """Tell whether a setting needs a logarithmic axis: positive values with very uneven steps over a wide range."""
        values = self.dataset[dim].values
        if not self.numeric(dim) or len(values) < 3 or not values[0] > 0.0:
            return False
        steps = np.diff(values)
        return bool(steps.max() > _UNEVEN * steps.min() and values[-1] > _UNEVEN * values[0])
