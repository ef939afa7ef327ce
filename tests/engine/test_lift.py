"""A piston that follows a pressure is moved by compiled code as its driver would move it from Python."""

import copy

import numpy as np
import pytest

from atmosbox.engine import FollowPressure, Mist, ParcelSet, Piston, Specular
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from tests.engine.boxes import WATER

UNDER_PISTON = (*(Specular(),) * 5, Piston())
TAU = 2.0


def gas(planar=False):
    random = np.random.default_rng(3)
    many = (5, 1, 5) if planar else (4, 4, 4)
    site = np.stack(np.meshgrid(*map(np.arange, many), indexing="ij"), axis=-1).reshape(-1, 3) + 0.5
    velocity = random.normal(size=site.shape) * ([1, 0, 1] if planar else 1)
    return site * 3.0, velocity


def follow(first, last, kind=FollowPressure, duration=400.0):
    return kind([0.0, duration], [first, last], mean_free_time=TAU)


MIXTURE = {"mass": [1.0, 0.62] * 32, "rotation": [2.0, 3.0] * 32, "rotational_energy": 1.0}
BOXES = {
    "dry": lambda driver: ParcelSet(*gas(), length=(12.0,) * 3, walls=UNDER_PISTON, driver=driver, rotation=2.0),
    "plane": lambda driver: ParcelSet(
        *gas(planar=True), length=(15.0, 3.0, 15.0), walls=UNDER_PISTON, driver=driver, planar=True, rotation=2.0
    ),
    "mist": lambda driver: MoistParcelSet(
        *gas(), length=(12.0,) * 3, walls=UNDER_PISTON, driver=driver, liquid=Mist(WATER, number=9, kT=1.0), **MIXTURE
    ),
}


@pytest.mark.parametrize("name", BOXES)
def test_compiled_code_gives_the_piston_the_velocity_that_python_would(name):
    driver = follow(1.0, 1.0)
    start = driver.pressure(BOXES[name](driver))
    box = BOXES[name](follow(start, 0.5 * start))
    interval = box._driver.interval
    fell = 0
    for turn in (1, 2, 40, 41, 150):
        box.advance((turn - 0.5) * interval)
        before = copy.deepcopy(box._driver)
        box.advance(turn * interval)
        assert box.piston_velocity == pytest.approx(before.velocity(box), rel=1e-11, abs=1e-15)
        assert box._driver._measured == pytest.approx(before._measured, rel=1e-12)
        fell += box.piston_velocity < 0.0
    assert box.contacts > 20
    assert box.ceiling > 12.0
    assert box.ledger() < 1e-12
