"""The sums in the texts of a sheet: ``{{ B.mean_temperature - A.mean_temperature }}``, worked out by Jinja.

The file of a sheet is data and runs no code. It may use only expressions of Jinja's language, no loops and no macros.
An expression may contain the runs, the functions below and the parts of a number, but no attribute, method or filter
of Python. The package ``uncertainties`` propagates standard errors through a sum.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

import jinja2
import numpy as np
from jinja2 import nodes
from jinja2.exceptions import SecurityError
from jinja2.sandbox import SandboxedEnvironment
from uncertainties import UFloat, Variable, nominal_value, std_dev, umath

from atmosbox.errors import ConfigError, shown
from atmosbox.sheet.number_text import bare, fixed, measured

__all__ = ["Facts", "Measured", "SetNumber", "check", "filled"]

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
    """A number with its standard error, which is propagated through a sum, and with its value in theory.

    Parameters
    ----------
    value, error
        The number and its standard error.
    theory
        Its value in theory; None if there is no theory of it.

    Examples
    --------
    >>> warm, cold = Measured(25.0, 3.0), Measured(20.0, 4.0)
    >>> print(warm - cold, 2.0 * warm, warm - warm)
    5+/-5 50+/-6 0.0+/-0
    """

    def __init__(self, value: float, error: float = 0.0, theory: float | None = None) -> None:
        super().__init__(value, error)
        self.theory = theory


def _part(number: Any, name: str) -> Any:
    """Return a part of a number: value, error, theory, misfit, or sigmas (the misfit in standard errors)."""
    theory = getattr(number, "theory", None)
    if name in ("theory", "misfit", "sigmas") and theory is None:
        raise ConfigError(f"there is no theory of a number whose {name} is asked for: leave it out")
    match name:
        case "value":
            return float(nominal_value(number))
        case "error":
            return float(std_dev(number))
        case "theory":
            return theory
        case "misfit":
            return number - theory
        case "sigmas":
            return abs(number.n - theory) / number.s if number.s > 0.0 else math.inf
    raise ConfigError(f"a number has no {shown(name)}: give one of value, error, theory, misfit, sigmas")


def _late(series: Any) -> np.ndarray:
    """Return the last four fifths of a series, in which the initial state no longer matters."""
    return np.asarray(series, dtype=float)[len(series) // 5 :]


def _digits(number: float) -> int:
    """Return the number of digits that is asked for, limited to what fits on a line."""
    return int(min(max(number, 0), MOST_DIGITS))


def _round(number: Any, digits: float = 0) -> str:
    """Return a number as text with some decimals."""
    return fixed(float(nominal_value(number)), _digits(digits))


def _at(level: float, along: Any, series: Any) -> float:
    """Return the value of a curve at a level of its abscissa, by linear interpolation."""
    order = np.argsort(along)
    return float(np.interp(level, np.asarray(along)[order], np.asarray(series)[order]))


_FUNCTIONS = {
    "pi": math.pi,
    "abs": lambda number: -number if nominal_value(number) < 0.0 else number,
    "sqrt": umath.sqrt,
    "exp": umath.exp,
    "ln": umath.log,
    "round": _round,
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
_ALLOWED = (
    nodes.Template, nodes.Output, nodes.TemplateData, nodes.Const, nodes.Name, nodes.Getattr, nodes.Call,
    nodes.Add, nodes.Sub, nodes.Mul, nodes.Div, nodes.Pow, nodes.Neg, nodes.Concat, nodes.CondExpr,
)  # fmt: skip
"""The parts of Jinja's language that a text may contain: no statements, and nothing that could run for long."""
_NUMBERS = (bool, int, float, UFloat, np.ndarray)


