"""The sums in the texts of a sheet, ``{{ B.mean_temperature - A.mean_temperature }}``, and how a page prints numbers.

The file of a sheet is data and runs no code. A sum is read as an expression of Python, of which only numbers, texts,
``+ - * / **``, brackets, the runs, the functions below and the parts of a number are allowed. The package
``uncertainties`` propagates standard errors through a sum.

Numbers and units have a true minus sign, superscripts, and only the digits that are known.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np
from uncertainties import UFloat, Variable, nominal_value, std_dev, ufloat, umath

from atmosbox.errors import ConfigError, shown
from atmosbox.scene.conversion import power_of_ten, spelled

__all__ = ["Facts", "Measured", "SetNumber", "bare", "check", "filled", "fixed", "measured", "spelled", "theoretical"]


def _easy(size: float) -> bool:
    """Return whether a number of this size is easily read without a power of ten."""
    return size == 0.0 or 1e-4 <= size < 1e6


def bare(value: float, figures: int = 3) -> str:
    """Return a number as text with some significant figures.

    >>> bare(17.2071), bare(-0.000123), bare(2.4e-19), bare(1013.25)
    ('17.2', '−0.000123', '2.40·10⁻¹⁹', '1013')
    """
    if not math.isfinite(value):
        return "–"
    mantissa, power = f"{value:.{figures - 1}e}".split("e")
    if not _easy(abs(value)):
        return f"{mantissa}·{power_of_ten(int(power))}".replace("-", "−")
    return f"{value:.{max(figures - 1 - int(power), 0) if value else 0}f}".replace("-", "−")


def fixed(value: float, decimals: int) -> str:
    """Return a number as text with some decimals, and never "-0".

    >>> fixed(-17.25, 1), fixed(-0.04, 1)
    ('−17.2', '0.0')
    """
    return f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", "−")


def measured(value: float, error: float) -> str:
    """Return a measurement with its standard error; the error has two significant figures.

    >>> measured(25.784, 0.983), measured(6.691e9, 6.0e7), measured(-18.25, 0.31), measured(3.0, 0.0)
    ('25.78 ± 0.98', '(6.691 ± 0.060)·10⁹', '−18.25 ± 0.31', '3.00')
    """
    if not (math.isfinite(value) and math.isfinite(error)):
        return "–"
    if error <= 0.0:
        return bare(value)
    form = "f" if _easy(max(abs(value), error)) else "e"
    text = format(ufloat(value, error), f".2u{form}P")
    return text.replace("±", " ± ").replace("×", "·").replace("-", "−")


def theoretical(value: float, error: float) -> str:
    """Return a number of theory with as many digits as a measurement with this standard error.

    >>> theoretical(25.0, 0.983), theoretical(6.671e9, 6.0e7)
    ('25.00', '6.671·10⁹')
    """
    if not (math.isfinite(value) and error > 0.0):
        return bare(value, 4)
    return re.sub(r"\(?([−\d.]+) ± [\d.]+\)?", r"\1", measured(value, error))


MOST_DIGITS = 12
LONGEST = 4000
"""Greatest length of a text [characters]."""


@runtime_checkable
class Facts(Protocol):
    """An object whose facts can be used in a sum by their names."""

    def fact(self, name: str) -> Any:
        """Return a fact; raise ConfigError if there is none of that name."""


class SetNumber(float):
    """The number of a setting, which is shown with all its digits."""


class Measured(Variable):  # type: ignore[misc]
    """A number with its standard error, which is propagated through a sum, and its value in theory, None without one.

    >>> warm, cold = Measured(25.0, 3.0), Measured(20.0, 4.0)
    >>> print(warm - cold, 2.0 * warm, warm - warm)
    5+/-5 50+/-6 0.0+/-0
    """

    def __init__(self, value: float, error: float = 0.0, theory: float | None = None) -> None:
        super().__init__(value, error)
        self.theory = theory


_PARTS: dict[str, Callable[[Any], Any]] = {
    "value": lambda number: float(nominal_value(number)),
    "error": lambda number: float(std_dev(number)),
    "theory": lambda number: number.theory,
    "misfit": lambda number: number - number.theory,
    "sigmas": lambda number: abs(number.n - number.theory) / number.s if number.s > 0.0 else math.inf,
}
"""The parts of a number; "sigmas" is its misfit in standard errors."""


def _part(number: Any, name: str) -> Any:
    """Return a part of a number."""
    if name not in _PARTS:
        raise ConfigError(f"a number has no {shown(name)}: give one of {', '.join(_PARTS)}")
    if name not in ("value", "error") and getattr(number, "theory", None) is None:
        raise ConfigError(f"this number has no theory: leave its {name} out")
    return _PARTS[name](number)


def _late(series: Any) -> np.ndarray:
    """Return the last four fifths of a series, in which the initial state no longer matters."""
    return np.asarray(series, dtype=float)[len(series) // 5 :]


def _digits(number: float) -> int:
    """Return the number of digits that is asked for, limited to what fits on a line."""
    return int(min(max(number, 0), MOST_DIGITS))


def _at(level: float, along: Any, series: Any) -> float:
    """Return the value of a curve at a level of its abscissa, by linear interpolation."""
    order = np.argsort(along)
    return float(np.interp(level, np.asarray(along)[order], np.asarray(series)[order]))


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": lambda number: -number if nominal_value(number) < 0.0 else number,
    "sqrt": umath.sqrt,
    "exp": umath.exp,
    "ln": umath.log,
    "round": lambda number, digits=0: fixed(float(nominal_value(number)), _digits(digits)),
    "figures": lambda number, count: bare(nominal_value(number), max(_digits(count), 1)),
    "first": lambda series: float(series[0]),
    "last": lambda series: float(series[-1]),
    "lowest": lambda series: float(np.nanmin(series)),
    "highest": lambda series: float(np.nanmax(series)),
    "mean": lambda series: float(np.nanmean(_late(series))),
    "scatter": lambda series: float(np.nanstd(_late(series), ddof=1)),
    "at": _at,
    "word": lambda number, above, below: above if nominal_value(number) > 0.0 else below,
}
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: lambda base, power: (base * 1.0) ** power,  # so that no power of integers fills the memory
    ast.USub: operator.neg,
}
_SUM = re.compile(r"\{\{(.*?)\}\}")


def _value(node: ast.AST, names: Mapping[str, Facts]) -> Any:
    """Return the value of a sum, or of a part of it."""
    match node:
        case ast.Constant(value=int() | float() | str() as value):
            return value
        case ast.Name(id="pi"):
            return math.pi
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.Attribute(value=whole, attr=name):
            found = _value(whole, names)
            return found.fact(name) if isinstance(found, Facts) else _part(found, name)
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*(_value(each, names) for each in arguments))
        case ast.BinOp(op=sign, left=ast.AST() as left, right=ast.AST() as right):
            sides = [_value(each, names) for each in (left, right)]
            if all(isinstance(each, int | float | UFloat | np.ndarray) for each in sides):
                return _OPERATORS[type(sign)](*sides)
        case ast.UnaryOp(op=sign, operand=operand):
            return _OPERATORS[type(sign)](_value(operand, names))
    raise ConfigError(f"{ast.unparse(node)} is neither a run, a function nor a sum of numbers: correct it")


def _printed(result: Any) -> str:
    """Return the result of a sum as text."""
    match result:
        case str():
            return result.replace("<", "&lt;")
        case bool():
            return "on" if result else "off"
        case SetNumber():
            return f"{result:.12g}".replace("-", "−")
        case UFloat():
            return measured(result.n, result.s)
        case int() | float():
            whole = abs(result) < 1e6 and result == int(result) if math.isfinite(result) else False
            return str(int(result)).replace("-", "−") if whole else bare(float(result))
    raise ConfigError("the result of a sum is not a number: name a number of the run")


def _typed(result: Any) -> str:
    """Return the result of a sum as it is typed for a setting."""
    return f"{result:.12g}" if isinstance(result, float) else str(result)


def check(text: str) -> list[str | ast.expr]:
    """Return the pieces of a text, words and sums in turn; no sum is worked out.

    >>> check("{% for i in (1, 2) %}again{% endfor %}")
    Traceback (most recent call last):
    atmosbox.errors.ConfigError: its sums cannot be understood (a brace that is not closed, a statement, or more than \
4000 characters): write sums as {{ 2 * 3 }}
    """
    pieces = _SUM.split(text)
    try:
        if len(text) > LONGEST or any("{{" in words or "{%" in words for words in pieces[::2]):
            raise SyntaxError(f"a brace that is not closed, a statement, or more than {LONGEST} characters")
        return [ast.parse(each.strip(), mode="eval").body if n % 2 else each for n, each in enumerate(pieces)]
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise ConfigError(f"its sums cannot be understood ({error}): write sums as {{{{ 2 * 3 }}}}") from error


def filled(text: str, names: Mapping[str, Facts], *, setting: bool = False) -> str:
    """Return a text with its sums worked out; ``names`` are the runs by their letters.

    A sum becomes a number with three significant figures, or a measurement with its error; ``round(x, 1)`` sets the
    number of decimals, ``figures(x, 2)`` the number of significant figures. Other functions are abs, sqrt, exp, ln; for
    a series of a run first, last, lowest, highest, mean and scatter (the latter two over its last four fifths), and
    ``at(level, along, series)``; and ``word(x, 'warmer', 'colder')``, which is the first word if x is above zero. In
    the value of a ``setting`` a number has all digits, as it is typed. A sum that cannot be worked out
    raises ConfigError.

    >>> class Box:
    ...     def fact(self, name):
    ...         return {"molecules": 800, "temperature": Measured(25.8, 0.9, 25.0)}[name]
    >>> filled("{{ A.temperature }} °C, noise {{ round(298 * sqrt(2 / (3 * A.molecules)), 1) }} K", {"A": Box()})
    '25.80 ± 0.90 °C, noise 8.6 K'
    """
    written = _typed if setting else _printed
    try:
        return "".join(each if isinstance(each, str) else written(_value(each, names)) for each in check(text))
    except (ArithmeticError, ValueError, TypeError, LookupError, RecursionError) as error:
        if isinstance(error, ConfigError):
            raise
        raise ConfigError(f"a sum cannot be worked out ({error}): correct {shown(text, 200)}") from error
