"""What lies ahead: the first event of every molecule of a small gas, and the tournament that finds the next of all."""

import numpy as np
from jobs.drawing import BLUE, VERMILLION, axes_of, save
from jobs.registry import Findings, job
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from atmosbox.engine import ParcelSet, Specular
from atmosbox.engine.exact.crossing import is_wall
from atmosbox.plot.theme import DARK, FAINT

MOLECULES, SIDE, DIAMETER, GROUP = 32, 8.0, 0.62, 8
GREEN, GREY = "#009e73", "#777777"
COLOURS = {"contact": VERMILLION, "cell": BLUE, "wall": GREEN, "nobody": GREY}
LABELS = {
    "contact": "a contact",
    "cell": "a boundary of cells",
    "wall": "a wall",
    "nobody": "nobody until then: it plans anew",
}


def small_gas() -> ParcelSet:
    """Return discs in a square box, some time after their start."""
    rng = np.random.default_rng(5)
    places: list[np.ndarray] = []
    while len(places) < MOLECULES:
        place = rng.uniform(0.5 * DIAMETER, SIDE - 0.5 * DIAMETER, 2)
        if all(np.hypot(*(place - other)) > 1.15 * DIAMETER for other in places):
            places.append(place)
    position = np.insert(np.array(places), 1, 0.5, axis=1)
    velocity = np.insert(rng.normal(size=(MOLECULES, 2)), 1, 0.0, axis=1)
    box = ParcelSet(
        position, velocity, length=(SIDE, 1.0, SIDE), walls=[Specular()] * 6, diameter=DIAMETER, planar=True, seed=5
    )
    box.advance(3.0)
    return box


def kind_of(box: ParcelSet, i: int) -> str:
    """Return what the event of a molecule is: contact, boundary of cells, wall, or none that it knows of."""
    what = int(box._events[i]["what"])
    if what > 5:
        return "contact" if int(box._events[i]["partner"]) != i else "nobody"
    return "wall" if is_wall(i, what, box._gas(), box._modes) else "cell"


def held_by_one(box: ParcelSet, times: np.ndarray, kinds: list[str]) -> tuple[int, int]:
    """Return the next molecule that will meet one that has something else in mind, and that one."""
    for i in np.argsort(times):
        partner = int(box._events[i]["partner"])
        if kinds[i] == "contact" and kinds[partner] != "contact":
            return int(i), partner
    raise LookupError("all pairs of this gas agree: take another seed")


@job("ahead", quick=True)
def ahead(found: Findings) -> None:
    """Draw a small gas with the first event of each molecule, and the tournament of their times."""
    box = small_gas()
    calendar = box._calendar
    times = calendar.time[calendar.leaf : calendar.leaf + MOLECULES] - box._now
    kinds = [kind_of(box, i) for i in range(MOLECULES)]
    first = int(np.argmin(times))
    if int(calendar.winner[1]) != first:
        found.failures.append(f"the calendar says that molecule {calendar.winner[1]} is next, and it is {first}")
    holder, partner = held_by_one(box, times, kinds)
    found.number("holder", holder)
    found.number("partner", partner)
    found.number("its-own", LABELS[kinds[partner]])
    found.number("first", first)
    with axes_of(2, (10.4, 5.4), (1.0, 1.05)) as (drawing, (left, right)):
        draw_gas(left, box, times, kinds, first)
        draw_tournament(right, calendar, times, kinds)
        shown = [
            Line2D([], [], color=COLOURS[kind], marker="o", label=LABELS[kind]) for kind in COLOURS if kind in kinds
        ]
        drawing.legend(handles=shown, loc="outside lower left", ncols=len(shown), frameon=False)
        save(found, drawing, "ahead")


def draw_gas(axes, box: ParcelSet, times: np.ndarray, kinds: list[str], first: int) -> None:
    """Draw the molecules where they are, and the way of each to its first event."""
    now = box.snapshot()
    place, way = now.position[:, [0, 2]], now.velocity[:, [0, 2]] * times[:, None]
    for k in range(box._cells.number_x + 1):
        edge = SIDE * k / box._cells.number_x
        axes.plot([edge, edge], [0, SIDE], color=FAINT, linewidth=0.8)
        axes.plot([0, SIDE], [edge, edge], color=FAINT, linewidth=0.8)
    for i, kind in enumerate(kinds):
        end = place[i] + way[i]
        axes.plot(*np.stack([place[i], end], axis=1), color=COLOURS[kind], linewidth=1.6, zorder=3)
        axes.add_patch(Circle(end, 0.5 * DIAMETER, fill=False, edgecolor=COLOURS[kind], linestyle=":", zorder=3))
        heavy = 2.6 if i == first else 0.7
        axes.add_patch(
            Circle(place[i], 0.5 * DIAMETER, facecolor=COLOURS[kind], edgecolor=DARK, linewidth=heavy, alpha=0.85)
        )
        axes.text(*place[i], str(i), ha="center", va="center", color="white", fontsize=8.5, zorder=4)
    axes.plot([0, 0, SIDE, SIDE, 0], [0, SIDE, SIDE, 0, 0], color=DARK, linewidth=2.4)
    axes.set(title="The first event of each molecule", aspect="equal", anchor="N")
    axes.set(xlim=(-0.1, SIDE + 0.1), ylim=(-0.1, SIDE + 0.1))
    axes.set_axis_off()


def draw_tournament(axes, calendar, times: np.ndarray, kinds: list[str]) -> None:
    """Draw the leaves, the winners of the groups, and their matches up to the root."""
    groups = MOLECULES // GROUP
    winners = [int(calendar.winner[calendar.node + g]) for g in range(groups)]
    for i, kind in enumerate(kinds):
        x, row = divmod(i, GROUP)
        wins = i == winners[x]
        axes.text(
            x + 0.5, -0.62 - 0.34 * row, f"{i}:  {times[i]:.2f}", ha="center", va="center", fontsize=9.5,
            color=COLOURS[kind], fontweight="bold" if wins else "normal",
        )  # fmt: skip
    champion = int(calendar.winner[1])
    spans = {calendar.node + g: g + 0.5 for g in range(groups)}
    height = 0
    while spans:
        for node, x in spans.items():
            i = int(calendar.winner[node])
            best = i == champion
            axes.text(
                x, height, f"{i}:  {times[i]:.2f}", ha="center", va="center", fontsize=10.5, zorder=4,
                bbox={"boxstyle": "round", "facecolor": "white", "edgecolor": VERMILLION if best else FAINT},
            )  # fmt: skip
            if node > 1:
                above = 0.5 * (x + spans[node ^ 1])
                axes.plot(
                    [x, x, above], [height, height + 0.6, height + 0.6], color=VERMILLION if best else FAINT,
                    linewidth=2.4 if best else 1.2, zorder=3 if best else 2,
                )  # fmt: skip
                axes.plot([above, above], [height + 0.6, height + 1.2], color=FAINT, linewidth=1.2, zorder=1)
                if best:
                    axes.plot([above, above], [height + 0.6, height + 1.2], color=VERMILLION, linewidth=2.4, zorder=3)
        spans = {node // 2: 0.5 * (x + spans[node ^ 1]) for node, x in spans.items() if node > 1 and node % 2 == 0}
        height += 1.2
    axes.set(title="The tournament of their times", xlim=(0, groups), ylim=(-3.3, height - 0.6))
    axes.set_axis_off()
