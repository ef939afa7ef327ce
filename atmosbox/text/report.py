"""A run, a file, a scene and a comparison of runs as lines of text and as JSON."""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from atmosbox.scene.conversion import from_si, slashed
from atmosbox.scene.headline import CHANCE
from atmosbox.text.table import digits, measurement, number, table, wrapped

if TYPE_CHECKING:
    from atmosbox.plot.compare import Compared, Naming
    from atmosbox.scene.headline import Headline
    from atmosbox.scene.settings import Parameter
    from atmosbox.simulation.preparation import Prepared
    from atmosbox.simulation.runner import Outcome


def next_command(command: str, path: Path) -> str:
    """Return a command to type next, with the path of a file.

    >>> next_command("plot", Path("my run.nc")), next_command("plot", Path("-7.nc"))
    ("atmosbox plot 'my run.nc'", 'atmosbox plot ./-7.nc')
    """
    name = str(path)
    return f"atmosbox {command} {shlex.quote(f'./{name}' if name.startswith('-') else name)}"


def _shown(headline: Headline) -> dict[str, Any]:
    """Return the numbers of a headline in its display unit."""
    unit, theory = headline.display_unit, headline.theory
    shown: dict[str, Any] = {"value": from_si(headline.value, unit), "standard_error": headline.standard_error}
    shown |= {"theory": None if theory is None else from_si(theory, unit), "difference": headline.misfit}
    shown |= {"tolerance": headline.tolerance, "bias": headline.bias, "expected_within": headline.allowed}
    shown |= {"chance": headline.chance, "known": headline.known}
    for part, value in shown.items():
        if value is not None and part not in ("value", "theory"):
            shown[part] = from_si(value, unit, difference=True)
    return shown


def headline_json(headline: Headline) -> dict[str, Any]:
    """Return a headline as a record for JSON, in the unit in which the table shows it."""
    words: dict[str, Any] = {"reason": headline.excuse}
    words |= {part: getattr(headline, part) for part in ("agrees", "verdict", "resolved", "program")}
    named = {"name": headline.name, "label": headline.label, "unit": headline.display_unit}
    return {**named, **_shown(headline), **words}


def headline_lines(headlines: Sequence[Headline], width: int) -> list[str]:
    r"""Return the table of measured values and theory, and in words how far they are expected to be apart.

    A column in which no row has an entry is left out; below stand the numbers of two programs, if there are any.

    >>> from atmosbox.scene.headline import Headline
    >>> warm = Headline("t", 291.0, 2.0, 288.0, 0.5, "the box is small", "K", "degC", "temperature")
    >>> print("\n".join(headline_lines([warm], 100)))
    quantity            measured    theory  difference  expected within  agrees?
    temperature [degC]  17.9 ± 2.0  14.9    +3.0 K      ±8.5 K           yes
    expected within: 4 standard errors (chance) plus 0.5 K, because the box is small.
    """
    if not headlines:
        return wrapped("Nothing is compared with theory: the run is too short, or a slider was moved.", width)
    rows = [_row(each) for each in headlines if each.resolved and not each.program]
    header = ["quantity", "measured", "theory", "difference", "expected within", "agrees?"]
    filled = [k for k in range(len(header)) if k < 2 or any(row[k] for row in rows)]
    lines = table([header[k] for k in filled], [[row[k] for k in filled] for row in rows], width, 12) if rows else []
    for note in [*_expected(headlines), *(_too_small(each) for each in headlines if not each.resolved)]:
        lines += wrapped(note, width)
    if compared := [each for each in headlines if each.program]:
        rows = [[_named(each), *(_rounded(_shown(each)[part]) for part in ("value", "theory"))] for each in compared]
        lines += ["", *table(["two programs compared", compared[0].program, "atmosbox"], rows, width, 12)]
        for reason in dict.fromkeys(each.reason for each in compared if each.reason):
            lines += wrapped(f"{reason[:1].upper()}{reason[1:]}.", width)
    return lines


def _named(headline: Headline) -> str:
    """Return the name of a number with its unit."""
    return headline.label + ("" if headline.display_unit in ("", "1") else f" [{slashed(headline.display_unit)}]")


