"""How accurate a run will be: a table of measured errors, and the cheapest way of running that meets a wish.

Every scene that has something to compare was run through engines and settings with many seeds; the table that comes
with atmosbox, ``accuracy.json``, holds for each of these ways the error of every headline and what a run costs,
as a ratio to the run that the scene makes by default. ``python benchmarks/accuracy.py`` measures it anew.
"""

from atmosbox.scene.wish import TARGETS, Wish, parse
from atmosbox.simulation.accuracy.cheapest import Expectation, choose, cost, expect
from atmosbox.simulation.accuracy.measured import ExpectedError, Measured, Table, load, said

__all__ = [
    "TARGETS",
    "Expectation",
    "ExpectedError",
    "Measured",
    "Table",
    "Wish",
    "choose",
    "cost",
    "expect",
    "load",
    "parse",
    "said",
]
