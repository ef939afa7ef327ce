"""The sums in the texts of a sheet: ``{B.mean_temperature - A.mean_temperature:.1f}`` and no more than that.

A text of a sheet is data and runs no code. What stands between its braces is read as an expression of numbers, names,
the four operations, powers and some functions, and worked out here.
"""

from __future__ import annotations

import ast
import math
import operator
import string
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from atmosbox.errors import ConfigError, shown
from atmosbox.sheet.number_text import bare, measured

__all__ = ["Known", "Measured", "filled"]


class Known(Protocol):
    """Something whose facts an expression may ask for by name."""

    def fact(self, name: str) -> Any:
        """Return a fact; raise ConfigError if there is none of that name."""


@dataclass(frozen=True)
class Measured:
    """A number with its standard error, which goes with it through a sum.

    Parameters
    ----------
    value, error
        The number and its standard error.
    theory
        What theory says of it; None where it says nothing.

    Notes
    -----
    Errors are added in quadrature, as those of numbers that know nothing of each other: of different runs, that is.

    Examples
    --------
    >>> str(Measured(25.0, 3.0) - Measured(20.0, 4.0)), str(2.0 * Measured(25.0, 3.0))
    ('5.0 ± 5.0', '50.0 ± 6.0')
    """

    value: float
    error: float = 0.0
    theory: float | None = None

    def fact(self, name: str) -> Any:
        """Return a part of it: value, error, theory, the misfit, or this in standard errors.

        Examples
        --------
        >>> Measured(25.0, 2.0, 20.0).fact("sigmas")
        2.5
        """
        if name in ("theory", "misfit", "sigmas") and self.theory is None:
            raise ConfigError(f"A sheet asks for the {name} of a number of which theory says nothing: leave it out.")
        theory = self.theory or 0.0
        misfit = self.value - theory
        parts = {
            "value": self.value,
            "error": self.error,
            "theory": theory,
            "misfit": Measured(misfit, self.error),
            "sigmas": abs(misfit) / self.error if self.error > 0.0 else math.inf,
        }
        if name not in parts:
            raise ConfigError(f"A sheet asks for {shown(name)} of a number: give one of {', '.join(parts)}.")
        return parts[name]

    def __str__(self) -> str:
        return measured(self.value, self.error)

    def __add__(self, other: Any) -> Measured:
        more = _as_measured(other)
        return Measured(self.value + more.value, math.hypot(self.error, more.error))

    __radd__ = __add__

    def __sub__(self, other: Any) -> Measured:
        return self + (-_as_measured(other))

    def __rsub__(self, other: Any) -> Measured:
        return _as_measured(other) - self

    def __neg__(self) -> Measured:
        return Measured(-self.value, self.error)

    def __mul__(self, other: Any) -> Measured:
        more = _as_measured(other)
        return Measured(self.value * more.value, math.hypot(self.error * more.value, more.error * self.value))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Measured:
        more = _as_measured(other)
        return self * Measured(1.0 / more.value, more.error / more.value**2)

    def __rtruediv__(self, other: Any) -> Measured:
        return _as_measured(other) / self

    def __pow__(self, power: float) -> Measured:
        return Measured(self.value**power, abs(power * self.value ** (power - 1.0)) * self.error)


def _as_measured(number: Any) -> Measured:
    """Return a number as one with an error."""
    return number if isinstance(number, Measured) else Measured(float(number))


def _late(values: Any) -> np.ndarray:
    """Return the last four fifths of a series, which have forgotten how it began."""
    series = np.asarray(values, dtype=float)
    return series[len(series) // 5 :]


def _plain(number: Any) -> float:
    """Return a number without its error."""
    return number.value if isinstance(number, Measured) else float(number)


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": lambda x: Measured(abs(x.value), x.error) if isinstance(x, Measured) else abs(x),
    "sqrt": lambda x: x**0.5,
    "exp": lambda x: math.exp(_plain(x)),
    "ln": lambda x: math.log(_plain(x)),
    "first": lambda x: float(np.asarray(x)[0]),
    "last": lambda x: float(np.asarray(x)[-1]),
    "lowest": lambda x: float(np.nanmin(x)),
    "highest": lambda x: float(np.nanmax(x)),
    "mean": lambda x: float(np.nanmean(_late(x))),
    "scatter": lambda x: float(np.nanstd(_late(x), ddof=1)),
    "at": lambda level, along, x: float(np.interp(level, *_sorted(along, x))),
    "word": lambda x, above, below: above if _plain(x) > 0.0 else below,
}
_OPERATIONS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: lambda base, power: base ** float(power),
    ast.USub: operator.neg,
}


def _sorted(along: Any, values: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return a curve in the order in which its abscissa grows."""
    order = np.argsort(along)
    return np.asarray(along, dtype=float)[order], np.asarray(values, dtype=float)[order]


def filled(text: str, names: Mapping[str, Known]) -> str:
    """Return a text with the sums between its braces worked out.

    Parameters
    ----------
    text
        The text. ``{sum}`` becomes a number of three figures, or a measurement with its error; ``{sum:.1f}`` says how
        many decimals. Functions are abs, sqrt, exp, ln; of a series of a run first, last, lowest, highest, and mean
        and scatter of its last four fifths; ``at(level, along, series)``; and ``word(x, "warmer", "colder")``, which
        picks the first word if x is above zero.
    names
        The runs by their letters.

    Raises
    ------
    ConfigError
        If a brace is open or a sum cannot be worked out.

    Examples
    --------
    >>> class Box:
    ...     def fact(self, name):
    ...         return {"molecules": 800.0, "temperature": Measured(25.8, 0.9, 25.0)}[name]
    >>> filled("{A.temperature} °C, noise {298 * sqrt(2 / (3 * A.molecules)):.1f} K", {"A": Box()})
    '25.80 ± 0.90 °C, noise 8.6 K'
    """
    made = []
    try:
        for literal, field, spec, conversion in string.Formatter().parse(text):
            made.append(literal)
            if field is not None:
                if conversion:
                    raise ValueError("an exclamation mark")
                made.append(_shown(_worked_out(ast.parse(field.strip(), mode="eval").body, names), spec or ""))
    except (SyntaxError, ValueError, TypeError, ArithmeticError, KeyError, IndexError) as error:
        raise ConfigError(f"A text of the sheet cannot be filled in ({error}): {shown(text, 200)}.") from error
    return "".join(made)


def _shown(number: Any, spec: str) -> str:
    """Return what a sum came to as text."""
    if isinstance(number, str):
        return number
    if isinstance(number, bool):
        return "on" if number else "off"
    if spec:
        return format(_plain(number), spec).replace("-", "−")
    if isinstance(number, Measured):
        return str(number)
    return str(number) if isinstance(number, int) else bare(float(number))


def _worked_out(node: ast.AST, names: Mapping[str, Known]) -> Any:
    """Return what an expression comes to; all but arithmetic is refused."""

    def of(child: ast.AST) -> Any:
        return _worked_out(child, names)

    match node:
        case ast.Constant(value=int() | float() | str()):
            return node.value
        case ast.Name(id="pi"):
            return math.pi
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.Attribute(value=owner, attr=name):
            return of(owner).fact(name)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATIONS:
            return _OPERATIONS[type(op)](of(left), of(right))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -of(operand)
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*(of(each) for each in arguments))
    raise ValueError(f"{ast.unparse(node)} is none of its sums")
