"""What the scenes with water leave out, and what it would change."""

import math

import numpy as np
from jobs.registry import Findings, job, rounded
from jobs.requirement import HEAD, set_up

from atmosbox import theory
from atmosbox.scene.ascent import finite_size
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY, WATER

SURFACE_TENSION = 75.65e-3
"""Of water at 0 degC [N m-1]: IAPWS R1-76(2014)."""
LIQUID_DENSITY = 999.8
"""Of water at 0 degC [kg m-3]."""
DIFFUSIVITY = 2.11e-5
"""Of vapour in air at 0 degC and 1013.25 hPa [m2 s-1]: Hall and Pruppacher 1976."""
DROPLET = 10e-6
"""Radius of a droplet of a young cloud [m]."""
CONCENTRATION = 200e6
"""Droplets in a cubic metre of it [m-3]."""


def kelvin(radius: float, temperature: float) -> float:
    """Return the logarithm of the vapour pressure over a droplet, over that of a flat surface (Kelvin)."""
    gas = GAS_CONSTANT / WATER.molar_mass
    return 2.0 * SURFACE_TENSION / (LIQUID_DENSITY * gas * temperature * radius)


def fusion(temperature: float) -> float:
    """Return the latent heat of freezing of supercooled water [J kg-1]: Murphy and Koop 2005, equations 5 and 9."""
    t = temperature
    ice = 46782.5 + 35.8925 * t - 0.07414 * t**2 + 541.5 * math.exp(-((t / 123.75) ** 2))
    liquid = 56579.0 - 42.212 * t + math.exp(0.1149 * (281.6 - t))
    return (ice - liquid) / WATER.molar_mass


@job("requirement-moist", quick=True)
def rising_cloud(found: Findings) -> None:
    """Weigh what the rising cloud leaves out, from the settings that it starts with."""
    module, settings, setup = set_up("lifting-moist")
    ascent = module._ascent(settings)
    top, base = ascent.top_pressure, ascent.base
    path = ascent.planned_at(top)
    end, liquid = float(path.temperature[0]), float(path.liquid[0])
    below = float(ascent.planned_at(base).temperature[0])
    heat = 3.5 * GAS_CONSTANT / DRY_AIR.molar_mass
    weight = end * liquid
    frozen = fusion(end) * liquid / heat
    humid = 4.0 * math.pi * DIFFUSIVITY * CONCENTRATION * DROPLET
    climbing = 1.0  # m/s
    scale_height = GAS_CONSTANT / DRY_AIR.molar_mass * below / STANDARD_GRAVITY
    latent = theory.BINDING_TEMPERATURE / below - (theory.LIQUID_HEAT_CAPACITY - theory.VAPOR_HEAT_CAPACITY)
    supersaturation = (latent / 3.5 - 1.0) * climbing / scale_height / humid
    small = (3.0 * WATER.molecule_mass * 100.0 / (4.0 * math.pi * LIQUID_DENSITY)) ** (1.0 / 3.0)
    pseudo = theory.parcel_path([top], ascent.pressure, ascent.temperature, ascent.total_water, 0.0)
    lost = float(pseudo.temperature[0]) - end
    known = finite_size.drift(ascent, ideal=False)
    hurry, lag = float(known.rate.max()), float(known.lag.max())
    clusters = float(known.clusters[np.argmin(np.abs(known.pressure - base))])
    nuclei = theory.parcel_path([top], ascent.pressure, ascent.temperature, ascent.total_water)
    faces = float(np.prod(setup.parcel.length[:2])) * settings.area * (setup.scale.length * 1e9) ** 2
    found.number("hurry", f"{rounded(hurry)} K")
    found.number("clusters", f"{rounded(clusters)} K")
    found.table(
        HEAD,
        [
            ["ice", f"{rounded(1000.0 * liquid)} g/kg of liquid at {top / 100.0:.0f} hPa, {end - 273.15:.0f} °C",
             f"if all of it froze there, with {rounded(fusion(end) / 1000.0, 3)} kJ/kg, the parcel would be "
             f"{rounded(frozen)} K warmer; real clouds do so between −10 and −38 °C"],
            ["rain (at the default)", f"the pseudo-adiabat ends {rounded(lost)} K from the reversible one",
             "`rain=on` shows it"],
            ["curvature of droplets", f"$\\ln e/e_s$ = {rounded(kelvin(DROPLET, below))} for {DROPLET * 1e6:.0f} µm, "
             f"{rounded(kelvin(small, below))} for a hundred molecules",
             "a cloud would not notice; but without nuclei none could begin, and here it begins by itself"],
            ["what is dissolved in them", "Köhler 1936: it lowers $e_s$ over small droplets",
             "that is how real clouds begin, at some tenths of a percent of supersaturation"],
            ["supersaturation in an updraught", f"{rounded(100.0 * supersaturation)} % at {climbing:.0f} m/s with "
             f"{CONCENTRATION / 1e6:.0f} droplets of {DROPLET * 1e6:.0f} µm in a cubic centimetre",
             f"here vapour that must first find liquid makes the parcel {rounded(lag)} K too cold"],
            ["the weight of the droplets", f"{rounded(1000.0 * liquid)} g/kg at the top",
             f"counts in the buoyancy as {rounded(weight)} K; the temperature knows nothing of it"],
            ["mixing with the environment", "in a simulated cumulus the air above 2 km comes on average from well "
             "above the cloud base (Yeo and Romps 2013, [doi:10.1175/JAS-D-12-0144.1]"
             "(https://doi.org/10.1175/JAS-D-12-0144.1))",
             "the largest difference of all between a parcel and a cloud"],
            ["the temperature of each droplet", "one for all of them",
             "real ones differ from their air by some hundredths of a kelvin"],
            ["the nuclei", f"heat capacity {rounded(ascent.nuclei)} k",
             f"they warm the parcel at the top by {rounded(end - float(nuclei.temperature[0]))} K, and theory counts "
             "them in"],
            ["an hour for the ascent", f"{rounded(setup.duration * setup.scale.time * 1e9)} ns, "
             f"{settings.ascent:.0f} mean free times", f"the parcel arrives up to {rounded(hurry)} K too warm"],
            ["a cubic metre of air", f"{ascent.molecules} molecules, {ascent.vapour} of them vapour",
             f"at the cloud base some are clustered too early, and the parcel is {rounded(clusters)} K too warm"],
            ["droplets that can be seen", f"a mist of {rounded(faces)} nm², for {ascent.vapour} molecules",
             "were they real droplets, vapour would find them too late for so fast an ascent"],
        ],
    )  # fmt: skip


