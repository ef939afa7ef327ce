"""Sweeps: runs at all points of a grid of settings, several members at each, to see how a number depends on a setting.

Read in this order: `axis` (one setting that varies), `plan` (the grid, its members and their seeds), `member` (one run
and its file), `workers` (where runs are computed), `conduct` (the whole sweep) and `result` (all runs joined).
"""

import sys

from atmosbox.callable_room import CallableRoom
from atmosbox.sweep.axis import Axis, parse_vary
from atmosbox.sweep.conduct import SweepInterrupted, Swept, folder_of, is_taken, sweep
from atmosbox.sweep.plan import Plan, member_seed, plan
from atmosbox.sweep.result import FEWEST

__all__ = [
    "FEWEST",
    "Axis",
    "Plan",
    "SweepInterrupted",
    "Swept",
    "folder_of",
    "is_taken",
    "member_seed",
    "parse_vary",
    "plan",
    "sweep",
]

sys.modules[__name__].__class__ = CallableRoom  # atmosbox.sweep("lifting-dry", ...) runs it
