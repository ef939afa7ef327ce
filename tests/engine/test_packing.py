"""The packing fraction of molecules, and the largest that geometry allows."""

import math

import numpy as np
import pytest

from atmosbox.engine import PackingError, packing_fraction
from atmosbox.engine.core.packing import refuse_impossible


def test_the_fraction_is_the_volume_of_all_spheres_over_that_of_the_box():
    assert packing_fraction((2.0, 3.0, 4.0), [1.0, 2.0]) == pytest.approx(math.pi / 6.0 * 9.0 / 24.0, rel=1e-15)


def test_the_fraction_of_discs_is_that_of_areas_whatever_the_depth():
    for depth in (1.0, 7.0):
        assert packing_fraction((4.0, depth, 5.0), [2.0], planar=True) == pytest.approx(math.pi / 20.0, rel=1e-15)


@pytest.mark.parametrize(("planar", "densest"), [(False, math.pi / math.sqrt(18.0)), (True, math.pi / math.sqrt(12.0))])
def test_equal_molecules_are_refused_just_above_the_densest_packing(planar, densest):
    number = 1000
    filled = number * (math.pi / 4.0 if planar else math.pi / 6.0)
    for share, lawful in ((0.999, True), (1.001, False)):
        side = (filled / (share * densest)) ** (0.5 if planar else 1.0 / 3.0)
        arguments = (np.full(3, side), np.ones(number), (False,) * 3, planar)
        if lawful:
            refuse_impossible(*arguments)
        else:
            with pytest.raises(PackingError, match="no packing of spheres fills more than"):
                refuse_impossible(*arguments)
