r"""Between the numbers of a user, the SI and the reduced numbers of the engine.

The engine knows no kilogram and no kelvin: it moves molecules whose length, mass and energy are measured in a
:class:`Scale` of the scene's choice. This module is the only place where the Boltzmann constant stands, and
the only one that reads a unit: ``parse_quantity("25 degC", "K", "temperature")``.

The units that scenes declare are known here by heart; any other that a user types, from feet to inches of
mercury, is looked up in pint, which is imported only then.

References
----------
.. [1] E. Tiesinga et al., CODATA recommended values of the fundamental physical constants: 2018, Rev. Mod.
   Phys. 93, 025010 (2021), https://doi.org/10.1103/RevModPhys.93.025010.
"""

from __future__ import annotations

import functools
import math
import re
import unicodedata
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from numbers import Integral, Real
from typing import Any, NamedTuple

from atmosbox.errors import SettingError, UnitError, shown

__all__ = [
    "AVOGADRO",
    "BOLTZMANN",
    "DRY_AIR",
    "GAS_CONSTANT",
    "STANDARD_GRAVITY",
    "WATER",
    "Scale",
    "Species",
    "from_si",
    "parse_quantity",
    "parse_whole",
    "phrase",
    "to_si",
    "typed",
]

BOLTZMANN = 1.380649e-23
"""Energy per temperature, k_B, exact [1]_ [J K-1]."""
AVOGADRO = 6.02214076e23
"""Molecules in a mole, exact [1]_ [mol-1]."""
GAS_CONSTANT = BOLTZMANN * AVOGADRO
"""Molar gas constant R = k_B N_A, exact but for rounding [J mol-1 K-1]."""
STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall [m s-2]."""


@dataclass(frozen=True)
class Species:
    """A kind of molecule: a hard sphere with a mass, a diameter and ways to rotate.

    Parameters
    ----------
    name
        What a meteorologist calls it.
    molar_mass
        Mass of a mole [kg mol-1].
    molecule_mass
        Mass of one molecule [kg].
    diameter
        Distance of the centres of two such molecules that touch [m].
    rotational_dof
        Number of rotational degrees of freedom.

    Examples
    --------
    The gas constant of dry air, 287 J kg-1 K-1, is that of one molecule over its mass:

    >>> round(BOLTZMANN / DRY_AIR.molecule_mass, 2)
    287.05
    """

    name: str
    molar_mass: float
    molecule_mass: float
    diameter: float
    rotational_dof: int


DRY_AIR = Species("dry air", 28.9647e-3, 28.9647e-3 / AVOGADRO, 0.37e-9, 2)
"""Dry air as one gas: mean molar mass 28.9647 g/mol, linear molecules."""
WATER = Species("water", 18.01528e-3, 18.01528e-3 / AVOGADRO, 0.265e-9, 3)
"""Water vapour: 18.01528 g/mol, bent molecules that rotate about three axes."""


@dataclass(frozen=True)
class Scale:
    r"""What one unit of the engine's numbers is in SI units.

    Three are free, the others follow: time = length sqrt(mass / energy), temperature = energy / k_B. A
    simulated molecule moves as a single real one does, but stands for `weight` of them in all that counts
    molecules: density, pressure, and the energy and momentum of the body of air.

    Parameters
    ----------
    length
        Usually a diameter of a molecule [m].
    mass
        Usually the mass of a molecule [kg].
    energy
        Usually k_B times a temperature of the scene, of one molecule [J].
    weight
        Number of real molecules for which a simulated one stands.

    Raises
    ------
    ValueError
        If one of the four is not a positive, finite number.

    Examples
    --------
    Molecules of dry air at 288.15 K, measured in their own diameter, mass and k_B T, have a unit of speed of
    sqrt(k_B T / m), 288 m/s:

    >>> scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 288.15)
    >>> round(scale.velocity, 1), round(scale.reduced_temperature(288.15), 12)
    (287.6, 1.0)
    """

    length: float
    mass: float
    energy: float
    weight: float = 1.0

    def __post_init__(self) -> None:
        for name in ("length", "mass", "energy", "weight"):
            if not 0.0 < getattr(self, name) < math.inf:
                raise ValueError(f"The {name} of a scale must be positive and finite, not {getattr(self, name)}.")

    @property
    def time(self) -> float:
        """Unit of time, in which a molecule of unit speed crosses the unit of length [s]."""
        return self.length * math.sqrt(self.mass / self.energy)

    @property
    def velocity(self) -> float:
        """Unit of velocity [m s-1]."""
        return math.sqrt(self.energy / self.mass)

    @property
    def acceleration(self) -> float:
        """Unit of acceleration, in which gravity is given to the engine [m s-2]."""
        return self.energy / (self.mass * self.length)

    @property
    def temperature(self) -> float:
        """Temperature at which k_B T is the unit of energy [K]."""
        return self.energy / BOLTZMANN

    @property
    def number_density(self) -> float:
        """Real molecules per volume when one simulated molecule fills the unit of volume [m-3]."""
        return self.weight / self.length**3

    @property
    def mass_density(self) -> float:
        """Unit of density of the air [kg m-3]."""
        return self.mass * self.number_density

    @property
    def pressure(self) -> float:
        """Unit of pressure of the air [Pa]."""
        return self.energy * self.number_density

    @property
    def total_energy(self) -> float:
        """Unit of energy of the body of air: of its ledger, of heat and of work [J]."""
        return self.weight * self.energy

    @property
    def total_impulse(self) -> float:
        """Unit of momentum of the body of air, and of the impulse that a wall receives from it [kg m s-1]."""
        return self.weight * self.mass * self.velocity

    def reduced_temperature(self, temperature: float) -> float:
        """Return k_B T in the unit of energy: the ``kT`` that the engine is given for a heat bath.

        Parameters
        ----------
        temperature
            Temperature [K].

        Returns
        -------
        float
            k_B T / energy, a pure number.
        """
        return BOLTZMANN * temperature / self.energy


class _Unit(NamedTuple):
    """A unit: value * up / down + offset is the value in the SI unit `si`."""

    si: str
    up: float = 1.0
    down: float = 1.0
    offset: float = 0.0


_UNITS = {
    "1": _Unit("1"), "%": _Unit("1", 1, 1e2), "kg kg-1": _Unit("kg kg-1"), "g kg-1": _Unit("kg kg-1", 1, 1e3),
    "K": _Unit("K"), "degC": _Unit("K", offset=273.15),
    "Pa": _Unit("Pa"), "hPa": _Unit("Pa", 1e2), "kPa": _Unit("Pa", 1e3),
    "m": _Unit("m"), "km": _Unit("m", 1e3), "cm": _Unit("m", 1, 1e2), "mm": _Unit("m", 1, 1e3),
    "um": _Unit("m", 1, 1e6), "nm": _Unit("m", 1, 1e9),
    "s": _Unit("s"), "min": _Unit("s", 60), "h": _Unit("s", 3600), "ms": _Unit("s", 1, 1e3),
    "us": _Unit("s", 1, 1e6), "ns": _Unit("s", 1, 1e9), "ps": _Unit("s", 1, 1e12), "fs": _Unit("s", 1, 1e15),
    "m s-1": _Unit("m s-1"), "km h-1": _Unit("m s-1", 1, 3.6), "m s-2": _Unit("m s-2"),
    "K m-1": _Unit("K m-1"), "K km-1": _Unit("K m-1", 1, 1e3), "J": _Unit("J"),
    "kg": _Unit("kg"), "g": _Unit("kg", 1, 1e3),
    "kg mol-1": _Unit("kg mol-1"), "g mol-1": _Unit("kg mol-1", 1, 1e3),
}  # fmt: skip

_MEASURES = {
    "1": "a pure number", "K": "a temperature", "Pa": "a pressure", "m": "a length", "s": "a time",
    "kg": "a mass", "J": "an energy", "N": "a force", "m2": "an area", "m3": "a volume", "s-1": "a frequency",
    "m s-1": "a speed", "m s-2": "an acceleration", "K m-1": "a lapse rate", "kg m-3": "a density",
    "kg kg-1": "a mixing ratio", "kg mol-1": "a molar mass",
}  # fmt: skip

_SPELLINGS = {
    "C": "degC", "c": "degC", "celsius": "degC", "Celsius": "degC", "centigrade": "degC",
    "F": "degF", "f": "degF", "fahrenheit": "degF", "Fahrenheit": "degF",
    "k": "K", "kelvin": "K", "Kelvin": "K", "kelvins": "K", "pa": "Pa", "hpa": "hPa", "kpa": "kPa",
    "mbar": "hPa", "mb": "hPa", "millibar": "hPa", "millibars": "hPa",
    "μm": "um", "μs": "us", "percent": "%", "Torr": "torr",
}  # fmt: skip
_UNCLEAR = {"deg", "degree", "degrees"}  # of temperature or of angle, and which scale

_NUMBER = r"[+-]?(?:[0-9](?:_?[0-9])*\.?(?:[0-9](?:_?[0-9])*)?|\.[0-9](?:_?[0-9])*)(?:[eE][+-]?[0-9]+)?"
_QUANTITY = re.compile(rf"({_NUMBER}|[+-]?(?i:nan|inf(?:inity)?)(?![A-Za-z]))\s*(.*)", re.DOTALL)
_DEGREES = re.compile(r"(?:°|\b(?i:deg(?:rees?)?))[\s_]*((?i:[cfk]|celsius|fahrenheit|kelvin))(?![A-Za-z])")
_FACTOR = re.compile(r"([A-Za-zμÅΩ_]+|%)(?:(?:\^|\*\*)?([+-]?[1-9][0-9]?))?")
_BETWEEN = re.compile(r"\s*(?:(/)|·|⋅|(?<!\*)\*(?!\*))\s*|\s+")
_SIGNS = str.maketrans({"−": "-", "º": "°", "˚": "°"})  # what keyboards and word processors put for - and °
_LONGEST = 200  # characters of a text that can be a quantity


def _canonical(text: str) -> str | None:
    """Return the one spelling of a unit ("m s-2" for "m/s^2"), or None where the text cannot be one."""
    if text in _UNITS:
        return text
    text = unicodedata.normalize("NFKC", text).translate(_SIGNS)  # "m s⁻²" is "m s-2", "℃" is "°C"
    text = _DEGREES.sub(lambda match: f"deg{match[1][0].upper()}", text).replace("degK", "K")
    text = re.sub(r"\s*(\^|\*\*)\s*", r"\1", re.sub(r"\s+per\s+", "/", text))
    parts = _BETWEEN.split(text)
    factors: list[tuple[str, int]] = []
    for part, slash in zip(parts[::2], [None, *parts[1::2]], strict=True):
        match = _FACTOR.fullmatch(part)
        if match is None or match[1] in _UNCLEAR or match[1].startswith("delta"):
            return None
        factors.append((_SPELLINGS.get(match[1], match[1]), int(match[2] or 1) * (-1 if slash else 1)))
    if len(factors) > 1 or factors[0][1] != 1:  # a degree in a product is one of difference, as in degC/km
        factors = [({"degC": "K", "degF": "delta_degF"}.get(name, name), power) for name, power in factors]
    return " ".join(name if power == 1 else f"{name}{power}" for name, power in factors)


@functools.cache
def _registry() -> Any:
    """Return pint's units, imported when the first unit is met that is not known by heart."""
    import pint

    return pint.UnitRegistry()


