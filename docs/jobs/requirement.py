"""What the scenes leave out, and by how much it would change what they show.

One table for each group of scenes, from the settings with which they start. Rows whose number would be zero, or too
small for anybody to measure, are left out.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from jobs.registry import Findings, job, rounded
from scipy import constants, integrate

from atmosbox import theory
from atmosbox.scene.ascent.drawn_parcels import drift, planned_cloud
from atmosbox.scene.units import Scale
from atmosbox.simulation import runner
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN, DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY, WATER

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
RELAXATION = {"N2": 4.0, "O2": 3.8}
"""Collisions in which rotation comes to equilibrium at 298 K: Kee et al. 1986, the transport data of CHEMKIN."""
DIFFUSIVITY = 2.11e-5
"""Of vapour in air at 0 degC and 1013.25 hPa [m2 s-1]: Hall and Pruppacher 1976."""
DROPLET, CONCENTRATION = 10e-6, 200e6
"""Radius of a droplet of a young cloud [m], and droplets in a cubic metre of it [m-3]."""


def attraction(temperature: float) -> tuple[float, float, float]:
    """Return the second virial coefficient of dry air [m3 mol-1], and its first and second derivative.

    Hyland and Wexler 1983, equation 10: with the attraction of molecules, and not only with their size.
    """
    terms = np.polynomial.Polynomial([34.9568e-6, -6687.72e-6, -2.10141, 92.4746])
    x = 1.0 / temperature
    first, second = float(terms.deriv()(x)), float(terms.deriv(2)(x))
    return float(terms(x)), -(x**2) * first, x**4 * second + 2.0 * x**3 * first


def vibration(temperature: float) -> float:
    """Return what vibration adds to the heat capacity of a molecule of air, in k: Einstein's formula."""
    quantum = constants.Planck * constants.c / BOLTZMANN
    ratio = {name: quantum * each / temperature for name, each in VIBRATION.items()}
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


def set_up(scene: str) -> tuple[Any, Any, Any]:
    """Return the module of a scene, its settings and its set-up."""
    prepared = runner.prepare(scene, {})
    return prepared.module, prepared.settings, prepared.module.build(prepared.settings)


def temperature() -> list[list[str]]:
    """Return what the two scenes of temperature leave out."""
    _, settings, _ = set_up("temperature-large")
    t, p = settings.si.temperature, settings.si.pressure
    spheres = 2.0 * math.pi / 3.0 * DRY_AIR.diameter**3 * AVOGADRO
    off = (spheres - attraction(t)[0]) * p / (GAS_CONSTANT * t)
    total = sum(share for share, _ in SHARES.values())
    mixed = sum(s * math.sqrt(DRY_AIR.molar_mass / molar) for s, molar in SHARES.values()) / total - 1.0
    return [
        [
            "attraction",
            f"the pressure of real air is {rounded(100.0 * off)} % below that of spheres of the same density and "
            "temperature",
        ],
        [
            "air is a mixture",
            f"its mean speed is {rounded(100.0 * mixed)} % higher than that of molecules of its mean mass",
        ],
    ]


def atmosphere() -> list[list[str]]:
    """Return what the column leaves out."""
    module, settings, _ = set_up("atmosphere")
    si, air = settings.si, module.Column(settings)
    held = float(theory.column_mean_height(air.height, 1.0, 1.0, 1.0)) * air.scale_height
    at = 10_000.0
    kT = BOLTZMANN * si.temperature
    isothermal = float(theory.barometric_pressure(at, si.surface_pressure, kT, DRY_AIR.molecule_mass, si.gravity))
    standard = float(theory.isa_pressure(at))
    own = {name: air.scale_height * DRY_AIR.molar_mass / molar / 1000.0 for name, (_, molar) in SHARES.items()}
    return [
        ["sunshine, radiation, wind", f"the pressure at 10 km is {isothermal / 100.0:.0f} hPa, in the standard "
         f"atmosphere {standard / 100.0:.0f} hPa: {rounded(100.0 * (isothermal / standard - 1.0))} % too much"],
        ["air above the ceiling", f"the ceiling replaces it: it pushes back with "
         f"{rounded(si.surface_pressure * math.exp(-air.height) / 100.0)} hPa, the weight of this air"],
        ["gravity falls with height", f"the air weighs {rounded(200.0 * held / EARTH)} % too much"],
        ["air is a mixture", f"at rest N₂ would have a scale height of {own['N2']:.2f} km and O₂ of {own['O2']:.2f} "
         "km; wind mixes the real atmosphere up to about 100 km"],
    ]  # fmt: skip


