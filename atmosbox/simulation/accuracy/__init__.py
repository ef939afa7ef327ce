"""How accurate a run will be: a table of measured errors, and the cheapest run that is accurate enough.

Every scene that can be compared with theory was run on several engines and with several settings, with many seeds each.
The table that comes with atmosbox, ``accuracy.json``, holds for each of these runs the error of every headline and the
cost, as a ratio to the scene's default run. ``python benchmarks/accuracy.py`` measures it again.
"""

from atmosbox.scene.target import TARGETS, Target, parse
from atmosbox.simulation.accuracy.cheapest import Expectation, choose, cost, expect
from atmosbox.simulation.accuracy.measured import ExpectedError, Measured, Table, load, said

__all__ = [
    "TARGETS",
    "Expectation",
    "ExpectedError",
    "Measured",
    "Table",
    "Target",
    "choose",
    "cost",
    "expect",
    "load",
    "parse",
    "said",
]
