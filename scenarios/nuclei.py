"""Why clouds need dust: small drops of pure water evaporate even in supersaturated air.

A molecule leaves a small drop more easily than a flat surface: the drop's surface shrinks and releases surface energy.
So the smaller a drop is, the more supersaturated the air must be, or the drop evaporates. And every drop begins small.
Salt helps: it replaces some of the molecules of water, so fewer leave. In one box of supersaturated air there are drops
with a grain of salt and drops of pure water, with the same number of molecules of water. Those with salt grow. The
others vanish, though the humidity is the same for all.

Prescribed: the surface energy of a drop, from the measured tension of water and the volume of its molecules; the curve
e_s(T) of a flat surface; and an ideal solution, in which all ways to arrange water and salt are equally likely. What
emerges is the vapour pressure over each drop (the laws of Kelvin and of Koehler), and therefore which drops grow.

Modelled: hard molecules of air and water at real density, drops that molecules hit and leave one by one. Left out: the
time in which salt dissolves, and forces of its ions on water; the change of surface tension with the radius (a drop of
sixty molecules has no sharp surface); gravity. Drops are at rest and have the temperature of the walls: their nuclei
take up the latent heat. In real drops this heat slows the growth. Exaggerated: molecules hit drops as if these were
drop_size times as wide, which changes how soon drops grow, but not which of them do. The grains are far smaller than
those in the atmosphere, and need far more vapour.
"""

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import Drops, HeatBath, Scattered, Start
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.exchange.drop_growth import DropGrowth, DropKind
from atmosbox.scene.exchange.moist_box import MoistBox, refuse_vapour_alone
from atmosbox.scene.headline import CHANCE_ALONE
from atmosbox.scene.instruments import Air, Nuclei, Water
from atmosbox.scene.moisture import WARM, moist_air, water
from atmosbox.scene.panels import Line, Panel, over_time
from atmosbox.scene.statistics import block_average
from atmosbox.scene.units import rounded
from atmosbox.theory.constants import BOLTZMANN

if TYPE_CHECKING:
    import xarray as xr

title = "Why do clouds need dust?"
level = "second year"
minutes = 20
FRAMES = 240
SETTLE = 120
BLOCKS = 20
HEAT = 1e8
"""Heat capacity of the nuclei, in k: so large that the latent heat hardly warms them."""
HEAVY = 1e10
"""Mass of a nucleus, in molecules of air: so large that it does not move."""
IONS = 2.0
"""Number of particles that a pair of ions forms in solution."""
RADII = np.linspace(0.3e-9, 2.5e-9, 221)
"""Radii at which the curves of theory are drawn [m]."""
HIGHEST = 4.0
"""Relative humidity up to which these curves are drawn."""

