"""The scenes as they come: the figure that `atmosbox plot` draws, and the table that `atmosbox run` prints."""

from functools import partial

from jobs.registry import SCENES, Findings, job

from atmosbox.plot import figure, figure_with_box
from atmosbox.simulation import runner
from atmosbox.text.report import headline_lines

WIDTH = 100
DOTS_PER_INCH = 185
WITH_BOX = {"attraction": 130}
"""Scenes whose figure shows the molecules, as `atmosbox plot --with-box` draws it, with its dots per inch."""


def scene(name: str, found: Findings) -> None:
    """Run a scene with its defaults; draw it and keep what it measured."""
    prepared = runner.prepare(name, {}, save_molecules=name in WITH_BOX)
    outcome = runner.execute(prepared, command=f"atmosbox run {name}")
    if not outcome.ledger <= runner.LEDGER_LIMIT:
        found.failures.append(f"the ledger of {name} is off by {outcome.ledger:.1e}")
    for headline in outcome.headlines:
        if headline.agrees is False:
            found.failures.append(
                f"{name}: {headline.label} is {headline.value:.6g}, theory says {headline.theory:.6g}"
            )
    lines = headline_lines(outcome.headlines, WIDTH)
    found.text("\n".join(["```text", *lines, "```"]))
    drawing = figure_with_box(outcome.dataset) if name in WITH_BOX else figure(outcome.dataset)
    found.figure(drawing, name, WITH_BOX.get(name, DOTS_PER_INCH))


for _name in SCENES:
    job(f"scene-{_name}")(partial(scene, _name))
