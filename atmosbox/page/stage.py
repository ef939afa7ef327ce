"""The stage: what the page gets once of a run, namely the box, how molecules are drawn, the graphs and the texts."""

import math
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.file.molecules import Molecules
from atmosbox.page.frame import clumps, encode, layer
from atmosbox.page.panel import plain
from atmosbox.theory.constants import DRY_AIR

MOST = 5000
"""Greatest number of molecules that are drawn; a computer without a graphics card is fast enough for this number."""

_ROOM = 850_000  # molecules times frames of a page of 10 MB
_ENOUGH = 240  # frames; a page with fewer would rather leave out molecules

Indices = NDArray[np.intp]


class Share(namedtuple("Share", "molecules frames")):
    """Numbers of molecules and frames of a run that a page holds."""


def share(molecules: int, frames: int, runs: int = 1) -> Share:
    """Return how many molecules and frames of a run fit into a page, which may show several runs.

    First, molecules beyond `MOST` are left out, then frames, down to 240, then more molecules:

    >>> share(800, 400), share(10_000, 240), share(200, 100_000)
    (Share(molecules=800, frames=400), Share(molecules=3541, frames=240), Share(molecules=200, frames=4250))
    """
    room = _ROOM // runs
    kept = max(1, min(molecules, MOST, room // max(1, min(frames, _ENOUGH))))
    return Share(kept, max(1, min(frames, room // kept)))


def chosen(count: int, most: int, water: NDArray[np.bool_] | None = None) -> Indices:
    """Return the indices of the ``most`` molecules to draw, evenly spaced in the list of all.

    All molecules of water are drawn if they are at most half of ``most``.
    """
    if count <= most:
        return np.arange(count)
    if water is None or not water.any():
        return _even(count, most)
    wet, dry = np.flatnonzero(water), np.flatnonzero(~water)
    kept = max(min(len(wet), most // 2), most - len(dry))
    parts = (wet[_even(len(wet), kept)], dry[_even(len(dry), most - kept)])
    return np.sort(np.concatenate(parts))


def _even(count: int, most: int) -> Indices:
    """Return at most ``most`` of the whole numbers below ``count``, evenly spaced."""
    if count <= most:
        return np.arange(count)
    return np.unique(np.rint(np.linspace(0, count - 1, most)).astype(np.intp))


_UNITS = {"nm": 1e-9, "µm": 1e-6, "mm": 1e-3, "m": 1.0, "km": 1e3}


def page_box(seen: Molecules) -> dict[str, Any]:
    """Return the box of a run at its start as data for the page, its lengths in the unit that is shown."""
    unit = length_unit(float(seen.side[0].max()))
    sides = seen.side.astype(np.float64) / _UNITS[unit]
    return {
        "unit": unit,
        "length": sides[0].tolist(),
        "reach": float(sides[0, 2] if seen.discs else sides[:, 2].max()),
        "walls": list(seen.walls),
        "wall_temperature": plain(seen.wall_temperature[0]),
        "planar": bool(seen.planar),
        "gravity": bool(seen.gravity),
    }


def length_unit(length: float) -> str:
    """Return the largest of nm, µm, mm, m and km that is not longer than a length [m]; nm for shorter lengths."""
    known = [name for name, size in _UNITS.items() if length >= 0.999 * size]
    return known[-1] if known else "nm"


def length_text(length: float, figures: int = 2) -> str:
    """Return a length [m] as text with its unit.

    >>> length_text(6.93e-9), length_text(129.898, 3)
    ('6.9 nm', '130 m')
    """
    unit = length_unit(length)
    return f"{length / _UNITS[unit]:.{figures}g} {unit}"


Floats = NDArray[np.floating]

_SEEN = 0.034  # drawn diameter over the side of a cube as large as the box, for _CROWD molecules
_CROWD = 800
_BESIDE_DROPS, _BESIDE_MIST = 0.4, 0.6  # factors on that diameter beside drops or a mist, so that these stand out
ROUND = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
_ALIKE = 0.01
_BEND = 0.5  # power of the speed that the colours of discs follow: most are slower than half of the fastest
NEIGHBOURS = 12.0
"""Upper end of the colour scale where colours show the number of neighbours."""
_PARTICLES = {False: "molecule", True: "disc"}


class Stage(NamedTuple):
    """The data that the page gets once, in types that JSON can hold, and what is needed to make frames for it.

    ``shown`` are the indices of the molecules that are drawn.
    """

    record: dict[str, Any]
    shown: Indices

    def frame(
        self,
        sequence: int,
        time: float,
        length: ArrayLike,
        position: ArrayLike,
        speed: ArrayLike,
        *,
        drops: ArrayLike | None = None,
        liquid: int = 0,
        rained: int = 0,
    ) -> bytes:
        """Return one frame as the bytes that the page reads, see `atmosbox.page.frame.encode`.

        ``time`` has the unit of the stage; ``length`` (axis,), ``position`` (molecule, axis) and the positions and
        radii of ``drops`` (drop, 4) are in m, ``speed`` (molecule,) in m/s. All molecules of the run are given, with
        NaN in the liquid; ``liquid`` is the number of those in a mist or a pool, ``rained`` of those that have left as
        rain.
        """
        metre = self.record["metre"]
        sides = np.asarray(length, np.float64) * metre
        place = np.asarray(position, np.float64)[self.shown] * metre
        fast = np.asarray(speed, np.float64)[self.shown]
        water = self.record["water"]
        wet: Floats = np.zeros((0, 4))
        if drops is not None:
            wet = np.asarray(drops, np.float64).reshape(-1, 4)
            wet = wet[np.isfinite(wet).all(axis=1)] * metre
        elif self.record["box"]["walls"][4] == "pool":
            wet = layer(liquid, water)
        elif liquid:
            wet = clumps(liquid, water, sides, self.record["species"][-1]["drawn"])
        wet = np.concatenate((wet, layer(rained, water, rain=True)))
        return encode(sequence, time, sides, place, fast, self.record["speed"]["high"], wet)


def stage(
    seen: Molecules,
    *,
    title: str,
    fastest: float,
    story: str = "",
    settings: Iterable[tuple[str, str]] = (),
    time_unit: str = "ns",
    panels: Sequence[dict[str, Any]] = (),
    most: int = MOST,
) -> Stage:
    """Return the stage of a run: the data that the page gets once.

    Parameters
    ----------
    seen
        The molecules and their box; of mass and diameter, NaN where they are not known. Drops are drawn to size, and
        molecules beside them smaller, so that drops stand out.
    title, story, settings
        Contents of the heading and of the caption.
    fastest : float
        Speed that the colour scale must reach [m/s]; the scale ends at the next round number. If colours show the
        number of neighbours, the end of the scale itself.
    time_unit : str
        The unit of the times of frames.
    panels : sequence of dict
        The graphs, see `panel_record`.
    most : int
        Greatest number of molecules that are drawn.

    Examples
    --------
    Molecules that would be too small to see are drawn wider, and the record says so:

    >>> place, wide, sides = np.ones((1, 9, 3)), np.full(9, 50.0), np.array([[8.4e3, 8.4e3, 2.5e4]])
    >>> walls = ("specular",) * 6, np.full((1, 6), math.nan)
    >>> air = Molecules(False, np.ones(1), place, place[:, :, 0], wide * 1e-27, wide, None, sides, *walls, False, True)
    >>> column = stage(air, title="A column", fastest=900.0, time_unit="s")
    >>> column.record["box"]["unit"], column.record["exaggeration"]
    ('km', 'Molecules collide as if 50 m wide, and are drawn 10 times as wide.')
    """
    box, discs, wet = page_box(seen), seen.discs, seen.water
    drops, counted = seen.drops is not None, seen.neighbours is not None
    heavy, wide = np.asarray(seen.mass, np.float64), np.asarray(seen.diameter, np.float64)
    shown = chosen(len(heavy), most, wet)
    kinds, kind = _kinds(heavy, wet, seen.right, discs=discs)
    lengths, metre = seen.side[0][[0, 2]] if seen.planar else seen.side[0], 1.0 / _UNITS[box["unit"]]
    misty = wet is not None and bool(wet.any()) and seen.walls[4] != "pool"
    beside = _BESIDE_DROPS if drops else _BESIDE_MIST if misty else 1.0
    room = float(np.exp(np.log(lengths).mean())) * beside
    wider, said = _width(wide, room, len(shown), discs=discs, unit=box["unit"])
    drawn = wide * wider
    if not discs and np.ptp(wide[np.isfinite(wide)]) == 0.0:
        drawn = drawn * np.cbrt(heavy / np.nanmax(heavy))  # equal diameters: the drawn size shows the mass
    species = [
        {
            "name": name,
            "mass": _mean(heavy[kind == number]),
            "diameter": _mean(wide[kind == number]) * metre,
            "drawn": _mean(drawn[kind == number]) * metre,
        }
        for number, name in enumerate(kinds)
    ]
    record = {
        "title": title,
        "story": story,
        "settings": [list(pair) for pair in settings],
        "particle": _PARTICLES[discs],
        "molecules": len(heavy),
        "molecules_shown": len(shown),
        "exaggeration": said,
        "metre": metre,
        "box": box | {"misty": misty and not drops},
        "species": species,
        "kind": kind[shown].tolist(),
        "size": plain(drawn[shown] * metre, 5) if discs and np.ptp(drawn) > 0.0 else None,
        "water": 0 if wet is None else int(wet.sum()),
        "time": {"unit": time_unit},
        "speed": {
            "unit": "m/s",
            "low": 0.0,
            "high": fastest if counted else round_up(fastest),
            "counted": counted,
            "bend": _BEND if discs else 1.0,
        },
        "panels": list(panels),
    }
    return Stage(record, shown)


def _kinds(
    mass: Floats, water: NDArray[np.bool_] | None, right: NDArray[np.bool_] | None, *, discs: bool
) -> tuple[tuple[str, ...], Indices]:
    """Return the names of the kinds of molecules, and the index of the kind of each molecule."""
    if water is not None and water.any():
        return ("dry air", "water"), water.astype(np.intp)
    if right is not None:
        return ("gas from the left", "gas from the right"), right.astype(np.intp)
    kind = np.zeros(len(mass), np.intp)
    if discs:
        if not len(mass) or mass.min() == mass.max():
            return ("disc",), kind
        kind[np.argsort(mass, kind="stable")[len(mass) // 2 :]] = 1
        return ("light half", "heavy half"), kind
    airy = len(mass) > 0 and abs(float(np.nanmean(mass)) / DRY_AIR.molecule_mass - 1.0) < _ALIKE
    return ("dry air" if airy else "molecule",), kind


def _width(diameter: Floats, side: float, count: int, *, discs: bool, unit: str) -> tuple[float, str]:
    """Return the ratio of the drawn to the collision diameter of molecules, and the sentence that tells it."""
    known = diameter[np.isfinite(diameter)]
    size = float(known.mean()) if known.size else 0.0
    particle = _PARTICLES[discs].capitalize()
    wanted = _SEEN * side * min(1.2, (_CROWD / max(count, 1)) ** (1.0 / 6.0))
    if size <= 0.0:
        return 1.0, f"{particle}s are points, and chance decides which of them collide."
    ratio = wanted / size
    power = 10.0 ** math.floor(math.log10(ratio)) if ratio > 1.0 else 1.0
    factor = 1.0 if ratio <= 1.0 else power * min(ROUND, key=lambda each: abs(math.log(each * power / ratio)))
    as_drawn = "are drawn true to size" if factor == 1.0 else f"are drawn {factor:g} times as wide"
    if discs:
        return factor, f"{particle}s {as_drawn}."
    real = size / DRY_AIR.diameter
    if unit in ("nm", "µm") and abs(real - 1.0) < _ALIKE:
        return factor, f"{particle}s {as_drawn if factor == 1.0 else as_drawn + ' as they are'}."
    if unit in ("nm", "µm"):
        also = "drawn as wide as they collide" if factor == 1.0 else f"drawn {factor:g} times wider still"
        return factor, f"{particle}s collide as if {real:.2g} times as wide as those of air, and are {also}."
    also = "drawn so" if factor == 1.0 else f"drawn {factor:g} times as wide"
    return factor, f"{particle}s collide as if {length_text(size, 3)} wide, and are {also}."


def round_up(value: float) -> float:
    """Return the next larger round number; 1 if the value is not a finite positive number.

    Examples
    --------
    >>> round_up(870.0), round_up(0.0)
    (1000.0, 1.0)
    """
    if not (math.isfinite(value) and value > 0.0):
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return float(f"{next(step for step in ROUND if step * power >= value * (1.0 - 1e-9)) * power:.6g}")


def _mean(values: Floats) -> float:
    """Return the mean of the finite values; 0 if there are none."""
    known = values[np.isfinite(values)]
    return float(f"{known.mean():.6g}") if known.size else 0.0
