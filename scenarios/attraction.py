"""Attraction between molecules is enough to form a liquid.

Prescribed are only the size of a molecule of argon and its attraction to neighbours. A liquid, a vapour pressure,
latent heat and a surface are not. Two molecules that come within one and a half diameters gain the depth of a square
well as kinetic energy; to separate, they must give it back. In a dense, cold vapour that is enough: they gather in
drops, the drops merge, and the energy released warms the vapour.

Modelled: hard spheres with a square well of range 1.5, whose diameter and depth give it the critical point of argon (or
nitrogen, or methane). Left out: the soft repulsion and the long tail of real forces. So the substance is like argon:
its vapour pressure is a third too low at 105 K and a sixth at 142 K, its latent heat an eighth too large at 111 K and a
fifth at 142 K. It is not like water. The critical temperature of water is four times as high, mostly because of
hydrogen bonds, which this model does not have. But the vapour pressure of both liquids follows a law of the same form.

At the start of the default run there is several times as much vapour as is stable: it is cooled so suddenly that drops
form everywhere at once, and merge (a quench). In a vapour that is barely supersaturated the first drop forms far later.

With ``heating`` the thermostat around a drop becomes warmer, and the heat that it gives is counted: plotted against
the heat, the temperature rises slowly while the drop evaporates, and steeply when only vapour is left. Other defaults
then apply: 400 molecules, a drop at 85 K, density 0.1, 3 ns.
"""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import (
    HeatBath,
    Maxwell,
    Periodic,
    Placed,
    Ramp,
    RandomBath,
    RandomNumbers,
    Scattered,
    Specular,
    SquareWell,
    Start,
    Wall,
    lattice_positions,
)
from atmosbox.errors import Setting, SettingError
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT
from atmosbox.scene.instruments import Air, Clusters, Slab
from atmosbox.scene.knob import Knob
from atmosbox.scene.panels import Line, Panel, over_time
from atmosbox.scene.statistics import BlockAverage, block_average, overlapping_average
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN

if TYPE_CHECKING:
    import xarray as xr

