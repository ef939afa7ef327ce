"""Discs of different mass collide in a plane and share their energy.

Sixty pucks on a frictionless table, light and heavy, start at the same speed: the heavy ones carry most of the energy.
Every collision conserves momentum and energy except for rounding. Collisions alone bring light and heavy discs to the
same mean energy, so the light ones are fast in the end. This is why hydrogen flies faster than oxygen in the same air.

Modelled: smooth elastic discs in one plane, exact collisions, smooth walls. Left out: friction, spin,
gravity. A disc's area grows with its mass. The scale is that of a table, and nothing is exaggerated.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import EqualSpeeds, RandomNumbers, Scattered, Start
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT
from atmosbox.scene.headline import ROUNDING
from atmosbox.scene.instruments import Air, Discs, Speeds
from atmosbox.scene.panels import Line, Panel, over_time
from atmosbox.scene.statistics import block_average
from atmosbox.scene.units import Scale, rounded

if TYPE_CHECKING:
    import xarray as xr

title = "Do light or heavy discs have more energy?"
level = "school"
minutes = 10
FRAMES = 1200
SETTLE = 400
BLOCKS = 5
"""Number of blocks for the errors of the speeds: each is longer than the time in which discs share their energy."""

series = (
    Series("exact", "duration", (15, 60, 240)),
    Series("stepped", "delta", (0.4, 0.1), {"duration": 60}),
    Series("stepped:applet-discs", "delta", (0.4, 0.1), {"duration": 60}),
)
"""Runs worth comparing: every scheme that exchanges momentum shares the energy out; they differ in cost."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(60, "1", "number of discs", low=2, high=5000)
    mass_ratio: float = setting(20.0, "1", "largest possible ratio of two masses", low=1.0, high=1e6)
    filling: float = setting(15.0, "%", "share of the table that the discs cover", low=0.01, high=70.0)
    side: float = setting(1.0, "m", "side of the table", low=0.01, high=100.0)
    speed: float = setting(0.5, "m s-1", "speed of every disc at the start", low=1e-3, high=1e3)
    duration: float = setting(60.0, "s", "how long to watch", low=0.1, high=1e6)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the discs on their table."""
    si = settings.si
    n = settings.molecules
    rng = RandomNumbers(settings.seed)
    mass = rounded(settings.mass_ratio ** rng.random(n))
    mass *= 1.0 / mass.min()
    area = mass / mass.sum() * (si.filling)
    diameter = np.sqrt(4.0 * area / math.pi)
    thickness = 2.0 * float(diameter.max())
    length = (1.0, thickness, 1.0)
    parcel = engine.begin(
        Start(n, (Scattered(), EqualSpeeds(1.0))),
        rng=rng,
        length=length,
        mass=mass,
        diameter=diameter,
        planar=True,
        seed=settings.seed,
    )
    lightest = 0.01
    scale = Scale(si.side, lightest, lightest * si.speed**2)
    facts = {
        "box": f"a table of {settings.side:g} m x {settings.side:g} m",
        "masses": f"from 10 g to {10.0 * float(mass.max()):.0f} g",
        "exaggeration": "none",
        "degrees of freedom": "2: the discs move in a plane",
        "noise": f"the mean energy of {n // 2} discs scatters by {100.0 / math.sqrt(n + 1.0):.0f} % "
        "from one reading to the next",
    }
    measured = Air(), Discs(), Speeds(np.linspace(0.0, 5.0, 51), blocks=BLOCKS)
    duration = si.duration / scale.time
    return Setup(parcel, scale, duration, FRAMES, measured, settle=SETTLE, time_unit="s", facts=facts)


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the mean energy that all discs reach, that of the start, and the law of speeds of such discs."""
    mean = dataset.kinetic_energy.values[0] / settings.molecules
    # N discs share one energy E: a share (1 - m v^2 / 2E)^(N - 1) of those of mass m is faster than v
    share_of_one = (
        dataset.disc_mass.values * dataset.speed_bnds.values[..., None] ** 2 / (2.0 * mean * settings.molecules)
    )
    slower = -np.expm1((settings.molecules - 1) * np.log1p(-np.minimum(share_of_one, 1.0 - 1e-15)))
    share = np.diff(slower.mean(axis=-1), axis=1)[:, 0] / np.diff(dataset.speed_bnds.values, axis=1)[:, 0]
    return {
        "kinetic_energy_light_theory": np.full(dataset.sizes["elapsed_time"], mean),
        "speed_probability_density_theory": share,
    }