class _Sandbox(SandboxedEnvironment):
    """Jinja's sandbox, in which only the facts of a run and the parts of a number are attributes."""

    intercepted_binops = frozenset(SandboxedEnvironment.default_binop_table)

    def call_binop(self, context: Any, operator: str, left: Any, right: Any) -> Any:
        """Work out a sum of numbers; powers in floating point, so that no power of integers fills the memory."""
        if not (isinstance(left, _NUMBERS) and isinstance(right, _NUMBERS)):
            raise SecurityError(f"{operator} stands between things that are not numbers")
        return super().call_binop(context, operator, left * 1.0 if operator == "**" else left, right)

    def getattr(self, obj: Any, attribute: str) -> Any:
        """Return a fact of a run, or a part of a number."""
        if isinstance(obj, Facts):
            return obj.fact(attribute)
        if isinstance(obj, UFloat | float):
            return _part(obj, attribute)
        name = getattr(obj, "_undefined_name", None)
        raise SecurityError(f"{name} is no run" if name else f"{attribute} is no fact of a run and no part of a number")


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


_TEXTS = _Sandbox(undefined=jinja2.StrictUndefined, finalize=_printed, autoescape=False)
_TEXTS.globals, _TEXTS.filters, _TEXTS.tests = dict(_FUNCTIONS), {}, {}
_SETTINGS = _TEXTS.overlay(finalize=_typed)


def _syntax(text: str) -> None:
    """Refuse a text that contains more than words and sums, or is too long for a sheet."""
    if len(text) > LONGEST:
        raise SecurityError(f"a text of more than {LONGEST} characters")
    for node in _TEXTS.parse(text).find_all(nodes.Node):
        if not isinstance(node, _ALLOWED):
            raise SecurityError(f"a {type(node).__name__.lower()} is more than a sum")


@functools.lru_cache(1000)
def _compiled(text: str, setting: bool) -> jinja2.Template:
    """Return a text whose sums can be worked out; its sums are compiled once, before and after the runs."""
    _syntax(text)
    return (_SETTINGS if setting else _TEXTS).from_string(text)


def check(text: str) -> None:
    """Refuse a text whose sums cannot be parsed or are more than sums; no sum is worked out.

    Raises
    ------
    ConfigError
        If a brace is not closed, or the text contains a loop, a macro or a filter.

    Examples
    --------
    >>> check("{% for i in (1, 2) %}again{% endfor %}")
    Traceback (most recent call last):
    atmosbox.errors.ConfigError: its sums cannot be understood (a for is more than a sum): write sums as {{ 2 * 3 }}
    """
    try:
        _syntax(text)
    except (jinja2.TemplateError, RecursionError) as error:
        raise ConfigError(f"its sums cannot be understood ({error}): write sums as {{{{ 2 * 3 }}}}") from error


def filled(text: str, names: Mapping[str, Facts], *, setting: bool = False) -> str:
    """Return a text with its sums worked out.

    Parameters
    ----------
    text
        The text. A sum becomes a number with three significant figures, or a measurement with its error;
        ``round(x, 1)`` sets the number of decimals, ``figures(x, 2)`` the number of significant figures. Other
        functions are abs, sqrt, exp, ln; for a series of a run first, last, lowest, highest, mean and scatter (the
        latter two over its last four fifths), and ``at(level, along, series)``; and ``word(x, 'warmer', 'colder')``,
        which is the first word if x is above zero.
    names
        The runs by their letters.
    setting
        Whether the text is the value of a setting, to be written with all digits as it is typed.

    Raises
    ------
    ConfigError
        If a sum cannot be worked out.

    Examples
    --------
    >>> class Box:
    ...     def fact(self, name):
    ...         return {"molecules": 800, "temperature": Measured(25.8, 0.9, 25.0)}[name]
    >>> filled("{{ A.temperature }} °C, noise {{ round(298 * sqrt(2 / (3 * A.molecules)), 1) }} K", {"A": Box()})
    '25.80 ± 0.90 °C, noise 8.6 K'
    """
    try:
        return _compiled(text, setting).render(names)
    except ConfigError:
        raise
    except (jinja2.TemplateError, ArithmeticError, ValueError, TypeError, LookupError, RecursionError) as error:
        raise ConfigError(f"a sum cannot be worked out ({error}): correct {shown(text, 200)}") from error
