"""The theory of every scene at the extreme values of its settings: finite, within physical bounds, and right.

Each setting is at its lowest, its default or its highest value, in combinations that hypothesis chooses; the run is
as short as the scene allows, since only its theory is tested. A combination that the scene refuses, in a sentence,
passes too.
"""

import math
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from atmosbox import scenarios, theory
from atmosbox.errors import AtmosboxError
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
from tests.few_frames import cut

SHORT = ("duration", "ascent", "travel")
FEW = 300
LEAST = {"diffusion": 3000}
"""Number of molecules below which a box is too narrow."""
THINNEST = 0.01
"""Density of attracting molecules below which more than a million molecules of air would be needed in the box."""
BUSY = {("diffusion", "length"), ("diffusion", "pressure"), ("diffusion", "diameter")}
"""Settings whose highest values need minutes, since each molecule has hundreds of collisions before the gases mix."""
OWN_KERNELS = {("condensation", "drops")}
"""Settings whose highest values need kernels that no other test needs; the scene nuclei tests drops too."""
SCENES = scenarios.names()
FRAMES = {
    "atmosphere": (60, 12),
    "attraction": (60, 12),
    "condensation": (60, 12),
    "convection": (60, 20),
    "diffusion": (30, None),
    "elastic-collisions": (60, 12),
    "evaporation": (80, None),
    "lifting-moist": (30, None),
    "lifting-sounding": (30, None),
    "mountains": (30, None),
    "nuclei": (60, 12),
    "temperature": (60, 12),  # and temperature-large, which is built there
}
"""Number of frames of a run, and how many of them are for settling: at least as many as the headlines need."""
ENERGIES = {"cape_theory", "cin_theory"}
"""Results of theory that may be negative: energies of a parcel."""
SILENT = {"virial_pressure_theory", "roll_speed_theory"}
"""Results of theory that are NaN where the series does not converge, or where no theory is known."""


@pytest.fixture(scope="module", autouse=True)
def fewer_frames():
    """Cut the runs of a scene into fewer frames."""
    with pytest.MonkeyPatch.context() as patch:
        cut(patch, FRAMES)
        yield


def values(scene, parameter):
    """Return the values to test: few molecules, a short run, and for all other settings the ends and the default."""
    if parameter.name in ("seed", "sounding"):
        return [parameter.default]
    if parameter.name in SHORT:
        return [parameter.low]
    if parameter.name == "molecules":
        return [max(LEAST.get(scene, 60), parameter.low)]
    if (scene, parameter.name) == ("attraction", "density"):
        return [THINNEST, parameter.default, parameter.high]
    if (scene, parameter.name) in BUSY:
        return sorted({parameter.low, parameter.default})
    if parameter.kind == "bool":
        return [False, True]
    if parameter.kind == "str":
        return list(parameter.choices)
    high = min(parameter.high, FEW) if parameter.kind == "int" else parameter.high
    return sorted({parameter.low, min(parameter.default, high), high})


def corner(scene, without=frozenset()):
    """Return a strategy for the settings of a scene; optional settings keep their defaults."""
    parameters = [each for each in scenarios.load(scene).Settings.describe() if (scene, each.name) not in without]
    return st.fixed_dictionaries({each.name: st.sampled_from(values(scene, each)) for each in parameters})


def atmosphere(data, stated, prepared):
    """The layers hold all molecules, whose mean height is that of points, or larger because of their size."""
    si = prepared.settings.si
    thick = np.diff(data.height_bnds.values, axis=1)[:, 0]
    held = float(data.air_density_theory.values @ thick) * si.gravity
    assert held == pytest.approx(stated["weight_of_the_air"].theory, rel=1e-6) if stated else held > 0.0
    warm = float(data.layer_temperature_theory.values[0])
    scale_height = BOLTZMANN * warm / (DRY_AIR.molecule_mass * si.gravity)
    law = np.exp(-data.height.values / scale_height)
    found = data.layer_pressure_barometric.values
    assert np.allclose(found / found[0], law / law[0], rtol=1e-9, atol=1e-300)
    column = prepared.module.Column(prepared.settings)
    kT = warm / column.scale.temperature
    reach = column.top - column.bottom
    a = reach / kT
    points = column.bottom + reach * (1.0 / a - 1.0 / math.expm1(min(a, 700.0)) if a > 1e-3 else 0.5 - a / 12.0)
    if stated:
        mean = column.mean_height(kT)
        mean -= column.on_the_floor(kT) * (mean - column.bottom)
        assert stated["mean_height"].theory / column.scale.length == pytest.approx(mean, rel=1e-9)
    assert points * (1.0 - 1e-9) <= column.mean_height(kT) < column.top
    column.room = 0.0
    assert column.mean_height(kT) == pytest.approx(points, rel=1e-6)