def _rounded(value: float) -> str:
    """Return a number with four significant digits, and no power of ten where it is easy to read without."""
    size = abs(value)
    return number(value, *digits(value, 1e-2 * 10.0 ** math.floor(math.log10(size)))) if 0.0 < size < math.inf else "0"


def _row(headline: Headline) -> list[str]:
    """Return the row of a result; what it does not have is empty."""
    shown = _shown(headline)
    value, error = shown["value"], shown["standard_error"]
    near = error or (shown["tolerance"] if shown["theory"] else 0.1 * abs(value))
    decimals, power = digits(value, near)
    found = measurement(value, error) if error > 0.0 else number(value, decimals, power)
    if headline.verdict is None:
        return [_named(headline), found, "", "", "", ""]
    theory = number(shown["theory"], decimals, power) if shown["theory"] else "0"
    off = f"{number(shown['difference'], decimals, power, '+')} {slashed(headline.difference_unit)}".rstrip()
    return [_named(headline), found, theory, off, headline.shown(headline.allowed, "±"), headline.verdict]


def _expected(headlines: Sequence[Headline]) -> list[str]:
    """Return a sentence that explains the column `expected within`, with every reason for a known error."""
    judged = [each for each in headlines if each.verdict is not None]
    if len({each.expectation for each in judged}) == 1:
        return [f"expected within: {judged[0].expectation}."]
    said = [CHANCE] if any(each.standard_error for each in judged) else []
    reasons: dict[str, list[str]] = {}
    for each in judged:
        if each.tells:
            reasons.setdefault(each.model_reason, []).append(f"{each.shown(each.known)} for {each.label}")
    for reason, sizes in reasons.items():
        said.append(f"{'plus ' * bool(said)}{', '.join(sizes)}, because {reason}")
    return [f"expected within: {'; '.join(said)}."] if judged else []


def _too_small(headline: Headline) -> str:
    """Return a sentence on a number that this run is too small to measure."""
    unit = f" {slashed(headline.display_unit)}".rstrip()
    low, high = (f"{from_si(end or 0.0, headline.display_unit):.4g}" for end in (headline.low, headline.high))
    found = measurement(_shown(headline)["value"], _shown(headline)["standard_error"])
    return (
        f"{headline.label}: this run is too small to measure it ({found}{unit}, where {low} to {high}{unit} is "
        f"possible): set {headline.needed:.0f} times as many molecules."
    )


def ledger_line(ledger: float) -> str:
    """Return a line that says whether the energy budget is closed.

    >>> ledger_line(3.2e-15), ledger_line(4e-6)
    ('energy budget: closed to 3e-15', 'energy budget: not closed, 4e-06 is missing, where at most 1e-10 may be')
    """
    from atmosbox.simulation.verification import LEDGER_LIMIT

    if ledger <= LEDGER_LIMIT:
        return f"energy budget: closed to {ledger:.0e}"
    return f"energy budget: not closed, {ledger:.0e} is missing, where at most {LEDGER_LIMIT:.0e} may be"


def cost_line(collisions: int, seconds: float) -> str:
    """Return a line with the number of collisions of a run and the time that it took.

    >>> cost_line(1234567, 2.0)
    '1,234,567 collisions in 2.0 s, 620,000 a second'
    """
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return f"{collisions:,} collisions in {seconds:{'#.2g' if seconds < 10.0 else '.0f'}} s{rate}"


def outcome_json(outcome: Outcome, prepared: Prepared, path: Path) -> dict[str, Any]:
    """Return a run as a record for JSON."""
    from atmosbox.simulation.verification import LEDGER_LIMIT

    closes = bool(outcome.ledger <= LEDGER_LIMIT)
    return {
        "scene": prepared.scene,
        "status": str(outcome.dataset.attrs.get("atmosbox_status", "complete")),
        "file": str(path),
        "headlines": [headline_json(headline) for headline in outcome.headlines],
        "ledger": {"residual": outcome.ledger, "limit": LEDGER_LIMIT, "closes": closes},
        "energy_made_by_the_scheme": outcome.made,
        "collisions": outcome.collisions,
        "seconds": outcome.seconds,
        "collisions_per_second": outcome.collisions / outcome.seconds if outcome.seconds > 0.0 else None,
        "next": next_command("plot", path),
        "settings": prepared.settings.as_dict(),
    }