def _looked_up(name: str) -> _Unit | None:
    """Return a canonical unit from pint; None for no unit, a pure number or a logarithmic scale."""
    from pint import PintError

    registry = _registry()

    def parsed(unit: str) -> Any:
        return registry.parse_units(re.sub(r"([^\W\d]+)([+-]?\d+)", r"\1**\2", unit).replace(" ", "*"))

    try:
        unit = parsed(name)
        zero, one, two = (registry.Quantity(x, unit).to_base_units().magnitude for x in (0.0, 1.0, 2.0))
    except (PintError, ArithmeticError, LookupError, ValueError):  # no such unit, or one like "m-99"
        return None
    if unit.dimensionless or not math.isclose(two - one, one - zero):
        return None
    alike = (si for si in _MEASURES if si not in ("1", "kg kg-1") and parsed(si).dimensionality == unit.dimensionality)
    return _Unit(next(alike, str(unit.dimensionality)), float(one - zero), 1.0, float(zero))


@functools.lru_cache(maxsize=256)
def _unit(text: str) -> _Unit | None:
    """Return the unit of any spelling, known by heart or else from pint; None where there is none."""
    name = _canonical(text)
    return None if name is None else _UNITS.get(name) or _looked_up(name)


def _declared(unit: str) -> _Unit:
    """Return the unit that a scene declares, or raise UnitError."""
    known = _unit(unit)
    if known is None:
        raise UnitError("unit", unit, "is not known", 'give one such as "hPa", "degC", "K/km" or "1"')
    return known


