"""The text of a figure: headline numbers, labels of the axes, and the footer with the provenance of the run."""

import json
import math
from typing import Any, NamedTuple

import xarray as xr

from atmosbox.errors import FileError
from atmosbox.plot.curve import convert, of_difference, power_of_ten, read, spelled, unit_of
from atmosbox.scene.panels import Panel


class Reading(NamedTuple):
    """A headline number as text, in parts; a part that does not exist is empty."""

    label: str
    """Name of the measured quantity."""
    number: str
    """The measured number, with as many digits as its standard error allows."""
    error: str
    """Its standard error, power of ten and unit."""
    theory: str
    """The value of the textbook, with its unit."""
    difference: str
    """Whether both agree; if they do not, measured minus textbook, and within how much it was expected."""

    @property
    def sentence(self) -> str:
        """Label, theory, number and error in one line, for a page."""
        beside = f" ({self.theory})" if self.theory else ""
        return f"{self.label}{beside} = {self.number} {self.error}".rstrip()


def headlines(dataset: xr.Dataset, panels: tuple[Panel, ...]) -> list[list[Reading]]:
    """Return the headline numbers of each panel, without those that the run has not measured.

    If no panel names a headline, all of them belong to the first panel that shows curves.
    """
    names = stated(dataset, "atmosbox_headlines", list)
    chosen = [list(panel.headlines) for panel in panels]
    if panels and not any(chosen):
        first = next((i for i, panel in enumerate(panels) if panel.kind != "discs"), 0)
        chosen[first] = names
    return [[found for name in each if (found := headline(dataset, name))] for each in chosen]


def headline(dataset: xr.Dataset, name: str) -> Reading | None:
    r"""Return a headline number with its error, theory and difference as text; None if the run has not measured it.

    The difference is expected within what chance and the known error of the model allow together.

    >>> import xarray as xr
    >>> dataset = xr.Dataset({"t": ((), 204.53, {"units": "K", "display_name": "T(300 hPa)"}), "t_se": 0.05})
    >>> dataset["t_theory"] = ((), 204.41, {"units": "K", "display_name": "adiabat"})
    >>> headline(dataset, "t").sentence.replace("\u00a0", " ")
    'T(300 hPa) (adiabat 204.41 K) = 204.53 ± 0.05 K'
    >>> for known in (0.1, 0.0):
    ...     dataset.t.attrs |= {"misfit_allowed_by_chance": 0.1, "misfit_allowed_as_known": known}
    ...     print(headline(dataset, "t").difference.replace("\u00a0", " "))
    agrees
    difference +0.12 K, expected within ±0.10 K
    """
    value, theory, error = (_scalar(dataset, name + part) for part in ("", "_theory", "_se"))
    if not math.isfinite(value):
        return None
    attrs = read(dataset, name).attrs
    if not attrs.get("resolved", True):  # the run is too small to measure it
        return None
    unit = str(attrs.get("units", "1"))
    shown = str(attrs.get("display_units", unit))
    apart = of_difference(shown)
    error = float(convert(error, unit, shown, name=name, difference=True))
    label = str(attrs.get("display_name") or attrs.get("long_name") or name.replace("_", " "))
    digits, deviation, power = _digits(float(convert(value, unit, shown, name=name)), error)
    spread = " ".join(part for part in ("±" if deviation else "", deviation, power, spelled(shown)) if part)
    if not math.isfinite(theory):
        return Reading(label, digits, spread, "", "")
    called = str(read(dataset, f"{name}_theory").attrs.get("display_name", "theory"))
    expected = _known(float(convert(theory, unit, shown, name=name)), error, shown)
    misfit = float(convert(value - theory, unit, apart, name=name, difference=True))
    most = sum(attrs.get(f"misfit_allowed_{part}", 0.0) for part in ("by_chance", "as_known"))
    most = float(convert(most, unit, apart, name=name, difference=True))
    away = f"difference {_known(misfit, error, apart, signed=True)}"
    if abs(misfit) <= most:
        away = "agrees"
    elif most > 0.0:
        away += f", expected within ±{_known(most, error, apart)}"
    return Reading(label, digits, spread, f"{called} {expected}", away)


