"""The text of a sheet for any scene: from its docstring, its settings and the headlines of its runs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from atmosbox.sheet.sheet_run import Trial
from atmosbox.sheet.sums import measured, spelled

WORDS = Path(__file__).with_suffix(".sheet.toml")
"""The text of a sheet for a scene without a sheet of its own."""
MOST_SETTINGS = 6
"""Greatest number of settings that the sheet names."""


def left_out(story: str) -> str:
    r"""Return the part of a scene's docstring on what is left out and exaggerated; empty if there is none.

    Examples
    --------
    >>> left_out("Air rises.\n\nModelled: spheres.\nLeft out: water,\nwind. Exaggerated: the pace.")
    'Left out: water, wind. Exaggerated: the pace.'
    """
    found = re.search(r"Left out: .*", " ".join(story.split()))
    return found.group() if found else ""


class AnyScene:
    """The object that the text of `WORDS` calls ``scene``.

    Parameters
    ----------
    runs
        The runs of the sheet; those that have been made give their headline numbers.
    """

    def __init__(self, runs: Sequence[Trial]) -> None:
        self.runs = runs

    def fact(self, name: str) -> Any:
        """Return a text about the scene by name.

        Examples
        --------
        >>> from atmosbox.simulation import runner
        >>> AnyScene([Trial("A", "", runner.prepare("lifting-dry", {}))]).fact("quantity")
        'result'
        """
        prepared, found = self.runs[0].prepared, list(self.runs[0].headlines.values())
        story = prepared.module.__doc__ or ""
        made = {each.name: [run.fact(each.name) for run in self.runs if each.name in run.headlines] for each in found}
        known = [(each.label, *made[each.name]) for each in found if each.standard_error > 0.0]
        match name:
            case "goal":
                sentences = re.split(r"(?<=[.!?])\s+", " ".join(story.partition("Modelled:")[0].split()))
                return " ".join(sentences[:2]) or f"{getattr(prepared.module, 'title', prepared.scene)}."
            case "leaves_out":
                return left_out(story)
            case "settings":
                named = [f"`{p.name}` ({p.help})" for p in prepared.settings.describe() if p.name != "seed"]
                return f": {', '.join(named[:MOST_SETTINGS])}" if named else ""
            case "quantity" if found:
                unit = spelled(found[0].display_unit)
                return f"{found[0].label} in {unit}" if unit else found[0].label
            case "both" if found:
                return " and ".join(measured(x.n, x.s) for x in made[found[0].name]) + " with the two seeds."
            case "misfits":
                far = [f"{label}: {abs(a.n - a.theory) / a.s:.1f}" for label, a, *_ in known if a.theory is not None]
                return f"Difference in standard errors: {'; '.join(far)}." if far else ""
            case "differences":
                apart = [(label, b[0] - a) for label, a, *b in known if b]
                said = "; ".join(f"{label}: {measured(x.n, x.s)}" for label, x in apart)
                chance = "Chance exceeds 4 standard errors of such a difference about once in 3 500 times."
                return f"B minus A: {said}. {chance}" if said else ""
        return "result" if name == "quantity" else ""
