"""The scenes as they come: the figure that `atmosbox plot` draws, and the table that `atmosbox run` prints."""

from functools import partial

from jobs.registry import Findings, job

from atmosbox import scenarios
from atmosbox.plot import figure
from atmosbox.simulation import runner
from atmosbox.text.report import headline_lines

WIDTH = 100
DOTS_PER_INCH = 100


def scene(name: str, found: Findings) -> None:
    """Run a scene with its defaults; draw it and keep what it measured."""
    outcome = runner.execute(runner.prepare(name, {}), command=f"atmosbox run {name}")
    if not outcome.ledger <= runner.LEDGER_LIMIT:
        found.failures.append(f"the ledger of {name} is off by {outcome.ledger:.1e}")
    for headline in outcome.headlines:
        if headline.agrees is False:
            found.failures.append(
                f"{name}: {headline.label} is {headline.value:.6g}, theory says {headline.theory:.6g}"
            )
    lines = headline_lines(outcome.headlines, WIDTH)
    found.text("\n".join(["```text", *lines, "```"]))
    shown = f"{name}-plot" if name == "lifting-dry" else name
    found.figure(figure(outcome.dataset, "slides"), shown, DOTS_PER_INCH)


for _name in scenarios.names():
    job(f"scene-{_name}")(partial(scene, _name))