def to_si(value: float, unit: str, *, difference: bool = False) -> float:
    """Return a value in SI units.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit, such as "hPa", "degC", "K/km", "%", or "1" for a pure number.
    difference
        Whether the value is a difference or an error bar: one of 2 degC is one of 2 K, not of 275.15 K.

    Returns
    -------
    float
        The value in Pa, K, K m-1, 1, ...

    Raises
    ------
    UnitError
        If there is no such unit.

    Examples
    --------
    >>> to_si(25.0, "degC"), to_si(1013.25, "hPa"), to_si(0.5, "degC", difference=True)
    (298.15, 101325.0, 0.5)
    """
    known = _declared(unit)
    return value * known.up / known.down + (0.0 if difference else known.offset)


def from_si(value: float, unit: str, *, difference: bool = False) -> float:
    """Return a value of the SI in another unit; the inverse of :func:`to_si`.

    Parameters
    ----------
    value
        A number in Pa, K, K m-1, 1, ...
    unit
        The unit wanted.
    difference
        Whether the value is a difference or an error bar, to which no offset is added.

    Returns
    -------
    float
        The value in `unit`.

    Raises
    ------
    UnitError
        If there is no such unit.

    Examples
    --------
    >>> from_si(298.15, "degC"), from_si(0.0098, "K/km")
    (25.0, 9.8)
    """
    known = _declared(unit)
    return (value - (0.0 if difference else known.offset)) * known.down / known.up


