"""A box that a class can change while it runs: it is measured and recorded, and a local page shows it.

Read in this order: `experiment` (the box, its time and its instruments), `control` and `hand` (what can be changed),
`lesson` (presets, pump, challenges), `trace`, `summary` and `gauge` (what graphs and gauges get), `outlook` and
`picture` (what is seen), `tape` and `recorder` (what is recorded), `session` (all of these, which obeys the page,
without a socket), `worker` (the thread that it runs in), `audience` (the pages that are open) and `server` (the
page's port).
"""

from atmosbox.live.session import Session

__all__ = ["Session"]