title = "What makes a gas become a liquid?"
level = "second year"
minutes = 20
series = (Series("exact", "molecules", (200, 400, 800)),)
"""Runs worth comparing: only the exact engine has an attraction; with fewer molecules there are fewer clusters."""
FRAMES = 150
SETTLE = 50
BLOCKS = 20
RANGE = 1.5
RATE = 0.1
"""Rate at which the random bath draws a new velocity where a vapour condenses [1/time]: low, so that the gas warms."""
FAST_RATE = 0.5
"""The same rate where liquid and vapour are present from the start [1/time]."""
GRAVITY = 0.08
"""Gravity of a pool [depth / (mass diameter)]: the density of the vapour falls by 1/e over some twelve diameters."""
TALL = 4.0
"""Height of the box of a slab or a pool, in widths."""
HEATED = {"start": "drop", "molecules": 400, "density": 0.1, "temperature": 85.0, "duration": 3.0}
"""Defaults of a drop that is heated."""
EVAPORATING = 0.25, 0.75
"""Shares of the molecules in the vapour between which the drop is said to evaporate."""
GONE = 0.05
"""Share of the molecules in the largest drop below which only vapour is left."""
DROP = 0.1
"""Share of the molecules from which on the largest cluster is a drop, with its vapour around it."""
THIN = 0.03
"""Density [diameter^-3] up to which the pressure of a gas is compared with its first three virial coefficients."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(800, "1", "number of molecules that attract each other", low=50, high=20_000)
    temperature: float = setting(105.0, "K", "temperature of the thermostat and at the start", low=10.0, high=20_000.0)
    density: float = setting(0.26, "1", "density of these molecules / critical density", low=1e-4, high=2.3)
    attraction: float = setting(1.0, "1", "strength of the attraction; at 0 nothing condenses", low=0.0, high=1.0)
    start: str = setting("vapour", "", "state at the start", choices=("vapour", "slab", "drop", "pool"))
    bath: str = setting("random", "", "what keeps the temperature constant", choices=("random", "walls", "none"))
    air: float = setting(0.0, "1", "density of molecules without attraction / critical density", low=0.0, high=1.0)
    substance: str = setting(
        "argon",
        "",
        "substance that sets the size and attraction of the molecules",
        choices=("argon", "nitrogen", "methane"),
    )
    heating: float = setting(
        0.0, "K ns-1", "how fast the thermostat becomes warmer; 0 for a constant temperature", low=0.0, high=1000.0
    )
    duration: float = setting(1.6, "ns", "how long to watch", low=1e-4, high=1e4)

    def __init__(self, /, **values: Any) -> None:
        declared = {parameter.name: parameter for parameter in self.describe()}["heating"]
        heated = declared.parse(values.get("heating", declared.default))
        super().__init__(**(HEATED | values if heated else values))

    def check(self) -> None:
        """Refuse a liquid where there is none, a box too small for two surfaces, and heat without a thermostat."""
        if self.heating and (self.start != "drop" or self.bath != "random" or self.air):
            wanted: dict[str, str | float] = {"start": "drop", "bath": "random", "air": 0.0}
            name, only = next(pair for pair in wanted.items() if getattr(self, pair[0]) != pair[1])
            raise self.refusal(name, "is impossible with heating", Setting(name, only), " or ", Setting("heating", 0.0))
        warmth = _warmth(self)
        if self.start != "vapour" and not warmth < 0.97 * law.WELL_CRITICAL_TEMPERATURE:
            most = 0.97 * law.SIMPLE_FLUIDS[self.substance].critical_temperature * self.attraction
            problem = f"is too warm for a {self.start} of {self.substance} with this attraction"
            raise self.refusal("temperature", problem, ", or ", Setting("start", "vapour"), at_most=math.floor(most))
        sides, _ = _sides(self)
        if min(sides) < 2.2 * RANGE:
            problem = "make the periodic box so small that a molecule attracts its own image"
            raise self.refusal("molecules", problem, "give more of them, or ", Setting("start", "vapour"))
        held = math.prod(sides) * math.pi / 6.0 * law.WELL_CRITICAL_DENSITY * (self.density + self.air)
        if self.start == "vapour" and held > 0.45 * math.prod(sides):
            raise SettingError(
                "density", self.density + self.air, "with the air is too dense a mixture", "give less of either"
            )


def _scale(settings: Settings) -> Scale:
    fluid = law.SIMPLE_FLUIDS[settings.substance]
    return Scale(fluid.well_diameter, fluid.molecule_mass, fluid.well_depth)


def _warmth(settings: Settings) -> float:
    """Return T*, the temperature over the depth of the wells at the set strength of the attraction."""
    kT = _scale(settings).reduced_temperature(settings.temperature)
    return kT / settings.attraction if settings.attraction > 0.0 else math.inf


def _sides(settings: Settings) -> tuple[tuple[float, float, float], int]:
    """Return the sides of the box [diameter], and the number of molecules of air in it."""
    volume = settings.molecules / (settings.density * law.WELL_CRITICAL_DENSITY)
    air = round(settings.air * law.WELL_CRITICAL_DENSITY * volume)
    tall = TALL if settings.start in ("slab", "pool") else 1.0
    side = rounded((volume / tall) ** (1.0 / 3.0))
    return (side, side, tall * side), air


def _densities(warmth: float) -> tuple[float, float]:
    """Return approximate densities of liquid and vapour at the start [diameter^-3]; no measurement uses them."""
    below = max(1.0 - warmth / law.WELL_CRITICAL_TEMPERATURE, 0.0)
    vapour = 1.3 * float(law.well_vapor_pressure(warmth)) / warmth
    return rounded(law.WELL_CRITICAL_DENSITY + 0.57 * below**0.35), rounded(vapour)


def _liquid_density(settings: Settings) -> float:
    """Return the approximate density of the liquid of the drops [diameter^-3]."""
    return _densities(min(_warmth(settings), 1.2))[0]


def _sites(settings: Settings, rng: RandomNumbers) -> np.ndarray:
    """Return the positions of molecules that are partly liquid at the start, those that attract each other first."""
    sides, air = _sides(settings)
    n = settings.molecules
    around = (True, True, not _walled(settings))
    # lattice sites as dense as the liquid: it takes those nearest to its middle, vapour and air some of the others
    dense, thin = _densities(_warmth(settings))
    volume = math.prod(sides)
    sites = lattice_positions(sides, np.ones(int(dense * volume)), periodic=around)
    liquid = min(max((n - thin * volume) / (1.0 - thin / dense), 0.1 * n), n)
    if settings.start == "drop":
        away = np.linalg.norm(sites - 0.5 * np.array(sides), axis=1)
    else:
        away = np.abs(sites[:, 2] - (0.5 * sides[2] if settings.start == "slab" else 0.0))
    order = np.argsort(away + 1e-6 * rng.random(len(away)), kind="stable")
    inner, outer = order[: int(liquid)], order[int(1.1 * liquid) :]
    others = n - len(inner) + air
    if others > len(outer):
        raise settings.refusal("density", f"leaves no vapour beside a {settings.start}", "give less, or less air")
    shuffled = np.argsort(rng.random(len(outer)), kind="stable")
    return np.asarray(sites[np.concatenate([inner, outer[shuffled[:others]]])])


def _walled(settings: Settings) -> bool:
    return settings.start == "pool" or settings.bath == "walls"


def _course(settings: Settings) -> float | Ramp:
    """Return the temperature of the thermostat over the run [depth], constant or rising."""
    scale = _scale(settings)
    if not settings.heating:
        return scale.reduced_temperature(settings.temperature)
    last = settings.temperature + settings.heating * settings.duration
    first, last = (scale.reduced_temperature(kelvin) for kelvin in (settings.temperature, last))
    return Ramp(first, last, 0.0, settings.si.duration / scale.time)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the molecules in their box."""
    scale = _scale(settings)
    kT = scale.reduced_temperature(settings.temperature)
    sides, air = _sides(settings)
    n = settings.molecules
    # at random, or on lattice sites that are drawn before
    rng = None if settings.start == "vapour" else RandomNumbers(settings.seed)
    places = Scattered(numbered="at random") if rng is None else Placed(_sites(settings, rng))
    ends: Wall = Periodic()
    if _walled(settings):
        ends = HeatBath(kT) if settings.bath == "walls" else Specular()
    rate = RATE if settings.start == "vapour" else FAST_RATE
    parcel = engine.begin(
        Start(n + air, (places, Maxwell(kT))),
        rng=rng,
        length=sides,
        walls=(Periodic(),) * 4 + (ends, ends),
        gravity=GRAVITY if settings.start == "pool" else 0.0,
        well=SquareWell(RANGE, [[1.0, 0.0], [0.0, 0.0]]),
        species=np.repeat([0, 1], [n, air]),
        strength=settings.attraction,
        bath=RandomBath(_course(settings), rate) if settings.bath == "random" else None,
        seed=settings.seed,
    )
    slab = (Slab(n),) if settings.start in ("slab", "pool") else ()

    box: Any = parcel  # its strength and its random bath are those of attracting molecules alone

    def warm(kelvin: float) -> None:
        turn = box.set_bath_kT if settings.bath == "random" else box.set_wall_kT
        turn(scale.reduced_temperature(kelvin))

    weaker, help, now = "strength of the attraction", "temperature of the thermostat", settings.temperature
    knobs = [Knob("attraction", weaker, "1", 0.0, 1.0, settings.attraction, lambda share: box.set_strength(share))]
    if settings.bath != "none":
        knobs.append(Knob("temperature", help, "K", min(60.0, now), max(250.0, now), now, warm))
    fluid = law.SIMPLE_FLUIDS[settings.substance]
    warmth = _warmth(settings)
    cold = f"Below T* = 0.65 the stable state of this model is a crystal, and {warmth:.2f} is colder."
    facts = {
        "molecules": f"spheres of {scale.length * 1e9:.3f} nm, with a well of {fluid.name}: "
        f"k x {scale.temperature * settings.attraction:.1f} K deep, out to {RANGE:g} diameters",
        "reduced temperature": f"T* = {warmth:.3f}; the critical one is {law.WELL_CRITICAL_TEMPERATURE}",
        "box": " x ".join(f"{side * scale.length * 1e9:.1f}" for side in sides) + " nm, real size",
        "units": f"time {scale.time * 1e12:.2f} ps, pressure {round(scale.pressure / 1e2, -3):.0f} hPa",
        "not water": "the critical temperature of water is four times as high (hydrogen bonds are not modelled)",
    }
    duration, measured = settings.si.duration / scale.time, (Air(), Clusters(n, _liquid_density(settings)), *slab)
    return Setup(
        parcel, scale, duration, FRAMES, measured, samples=10 if slab else 4, settle=SETTLE, facts=facts,
        knobs=tuple(knobs), doubts=(cold,) if warmth < 0.65 else (),
    )  # fmt: skip


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the temperature of the thermostat, the saturation pressure, and the pressure of the vapour by B2, B3."""
    scale = _scale(settings)
    frames = dataset.sizes["elapsed_time"]
    found = {}
    if settings.bath != "none":
        found["air_temperature_theory"] = settings.temperature + settings.heating * dataset.elapsed_time.values
    if "normal_pressure" in dataset:
        saturated = float(law.well_vapor_pressure(_warmth(settings))) * settings.attraction * scale.pressure
        found["normal_pressure_theory"] = np.full(frames, saturated)
    elif not settings.air:
        # without a drop all molecules are the gas, also those that touch by chance
        drop = dataset.largest_drop_molecule_count.values >= DROP * settings.molecules
        whole = settings.density * law.WELL_CRITICAL_DENSITY
        density = np.where(drop, _densities_of_vapour(dataset, settings)[1], whole)
        pressure = _pressure_of_gas(density, dataset.air_temperature.values / scale.temperature, settings)
        # where the series is negative it is not valid: a vapour so cold and dense must condense
        found["virial_pressure_theory"] = np.where(pressure > 0.0, pressure, np.nan)
    # it is that of the settings, and ends where a knob is turned
    turns = json.loads(dataset.attrs.get("atmosbox_turns", "[]"))
    valid = np.arange(frames) < (turns[0]["frame"] if turns else frames)
    return {name: np.where(valid, values, np.nan) for name, values in found.items()}


def _units_of_slab(scale: Scale) -> dict[str, float]:
    """Return the measurements that most frames of a slab must have, with their units.

    A thin layer has no inside, and may have no vapour beside it.
    """
    return {
        "vapor_number_density": scale.number_density,
        "liquid_number_density": scale.number_density,
        "normal_pressure": scale.pressure,
        "vapor_well_energy": scale.energy,
        "liquid_well_energy": scale.energy,
        "surface_tension": scale.pressure * scale.length,
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the drop, the vapour, temperature and pressure, or the properties of a slab and its vapour."""
    if settings.heating:
        return _of_heating(dataset, settings)
    late = dataset.isel(elapsed_time=slice(SETTLE, None))
    if late.sizes["elapsed_time"] < 2 * BLOCKS:
        return ()
    if settings.start == "slab" and all(
        name in late and np.isfinite(late[name].values).mean() > 0.5 for name in _units_of_slab(_scale(settings))
    ):
        return *_of_slab(late, settings), _temperature(dataset, settings)
    vapour = _Vapour(dataset, settings)
    found = []
    for name, label, error in (
        ("largest_drop_molecule_count", "molecules in the largest drop", vapour.error_of_drop),
        ("vapor_molecule_count", "molecules of the vapour", vapour.error),
    ):
        found.append(Headline(f"last_{name}", float(dataset[name][-1]), error, None, 0.0, "", "1", "1", label))
    found.append(_temperature(dataset, settings))
    if settings.start != "pool":
        found.append(_gas_pressure(dataset, settings) if vapour.alone else vapour.pressure())
    return tuple(found)


