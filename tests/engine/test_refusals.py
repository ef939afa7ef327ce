"""Refusals of the engines: a number by its name and value, with what to give instead; a contradiction in a sentence."""

import math
import re

import numpy as np
import pytest

from atmosbox.engine import (
    AttractingParcelSet,
    Drops,
    HeatBath,
    Mist,
    ParcelSet,
    Periodic,
    Piston,
    Pool,
    RandomBath,
    RefusedError,
    Specular,
    SquareWell,
    Substance,
    random_positions,
)
from atmosbox.engine.core.packing import refuse_impossible
from atmosbox.engine.core.walls import WALL_NAMES, new_walls
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.dsmc.moist_dsmc_parcel import MoistDsmcParcel
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.engine.stepped.stepped_parcel import SteppedParcel
from tests.engine.boxes import SMOOTH, TURNING, Pulse

S, P, NAN, INF = Specular(), Periodic(), math.nan, math.inf
WAY_OUT = re.compile(r"\b(give|make|choose) ")
CRYSTAL = 0.70711 * np.array([[0, 0, 0], [0, 1, 1], [1, 0, 1], [1, 1, 0]])
FACTS = {"mass": 0.62, "diameter": 0.5, "binding_energy": 3.0, "heat_capacity": 9.0, "volatility": 1.0, "rotation": 3.0}


def box(engine):
    """Return a function that makes a box of an engine with two molecules at rest."""

    def make(**changes):
        facts = {"position": [[1.0, 2, 2], [3.0, 2, 2]], "velocity": np.zeros((2, 3)), "length": (4.0, 4.0, 4.0)}
        return engine(**(facts | changes))

    return make


def substance(**changes):
    return Substance(**(FACTS | changes))


def mist(**changes):
    return Mist(Substance(**FACTS), **changes)


def driven(interval):
    return box(ParcelSet)(driver=Pulse(interval), walls=(*SMOOTH[:5], Piston()))


def wall(**law):
    return new_walls((*SMOOTH[:4], HeatBath(**({"kT": 1.0} | law)), S), 1.0)


def moving(speed):
    return box(ParcelSet)(velocity=[[speed, 0, 0], [-speed, 0, 0]])


def piston(velocity):
    return new_walls((*SMOOTH[:5], Piston(velocity)), 1.0)


def lid(top):
    return random_positions((6.0, 6.0, 20.0), np.ones(5), np.random.default_rng(5), top=top)


def sides(length):
    return refuse_impossible(np.array(length), np.array([0.5]), (False,) * 3, False)


def well(**changes):
    return box(AttractingParcelSet)(**({"well": SquareWell(), "length": (8, 8, 8)} | changes))


def attraction(**changes):
    return well(well=SquareWell(**({"range": 1.5, "depth": 1.0} | changes)))


def bath(**changes):
    return well(bath=RandomBath(**({"kT": 1.0, "rate": 1.0} | changes)))


def drops(position=((4.0, 4.0, 4.0),), **changes):
    facts = {"number": 3, "position": position, "nuclei": 30.0, "nucleus": 0.5, "nucleus_mass": 4.0}
    return Drops(changes.pop("substance", Substance(**FACTS)), **(facts | {"molecule_radius": 0.3} | changes))


def damp(centres=((4.0, 4.0, 4.0),), **changes):
    facts = {"length": (8, 8, 8), "mass": 0.62, "diameter": 0.5, "rotation": 3.0, "position": [[7, 7, 7], [7, 7, 5]]}
    return box(DropParcelSet)(**({"liquid": drops(centres)} | facts | changes))


exact, stepped, dsmc = map(box, (ParcelSet, SteppedParcel, DsmcParcel))