def phrase(value: float, unit: str) -> str:
    """Return a number and its unit as a sentence says them.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit; "1" and the empty one are not said.

    Examples
    --------
    >>> phrase(25.0, "degC"), phrase(4000, "1")
    ('25 degC', '4000')
    """
    number = shown(value) if isinstance(value, int) else f"{value:.12g}"
    return number if unit in ("1", "") else f"{number} {unit}"


def typed(value: float, unit: str) -> str:
    """Return a number and its unit as they are typed after ``--set``, without a blank.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit; "1" and the empty one are not typed.

    Examples
    --------
    >>> typed(25.0, "degC"), typed(9.8, "m s-2"), typed(3.0, "m s-1")
    ('25degC', '9.8m/s2', '3m/s')
    """
    slashed = re.sub(r" ([A-Za-z]+)-(\d+)", lambda match: f"/{match[1]}{match[2].removeprefix('1')}", unit)
    return phrase(value, slashed.replace(" ", "*")).replace(" ", "")


@dataclass(frozen=True)
class _Request:
    """A number that is asked of the user: it reads the answer and words the refusals."""

    setting: str
    unit: str
    low: float | None
    high: float | None
    example: str | None
    whole: bool = False

    @property
    def wanted(self) -> str:
        """What would be right: "a temperature from -100 degC to 500 degC"."""
        kind = "a percentage" if self.unit == "%" else _MEASURES.get(_declared(self.unit).si, "a quantity")
        if self.whole:
            kind = "a whole number" if self.unit == "1" else f"a whole number of {self.unit}"
        limits = [None if limit is None else phrase(limit, self.unit) for limit in (self.low, self.high)]
        match limits:
            case [str(low), str(high)]:
                return f"{kind} from {low} to {high}"
            case [str(low), None]:
                return f"{kind} of at least {low}"
            case [None, str(high)]:
                return f"{kind} of at most {high}"
        return kind if self.whole or self.unit in ("1", "%") else f"{kind} in {self.unit}"

    @property
    def fix(self) -> str:
        """What to type instead: the example, or else 25 degC, 1000 hPa or a limit."""
        if self.example is not None:
            return f"give --set {self.setting}={self.example}"
        usual = {"K": ("25degC", 298.15), "Pa": ("1000hPa", 1e5)}
        text, value = usual.get(_declared(self.unit).si, ("", math.nan))
        low = -math.inf if self.low is None else to_si(self.low, self.unit)
        high = math.inf if self.high is None else to_si(self.high, self.unit)
        if not low <= value <= high:
            text = typed(next((x for x in (self.low, self.high) if x is not None), 1), self.unit)
        return f"give --set {self.setting}={text}"

    def refusal(self, value: object, problem: str) -> UnitError:
        """Return the error that says what is wrong with a value and what is wanted."""
        return UnitError(self.setting, value, f"{problem}, but {self.wanted} is wanted", self.fix)

    def read(self, value: object) -> tuple[Decimal, str]:
        """Return the number, exactly as given, and the spelling of its unit, empty for a bare number."""
        number: float | str
        unit = ""
        if isinstance(value, bool) or not isinstance(value, str | Real):
            raise self.refusal(value, "is not a number")
        if isinstance(value, str):
            text = value.strip().translate(_SIGNS)
            if not text:
                raise self.refusal(value, "is empty")
            match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
            if match is None or match[2].startswith(","):
                comma = re.match(r"[+-]?[0-9]*,[0-9]", text)
                raise self.refusal(value, "is written with a comma" if comma else "is not a number")
            number, unit = match[1], match[2]
        else:
            number = int(value) if isinstance(value, Integral) else float(value)
        try:
            exact = Decimal(number)
        except InvalidOperation:  # an exponent of twenty digits
            raise self.refusal(value, "is out of reach of any number") from None
        if not exact.is_finite():
            raise self.refusal(value, "is not finite")
        if math.isinf(float(exact)):
            raise self.refusal(value, "is too large")
        return exact, unit

    def converted(self, value: object, number: float, unit: str) -> float:
        """Return a number of the unit that was given in the one that is asked for."""
        known = None if unit == "1" else _unit(unit)
        if known is None:
            raise self.refusal(value, "has an unknown unit")
        aim = _declared(self.unit)
        if known.si != aim.si:
            kind = _MEASURES.get(known.si, "a quantity of another kind")
            raise self.refusal(value, f"is {kind}")
        result = (number * known.up / known.down + known.offset - aim.offset) * aim.down / aim.up
        if not math.isfinite(result):
            raise self.refusal(value, "is too large")
        # A typed number has few digits: 77 degF is 25 degC, not 25.00000000000006.
        return float(f"{round(result, 9) if aim.offset else result:.12g}")

    def check_range(self, value: object, unit: str, number: Decimal | float) -> None:
        """Raise SettingError if a number is outside the limits."""
        below = self.low is not None and number < self.low
        if not below and (self.high is None or number <= self.high):
            return
        limits = " to ".join(phrase(limit, self.unit) for limit in (self.low, self.high) if limit is not None)
        given = shown(value.strip() if isinstance(value, str) else value)
        if not unit and self.unit != "1":
            given = f"{given} {self.unit}"
        side = "below the lowest" if below else "above the highest"
        raise SettingError(self.setting, given, f"is {side} allowed, {limits}", self.fix)