def _temperature(dataset: "xr.Dataset", settings: Settings) -> Headline:
    r"""Return the mean temperature after the settling, beside that of the thermostat.

    Each molecule that the thermostat touches, M of them in all, gives it on average :math:`c (kT - kT_b)`, with c = 3/2
    for a velocity drawn at random and 2 for a hit on a wall, and the variance of that is 2 c (kT)^2. So the mean of T
    is :math:`T_b + Q / c k M`, with the heat Q that went to the thermostat, and a standard error of
    :math:`T \sqrt{2 / c M}`. Blocks of one run would make the error too small by half: a drop holds its heat for long.
    Without a thermostat no error is known: the temperature depends on the energy of the start.
    """
    scale = _scale(settings)
    time, kelvin = dataset.elapsed_time.values, float(dataset.air_temperature.values[SETTLE:].mean())
    if settings.bath == "none":
        return Headline("mean_temperature", kelvin, 0.0, None, 0.0, "", "K", "K", "temperature")
    _, air = _sides(settings)
    if settings.bath == "random":
        rate = RATE if settings.start == "vapour" else FAST_RATE
        each, touched = 1.5, (settings.molecules + air) * rate * (time[-1] - time[SETTLE - 1]) * 1e-9 / scale.time
        gained = dataset.heat_from_bath.values
    else:
        each, touched = 2.0, float(dataset.wall_hit_count[-1] - dataset.wall_hit_count[SETTLE - 1])
        gained = dataset.heat_from_wall.values.sum(axis=1)
    heat = abs(float(gained[-1] - gained[SETTLE - 1])) / BOLTZMANN
    touched = max(touched, 1.0)
    error = settings.temperature * math.sqrt(2.0 / (each * touched))
    mean, off = BlockAverage(np.asarray(kelvin), np.asarray(error)), heat / (each * touched)
    name, label, reason = "mean_temperature", "temperature", "heat still flows to the thermostat"
    return Headline.of_mean(name, label, mean, settings.temperature, "K", tolerance=off, reason=reason)