NUMBERS = [
    # the object, its argument, the name of that in a refusal, values that are refused
    (exact, "mass", "mass", (0.0, -2.0, NAN, INF, 1e-60, 1e60)),
    (exact, "diameter", "diameter", (-1.0, INF, 1e-320, 1e155)),
    (moving, "speed", "velocity", (1e-60, 1e155)),
    (exact, "rotation", "rotation", (-2.0, NAN)),
    (exact, "rotational_energy", "rotational_energy", (-1.0, NAN)),
    (exact, "length", "length", ((4.0, 4.0), (4.0, 4.0, 0.0), (4.0, NAN, 4.0), (4.0, 4.0, 1e60), "large")),
    (exact, "gravity", "gravity", (-9.8, NAN, INF, 1e300, "down")),
    (exact, "collision_number", "collision_number", (0.5, NAN)),
    (exact, "seed", "seed", (-1, 1.5, "x")),
    (exact, "layers", "layers", (0,)),
    (driven, "interval", "interval of the driver", (0.0, NAN)),
    (sides, "length", "length", ([1.0, 0.0, 1.0], [1.0, NAN, 1.0])),
    (lid, "top", "top", (0.0, -1.0, 20.1, NAN)),
    (wall, "kT", "kT of wall z_low", (0.0, -1.0, NAN, INF, 1e200, "hot")),
    (wall, "accommodation", "accommodation of wall z_low", (-0.1, 1.1, NAN, None)),
    (piston, "velocity", "velocity of the piston", (NAN, INF, -1e60, "fast")),
    (stepped, "delta", "delta", (0.0, NAN)),
    (stepped, "dt", "dt", (-1.0, INF)),
    (stepped, "motion", "motion", ("verlet",)),
    (stepped, "smooth_walls", "smooth_walls", ("sticky",)),
    (stepped, "rule", "rule", ("verlet", 1)),
    (dsmc, "dt", "dt", (0, -1.0, 11.0, "fast")),
    (dsmc, "occupancy", "occupancy", (0.5, NAN)),
    (dsmc, "cell", "cell", (0.0, 0.001)),
    (dsmc, "threads", "threads", (0, 1.5)),
    (substance, "mass", "mass of the substance", (0.0, NAN, "heavy")),
    (substance, "binding_energy", "binding_energy of the substance", (-1.0,)),
    (substance, "heat_capacity", "heat_capacity of the substance", (0.0,)),
    (substance, "volatility", "volatility of the substance", (0.0, INF)),
    (substance, "diameter", "diameter of the substance", (-1.0,)),
    (substance, "rotation", "rotation of the substance", (1.0, 2.5, NAN)),
    (mist, "number", "number of molecules in the liquid", (-1, 1.5, NAN)),
    (mist, "kT", "kT of the liquid", (-0.1, INF)),
    (mist, "nuclei", "heat capacity of the nuclei", (-1.0,)),
    (mist, "rain", "rain", (-1.0, NAN)),
    (mist, "keeps", "number of molecules that the liquid keeps", (-1,)),
    (mist, "sticking", "sticking", (0.0, 1.1, NAN, None)),
    (mist, "area", "area of the mist", (0.0, -1.0, NAN, INF, "wide")),
    (drops, "nucleus", "radius of the nuclei", (0.0,)),
    (drops, "nucleus_mass", "mass of the nuclei", (0.0,)),
    (drops, "molecule_radius", "radius of a molecule in a drop", (-0.1,)),
    (attraction, "range", "range of the well", (0.9,)),
    (attraction, "depth", "depth of the well", (-1.0, NAN)),
    (well, "strength", "strength of the attraction", (-1.0,)),
    (bath, "rate", "rate of the random bath", (-1.0,)),
    (bath, "kT", "kT of the random bath", (0.0,)),
]


def test_an_impossible_number_is_refused_with_its_name_its_value_and_a_way_out():
    for make, argument, name, values in NUMBERS:
        for value in values:
            with pytest.raises(RefusedError) as refused:
                make(**{argument: value})
            told = f"{value:g}" if isinstance(value, int | float) else repr(value)
            assert f"{name} = {told}" in str(refused.value)
            assert WAY_OUT.search(str(refused.value)), str(refused.value)


def refuses(make, *cases):
    """Check that each change of a box is refused with these words."""
    for changes, words in cases:
        with pytest.raises(RefusedError, match=words):
            make(**changes)


def test_what_no_box_can_hold_is_refused():
    refuses(
        exact,
        ({"position": [[1.0, 2, NAN], [3, 2, 2]]}, "position of molecule 0 is not finite"),
        ({"velocity": [[0.0, 0, 0], [0, -INF, 0]]}, "velocity of molecule 1 is not finite"),
        ({"position": [1.0, 2, 3]}, r"position has shape \(3,\): give three numbers"),
        ({"position": "here"}, "position holds something that is not a number: give"),
        ({"velocity": [[0.0, 0, 0]]}, "2 positions and 1 velocities"),
        ({"mass": [1.0, 2, 3]}, r"mass has shape \(3,\): give one number, or one for each of 2"),
        ({"diameter": [[1.0], [1.0]]}, r"diameter has shape \(2, 1\)"),
        ({"mass": "heavy"}, "mass holds something that is not a number"),
        ({"rotation": 1.0}, "0, 2 or 3"),
        ({"position": [[1.0, 2, 2], [1.9, 2, 2]]}, "molecules 0 and 1 overlap at the start, by 0.1 of"),
        ({"position": [[0.4, 2, 2], [3, 2, 2]]}, r"molecule 0 at x = 0.4 .*x_low.* 0.5 and 3.5"),
        ({"position": [[1.0, 2, 2], [3, 2, 4.1]]}, r"molecule 1 at z = 4.1 .*z_high"),
        ({"diameter": 5.0}, "reaches through wall"),
        (
            {"position": CRYSTAL, "velocity": CRYSTAL, "length": [1.41422] * 3, "walls": TURNING},
            "4 molecules .* can hardly",
        ),
        ({"planar": True, "velocity": [[0.0, 1, 0], [0, 0, 0]]}, "no velocity along y"),
        ({"planar": True, "position": [[1.0, 2, 2], [3, 2.5, 2]]}, "in one plane"),
        ({"gravity": 1.0, "walls": TURNING}, "periodic along z cannot have gravity"),
        ({"length": (1.9, 4, 4), "walls": TURNING, "position": [[1, 1, 1], [1, 3, 3]]}, "length = 1.9 along x is too"),
        ({"driver": Pulse()}, "a driver needs a piston"),
    )