def discs() -> list[list[str]]:
    """Return what the table with pucks leaves out."""
    _, _, setup = set_up("elastic-collisions")
    parcel = setup.parcel
    parcel.advance(setup.duration)
    met = 2.0 * parcel.contacts / parcel.number
    restitution = 0.95
    left = math.exp(-0.5 * (1.0 - restitution**2) * met)
    return [
        ["loss at a collision", f"with a coefficient of restitution of {restitution}, {rounded(100.0 * left)} % of the "
         f"energy would be left after the {met:.0f} collisions of a disc in a run: the law shown is that of molecules, "
         "not of pucks"]
    ]  # fmt: skip


def spheres_arrive(diameter: float, start: float, bottom: float, top: float, freedom: int) -> float:
    """Return how far from points spheres arrive that are lifted infinitely slowly [K]."""
    scale = Scale(diameter, DRY_AIR.molecule_mass, BOLTZMANN * start)
    thin = np.geomspace(0.1 * top, 1.2 * bottom, 4000) / scale.pressure
    ground = float(np.interp(bottom / scale.pressure, theory.gas_pressure(thin, 1.0, 1.0), thin))
    falling = np.geomspace(0.1 * ground, ground, 4000)
    filled = theory.packing_fraction(falling, 1.0)
    temperature = theory.hard_sphere_isentrope(filled, filled[-1], freedom)
    pressure = theory.gas_pressure(falling, temperature, 1.0) * scale.pressure
    arrived = start * float(np.interp(top, pressure, temperature))
    return arrived - float(theory.dry_adiabat_temperature(top, start, bottom, freedom))


def lifting() -> list[list[str]]:
    """Return what the rising parcel of dry air leaves out."""
    scene, settings, setup = set_up("lifting-dry")
    si = settings.si
    start, bottom, top = si.temperature, si.pressure, si.top_pressure
    end = float(theory.dry_adiabat_temperature(top, start, bottom, 5))
    ascent = scene._ascent(settings)
    hurry = end * ascent.finite_speed(top)
    n, kT = bottom / (BOLTZMANN * start), BOLTZMANN * start
    free = float(theory.mean_free_time(n, DRY_AIR.diameter, kT, DRY_AIR.molecule_mass))
    # in an hour the order that counts is the first
    hour = end * replace(ascent, length=1e6, height=0.0).finite_speed(top) * 1e6 / (3600.0 / free)

    def attracting(t: float, p: float) -> float:
        _, slope, curve = attraction(t)
        return (1.0 + p * slope / GAS_CONSTANT) / (3.5 - t * curve * p / GAS_CONSTANT)

    attracted = arrival(start, bottom, top, attracting) - end
    vibrating = arrival(start, bottom, top, lambda t, p: 1.0 / (3.5 + vibration(t))) - end
    slow = sum(SHARES[name][0] * each for name, each in RELAXATION.items()) / sum(SHARES[n][0] for n in RELAXATION)
    delayed = hurry * (1.0 - 5.0 / 3.0 / theory.DISSIPATION) * (slow - 1.0)
    return [
        ["an ascent of an hour; here it takes nanoseconds",
         f"after {rounded(setup.duration * setup.scale.time * 1e9)} ns the parcel is "
         f"{rounded(hurry)} K too warm, after an hour, with molecules of the true size, {rounded(hour)} K"],
        ["vibration", f"it would make air {rounded(vibrating)} K warmer at {top / 100.0:.0f} hPa"],
        ["attraction", f"it moves the adiabat of air by {rounded(attracted)} K"],
        ["the true size of molecules", f"as simulated, their excluded volume moves the adiabat by "
         f"{rounded(spheres_arrive(si.diameter, start, bottom, top, 5))} K, with the true size by "
         f"{rounded(spheres_arrive(DRY_AIR.diameter, start, bottom, top, 5))} K"],
        ["rotation exchanges energy slowly", f"in air it takes {rounded(slow)} collisions, here one; this would add "
         f"{rounded(delayed)} K in so fast an ascent, nothing in an hour"],
    ]  # fmt: skip


def fusion(temperature: float) -> float:
    """Return the latent heat of freezing of supercooled water [J kg-1]: Murphy and Koop 2005, equations 5 and 9."""
    t = temperature
    ice = 46782.5 + 35.8925 * t - 0.07414 * t**2 + 541.5 * math.exp(-((t / 123.75) ** 2))
    liquid = 56579.0 - 42.212 * t + math.exp(0.1149 * (281.6 - t))
    return (ice - liquid) / WATER.molar_mass


