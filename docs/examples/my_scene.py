"""A vacuum flask: why so little air carries so little heat.

Between a hot and a cold wall, five millimetres apart, there is so little air that molecules fly across
without colliding. Each carries heat from the hot wall to the cold one; half as many carry half as much.
Left out: radiation, which carries more, even between silvered walls.
"""

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import HeatBath, RandomNumbers, Specular, maxwell_velocities
from atmosbox.scene import Air, Headline, Line, Panel, Scale, SceneSettings, Setup, block_average, setting
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

title = "A vacuum flask"
GAP = 0.005  # m
SETTLE = 50  # frames that pass before averages begin


class Settings(SceneSettings):
    """What may be set."""

    molecules: int = setting(2000, "1", "number of molecules", low=1, high=100_000)
    hot: float = setting(90.0, "degC", "temperature of the inner wall", low=-200.0, high=1000.0)
    cold: float = setting(20.0, "degC", "temperature of the outer wall", low=-200.0, high=1000.0)
    pressure: float = setting(0.01, "Pa", "pressure of the air that is left", low=1e-6, high=0.1)


def answer(settings):
    """Return what theory says of so thin a gas, and the units of the engine in SI."""
    si = settings.si
    kT = BOLTZMANN * np.sqrt(si.hot * si.cold)
    scale = Scale(GAP, DRY_AIR.molecule_mass, kT, weight=si.pressure * GAP**3 / kT / settings.molecules)
    hot, cold, density = BOLTZMANN * si.hot, BOLTZMANN * si.cold, si.pressure / kT
    return law.free_molecular_slab(hot, cold, density, DRY_AIR.molecule_mass, rotational_dof=2), scale


def build(settings, engine):
    """Return the box between the walls: its molecules are points, which never collide."""
    n, scale = settings.molecules, answer(settings)[1]
    rng = RandomNumbers(settings.seed)
    bath = [HeatBath(scale.reduced_temperature(wall)) for wall in (settings.si.hot, settings.si.cold)]
    start = rng.random((n, 3)), maxwell_velocities(1.0, np.ones(n), rng)
    parcel = engine.make(
        *start, length=(1, 1, 1), walls=[Specular()] * 4 + bath, diameter=0.0, rotation=2, seed=settings.seed
    )
    return Setup(parcel, scale, duration=450.0, frames=450, instruments=(Air(),), settle=SETTLE, time_unit="s")


def theory(dataset, settings):
    """Return theory: the temperature of the air is the geometric mean of those of the walls."""
    kT = answer(settings)[0].kT
    return {"air_temperature_theory": np.full(dataset.sizes["elapsed_time"], kT / BOLTZMANN)}


def headlines(dataset, settings):
    """Return the main result: the heat that the hot wall gives and the cold one takes."""
    gave = np.diff(dataset.heat_from_wall.values, axis=0) / np.diff(dataset.elapsed_time.values)[:, None]
    flux = block_average((gave[SETTLE:, 4] - gave[SETTLE:, 5]) / (2.0 * GAP**2))
    numbers = float(flux.mean), float(flux.standard_error), float(answer(settings)[0].heat_flux)
    return (Headline("heat_flux", *numbers, 0.0, "", "W m-2", "W m-2", "heat through a square metre"),)


def panels(settings):
    """Return the graphs of the figure."""
    air = Line("elapsed_time", "air_temperature", "air")
    mean = Line("elapsed_time", "air_temperature_theory", "√(hot × cold)", "theory")
    return (Panel("line", "Between hot and cold", (air, mean), x_label="time", y_label="temperature", y_unit="degC"),)