series = (Series("exact", "molecules", (1500, 3000, 6000)),)
"""Runs worth comparing: the more molecules there are, the less the humidity scatters."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(3000, "1", "number of molecules of air and vapour", low=50, high=1_000_000)
    temperature: float = setting(20.0, "degC", "temperature of the walls and of the drops", low=-30.0, high=95.0)
    pressure: float = setting(100.0, "hPa", "pressure of air and vapour at the start", low=1.0, high=5000.0)
    humidity: float = setting(250.0, "percent", "relative humidity at the start", low=0.0, high=1000.0)
    salted: int = setting(1, "1", "number of drops with a grain of salt in them", low=0, high=20)
    pure: int = setting(3, "1", "number of drops of pure water", low=0, high=20)
    salt: int = setting(25, "1", "pairs of ions in each grain of salt", low=1, high=1000)
    water: int = setting(60, "1", "molecules of water in each drop at the start", low=0, high=5000)
    tension: float = setting(1.0, "1", "surface tension, divided by that of water", low=0.0, high=2.0)
    drop_size: float = setting(4.0, "1", "width of the drops, divided by that of real ones", low=1.0, high=10.0)
    duration: float = setting(150.0, "ns", "how long to watch", low=0.1, high=1e5)

    def check(self) -> None:
        """Refuse a box without drops, so much vapour that no air is left, and drops that fill the box."""
        if not self.salted + self.pure:
            raise self.refusal("salted", "and pure = 0 leave no drop to watch", at_least=1)
        refuse_vapour_alone(self)
        growth = _growth(self)
        widest = max(float(growth.radius(growth.box.vapour + self.water, kind)) for kind in growth.kinds)
        gap = growth.box.side * growth.box.scale.length / _side(self)
        if 2.0 * self.drop_size * widest > gap:
            problem = f"would let a drop that takes all the vapour touch the next, {1e9 * gap:.3g} nm away"
            most = math.floor(50.0 * gap / widest) / 100.0
            raise self.refusal("drop_size", problem, ", or fewer drops", at_most=most)


def _growth(settings: Settings, *, ideal: bool = False) -> DropGrowth:
    """Return the growth of the drops according to theory; those with salt come first."""
    particles = IONS * settings.salt
    kinds = (
        DropKind(settings.salted, particles, particles * law.SALT_VOLUME),
        DropKind(settings.pure, 0.0, law.WATER_VOLUME),
    )
    tension = settings.tension * float(law.water_surface_tension(settings.si.temperature))
    there = tuple(kind for kind in kinds if kind.count)
    return DropGrowth(MoistBox.of(settings, ideal=ideal), there, settings.water, settings.drop_size, tension)


def _side(settings: Settings) -> int:
    """Return the number of drops along a side of the box."""
    return math.ceil(float(np.cbrt(settings.salted + settings.pure)) - 1e-9)


def _places(settings: Settings, side: float) -> list[tuple[float, float, float]]:
    """Return the positions of the drops in a box of a side [length]: on a lattice, as far apart as possible."""
    along, number = _side(settings), settings.salted + settings.pure
    across = [(k + 0.5) * side / along for k in range(along)]
    lattice = list(itertools.product(across, across, across))
    return [lattice[k * len(lattice) // number] for k in range(number)]


def _is_salted(settings: Settings) -> np.ndarray:
    """Tell which drops have salt in them: these are distributed among the others."""
    number = settings.salted + settings.pure
    so_far = np.arange(number + 1) * settings.salted // number
    return np.asarray(np.diff(so_far) > 0)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the supersaturated air, with drops in it."""
    n = settings.molecules
    growth = _growth(settings, ideal=engine.ideal)
    box = growth.box
    scale, side = box.scale, box.side + 1.0
    gas = moist_air(n, box.vapour)
    salted = _is_salted(settings)
    centre = _places(settings, side)
    ball = settings.drop_size * (3.0 / (4.0 * math.pi) * law.WATER_VOLUME) ** (1.0 / 3.0) / scale.length
    particles = np.where(salted, IONS * settings.salt, 0.0)
    core = np.where(salted, particles * law.SALT_VOLUME / law.WATER_VOLUME, 1.0)
    tension = growth.tension * scale.length**2 / (BOLTZMANN * scale.temperature * settings.drop_size**2)
    liquid = Drops(
        water(scale),
        number=settings.water * len(salted),
        kT=1.0,
        nuclei=HEAT,
        position=tuple(centre),
        nucleus=tuple(rounded(ball * float(each) ** (1.0 / 3.0)) for each in core),
        nucleus_mass=HEAVY,
        molecule_radius=rounded(ball),
        surface_tension=rounded(tension),
        dissolved=tuple(float(each) for each in particles),
    )
    reach = ball * (core + settings.water) ** (1.0 / 3.0) + 0.6
    parcel = engine.begin(
        Start(n, (*WARM, Scattered(centre=centre, reach=reach))),
        length=(side,) * 3,
        walls=(HeatBath(1.0),) * 6,
        mass=gas.mass,
        rotation=gas.rotation,
        seed=settings.seed,
        liquid=liquid,
    )
    duration, measured = settings.si.duration / scale.time, (Air(), Water(), Nuclei(settings.drop_size, RADII))
    return Setup(parcel, scale, duration, FRAMES, measured, 4, SETTLE, facts=_facts(settings, growth))


def _facts(settings: Settings, growth: DropGrowth) -> dict[str, str]:
    """Return the facts of the model card for these settings."""
    box, si = growth.box, settings.si
    found = {
        "box": f"a cube of {1e9 * (box.side + 1.0) * box.scale.length:.1f} nm, real size",
        "real molecules per simulated one": "1",
        "exaggeration": f"none in the gas; molecules hit drops as if these were {settings.drop_size:g} times as wide, "
        "and the drops keep their temperature",
        "vapour at the start": f"{box.vapour} molecules; {box.full:.0f} saturate the air",
        "surface tension": f"{1e3 * growth.tension:.1f} mN/m",
    }
    facts = {"tension": growth.tension, "volume": law.WATER_VOLUME, "kT": BOLTZMANN * si.temperature}
    if settings.tension and si.humidity > 1.0:
        critical = law.kelvin_radius(**facts) / math.log(si.humidity)
        found["a drop without salt grows at this humidity"] = f"from a radius of {1e9 * critical:.2f} nm on"
    if settings.tension and settings.salted:
        kind = growth.kinds[0]
        top = law.critical_drop(**facts, particles=kind.particles, core=kind.core)
        found["a drop with this salt needs"] = (
            f"{100.0 * top.humidity:.0f} % to get past a radius of {1e9 * top.radius:.2f} nm"
        )
    return found


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the growth of the drops and the humidity, and the humidity over drops of any radius."""
    growth = _growth(settings, ideal=used(dataset).ideal)
    number, humidity = _path(dataset, growth)
    found = {"saturation_ratio_theory": humidity}
    facts = {"tension": growth.tension, "volume": law.WATER_VOLUME, "kT": BOLTZMANN * settings.si.temperature}
    sphere = 4.0 / 3.0 * math.pi * dataset.radius.values**3
    for kind, n in zip(growth.kinds, number, strict=True):
        name = "salted" if kind.particles else "pure"
        found[f"{name}_drop_radius_theory"] = growth.radius(n, kind)
        core = kind.core if kind.particles else 0.0
        held = (sphere - core) / law.WATER_VOLUME
        over = law.humidity_over_drop(np.maximum(held, 1.0), **facts, particles=kind.particles, core=core)
        found[f"{name}_drop_humidity"] = np.where((held >= 1.0) & (over < HIGHEST), over, math.nan)
    return found


def _path(dataset: "xr.Dataset", growth: DropGrowth) -> tuple[np.ndarray, np.ndarray]:
    """Return the molecules in a drop of each kind and the humidity, according to theory, at the ends of frames."""
    number, humidity = growth.path(np.append(0.0, dataset.elapsed_time.values * 1e-9))
    return number[:, 1:], humidity[1:]


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the humidity around the drops and the one that they need, and their size."""
    late = slice(SETTLE, None)
    if dataset.sizes["elapsed_time"] - SETTLE < 2 * BLOCKS:
        return ()
    growth = _growth(settings, ideal=used(dataset).ideal)
    of = _is_salted(settings) == bool(growth.kinds[0].particles)
    found = []
    if (dataset.drop_molecule_count.values[late][:, of] > 0).all():
        found.append(_balance(dataset.isel(elapsed_time=late), growth, of))
    if settings.salted:
        found.append(_size(dataset, growth, late))
    if not found:
        found.append(_left(dataset, growth, late))
    return tuple(found)


