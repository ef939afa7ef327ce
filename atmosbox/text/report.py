"""A run, a file and a scene as lines of text and as JSON."""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from atmosbox.scene.conversion import from_si
from atmosbox.scene.headline import AS_STATED, CHANCE_LIMIT
from atmosbox.scene.quantity import phrase
from atmosbox.text.table import digits, measurement, number, table, wrapped

if TYPE_CHECKING:
    from atmosbox.scene.headline import Headline
    from atmosbox.scene.parameter import Parameter
    from atmosbox.simulation.runner import Card, Outcome

_ALIKE = {1: "", 2: "both "}


def next_command(command: str, path: Path) -> str:
    """Return a command to type next, with the path of a file.

    Examples
    --------
    >>> next_command("plot", Path("my run.nc")), next_command("plot", Path("-7.nc"))
    ("atmosbox plot 'my run.nc'", 'atmosbox plot ./-7.nc')
    """
    name = str(path)
    return f"atmosbox {command} {shlex.quote(f'./{name}' if name.startswith('-') else name)}"


def _shown(headline: Headline) -> dict[str, Any]:
    """Return the numbers of a headline in its display unit."""
    unit = headline.display_unit

    def difference(value: float | None) -> float | None:
        return None if value is None else from_si(value, unit, difference=True)

    return {
        "value": from_si(headline.value, unit),
        "standard_error": difference(headline.standard_error),
        "theory": None if headline.theory is None else from_si(headline.theory, unit),
        "misfit": difference(headline.misfit),
        "tolerance": difference(headline.tolerance),
        "bias": difference(headline.bias),
        "allowed": difference(headline.allowed),
        "chance": difference(headline.chance),
        "known": difference(headline.known),
    }


def headline_json(headline: Headline) -> dict[str, Any]:
    """Return a headline as a record for JSON, in the unit in which the table shows it."""
    return {
        "name": headline.name,
        "label": headline.label,
        "unit": headline.display_unit,
        **_shown(headline),
        "reason": headline.excuse,
        "agrees": headline.agrees,
        "within_error": headline.verdict,
    }


def headline_lines(headlines: Sequence[Headline], width: int) -> list[str]:
    r"""Return the table of measured values, theory and allowed differences, and why a model may differ from theory.

    Examples
    --------
    >>> from atmosbox.scene.headline import Headline
    >>> warm = Headline("t", 291.0, 2.0, 288.0, 0.5, "the box is small", "K", "degC", "temperature")
    >>> print("\n".join(headline_lines([warm], 100)))
    quantity            measured    theory  misfit       allowed  within error?
    temperature [degC]  17.9 ± 2.0  14.9    +3.0 (1.5σ)  4σ+0.5   yes
    allowed: 4 standard errors σ, by chance, + the known error of the model
    """
    header, rows, notes = headline_cells(headlines)
    lines = table(header, rows, width) if rows else []
    return [*lines, *(line for note in notes for line in wrapped(note, width))]


def headline_cells(headlines: Sequence[Headline]) -> tuple[list[str], list[list[str]], list[str]]:
    """Return the table of headlines as cells: names of the columns, a row for each headline, and the sentences below.

    Examples
    --------
    >>> headline_cells([])[2]
    ['No frame is late enough for an average.']
    """
    rows: list[list[str]] = []
    notes: dict[str, list[str]] = {}
    for headline in headlines:
        shown = _shown(headline)
        value, error = shown["value"], shown["standard_error"]
        near = error or (shown["tolerance"] if shown["theory"] else 0.1 * abs(value))
        decimals, power = digits(value, near)
        theory = misfit = allowed = "-"
        if headline.verdict is not None:
            theory = number(shown["theory"], decimals, power)
            misfit = number(shown["misfit"], decimals, power, "+")
            if error > 0.0 and math.isfinite(shown["misfit"] / error):
                misfit += f" ({abs(shown['misfit']) / error:.1f}σ)"
            known = number(shown["known"], decimals, power) if error > 0.0 else number(shown["known"])
            chance = [f"{CHANCE_LIMIT:g}σ"] if error > 0.0 else []
            allowed = "+".join([*chance, known] if not chance or float(known) else chance)
            if headline.verdict == AS_STATED:
                known = f"{known} {headline.difference_unit}".rstrip()
                notes.setdefault(headline.excuse, []).append(f"{headline.label}: up to {known} off")
        unit = "" if headline.display_unit in ("", "1") else f" [{headline.display_unit}]"
        found = measurement(value, error) if error > 0.0 else number(value, decimals, power)
        rows.append([headline.label + unit, found, theory, misfit, allowed, headline.verdict or "-"])
    header = ["quantity", "measured", "theory", "misfit", "allowed", "within error?"]
    if not rows:
        return header, rows, ["No frame is late enough for an average."]
    said = []
    if any("σ" in row[4] for row in rows):
        known = ", + the known error of the model" if any("+" in row[4] for row in rows) else ""
        said.append(f"allowed: {CHANCE_LIMIT:g} standard errors σ, by chance{known}")
    said += [
        f"{'; '.join(which)}, {_ALIKE.get(len(which), 'all ')}because {reason}." for reason, which in notes.items()
    ]
    return header, rows, said


