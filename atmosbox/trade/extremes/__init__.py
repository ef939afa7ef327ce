"""Boxes that break simulations, and what each engine makes of them.

Read `catalogue` for the list, `trial` for what is demanded of every engine at every moment, and `assessment`
for how an engine is put through it.
"""

from atmosbox.trade.extremes.assessment import Finding, assess, examine
from atmosbox.trade.extremes.catalogue import EXTREMES
from atmosbox.trade.extremes.extreme import Extreme, extreme
from atmosbox.trade.extremes.guarded_run import Candidate, Trial, UnlawfulError
from atmosbox.trade.extremes.verdict import OUTCOMES, Outcome, Verdict, degraded, judged, wrong

__all__ = [
    "EXTREMES",
    "OUTCOMES",
    "Candidate",
    "Extreme",
    "Finding",
    "Outcome",
    "Trial",
    "UnlawfulError",
    "Verdict",
    "assess",
    "degraded",
    "examine",
    "extreme",
    "judged",
    "wrong",
]