def moist() -> list[list[str]]:
    """Return what the rising cloud leaves out."""
    module, settings, _ = set_up("lifting-moist")
    ascent = module._ascent(settings)
    top, base = ascent.top_pressure, ascent.base
    path = ascent.planned_at(top)
    end, liquid = float(path.temperature[0]), float(path.liquid[0])
    below = float(ascent.planned_at(base).temperature[0])
    frozen = fusion(end) * liquid * DRY_AIR.molar_mass / (3.5 * GAS_CONSTANT)
    scale_height = GAS_CONSTANT / DRY_AIR.molar_mass * below / STANDARD_GRAVITY
    latent = theory.BINDING_TEMPERATURE / below - (theory.LIQUID_HEAT_CAPACITY - theory.VAPOR_HEAT_CAPACITY)
    climbing = 1.0  # m/s
    humid = 4.0 * math.pi * DIFFUSIVITY * CONCENTRATION * DROPLET
    supersaturation = (latent / 3.5 - 1.0) * climbing / scale_height / humid
    pseudo = theory.parcel_path([top], ascent.pressure, ascent.temperature, ascent.total_water, 0.0)
    cloud = planned_cloud(ascent)
    grouped = cloud.temperature * cloud.clusters()
    clusters = float(grouped[np.argmin(np.abs(cloud.pressure - base))])
    lag = cloud.temperature * np.einsum("ti,ti->t", cloud.seen(), cloud.behind)
    fast = cloud.temperature * drift(cloud) - grouped + lag
    return [
        ["mixing with the environment", "the largest difference between this parcel and a cloud: in a simulated "
         "cumulus the air above 2 km comes on average from well above the cloud base (Yeo and Romps 2013, "
         "[doi:10.1175/JAS-D-12-0144.1](https://doi.org/10.1175/JAS-D-12-0144.1))"],
        ["ice", f"if all {rounded(1000.0 * liquid)} g/kg of liquid froze at {top / 100.0:.0f} hPa and "
         f"{rounded(end - 273.15)} °C, at {rounded(fusion(end) / 1000.0, 3)} kJ/kg, the parcel would be "
         f"{rounded(frozen)} K warmer"],
        ["rain, where it is off", f"the pseudo-adiabat ends {rounded(end - float(pseudo.temperature[0]))} K colder "
         "than the reversible one; a run with `rain=on` ends nearly as cold"],
        ["the weight of the droplets", f"lowers the buoyancy as if the parcel were {rounded(end * liquid)} K "
         "colder; the temperature stays the same"],
        ["supersaturation in an updraft", f"in a real cloud {rounded(100.0 * supersaturation)} % at "
         f"{climbing:.0f} m/s with {CONCENTRATION / 1e6:.0f} droplets of {DROPLET * 1e6:.0f} µm radius in a "
         "cubic centimetre; here vapour condenses a little late, so its latent heat is missing: the parcel is up to "
         f"{rounded(float(lag.max()))} K too cold"],
        ["an ascent of an hour; here it takes nanoseconds",
         f"the parcel is up to {rounded(float(fast.max()))} K too warm"],
        ["clusters of few molecules", f"some molecules condense too early: at the cloud base the parcel is "
         f"{rounded(clusters)} K too warm"],
    ]  # fmt: skip


def vapour() -> list[list[str]]:
    """Return what the box of moist air and the pool leave out."""
    _, settings, _ = set_up("condensation")
    t = settings.si.temperature
    # second virial coefficient of water vapour at 20 degC: Harvey and Lemmon 2004, doi:10.1063/1.1587731
    nonideal = -1.4e-3 * float(theory.saturation_vapor_pressure(t)) / (GAS_CONSTANT * t)
    # Buck 1981, doi:10.1175/1520-0450(1981)020<1527:NEFCVP>2.0.CO;2, the equation for water
    enhancement = 1.0007 - 1.0 + 3.46e-6 * settings.si.pressure / 100.0
    return [
        ["forces between molecules of vapour", f"saturated vapour at {t - 273.15:.0f} °C has a pressure "
         f"{rounded(-100.0 * nonideal)} % below that of an ideal gas"],
        ["attraction between molecules of air and vapour, and the pressure of the air on the liquid",
         f"saturated air has {rounded(100.0 * enhancement)} % more vapour at {settings.si.pressure / 100.0:.0f} hPa "
         "(Buck 1981), a sixth of it because of the pressure"],
        ["molecules that bounce off the liquid", "measured sticking probabilities lie between about 0.01 "
         "and 1, here it is 1; both rates change alike, and saturation does not"],
    ]  # fmt: skip


@job("requirement", quick=True)
def requirement(found: Findings) -> None:
    """Make a table for each group of scenes."""
    for rows in (temperature, atmosphere, discs, lifting, moist, vapour):
        found.table(["left out or simplified", "what it would change"], rows(), key=rows.__name__)