def outcome_lines(outcome: Outcome, path: Path, width: int, expected: Sequence[str] = ()) -> list[str]:
    """Return a run as text, with the lines about its expected errors."""
    made = f"error of the engine in the energy of motion: {100.0 * outcome.made:+.2g} %"
    return [
        *headline_lines(outcome.headlines, width),
        "",
        *([*expected, ""] if expected else []),
        ledger_line(outcome.ledger),
        *([made] if outcome.made else []),
        cost_line(outcome.collisions, outcome.seconds),
        f"file: {path}",
        f"next: {next_command('plot', path)}",
    ]


def scene_lines(summaries: Mapping[str, Sequence[Any]], width: int) -> list[str]:
    """Return the table of the scenes from the sentence, the level and the minutes of each."""
    rows = [[name, level, str(minutes or ""), sentence] for name, (sentence, level, minutes) in summaries.items()]
    return table(["scene", "level", "minutes", "what it shows"], rows, width)


def parameter_lines(parameters: Sequence[Parameter], width: int) -> list[str]:
    """Return the table of the settings of a scene."""
    header = ["setting", "default", "unit", "allowed", "what it is"]
    rows = [
        [p.name, p.said(p.default).removesuffix(f" {p.unit}"), p.unit or "-", p.allowed, p.help] for p in parameters
    ]
    return table(header, rows, width)


def setting_lines(settings: Mapping[str, Any], parameters: Sequence[Parameter], width: int) -> list[str]:
    """Return the values with which a scene runs; values that differ from their defaults are marked."""
    rows = [[p.name, p.said(settings[p.name]), "" if settings[p.name] == p.default else "set"] for p in parameters]
    return table(["setting", "value", ""], rows, width)


def comparison_lines(files: Sequence[str], names: Naming, numbers: Sequence[Compared], columns: int) -> list[str]:
    """Return the comparison as text: the settings that differ, and the results of all runs with their differences."""
    head = f"{' and '.join(dict.fromkeys(names.scenes))}: {names.title}"
    runs = [f"{label}: {file}" for label, file in zip(names.labels, files, strict=True) if label != Path(file).stem]
    made = [*wrapped(head, columns), *(line for run in runs for line in wrapped(run, columns, indent="  ")), ""]
    if not numbers:
        return [*made, "The files have no number in common: atmosbox check shows those of each."]
    rows, pair = [], len(files) == 2
    for each in numbers:
        what = each.label + ("" if each.unit in ("", "1") else f" [{slashed(each.unit)}]")
        if pair:
            rows.append([what, _said(each, 0), _said(each, 1), _changed(each, 1), _by_theory(each, 1)])
            continue
        rows.append([what, names.labels[0], _said(each, 0), "", ""])
        for run, label in enumerate(names.labels[1:], 1):
            rows.append(["", label, _said(each, run), _changed(each, run), _by_theory(each, run)])
    parts = [*names.labels, "difference"] if pair else ["run", "measured", "minus the first"]
    return [*made, *table(["quantity", *parts, "by theory"], rows, columns)]


def _said(each: Compared, run: int) -> str:
    """Return a measurement of a run."""
    value, error = each.runs[run].value, each.runs[run].error
    if not math.isfinite(value):
        return "-"
    return measurement(value, error) if math.isfinite(error) else number(value)


def _changed(each: Compared, run: int) -> str:
    """Return the difference from the first run with its standard error, and their ratio."""
    difference, error = each.difference(run), each.error(run)
    if not math.isfinite(difference):
        return "-"
    decimals, power = digits(difference, error)
    if decimals is None:
        return number(difference, sign="+") if difference else "0"
    shown = f"{number(difference, decimals, power, '+')} ± {number(error, decimals, power)}"
    return f"{shown} ({abs(each.sigma(run)):.1f}σ)"


def _by_theory(each: Compared, run: int) -> str:
    """Return the difference that theory predicts, with as many digits as the measured difference."""
    expected = each.expected(run)
    if not math.isfinite(expected):
        return "-"
    return number(expected, *digits(each.difference(run), each.error(run)), "+") if expected else "0"