def test_walls_that_no_box_can_have_are_refused_by_their_names():
    for number in (0, 5, 7):
        with pytest.raises(RefusedError, match=f"{number} walls .*six"):
            new_walls((S,) * number, 1.0)
    for wall, name in enumerate(WALL_NAMES):
        pair = f"{WALL_NAMES[wall // 2 * 2]} and {WALL_NAMES[wall // 2 * 2 + 1]}"
        laws = [("glass", f"{name} = 'glass' is not a law"), (P, f"{pair} must both be periodic")]
        for law, words in [*laws, (Piston(), f"{name} cannot be a piston.*z_high")][: 2 if wall == 5 else 3]:
            with pytest.raises(RefusedError, match=words):
                new_walls((*SMOOTH[:wall], law, *SMOOTH[wall + 1 :]), 1.0)


def test_what_an_engine_of_steps_cannot_do_is_refused_with_what_it_can():
    refuses(
        stepped,
        ({"diameter": 0.0}, "give the length of a step as dt"),
        ({"dt": 4.0, "velocity": [[1.0, 0, 0], [0, 0, 0]]}, r"cross the box along x in one step: give dt = 0.05 or"),
        (
            {"length": (4, 1, 4), "velocity": [[1, 1e-3, 0]], "position": [[1, 0.5, 1]]},
            "would cross the box along .* make the box longer",
        ),
        ({"length": (2.1, 4, 4), "walls": TURNING, "position": [[1, 1, 1], [1, 3, 3]]}, "too short"),
    )
    refuses(
        dsmc,
        ({"planar": True}, "the cells of dsmc are three-dimensional"),
        *(({name: [0, 2]}, "the molecules of dsmc are all alike") for name in ("diameter", "rotation")),
        ({"mass": [1, 2]}, "the molecules of dsmc are all alike"),
    )


def test_what_no_box_with_liquid_can_have_is_refused():
    for engine, plane in ((MoistParcelSet, "three dimensions"), (MoistDsmcParcel, "three-dimensional")):
        refuses(
            box(engine),
            ({"liquid": mist(number=1), "gravity": 1.0}, "no gravity"),
            ({"liquid": mist(number=1), "planar": True}, plane),
            ({"liquid": Pool(Substance(**FACTS)), "walls": (HeatBath(1.0),) * 6}, "z_low Specular"),
        )
    refuses(
        box(MoistDsmcParcel),
        ({"liquid": mist(number=1), "diameter": 0.9}, "one size"),
        ({"liquid": drops()}, "drops that can be hit need the engine exact"),
        (
            {"liquid": Mist(substance(diameter=1.0), number=1), "position": np.full((300, 3), 2.0),
             "velocity": np.zeros((300, 3)), "mass": 1.0 + np.arange(300)},
            "301 kinds of molecules",
        ),
    )  # fmt: skip
    near = ((4.0, 4.0, 4.0), (4.5, 4.0, 4.0))
    refuses(
        damp,
        ({"centres": near}, "overlap at the start"),
        ({"centres": near, "position": [], "velocity": []}, "overlap at the start"),
        ({"centres": ((6.5, 7.0, 7.0),)}, "overlap at the start"),
        ({"centres": ((4.0, 4.0, 4.0), (4.0, 9.0, 4.0))}, "drop 1 lies outside"),
        ({"centres": ((4.0, 4.0, NAN),)}, "three finite numbers"),
        (
            {"centres": ((0.6, 0.6, 0.6),), "length": (1.2, 9, 9), "position": [[0.6, 7, 7], [0.6, 7, 5]]},
            "make the box larger",
        ),
        ({"diameter": 0.0}, "without a diameter"),
        ({"liquid": drops(substance=substance(diameter=0.0))}, "without a diameter"),
        ({"liquid": mist()}, "give it Drops"),
        ({"gravity": 1.0}, "no gravity"),
        ({"planar": True}, "three dimensions"),
        ({"collisions": False}, "leave collisions on"),
    )
    refuses(drops, ({"position": ()}, "drops need nuclei"), ({"rain": 0.1}, "do not rain"))


def test_what_molecules_that_attract_each_other_cannot_have_is_refused():
    refuses(
        well,
        ({"well": SquareWell([[1.5, 2.0], [1.0, 1.5]]), "species": [0, 1]}, "symmetric"),
        ({"well": SquareWell([[1.5]]), "species": [0, 1]}, "species"),
        ({"species": [0, 0, 1]}, "species"),
        ({"species": [0.5, 0]}, "species"),
        ({"walls": (*SMOOTH[:5], Piston(0.1))}, "piston"),
        ({"rotation": 2.0}, "rotation"),
        ({"collisions": False}, "collisions"),
        ({"length": (3.0, 8, 8), "walls": TURNING, "position": [[1, 1, 1], [1, 3, 1]]}, "length"),
    )
