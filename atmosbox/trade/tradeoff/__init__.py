"""Speed against accuracy, measured: the same scene through engines and settings, errors beside seconds.

`rung`             one way of running a scene
`budgeted_runs`    which run comes next, so that all fit into a budget of time
`timed_run`        what one run came to
`warm_engine`      an engine compiled, but for no longer than the budget
`kept_runs`        what is saved while it is measured, and from where it goes on
`measured_trade`   all the ways of a scene, within a budget of time
"""

from atmosbox.trade.tradeoff.kept_runs import KeptRuns
from atmosbox.trade.tradeoff.measured_trade import measure
from atmosbox.trade.tradeoff.rung import Rung, rungs

__all__ = ["KeptRuns", "Rung", "measure", "rungs"]
