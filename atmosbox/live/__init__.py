"""A box that a class plays with: it runs, is changed, measured and recorded, and a local page shows it.

Read in this order: `experiment` (the box, its time and its instruments), `control` (what can be changed), `trace` and
`report` (what the graphs are told), `picture` (what is seen), `tape` and `recorder` (what is recorded), `session` (all
of these, which obeys the page, without a socket), `worker` (the thread that it runs in), `audience` (who looks) and
`server` (the page's port).
"""

from atmosbox.live.session import Session

__all__ = ["Session"]
