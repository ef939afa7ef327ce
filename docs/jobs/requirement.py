"""What the scenes leave out, and how little it would change what they show."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from jobs.registry import Findings, job, rounded
from scipy import constants, integrate

from atmosbox import theory
from atmosbox.scene.units import Scale
from atmosbox.simulation import runner
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN, DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY

EARTH = 6.356766e6
"""Radius of the earth by which gravity falls off in the standard atmosphere, ISO 2533:1975 [m]."""
SHARES = {
    "N2": (0.78084, 28.0134e-3),
    "O2": (0.209476, 31.9988e-3),
    "Ar": (0.00934, 39.948e-3),
    "CO2": (0.000314, 44.00995e-3),
}
"""Volume share [1] and molar mass [kg mol-1] of the gases of dry air, ISO 2533:1975."""
VIBRATION = {"N2": 235857.0 - 2.0 * 1432.4, "O2": 158019.3 - 2.0 * 1198.1}
"""Wave number of the first quantum of vibration [m-1]: Huber and Herzberg 1979, omega_e - 2 omega_e x_e."""
ROTATION = {"N2": 199.824, "O2": 144.563}
"""Rotational constant B_e [m-1]: Huber and Herzberg 1979."""
RELAXATION = {"N2": 4.0, "O2": 3.8}
"""Collisions in which rotation comes to equilibrium at 298 K: Kee et al. 1986, the transport data of CHEMKIN."""
HEAD = ["left out or simplified", "the number", "so that"]


def attraction(temperature: float) -> tuple[float, float, float]:
    """Return the second virial coefficient of dry air [m3 mol-1], and its first and second derivative.

    Hyland and Wexler 1983, equation 10: with what molecules attract each other, and not only with their size.
    """
    terms = np.polynomial.Polynomial([34.9568e-6, -6687.72e-6, -2.10141, 92.4746])
    x = 1.0 / temperature
    first, second = float(terms.deriv()(x)), float(terms.deriv(2)(x))
    return float(terms(x)), -(x**2) * first, x**4 * second + 2.0 * x**3 * first


def size(diameter: float) -> float:
    """Return the second virial coefficient of hard spheres [m3 mol-1]."""
    return 2.0 * math.pi / 3.0 * diameter**3 * AVOGADRO


def wave(temperature: float) -> float:
    """Return the thermal de Broglie wavelength of a molecule of air [m]."""
    return constants.Planck / math.sqrt(2.0 * math.pi * DRY_AIR.molecule_mass * BOLTZMANN * temperature)


def trembling(temperature: float) -> float:
    """Return what vibration adds to the heat capacity of a molecule of air, in k: Einstein's formula."""
    quanta = {name: constants.Planck * constants.c * each / BOLTZMANN for name, each in VIBRATION.items()}
    ratio = {name: quantum / temperature for name, quantum in quanta.items()}
    return sum(SHARES[name][0] * (x / (2.0 * math.sinh(0.5 * x))) ** 2 for name, x in ratio.items())


def arrival(start: float, bottom: float, top: float, slope: Callable[[float, float], float]) -> float:
    """Return the temperature [K] to which d ln T / d ln p leads from one pressure to another [Pa]."""
    path = integrate.solve_ivp(
        lambda ln_p, ln_t: [slope(math.exp(ln_t[0]), math.exp(ln_p))],
        (math.log(bottom), math.log(top)),
        [math.log(start)],
        rtol=1e-12,
        atol=1e-12,
    )
    return math.exp(float(path.y[0, -1]))


def set_up(scene: str, **settings: Any) -> tuple[Any, Any, Any]:
    """Return the module of a scene, its settings and its set-up."""
    prepared = runner.prepare(scene, settings)
    return prepared.module, prepared.settings, prepared.module.build(prepared.settings)


def nm(length: float, figures: int = 3) -> str:
    """Return a length in nanometres."""
    return f"{rounded(length * 1e9, figures)} nm"


def density(temperature: float, pressure: float) -> float:
    """Return the number density of an ideal gas [m-3]."""
    return pressure / (BOLTZMANN * temperature)


