"""Boxes that are difficult to simulate ("extremes"), and the outcome of each on each engine.

`extreme`          the table of extremes: the boxes, the measurements, the expected results
`extreme_box`      functions that build the boxes
`probe`            functions that measure a box
`guarded_run`      checks of every engine after every run
`verdict`          the outcome: right, refused, degrades (and by how much), or wrong; the stored outcomes
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
