"""The theory of every scene is finite and within physical bounds: with few molecules, and at the ends of all settings.

The run is as short as the scene allows. A combination that the scene refuses in a sentence passes too.
"""

import math
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError
from atmosbox.simulation import runner
from tests.few_frames import few_frames_of

SHORT = ("duration", "ascent", "travel")
FEW = 300
LEAST = {"diffusion": 3000, "nuclei": 1000}
"""Number of molecules below which a box is too narrow, or needs the kernels of drops that are larger than cells."""
THINNEST = 0.01
"""Density of attracting molecules below which more than a million molecules of air would be needed in the box."""
BUSY = {("diffusion", "length"), ("diffusion", "pressure"), ("diffusion", "diameter")}
"""Settings whose highest values need minutes, since each molecule has hundreds of collisions before the gases mix."""
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


few_frames = few_frames_of(FRAMES)
"""Cut the runs of a scene into fewer frames."""


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


def corner(scene):
    """Return a strategy for the settings of a scene."""
    parameters = scenarios.load(scene).Settings.describe()
    return st.fixed_dictionaries({each.name: st.sampled_from(values(scene, each)) for each in parameters})


def examined(scene, given_settings):
    """Make the shortest run of a scene; check what holds for the theory of all scenes."""
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
    for each in outcome.headlines:
        assert each.theory is None or math.isfinite(each.theory), each.name
        assert each.theory is None or each.unit not in ("K", "m", "s-1") or each.theory >= 0.0, each.name
    return True


@pytest.mark.parametrize("scene", SCENES)
def test_the_theory_of_a_scene_holds_with_few_molecules(scene):
    described = scenarios.load(scene).Settings.describe()
    least = {each.name: values(scene, each)[0] for each in described if each.name in (*SHORT, "molecules")}
    assert examined(scene, least)


@pytest.mark.nightly
@pytest.mark.parametrize("scene", SCENES)
def test_the_theory_of_a_scene_holds_at_the_ends_of_its_settings(scene):
    ran = []

    @settings(max_examples=150, suppress_health_check=list(HealthCheck), database=None)
    @given(corner(scene))
    def at(given_settings):
        ran.append(examined(scene, given_settings))

    at()
    assert sum(ran) > 10