@job("requirement-temperature", quick=True)
def warm_box(found: Findings) -> None:
    """Weigh what the two scenes of temperature leave out."""
    _, settings, small = set_up("temperature")
    _, _, large = set_up("temperature-large")
    t, p = settings.si.temperature, settings.si.pressure
    mass, sigma = DRY_AIR.molecule_mass, DRY_AIR.diameter
    n = density(t, p)
    boxes = [float(each.parcel.length[2]) * each.scale.length for each in (small, large)]
    fall = [mass * STANDARD_GRAVITY * side for side in boxes]
    path = float(theory.mean_free_path(n, sigma))
    real, ours = attraction(t)[0] * p / (GAS_CONSTANT * t), size(sigma) * p / (GAS_CONSTANT * t)
    total = sum(share for share, _ in SHARES.values())
    mixed = sum(s * math.sqrt(DRY_AIR.molar_mass / molar) for s, molar in SHARES.values()) / total - 1.0
    both = " and ".join
    found.number("gravity", f"{rounded(2.0 * fall[1] / (3.0 * BOLTZMANN))} K")
    found.table(
        HEAD,
        [
            ["gravity", f"$mgL/kT$ = {both(rounded(each / (BOLTZMANN * t)) for each in fall)} in boxes of "
             f"{both(nm(side) for side in boxes)}",
             f"a molecule that falls from ceiling to floor gains "
             f"{both(rounded(2.0 * each / (3.0 * BOLTZMANN)) for each in fall)} K; the temperature of the gas is the "
             "same at all heights"],
            ["rotation", "velocities and rotations are independent in equilibrium: 0",
             "Maxwell's curve, the pressure and the collision rate stay as they are; only the energy of the gas would "
             "be 5/3 of it"],
            ["attraction", f"$Bn$ = {rounded(real)} (air), {rounded(ours)} (our spheres), at {p / 100.0:.0f} hPa",
             f"at one density and temperature real air presses {rounded(100.0 * (ours - real))} % less than ours"],
            ["air is a mixture", f"mean speed of its gases over that of their mean mass: {1.0 + mixed:.4f}",
             f"the mean speed is {rounded(100.0 * mixed)} % too low"],
            ["quantum mechanics", f"wavelength {nm(wave(t))}; diameter {nm(sigma)}, distance {nm(n ** (-1 / 3))}",
             f"$n\\Lambda^3$ = {rounded(n * wave(t) ** 3)}: it matters for two molecules only while they touch"],
            ["walls of molecules", f"Knudsen number {both(rounded(path / side) for side in boxes)}",
             "a molecule meets more walls than molecules, and what a wall sends back decides; a heat bath sends what "
             "a gas of its temperature would, which is exact in equilibrium"],
            ["more molecules",
             f"noise {both(f'{theory.temperature_noise(each.parcel.number, 3, t):.2g} K' for each in (small, large))}",
             "true of that many real molecules: nothing is scaled, each stands for itself"],
        ],
    )  # fmt: skip


@job("requirement-atmosphere", quick=True)
def column(found: Findings) -> None:
    """Weigh what the column leaves out."""
    module, settings, _ = set_up("atmosphere")
    si = settings.si
    air = module.Column(settings)
    h = air.scale_height
    top = si.height
    held = float(theory.column_mean_height(air.height, 1.0, 1.0, 1.0)) * h
    lower = (EARTH / (EARTH + top)) ** 2 - 1.0
    edges = np.linspace(0.0, air.height, 401)
    thick = np.diff(edges)

    def mean_height(diameter: float) -> float:
        share = air.density(edges, 1.0, diameter) * thick
        return float(np.sum(share * 0.5 * (edges[1:] + edges[:-1])) / np.sum(share))

    floor = float(air.density(edges, 1.0, air.diameter).max())
    crowd = float(theory.compressibility_factor(theory.packing_fraction(floor, air.diameter))) - 1.0
    higher = mean_height(air.diameter) / mean_height(0.0) - 1.0
    real_n = density(si.temperature, si.surface_pressure)
    real_path = float(theory.mean_free_path(real_n, DRY_AIR.diameter))
    heights = {name: h * DRY_AIR.molar_mass / molar for name, (_, molar) in SHARES.items()}
    at = 10_000.0
    isothermal = float(
        theory.barometric_pressure(
            at, si.surface_pressure, BOLTZMANN * si.temperature, DRY_AIR.molecule_mass, si.gravity
        )
    )
    standard = float(theory.isa_pressure(at))
    found.table(
        HEAD,
        [
            ["gravity falls with height", f"{rounded(100.0 * lower)} % at {top / 1000.0:g} km, "
             f"{rounded(-200.0 * held / EARTH)} % at the mean height",
             f"the air weighs {rounded(200.0 * held / EARTH)} % too much"],
            ["air above the ceiling", f"$e^{{-h/H}}$ = {rounded(100.0 * math.exp(-air.height))} %",
             f"the ceiling pushes back with the {rounded(si.surface_pressure * math.exp(-air.height) / 100.0)} hPa "
             "that it would weigh"],
            ["true size of molecules", f"mean free path {rounded(settings.knudsen)} H, in air "
             f"{rounded(real_path / h)} H", "in equilibrium the profile of points does not depend on how often they "
             "meet: 0"],
            ["the excluded volume of wide molecules", f"$Z - 1$ = {rounded(crowd)} at the floor",
             f"on `exact` the mean height is {rounded(100.0 * higher)} % larger, which the theory beside it counts; on "
             "`dsmc`, on which so many molecules run, they exclude none"],
            ["real molecules per simulated one", f"{rounded(air.scale.weight)}",
             "pressure, density and energy are multiplied by it, speeds and temperatures are not; what does not "
             f"scale is chance: the temperature of the column scatters by "
             f"{rounded(100.0 * math.sqrt(2.0 / (3.0 * settings.molecules)))} %, as that of {settings.molecules} "
             "molecules does"],
            ["rotation", "0", "the Boltzmann factor of height is that of $mgz$ alone"],
            ["air is a mixture", f"H of N₂ {heights['N2'] / 1000.0:.2f} km, of O₂ {heights['O2'] / 1000.0:.2f} km, of "
             f"their mean {h / 1000.0:.2f} km", "at rest they would part; wind stirs the real atmosphere up to 100 km, "
             "and its mean mass is that of the scene"],
            ["sunshine, radiation, wind", f"{isothermal / 100.0:.0f} hPa at 10 km, in the standard atmosphere "
             f"{standard / 100.0:.0f} hPa",
             f"the real profile is not this one: the scene is {rounded(100.0 * (isothermal / standard - 1.0))} % off, "
             "and shows the law of an atmosphere at rest"],
        ],
    )  # fmt: skip