def parse_quantity(
    value: object,
    unit: str,
    setting: str,
    *,
    low: float | None = None,
    high: float | None = None,
    example: str | None = None,
) -> float:
    """Return what a user gave for a setting as a number of the setting's unit.

    Parameters
    ----------
    value
        A number, or a text such as "25 degC", "298.15 K", "77F", "1013.25 mbar" or "9.8 m/s^2". A bare number
        is taken in `unit`. Temperatures are absolute; a degree in a product, as in "6.5 degC/km", is one of
        difference.
    unit
        The documented unit of the setting, "1" for a pure number.
    setting
        The name of the setting, for the sentence of an error.
    low, high
        The lowest and highest number allowed, in `unit`.
    example
        What an error tells the user to type; without it, something usual.

    Returns
    -------
    float
        The finite value in `unit`. One that was converted is rounded to 12 digits.

    Raises
    ------
    UnitError
        If the value is not a finite number of that kind.
    SettingError
        If it is below `low` or above `high`.

    Examples
    --------
    >>> parse_quantity("77 degF", "degC", "temperature"), parse_quantity(300, "hPa", "pressure")
    (25.0, 300.0)
    >>> parse_quantity("5 m", "degC", "temperature", low=-100.0, high=500.0)
    Traceback (most recent call last):
    atmosbox.errors.UnitError: temperature = 5 m is a length, but a temperature from -100 degC to 500 degC
    is wanted: give --set temperature=25degC.
    """
    request = _Request(setting, unit, low, high, example)
    exact, given = request.read(value)
    number = float(exact)
    if given and given != unit:
        number = request.converted(value, number, given)
    request.check_range(value, given, number)
    return number


def parse_whole(
    value: object,
    unit: str,
    setting: str,
    *,
    low: float | None = None,
    high: float | None = None,
    example: str | None = None,
) -> int:
    """Return what a user gave for a setting that counts something, exactly.

    Parameters
    ----------
    value, unit, setting, low, high, example
        As for :func:`parse_quantity`; "4e3" and 4000.0 are whole numbers, too.

    Returns
    -------
    int
        The value in `unit`, with all its digits.

    Raises
    ------
    UnitError
        If the value is not a whole number of that kind.
    SettingError
        If it is below `low` or above `high`.

    Examples
    --------
    >>> parse_whole("4e3", "1", "molecules"), parse_whole("9223372036854775807", "1", "seed")
    (4000, 9223372036854775807)
    """
    request = _Request(setting, unit, low, high, example, whole=True)
    exact, given = request.read(value)
    if given and given != unit:
        exact = Decimal(repr(request.converted(value, float(exact), given)))
    if exact != exact.to_integral_value():
        raise request.refusal(value, "is not whole")
    request.check_range(value, given, exact)
    return int(exact)
