"""Measured speed against measured accuracy: the same scene with several engines and settings, errors and seconds.

`rung`             one way of running a scene
`budgeted_runs`    the order of the runs, so that all fit into a budget of time
`timed_run`        the errors and the cost of one run
`warm_engine`      compilation of an engine within the budget
`kept_runs`        runs that are saved during the measurement, so that it can be continued
`measured_trade`   all ways of running a scene, within a budget of time
"""

from atmosbox.trade.tradeoff.kept_runs import KeptRuns
from atmosbox.trade.tradeoff.measured_trade import measure
from atmosbox.trade.tradeoff.rung import Rung, rungs

__all__ = ["KeptRuns", "Rung", "measure", "rungs"]