@job("requirement-discs", quick=True)
def table_of_pucks(found: Findings) -> None:
    """Weigh what the table with pucks leaves out."""
    _, settings, setup = set_up("elastic-collisions")
    discs = setup.parcel
    discs.advance(setup.duration)
    met = 2.0 * discs.contacts / discs.number
    restitution = 0.95
    left = math.exp(-0.5 * (1.0 - restitution**2) * met)
    needed = math.sqrt(1.0 + 2.0 * math.log(0.99) / met)
    found.table(
        HEAD,
        [
            ["loss at a collision", f"{met:.0f} collisions of a disc in a run; with a restitution of {restitution} "
             f"{rounded(100.0 * left)} % of the energy would be left",
             f"real pucks stop; to lose no more than 1 % they would need a restitution of {needed:.5f}. The scene "
             "shows the law that is exact for molecules, not pucks"],
            ["the third dimension", "0: all centres and velocities lie in one plane, and contacts leave them there",
             "the energy of a disc is $kT$ on average, of a sphere $\\frac32 kT$; that it is the same for all masses "
             "holds in both"],
            ["spin and friction", "0: the impulse is along the line of centres, and turns no smooth disc",
             "all energy is kinetic energy of translation"],
            ["more discs", f"noise {rounded(100.0 / math.sqrt(discs.number + 1.0))} % of the mean energy of one half",
             "the curves are means since the start, which come to rest"],
            ["relativity", f"$(v/c)^2$ = {rounded((settings.si.speed / constants.c) ** 2)}",
             "Newton's mechanics is exact here"],
        ],
    )  # fmt: skip


def spheres_arrive(diameter: float, start: float, bottom: float, top: float, freedom: int) -> float:
    """Return how far from points spheres arrive that are lifted without end slowly [K]."""
    scale = Scale(diameter, DRY_AIR.molecule_mass, BOLTZMANN * start)
    thin = np.geomspace(0.1 * top, 1.2 * bottom, 4000) / scale.pressure
    ground = float(np.interp(bottom / scale.pressure, theory.gas_pressure(thin, 1.0, 1.0), thin))
    falling = np.geomspace(0.1 * ground, ground, 4000)
    filled = theory.packing_fraction(falling, 1.0)
    temperature = theory.hard_sphere_isentrope(filled, filled[-1], freedom)
    pressure = theory.gas_pressure(falling, temperature, 1.0) * scale.pressure
    arrived = start * float(np.interp(top, pressure, temperature))
    return arrived - float(theory.dry_adiabat_temperature(top, start, bottom, freedom))