def _gas_energy(density: float, warmth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    r"""Return the energy of attraction of a molecule of a gas by B2 and B3 [depth], and the part that is due to B3.

    From the virial series of the pressure, :math:`u = -T^2 (B_2' \rho + B_3' \rho^2 / 2)` with derivatives in T.
    """
    step = 1e-4
    second, third = (
        (virial(warmth + step) - virial(warmth - step)) / (2.0 * step)
        for virial in (law.square_well_second_virial, law.square_well_third_virial)
    )
    triple = -0.5 * (warmth * density) ** 2 * third
    return -(warmth**2) * density * second + triple, triple


def _of_heating(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    r"""Return the heat capacity before the drop evaporates, the latent heat, and the heat capacity of the vapour.

    A heat capacity is the slope of the heat over the temperature of the thermostat. The energy of N molecules has the
    variance :math:`N (k T)^2 c` in equilibrium, with the heat capacity c of a molecule over k. In a vapour frames are
    independent of each other; beside a drop, which exchanges molecules slowly, the energies at both ends are taken to
    be off by their scatter. The latent heat is the slope of the energy of attraction over the number of molecules in
    the vapour while the drop evaporates, plus kT for the work of making room.
    """
    scale, n = _scale(settings), settings.molecules
    kT = (settings.temperature + settings.heating * dataset.elapsed_time.values) / scale.temperature
    heat = dataset.heat_from_bath.values / scale.energy / n
    share = dataset.vapor_molecule_count.values / n
    drop = np.flatnonzero(dataset.largest_drop_molecule_count.values >= GONE * n)
    first, last = (int(np.flatnonzero(np.append(share >= least, True))[0]) for least in EVAPORATING)
    gone = int(drop[-1]) + 1 if len(drop) else 0
    per_mole, each = scale.energy * AVOGADRO, BOLTZMANN * AVOGADRO
    found, molar = [], "J mol-1 K-1"

    def capacity(name: str, label: str, value: float, error: float, theory: float | None, tolerance: float) -> None:
        known = None if theory is None else theory * each
        reason, label = "further virial coefficients are left out" if tolerance else "", f"heat capacity {label}"
        sizes = value * each, error * each, known, tolerance * each
        found.append(Headline(name, *sizes, reason, molar, molar, label))

    def slope(x: np.ndarray, y: np.ndarray) -> float:
        away = x - x.mean()
        return float(away @ y) / float(away @ away)

    if first >= BLOCKS:
        value = slope(kT[:first], heat[:first])
        scatter = math.sqrt(2.0 * max(value, 1.5) / n) * kT[:first].mean()
        capacity("liquid_heat_capacity", "before the drop evaporates", value, scatter / np.ptp(kT[:first]), None, 0.0)
    if last - first >= BLOCKS:
        part = slice(first, last)
        pulled = dataset.attraction_energy.values[part] / scale.energy / n
        freed = share[part] - share[part].mean()
        value = slope(share[part], pulled)
        bent = np.polyval(np.polyfit(freed, pulled, 2), freed)  # of a smaller drop more is surface
        rest = block_average(pulled - bent, BLOCKS // 2)
        error = float(rest.standard_error) * math.sqrt(len(freed) / float(freed @ freed)) * per_mole
        value, label = (value + float(kT[part].mean())) * per_mole, "latent heat L of the drop"
        found.append(Headline("latent_heat", value, error, None, 0.0, "", "J mol-1", "kJ mol-1", label))
    if len(kT) - gone >= BLOCKS:
        warm = kT[gone:]
        value, away = slope(warm, heat[gone:]), warm - warm.mean()
        error = math.sqrt(max(value, 1.5) / n) * float(np.linalg.norm(away * warm)) / float(away @ away)
        density = settings.density * law.WELL_CRITICAL_DENSITY
        gas, triple = (settings.attraction * part for part in _gas_energy(density, warm / settings.attraction))
        known, unknown = slope(warm, 1.5 * warm + gas), slope(warm, triple)
        capacity("vapor_heat_capacity", "of the vapour", value, error, known, abs(unknown))
    return tuple(found)


def _gas_pressure(dataset: "xr.Dataset", settings: Settings) -> Headline:
    """Return the pressure of molecules that stay a gas, beside that by B2 and B3 where these are enough."""
    density, warmth, scale = settings.density * law.WELL_CRITICAL_DENSITY, _warmth(settings), _scale(settings)
    pressure, kelvin = (dataset[name].values[SETTLE:] for name in ("virial_pressure", "air_temperature"))
    # the pressure follows the temperature, whose error is known, and has fast noise of its own
    warmer = kelvin - kelvin.mean()
    slope = float(warmer @ pressure) / float(warmer @ warmer)
    quick = overlapping_average(pressure - slope * warmer, BLOCKS)
    error = np.hypot(slope * _temperature(dataset, settings).standard_error, quick.standard_error)
    theory, left_out = None, 0.0
    if settings.bath == "random" and not settings.air:
        factor = float(law.square_well_compressibility(density, min(warmth, 1e9)))
        # the next coefficient is some times larger than that of hard spheres, and is multiplied by the density cubed
        share = 4.0 * abs(float(law.square_well_third_virial(min(warmth, 1e9)))) * density**3
        if factor > 0.0 and (density <= THIN or not settings.attraction):
            theory = density * factor * scale.reduced_temperature(settings.temperature) * scale.pressure
            left_out = share * theory
    mean, reason = BlockAverage(quick.mean, error), "further virial coefficients are left out"
    return Headline.of_mean(
        "mean_virial_pressure", "pressure", mean, theory, "Pa", "hPa", tolerance=left_out, reason=reason
    )


def _pressure_of_gas(density: np.ndarray, kT: np.ndarray, settings: Settings) -> np.ndarray:
    """Return the pressure by B2 and B3 [Pa] of a gas of a density [diameter^-3] at a temperature [depth]."""
    factor = law.square_well_compressibility(density, kT / max(settings.attraction, 1e-9))
    return np.asarray(density * kT * factor * _scale(settings).pressure)


def _densities_of_vapour(dataset: "xr.Dataset", settings: Settings) -> list[np.ndarray]:
    """Return the least, the middle and the greatest density that the free vapour may have in each frame [diameter^-3].

    The surface of a drop is not sharp. The vapour may fill the box up to where a drop as dense as the liquid would end,
    or up to a range of the wells farther out, where a molecule counts as part of the drop: theory takes the middle, and
    half the difference is how far it may be off.
    """
    number, largest = dataset.vapor_molecule_count.values, dataset.largest_drop_molecule_count.values
    drops = dataset.drop_count.values
    others = np.maximum(drops - 1.0, 1.0)
    sizes = (largest, np.ones(len(drops))), ((settings.molecules - number - largest) / others, others)
    box, dense = math.prod(_sides(settings)[0]), _liquid_density(settings)
    held = [
        sum(
            many * (size > 0.0) * 4.0 / 3.0 * np.pi * (np.cbrt(0.75 * size / (np.pi * dense)) + out) ** 3
            for size, many in sizes
        )
        for out in (0.0, 0.5 * RANGE, RANGE)
    ]
    return [number / np.maximum(box - each, 0.1 * box) for each in held]


class _Vapour:
    """The free vapour around drops: its pressure by B2 and B3, and how much its number fluctuates."""

    def __init__(self, dataset: "xr.Dataset", settings: Settings) -> None:
        self.settings, self.scale = settings, _scale(settings)
        half = dataset.isel(elapsed_time=slice(dataset.sizes["elapsed_time"] // 2, None))
        self.measured = half.virial_pressure.values
        self.kT = half.air_temperature.values / self.scale.temperature
        number, largest = half.vapor_molecule_count.values, half.largest_drop_molecule_count.values
        self.alone = largest.mean() < DROP * settings.molecules
        self.density = _densities_of_vapour(half, settings)
        # the variance of the number of molecules of a gas that may leave it, from its compressibility
        density, depth = float(self.density[1][-1]), max(settings.attraction, 1e-9)
        second, third = (
            float(law.square_well_compressibility(step, self.kT.mean() / depth)) for step in (1e-6, density)
        )
        stiff = 1.0 + 2.0 * (second - 1.0) * 1e6 * density
        stiff += 3.0 * (third - 1.0 - (second - 1.0) * 1e6 * density)
        self.error = math.sqrt(float(number[-1]) / stiff) if stiff > 0.0 else 0.0
        self.error_of_drop = self.error if half.drop_count.values[-1] == 1.0 else 0.0
        if self.alone:  # where clusters are rare, their number in one frame has no error bar
            often = bool(largest.mean() > 1.0)
            self.error, self.error_of_drop = (float(each.std(ddof=1)) * often for each in (number, largest))

    def pressure(self) -> Headline:
        """Return the mean pressure, beside that of a gas as dense as the free vapour."""
        low, theory, high = (_pressure_of_gas(each, self.kT, self.settings) for each in self.density)
        apart = block_average(self.measured - theory, BLOCKS // 2)
        known = None if self.settings.air or not (np.asarray(theory) > 0.0).all() else float(np.mean(theory))
        off = 0.0 if known is None else 0.5 * abs(float(np.mean(high - low)))
        name, label, reason = "mean_virial_pressure", "pressure of the vapour", "the surface of a drop is not sharp"
        mean = BlockAverage(np.asarray(self.measured.mean()), apart.standard_error)
        return Headline.of_mean(name, label, mean, known, "Pa", "hPa", tolerance=off, reason=reason)


def _of_slab(late: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return densities, pressure, latent heat and surface tension of liquid and vapour in coexistence.

    The number of molecules in the vapour has the correlation time 4 V / A c, the mean time until a molecule hits the
    liquid, with the volume V of the vapour, its surfaces A and the mean speed c. Shorter blocks would make the errors
    too small.
    """
    scale, warmth = _scale(settings), _warmth(settings)
    kT = scale.reduced_temperature(settings.temperature)
    (_, _, height), _ = _sides(settings)
    dense, thin = (float(late[name].mean()) for name in ("liquid_number_density", "vapor_number_density"))
    mean = settings.density * law.WELL_CRITICAL_DENSITY * scale.number_density
    share = min(max((dense - mean) / (dense - thin), 0.0), 1.0)
    memory = 2.0 * share * height / math.sqrt(8.0 * kT / math.pi)
    frame = float(late.elapsed_time[1] - late.elapsed_time[0]) * 1e-9 / scale.time
    series = np.array([late[name].values / unit for name, unit in _units_of_slab(scale).items()])
    series = np.where(np.isfinite(series), series, np.nanmean(series, axis=1, keepdims=True))
    means = series.mean(axis=1)

    def of(function: Callable[..., float]) -> tuple[float, float]:
        """Return a function of the means, and its standard error to first order."""
        value, steps = function(*means), 1e-6 * np.maximum(np.abs(means), 1e-3)
        slopes = [(function(*(means + step)) - value) / step.sum() for step in np.diag(steps)]
        linear = slopes @ (series - means[:, None])
        return value, float(block_average(linear, BLOCKS, memory / frame).standard_error)

    def latent(vapour: float, liquid: float, pressure: float, above: float, below: float, _: float) -> float:
        return above - below + pressure * (1.0 / vapour - 1.0 / liquid)

    def slope(vapour: float, liquid: float, pressure: float, *others: float) -> float:
        volume = 1.0 / vapour - 1.0 / liquid
        return latent(vapour, liquid, pressure, *others) * kT / (pressure * volume)

    published = float(law.well_vapor_pressure(warmth)) * settings.attraction
    steep, depth = 7.1939 * settings.attraction, scale.energy / BOLTZMANN
    pressure, mole, tension = scale.pressure, scale.energy * AVOGADRO, scale.pressure * scale.length
    rows = (
        ("liquid_density", lambda *means: means[1], None, scale.mass_density, "kg m-3", "kg m-3", "liquid"),
        ("vapor_density", lambda *means: means[0], None, scale.mass_density, "kg m-3", "kg m-3", "vapour"),
        ("vapor_pressure", lambda *means: means[2], published, pressure, "Pa", "hPa", "vapour pressure"),
        ("latent_heat", latent, None, mole, "J mol-1", "kJ mol-1", "latent heat L"),
        ("clapeyron_slope", slope, steep, depth, "K", "K", "L/RΔZ, the slope of ln p against −1/T"),
        ("mean_surface_tension", lambda *means: means[5], None, tension, "N m-1", "mN m-1", "surface tension"),
    )
    found, line = [], "published simulations are a line through all temperatures"
    for name, function, answer, unit, si, shown, label in rows:
        (value, error), expected = of(function), None if answer is None else answer * unit
        allowed, reason = (0.0, "") if expected is None else (0.05 * expected, line)
        found.append(Headline(name, value * unit, error * unit, expected, allowed, reason, si, shown, label))
    return tuple(found)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of the drop, the energy, the temperature and the pressure; for a slab its profile."""
    start, bath = settings.start, settings.bath
    grown = over_time(
        "A drop forms in the vapour" if start == "vapour" else "Drop and vapour",
        {"largest_drop_molecule_count": "largest drop", "vapor_molecule_count": "free vapour"},
        f"molecules of {settings.substance}",
    )
    stores = {"kinetic_energy": "kinetic", "attraction_energy": "of attraction", "molecular_energy": "both"}
    energies = over_time(
        "Energy from attraction becomes motion" if bath == "none" else "Energy from attraction goes to the thermostat",
        stores | ({"heat_from_bath": "from the thermostat"} if bath == "random" else {}),
        "energy",
        "zJ",
    )
    if settings.heating:
        title = "Heat first warms the drop, then evaporates it"
        line = Line("heat_from_bath", "air_temperature", "molecules")
        axes: dict[str, Any] = {"x_unit": "zJ", "y_label": "temperature", "y_unit": "K", "averages": 50}
        numbers = "latent_heat", "vapor_heat_capacity"
        heated = Panel("line", title, (line,), "heat supplied", headlines=numbers, **axes)
        return heated, grown, replace(energies, title="Heat separates the molecules")
    warming = "Condensation releases heat" if bath == "none" else "At first condensation warms the gas"
    warm = over_time(
        warming if start == "vapour" else "Temperature", {"air_temperature": "molecules"}, "temperature", "K",
        start=settings.temperature if start == "vapour" else None, theory="thermostat" if bath != "none" else "",
        headline="mean_temperature",
    )  # fmt: skip
    if start in ("slab", "pool"):
        title = "Liquid beside its vapour" if start == "slab" else "A pool, and vapour that thins out"
        line = Line("number_density", "height", "molecules", error="number_density_se")
        numbers = "liquid_density", "vapor_density"
        axes = {"x_unit": "nm-3", "y_unit": "nm", "x_scale": "log", "headlines": numbers if start == "slab" else ()}
        profile = Panel("profile", title, (line,), "molecules per volume", **axes)
        pressure = over_time(
            "Its vapour pressure, which was not prescribed", {"normal_pressure": "across the surface"}, "pressure",
            unit="hPa", theory="published simulations", parts=30, headline="vapor_pressure",
        )  # fmt: skip
        return (profile, pressure, warm) if start == "slab" else (profile, grown, energies, warm)
    pressure = over_time(
        "A drop adds hardly any pressure", {"virial_pressure": "molecules"}, "pressure", "hPa",
        theory="" if settings.air else "theory of the free vapour", parts=50, headline="mean_virial_pressure",
    )  # fmt: skip
    return (grown, energies, warm) if bath == "none" else (warm, pressure, grown)