def temperature(data, stated, prepared):
    """The walls set the temperature, and the pressure of points at it is that of the gas or a little less."""
    si = prepared.settings.si
    assert stated["mean_temperature"].theory == pytest.approx(si.temperature, rel=0.02)
    assert stated["mean_pressure"].theory == pytest.approx(si.pressure, rel=0.02)


def saturated(data, stated, prepared):
    """There is no more vapour than saturates air at the temperature of the walls, by another formula for it."""
    si, walls = prepared.settings.si, data.wall_temperature.values[:, 0]
    assert np.allclose(data.air_temperature_theory, walls, rtol=1e-12)
    if si.temperature >= 240.0 and not si.drops:
        most = theory.saturation_vapor_pressure_iapws(walls)
        assert (data.water_vapor_partial_pressure_theory.values <= 1.002 * most).all()
    assert (data.relative_humidity_theory.values <= (1.0 + 1e-9 if not si.drops else 50.0)).all()


def evaporated(data, stated, prepared):
    """Dry air cools, air with too much vapour becomes warmer; and the vapour is part of the gas."""
    si, end = prepared.settings.si, float(data.gas_temperature_theory.values[-1])
    if si.humidity < 0.5:
        assert end <= si.temperature + 0.5
    if si.humidity > 5.0:
        assert end >= si.temperature - 0.5
    assert data.water_vapor_partial_pressure_theory.values.max() <= si.pressure
    assert data.condensation_rate_theory.values.min() >= 0.0


def lifted(data, stated, prepared):
    """A rising parcel is never warmer than at its start, and not colder than on the dry adiabat of argon."""
    pressure = data.parcel_pressure.values
    warm = data.adiabat_temperature.values
    share = pressure / pressure.max()
    start = warm[np.argmax(pressure)]
    assert (warm <= start * 1.001).all()
    assert (warm >= 0.985 * start * share**0.4).all()


def crossed(data, stated, prepared):
    """Air that rained on the mountains comes down warmer, by no more than the heat of all its vapour."""
    pressure, warm = data.parcel_pressure.values, data.adiabat_temperature.values
    share, start = pressure / pressure[0], warm[0]
    most = 2.6e6 / 1005.0 * theory.mixing_ratio(theory.saturation_vapor_pressure(start), pressure[0])
    # theory knows how much water has rained out in the box, where a few hundred molecules tell the temperature to 2 %
    assert (warm <= (1.02 * start + most) * np.maximum(share, 1.0) ** 0.4).all()
    assert (warm >= 0.98 * start * np.minimum(share, 1.0) ** 0.4).all()


BOUNDS = {
    "atmosphere": atmosphere,
    "temperature": temperature,
    "temperature-large": temperature,
    "condensation": saturated,
    "evaporation": evaporated,
    "lifting-dry": lifted,
    "lifting-moist": lifted,
    "lifting-sounding": lifted,
    "mountains": crossed,
}


def examined(scene, given_settings):
    """Make the shortest run of a scene; check what holds for all scenes, then what holds for this one."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # doubtful settings give a warning, and can be run
            prepared = runner.prepare(scene, given_settings)
            outcome = runner.execute(prepared)
    except AtmosboxError:  # a sentence, as the tests of refusals check
        return False
    data = outcome.dataset
    for name, found in data.variables.items():
        if name.endswith(("_theory", "_barometric")) and not name.startswith("leaving_energy"):
            known = found.values[np.isfinite(found.values)] if name in SILENT else found.values
            assert np.isfinite(known).all(), name
            assert name in ENERGIES or (known >= 0.0).all(), name
    stated = {each.name: each for each in outcome.headlines}
    for each in stated.values():
        assert each.theory is None or math.isfinite(each.theory), each.name
        assert each.theory is None or each.unit not in ("K", "m", "s-1") or each.theory >= 0.0, each.name
    if scene in BOUNDS:
        BOUNDS[scene](data, stated, prepared)
    return True


@pytest.mark.parametrize("scene", SCENES)
def test_the_theory_of_a_scene_holds_at_the_corners_of_its_settings(scene):
    described = scenarios.load(scene).Settings.describe()
    least = {each.name: values(scene, each)[0] for each in described if each.name in (*SHORT, "molecules")}
    assert examined(scene, least)  # with its defaults and few molecules

    @settings(max_examples=4, suppress_health_check=list(HealthCheck), database=None)
    @given(corner(scene, OWN_KERNELS))
    def at(given_settings):
        examined(scene, given_settings)

    at()


@pytest.mark.nightly
@pytest.mark.parametrize("scene", SCENES)
def test_the_theory_of_a_scene_holds_at_many_more_corners(scene):
    ran = []

    @settings(max_examples=150, suppress_health_check=list(HealthCheck), database=None)
    @given(corner(scene))
    def at(given_settings):
        ran.append(examined(scene, given_settings))

    at()
    assert sum(ran) > 10
