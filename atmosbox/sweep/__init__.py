"""Sweeps: runs at all points of a grid of settings, several members at each, to see how a number depends on a setting.

Read in this order: `plan` (the grid, its members and their seeds), `conduct` (the runs and their files) and `result`
(all runs joined).
"""

import sys

from atmosbox.callable_room import CallableRoom
from atmosbox.sweep.conduct import folder_of, is_taken, sweep
from atmosbox.sweep.plan import Plan, member_seed, parse_vary, plan
from atmosbox.sweep.result import FEWEST

__all__ = ["FEWEST", "Plan", "folder_of", "is_taken", "member_seed", "parse_vary", "plan", "sweep"]

sys.modules[__name__].__class__ = CallableRoom  # atmosbox.sweep("lifting-dry", ...) runs it
