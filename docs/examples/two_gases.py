"""Two gases in gravity: each has its own height, as if the other were not there.

Helium and argon are in one box, on a warm floor. Their molecules collide with each other, and so are equally warm. But
with the same energy a light molecule flies higher. Each gas thins with height by its own scale height, kT / mg.
"""

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import HeatBath, Maxwell, Periodic, Scattered, Specular, Start
from atmosbox.scene import Air, Headline, Layers, Line, Panel, Scale, SceneSettings, Setup, block_average, setting
from atmosbox.scene.instruments import Readings
from atmosbox.theory.constants import BOLTZMANN

title = "Two gases in gravity"
HEIGHT = 40_000.0  # m
DIAMETER = 0.004  # of the molecules, as a share of the height
MASSES = {"helium": 6.646e-27, "argon": 6.634e-26}  # kg
LAYERS = 20
variables = {  # dimensions, unit and words of what no scene of atmosbox has
    f"{gas}_{name}": (dimensions, unit, words.format(gas))
    for gas in MASSES
    for name, dimensions, unit, words in [
        ("number_density", "height", "m-3", "number density of the {}"),
        ("layer_temperature", "height", "K", "temperature of the {} in the layer"),
        ("mean_height", "elapsed_time", "m", "mean height of the {}"),
    ]
}


class Settings(SceneSettings):
    """What may be set."""

    molecules: int = setting(1000, "1", "number of molecules of each gas", low=10, high=100_000)
    temperature: float = setting(15.0, "degC", "temperature of the floor", low=-100.0, high=500.0)
    gravity: float = setting(9.80665, "m s-2", "gravity", low=2.0, high=20.0)


class MeanHeight:
    """The mean height of one gas in each frame."""

    def __init__(self, gas, which):
        self._name, self._which, self._sums, self._frames = f"{gas}_mean_height", which, [], []

    def sample(self, parcel, snapshot):
        """Note the mean height."""
        self._sums.append(snapshot.position[self._which, 2].mean())

    def end_frame(self, parcel, snapshot):
        """Finish the mean of a frame."""
        self._frames.append(np.mean(self._sums))
        self._sums = []

    def readings(self, scale, settle):
        """Return the mean heights."""
        return Readings({self._name: np.array(self._frames) * scale.length})


def build(settings, engine):
    """Return the box: a column with a warm floor, in which the last half of the molecules is argon."""
    n, si = settings.molecules, settings.si
    scale = Scale(HEIGHT, MASSES["argon"], BOLTZMANN * si.temperature)
    argon = np.arange(2 * n) >= n
    mass = np.where(argon, 1.0, MASSES["helium"] / MASSES["argon"])
    parcel = engine.begin(
        Start(2 * n, (Scattered(), Maxwell(1.0))),
        length=(1, 1, 1),
        walls=(Periodic(),) * 4 + (HeatBath(1.0), Specular()),
        mass=mass,
        diameter=DIAMETER,
        gravity=si.gravity / scale.acceleration,
        layers=LAYERS,
        seed=settings.seed,
    )
    gases = {"helium": ~argon, "argon": argon}
    profiles = tuple(Layers(LAYERS, gas=gas, which=which) for gas, which in gases.items())
    heights = tuple(MeanHeight(gas, which) for gas, which in gases.items())
    instruments = (Air("floor"), *profiles, *heights)
    return Setup(parcel, scale, 60.0, 240, instruments, samples=4, settle=60, time_unit="s", right=argon)


def expected(settings, gas):
    """Return the mean height of a gas that is alone [m]; no centre is nearer to floor and lid than a radius."""
    kT, reach = BOLTZMANN * settings.si.temperature, HEIGHT * (1.0 - DIAMETER)
    return 0.5 * DIAMETER * HEIGHT + float(law.column_mean_height(reach, kT, MASSES[gas], settings.si.gravity))


def theory(dataset, settings):
    """Return the barometric law of each gas, and its mean height."""
    si, out = settings.si, {}
    for gas, mass in MASSES.items():
        edges = HEIGHT * np.clip(np.linspace(0.0, 1.0, LAYERS + 1), 0.5 * DIAMETER, 1.0 - 0.5 * DIAMETER)
        share = np.diff(-np.exp(-edges * mass * si.gravity / (BOLTZMANN * si.temperature)))
        out[f"{gas}_number_density_theory"] = settings.molecules * share / share.sum() / (HEIGHT**3 / LAYERS)
        out[f"{gas}_mean_height_theory"] = np.full(dataset.sizes["elapsed_time"], expected(settings, gas))
    return out


def headlines(dataset, settings):
    """Return the mean height of each gas."""
    found = []
    for gas in MASSES:
        mean = block_average(dataset[f"{gas}_mean_height"].values[60:])
        numbers = float(mean.mean), float(mean.standard_error), expected(settings, gas)
        found.append(Headline(f"{gas}_height", *numbers, 0.0, "", "m", "km", f"mean height of the {gas}"))
    return tuple(found)


def panels(settings):
    """Return the graphs of the figure."""
    return (
        Panel(
            "profile",
            "Each gas has its own height",
            tuple(
                Line(f"{gas}_number_density{end}", "height", f"{gas}{words}", role, error)
                for gas in MASSES
                for end, words, role, error in (
                    ("", "", "data", f"{gas}_number_density_se"),
                    ("_theory", ", alone", "theory", None),
                )
            ),
            x_label="number density",
            y_label="height",
            y_unit="km",
            x_scale="log",
        ),
        Panel(
            "line",
            "Mean heights",
            tuple(Line("elapsed_time", f"{gas}_mean_height", gas) for gas in MASSES),
            x_label="time",
            y_label="height",
            y_unit="km",
        ),
    )
