"""A box that a class can change while it runs: it is measured and recorded, and a local page shows it.

Read in this order: `experiment` (the box, its time and its instruments), `control` and `hand` (knobs and settings),
`lesson` (presets, pump, challenges), `trace`, `summary` and `gauge` (data for graphs and gauges), `outlook` and
`picture` (data for axes and pictures), `tape` and `recorder` (recordings), `session` (combines all of these and carries
out the requests of the page, without a socket), `worker` (the thread of the session), `audience` (the open pages) and
`server` (the port of the page).
"""

from atmosbox.live.session import Session

__all__ = ["Session"]
