"""Boxes that break simulations, and what each engine makes of them.

`extreme`          the table of boxes: what is built, what is measured, what a right engine gives
`extreme_box`      how the boxes are built
`probe`            the rules by which they are measured
`guarded_run`      what is demanded of every engine at every moment
`verdict`          right, refused, degraded by how much, or wrong; the stored outcomes
`assessment`       all extremes on all engines
"""

from atmosbox.trade.extremes.assessment import Finding, assess, examine
from atmosbox.trade.extremes.extreme import EXTREMES, FAMILIES, Extreme
from atmosbox.trade.extremes.guarded_run import Candidate, GuardedRun, UnlawfulError
from atmosbox.trade.extremes.verdict import OUTCOMES, STORED, Outcome, Reading, Verdict, compared, judged

__all__ = [
    "EXTREMES",
    "FAMILIES",
    "OUTCOMES",
    "STORED",
    "Candidate",
    "Extreme",
    "Finding",
    "GuardedRun",
    "Outcome",
    "Reading",
    "UnlawfulError",
    "Verdict",
    "assess",
    "compared",
    "examine",
    "judged",
]