def _balance(late: "xr.Dataset", growth: DropGrowth, of: np.ndarray) -> Headline:
    """Return the humidity, and the one at which such drops would gain what they did according to Koehler's law."""
    kind, held = growth.kinds[0], late.drop_molecule_count.values[:, of].astype(float)
    hit = growth.area(held, kind).sum(axis=1)
    needed = (growth.area(held - 1.0, kind) * growth.over(held, kind)).sum(axis=1) / hit.mean()
    time = late.elapsed_time.values * 1e-9
    gained = (held[-1].sum() - held[0].sum()) / ((time[-1] - time[0]) * growth.flux * hit.mean())
    felt = late.saturation_ratio.values * hit / hit.mean()
    # each molecule came or left at random
    events = growth.flux * hit.mean() * (time[-1] - time[0]) * (felt.mean() + needed.mean())
    error = math.sqrt(events) / (growth.flux * hit.mean() * (time[-1] - time[0]))
    label = "humidity over the drops with salt" if kind.particles else "humidity over the drops of pure water"
    value, answer = float(felt.mean()), float(needed.mean() + gained)
    return Headline("humidity_over_drops", value, error, answer, 0.0, CHANCE_ALONE, "1", "percent", label)


def _left(dataset: "xr.Dataset", growth: DropGrowth, late: slice) -> Headline:
    """Return the humidity that remains when all drops have evaporated."""
    found = block_average(dataset.saturation_ratio.values[late], BLOCKS)
    theory = float(_path(dataset, growth)[1][late].mean())
    return Headline.of_mean("humidity_at_the_end", "humidity at the end", found, theory, "1", "percent")


def _size(dataset: "xr.Dataset", growth: DropGrowth, late: slice) -> Headline:
    """Return the radius of the drops with salt, and that of theory, which leaves fluctuations out."""
    time = np.append(0.0, dataset.elapsed_time.values * 1e-9)
    number, humidity = growth.path(time)
    variance, back = growth.scatter(time, number, humidity)
    radius = growth.radius(number[0], growth.kinds[0])
    steep = law.WATER_VOLUME / (4.0 * math.pi * radius**2)
    span, wait = time[-1] - time[1:][late][0], float(back[1:][late].mean())
    error = float((steep * np.sqrt(variance))[1:][late].mean()) * math.sqrt(min(2.0 * wait / span, 1.0))
    value, answer = float(dataset.salted_drop_radius[late].mean()), float(radius[1:][late].mean())
    label = "radius of the drops with salt"
    return Headline("salted_drop_radius_at_the_end", value, error, answer, 0.0, CHANCE_ALONE, "m", "nm", label)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of radii against time, and of the humidity over drops of any radius."""
    there = [name for name, count in (("salted", settings.salted), ("pure", settings.pure)) if count]
    called = {"salted": "with salt", "pure": "pure water"}
    law_of = {"salted": "with salt: Köhler", "pure": "pure water: Kelvin"}
    over = [Line("radius", f"{name}_drop_humidity", law_of[name], "theory") for name in there]
    over += [Line(f"{name}_drop_radius", "saturation_ratio", called[name]) for name in there]
    theory = tuple(Line("elapsed_time", f"{name}_drop_radius_theory", "theory", "theory") for name in there)
    grown = over_time(
        "Drops with salt grow, others vanish" if len(there) > 1 else "Drops grow or vanish",
        {f"{name}_drop_radius": called[name] for name in there}, "radius", "nm", more=theory,
        headline="salted_drop_radius_at_the_end" if settings.salted else "",
    )  # fmt: skip
    curves = Panel(
        "line", "Above its curve a drop grows", tuple(over), "radius", "relative humidity", "nm", "percent",
        note="Below it shrinks, as pure water does here." if settings.pure else "", headlines=("humidity_over_drops",),
        guides=(("y", 100.3, "clouds, with larger drops: 100.3 %"),), x_limits=(0.1, 2.7),
    )  # fmt: skip
    return grown, curves
