"""Speed against accuracy, measured: the same scene through engines and settings, errors beside seconds.

`rung`      one way of running a scene
`trial`     what one run came to
`measure`   all the ways of a scene, within a budget of time
"""

from atmosbox.tradeoff.measure import measure
from atmosbox.tradeoff.rung import Rung, rungs

__all__ = ["Rung", "measure", "rungs"]