@job("requirement-vapour", quick=True)
def vapour_and_pool(found: Findings) -> None:
    """Weigh what the box of moist air and the pool leave out."""
    _, settings, setup = set_up("condensation")
    t = settings.si.temperature
    saturated = float(theory.saturation_vapor_pressure(t))
    side = float(setup.parcel.length[0]) * setup.scale.length
    # second virial coefficient of water vapour at 20 degC: Harvey and Lemmon 2004, doi:10.1063/1.1587731
    virial = -1.4e-3  # m3 mol-1
    attraction = virial * saturated / (GAS_CONSTANT * t)
    # Buck, A. L. (1981), doi:10.1175/1520-0450(1981)020<1527:NEFCVP>2.0.CO;2, equation for water at 1000 hPa
    enhancement = 1.0007 - 1.0 + 3.46e-6 * settings.si.pressure / 100.0
    heavy = WATER.molecule_mass * STANDARD_GRAVITY * side / (BOLTZMANN * t)
    warm = np.array([-10.0, 20.0, 40.0, 100.0]) + 273.15
    off = 100.0 * (theory.saturation_vapor_pressure(warm) / theory.saturation_vapor_pressure_iapws(warm) - 1.0)
    below = "{:.2f}, {:.2f} and {:.2f} %".format(*np.abs(off[:3]))
    found.table(
        HEAD,
        [
            ["forces between molecules of vapour", f"$B n$ = {rounded(attraction)} at {t - 273.15:.0f} °C",
             "so little does saturated vapour differ from an ideal gas"],
            ["the pressure of the air on the liquid, and air dissolved in it",
             f"enhancement factor 1 + {rounded(enhancement)} at 1000 hPa (Buck 1981)",
             "saturated air has that much more vapour than the table of pure water says"],
            ["heat capacities that change with temperature", f"$e_s$ at 100 °C is {rounded(float(off[3]))} % off",
             f"at −10, 20 and 40 °C it is {below} below measured water"],
            ["gravity", f"$mgh/kT$ = {rounded(heavy)} over the box", "nothing falls within it"],
            ["molecules that bounce off the liquid", "all that meet it stay (sticking 1)",
             "measured values lie between 0.1 and 1; both rates change alike, and saturation does not move"],
        ],
    )  # fmt: skip