@job("requirement-lifting", quick=True)
def rising_parcel(found: Findings) -> None:
    """Weigh what the rising parcel leaves out."""
    scene, settings, setup = set_up("lifting-dry")
    si = settings.si
    start, bottom, top, sigma = si.temperature, si.pressure, si.top_pressure, si.diameter
    end = float(theory.dry_adiabat_temperature(top, start, bottom, 5))
    grown = (bottom / top) ** (5.0 / 7.0)
    low = float(setup.parcel.length[2]) * setup.scale.length
    high = low * grown
    mass, scale = DRY_AIR.molecule_mass, setup.scale
    seconds = setup.duration * scale.time
    climbed = float(theory.height_of_pressure(top, start, bottom, si.lapse_rate))
    free = {width: mean_free(start, bottom, width) for width in (sigma, DRY_AIR.diameter)}
    ascent = scene._ascent(settings)
    hurry = end * ascent.finite_speed(top)
    # in an hour the order that counts is the first
    hour = end * replace(ascent, length=1e6, height=0.0).finite_speed(top) * 1e6 / (3600.0 / free[DRY_AIR.diameter][1])
    sound = math.sqrt(float(theory.adiabatic_index(5)) * BOLTZMANN * end / mass)
    piston = (high - low) / seconds
    room = {width: spheres_arrive(width, start, bottom, top, 5) for width in (sigma, DRY_AIR.diameter)}
    spheres, real = (b * bottom / (GAS_CONSTANT * start) for b in (size(sigma), attraction(start)[0]))

    def attracting(t: float, p: float) -> float:
        _, slope, curve = attraction(t)
        return (1.0 + p * slope / GAS_CONSTANT) / (3.5 - t * curve * p / GAS_CONSTANT)

    attracted = arrival(start, bottom, top, attracting) - end
    vibrating = arrival(start, bottom, top, lambda t, p: 1.0 / (3.5 + trembling(t))) - end
    quantum = constants.Planck * constants.c * ROTATION["N2"] / BOLTZMANN
    slow = sum(SHARES[name][0] * each for name, each in RELAXATION.items()) / sum(SHARES[n][0] for n in RELAXATION)
    delayed = hurry * (1.0 - 5.0 / 3.0 / theory.DISSIPATION) * (slow - 1.0)
    stiff = float(theory.dry_adiabat_temperature(top, start, bottom, 3)) - end
    found.number("gravity", f"{rounded(mass * STANDARD_GRAVITY * high / (5.0 * BOLTZMANN))} K")
    found.number("hurry", f"{rounded(hurry)} K")
    found.table(
        HEAD,
        [
            ["gravity inside the parcel", f"$mgh/kT$ = {rounded(mass * STANDARD_GRAVITY * high / (BOLTZMANN * end))} "
             f"over {nm(high, 2)}",
             f"to lift all molecules by half of it would cool them by "
             f"{rounded(mass * STANDARD_GRAVITY * high / (5.0 * BOLTZMANN))} K"],
            ["rotation is **not** left out", f"{rounded(stiff)} K at {top / 100.0:.0f} hPa without it",
             "without it the adiabat would be that of argon"],
            ["quanta of rotation", f"$kT/hcB$ = {rounded(end / quantum, 3)} (N₂)",
             f"its heat capacity is off by {rounded((quantum / end) ** 2 / 45.0)} k, and may be classical"],
            ["vibration", f"{rounded(trembling(start))} k at the ground, {rounded(trembling(end))} k at the top",
             f"at {top / 100.0:.0f} hPa air is {rounded(vibrating)} K warmer with it"],
            ["attraction", f"$Bn$ = {rounded(real)} in air, {rounded(spheres)} with our spheres",
             f"the attraction moves the adiabat of air by {rounded(attracted)} K"],
            ["true size of molecules", f"{sigma * 1e9:g} nm, and not {DRY_AIR.diameter * 1e9:.2g} nm: "
             f"{rounded((sigma / DRY_AIR.diameter) ** 2)} times as many contacts",
             f"their excluded volume moves the adiabat by {rounded(room[sigma])} K (with the true size by "
             f"{rounded(room[DRY_AIR.diameter])} K), since a constant $B$ drops out in first order"],
            ["an hour for the ascent", f"{rounded(seconds * 1e9)} ns, {settings.ascent:.0f} mean free times; in an "
             f"hour {rounded(3600.0 / free[DRY_AIR.diameter][1])}",
             f"the parcel arrives {rounded(hurry)} K too warm, a real one {rounded(hour)} K"],
            ["a piston without sound", f"{rounded(piston)} m/s for {climbed / 1000.0:.1f} km, "
             f"{rounded(piston / sound)} of the speed of sound", "pressure and temperature are alike in the whole box"],
            ["rotation exchanges slowly", f"after {rounded(slow)} collisions in air, at each contact here",
             f"in so fast an ascent the parcel would end another {rounded(delayed)} K warmer, in an hour none"],
            ["walls close by", f"Knudsen number {rounded(free[sigma][0] / low)}",
             "smooth walls take no heat and no momentum along them, so that it does not matter"],
            ["quantum mechanics", f"wavelength {nm(wave(end))} at the top; $n\\Lambda^3$ = "
             f"{rounded(density(end, top) * wave(end) ** 3)}", "the molecules are billiard balls"],
        ],
    )  # fmt: skip


def mean_free(temperature: float, pressure: float, diameter: float) -> tuple[float, float]:
    """Return the mean free path [m] and time [s] of molecules of air that were so wide."""
    n, kT = density(temperature, pressure), BOLTZMANN * temperature
    path = theory.mean_free_path(n, diameter)
    return float(path), float(theory.mean_free_time(n, diameter, kT, DRY_AIR.molecule_mass))