def _memory(dataset: "xr.Dataset") -> float:
    r"""Return the correlation time of the energy of the light discs [s].

    In a collision disc i receives on average :math:`4 m_i m_j / (m_i + m_j)^2` of the excess of j's energy, and they
    collide at the rate :math:`\sigma_{ij} g \sqrt{2 \pi kT (1/m_i + 1/m_j)} / A`. So the energies relax to their mean
    as :math:`dE/dt = -R E` with a symmetric matrix R, and a surplus a of the light discs, taken from the others, has
    the correlation time :math:`a R^{-1} a / a^2`.
    """
    mass, diameter = dataset.disc_mass.values, dataset.disc_diameter.values
    area = float(np.prod(dataset.box_length.values[[0, 2]]))
    energy = float(dataset.kinetic_energy.values[0]) / mass.size
    contact = float(law.contact_value_discs(np.pi / 4.0 * np.sum(diameter**2) / area))
    one, other = mass[:, None], mass[None, :]
    reach = 0.5 * (diameter[:, None] + diameter[None, :])
    rate = reach * contact / area * np.sqrt(2.0 * math.pi * energy * (1.0 / one + 1.0 / other))
    rate *= 4.0 * one * other / (one + other) ** 2
    np.fill_diagonal(rate, 0.0)
    half = mass.size // 2
    surplus = np.full(mass.size, -1.0 / (mass.size - half))
    surplus[np.argsort(mass, kind="stable")[:half]] = 1.0 / half
    # the mean energy is constant: adding a constant to R makes it regular and does not change the surplus
    back = np.diag(rate.sum(axis=1)) - rate + rate.mean()
    return float(surplus @ np.linalg.solve(back, surplus) / (surplus @ surplus))


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the ratio of mean energies, and the largest errors of energy and momentum."""
    late = dataset.isel(elapsed_time=slice(SETTLE, None))
    changed, off = np.abs(dataset.energy_change.values).max(), dataset.momentum_residual.values.max()
    found = [
        Headline(name, float(largest), 0.0, 0.0, 1e-12, ROUNDING, "1", "1", label)
        for name, largest, label in (
            ("largest_energy_change", changed, "largest relative change of the energy"),
            ("largest_momentum_residual", off, "largest relative error of the momentum"),
        )
    ]
    if late.sizes["elapsed_time"] >= 40 and settings.mass_ratio > 1.0:
        mean = float(dataset.kinetic_energy.values[0]) / settings.molecules
        memory = _memory(dataset) / settings.si.duration * FRAMES
        share = block_average(late.kinetic_energy_light.values / mean, memory=memory)
        label = "energy of a light disc / mean energy"
        reason = "none: in the long run all discs have the same mean energy"
        found.insert(0, Headline.of_mean("energy_of_light_discs", label, share, 1.0, "1", reason=reason))
    return tuple(found)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of the discs, of their energies, and of their speeds."""
    unlike = settings.mass_ratio > 1.0
    density = "speed_probability_density"
    light, heavy = ("light half", "heavy half") if unlike else ("one half", "the other")
    mean = Line("elapsed_time", "kinetic_energy_light_theory", "mean of all: conserved", "theory")
    shared = over_time(
        "Light and heavy: the same energy" if unlike else "Discs alike: the same energy",
        {"running_energy_light": light, "running_energy_heavy": heavy}, "mean energy so\u00a0far",
        "mJ", more=(mean,), log=True, headline="energy_of_light_discs",
    )  # fmt: skip
    measured, guides = Line("speed", density, "discs", error=f"{density}_se"), (("x", settings.speed, "start"),)
    lines = measured, Line("speed", f"{density}_theory", "Maxwell, in a plane", "theory")
    title = "Equal speeds become unequal"
    speeds = Panel("histogram", title, lines, "speed", "probability density", guides=guides)
    return Panel("discs", "The discs at the end", x_unit="m"), shared, speeds