def _known(value: float, error: float, unit: str, *, signed: bool = False) -> str:
    """Return a number with as many digits as its error allows, and its unit, joined by spaces that do not break."""
    digits, _, power = _digits(value, error, signed=signed)
    return "\u00a0".join(part for part in (digits, power, spelled(unit).replace(" ", "\u00a0")) if part)


def _digits(value: float, error: float, *, signed: bool = False) -> tuple[str, str, str]:
    """Return the digits of a number, those of its error (empty if it is not known), and their common power of ten."""
    known = math.isfinite(error) and error > 0
    largest = max(abs(value), error) if known else abs(value)
    power = 0 if largest == 0 or 1e-3 <= largest < 1e6 else math.floor(math.log10(largest))
    value, error = value / 10.0**power, error / 10.0**power
    if known:
        magnitude = math.floor(math.log10(error))
        decimals = (1 if error < 1.95 * 10.0**magnitude else 0) - magnitude
    elif power or not value:
        decimals = 1 if power else 0
    else:
        decimals = 2 - math.floor(math.log10(abs(value)))
    decimals = max(0, decimals)
    text = f"{value:{'+' if signed else ''}.{decimals}f}".replace("-", "−")
    if not text.strip("+−0."):
        text = text.strip("+−")
    return text, f"{error:.{decimals}f}" if known else "", f"× {power_of_ten(power)}" if power else ""


def footer(dataset: xr.Dataset) -> str:
    """Return the small type under a figure: version, scene, molecules, seed, engine, and the status if incomplete."""
    parameters = stated(dataset, "atmosbox_parameters", dict)
    settings = parameters.get("settings", {})
    count = settings.get("molecules", dataset.sizes.get("molecule"))
    seed, engine = settings.get("seed"), parameters.get("engine")
    status = dataset.attrs.get("atmosbox_status", "complete")
    particle = ("disc" if "disc_position" in dataset.variables else "molecule") + ("" if count == 1 else "s")
    parts = [
        f"atmosbox {parameters.get('version', '')}".rstrip(),
        str(parameters.get("scene", "")),
        "" if count is None else f"{int(count):,} {particle}".replace(",", "\u2009" if count >= 10000 else ""),
        "" if seed is None else f"seed {seed}",
        "" if engine is None else f"{engine} engine",
        "" if status == "complete" else f"{status} run",
    ]
    return " · ".join(part for part in parts if part)


def axis_labels(dataset: xr.Dataset, panel: Panel) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return label and unit of both axes; what the panel does not give is that of the variables of its first line."""
    if panel.kind == "discs":
        return (panel.x_label or "x", panel.x_unit or "nm"), (panel.y_label or "z", panel.x_unit or "nm")
    if panel.kind == "atmosphere":
        return (panel.x_label, ""), (panel.y_label or "height", "km")
    line = panel.lines[0]
    x, y = (str(read(dataset, name).attrs.get("long_name", name.replace("_", " "))) for name in (line.x, line.y))
    units = unit_of(dataset, panel, "x"), unit_of(dataset, panel, "y")
    return (panel.x_label or x, units[0]), (panel.y_label or y, units[1])


def _scalar(dataset: xr.Dataset, name: str) -> float:
    """Return a single number of the file; NaN if the file lacks it."""
    return float(read(dataset, name)) if name in dataset.variables else math.nan


def stated(dataset: xr.Dataset, name: str, kind: type) -> Any:
    """Return the value of an attribute that holds JSON; an empty one of this kind if the file lacks the attribute."""
    text = dataset.attrs.get(name)
    try:
        found = kind() if text is None else json.loads(text)
    except (TypeError, ValueError):
        found = None
    if not isinstance(found, kind):
        raise FileError(f"The attribute {name} of the file cannot be read: it was not written by atmosbox.")
    return found