def ledger_line(ledger: float, limit: float) -> str:
    """Return a line that says how well the energy ledger closes.

    Examples
    --------
    >>> ledger_line(3.2e-15, 1e-10), ledger_line(4e-6, 1e-10)
    ('energy ledger closes to 3e-15', 'energy ledger does not close: 4e-06, where at most 1e-10 is allowed')
    """
    if ledger <= limit:
        return f"energy ledger closes to {ledger:.0e}"
    return f"energy ledger does not close: {ledger:.0e}, where at most {limit:.0e} is allowed"


def made_line(made: float) -> str:
    """Return a line that says how much energy the scheme of an approximate engine has made by itself.

    Examples
    --------
    >>> made_line(0.0312)
    'the scheme itself has made +3.1 % of the energy of motion'
    """
    return f"the scheme itself has made {100.0 * made:+.2g} % of the energy of motion"


def cost_line(collisions: int, seconds: float) -> str:
    """Return a line with the number of collisions of a run and the time that it took.

    Examples
    --------
    >>> cost_line(1234567, 2.0)
    '1,234,567 collisions in 2.0 s, 620,000 a second'
    """
    taken = f"{seconds:#.2g}" if seconds < 10.0 else f"{seconds:.0f}"
    return f"{collisions:,} collisions in {taken} s" + (
        f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    )


def outcome_json(outcome: Outcome, *, scene: str, path: Path | None, limit: float) -> dict[str, Any]:
    """Return a run as a record for JSON."""
    rate = outcome.collisions / outcome.seconds if outcome.seconds > 0.0 else None
    return {
        "scene": scene,
        "status": str(outcome.dataset.attrs.get("atmosbox_status", "complete")),
        "file": None if path is None else str(path),
        "headlines": [headline_json(headline) for headline in outcome.headlines],
        "ledger": {"residual": outcome.ledger, "limit": limit, "closes": bool(outcome.ledger <= limit)},
        "energy_made_by_the_scheme": outcome.made,
        "collisions": outcome.collisions,
        "seconds": outcome.seconds,
        "collisions_per_second": rate,
        "next": None if path is None else next_command("plot", path),
    }


def outcome_lines(outcome: Outcome, *, path: Path, limit: float, width: int, expected: Sequence[str] = ()) -> list[str]:
    """Return a run as text, with the lines about its expected errors."""
    return [
        *headline_lines(outcome.headlines, width),
        "",
        *([*expected, ""] if expected else []),
        ledger_line(outcome.ledger, limit),
        *([made_line(outcome.made)] if outcome.made else []),
        cost_line(outcome.collisions, outcome.seconds),
        f"file: {path}",
        f"next: {next_command('plot', path)}",
    ]


def card_json(card: Card) -> dict[str, Any]:
    """Return a model card as a record for JSON."""
    return {
        "scene": card.scene,
        "title": card.title,
        "story": card.story,
        "facts": dict(card.facts),
        "parameters": [
            {part: getattr(p, part) for part in ("name", "unit", "default", "low", "high", "choices", "kind", "help")}
            for p in card.parameters
        ],
    }


def scene_lines(summaries: Mapping[str, Sequence[Any]], width: int) -> list[str]:
    """Return the table of the scenes from the sentence, the level and the minutes of each."""
    rows = [[name, level, str(minutes or ""), sentence] for name, (sentence, level, minutes) in summaries.items()]
    return table(["scene", "level", "minutes", "what it shows"], rows, width)


def parameter_lines(parameters: Sequence[Parameter], width: int) -> list[str]:
    """Return the table of the settings of a scene."""
    header = ["setting", "default", "unit", "allowed", "what it is"]
    rows = [
        [p.name, _value(p, p.default).removesuffix(f" {p.unit}"), p.unit or "-", p.allowed, p.help] for p in parameters
    ]
    return table(header, rows, width)


def _value(parameter: Parameter, value: bool | int | float | str) -> str:
    """Return the value of a setting with its unit."""
    if isinstance(value, bool | str):
        return parameter.typed(value)
    return phrase(value, parameter.unit)


def setting_lines(settings: Mapping[str, Any], parameters: Sequence[Parameter], width: int) -> list[str]:
    """Return the values with which a scene runs; values that differ from their defaults are marked."""
    rows = [[p.name, _value(p, settings[p.name]), "" if settings[p.name] == p.default else "set"] for p in parameters]
    return table(["setting", "value", ""], rows, width)
