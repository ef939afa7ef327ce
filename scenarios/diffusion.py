"""Two gases mix, because their molecules move at random.

One gas fills the left half of a box and another the right half, at the same pressure and temperature. The wall between
them is taken away. Every molecule flies on as before; collisions turn its path into a random walk. Differences
disappear, small-scale ones first. The last to disappear is that between left and right, as exp(-D (pi/L)^2 t). The two
gases do not separate again: the entropy of mixing grows to k ln 2 for each molecule.

By default the two gases differ by a label alone, as if half of the air were painted: this is self-diffusion. With
mass_ratio the molecules on the right are heavier; 10 is the ratio of argon to helium.

Modelled: hard spheres of one size between smooth end walls; the other sides are periodic: what leaves on one comes in
on the other. Left out: rotation, gravity, currents. Exaggerated: molecules are wider than those of air, so that
thousands of them make the box many mean free paths long. In theory D is that of Chapman and Enskog for a thin gas,
divided by Enskog's contact value, plus 2 % because collisions in a denser gas are correlated. Gases of unlike masses
also carry heat as they mix, and the light one begins to spread first; theory then is the Boltzmann equation.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import Maxwell, Periodic, Scattered, Specular, Start
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.headline import CHANCE_ALONE, CHANCE_LIMIT
from atmosbox.scene.instruments import MOMENTS, Air, Mixing
from atmosbox.scene.panels import Line, Panel, over_time
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "Why do gases mix?"
level = "school"
minutes = 15
series = (Series("exact", "molecules", (1500, 3000, 6000, 12_000)), Series("dsmc", "molecules", (12_000, 48_000)))
"""Runs worth comparing: molecules diffuse equally in both engines; with more molecules the shares scatter less."""
FRAMES = 120
SKIP = 2
"""Number of frames in which the molecules still remember how they flew when the wall was taken away."""
BINS = 20
LEAST_PATHS = 10.0
"""Least length of the box in mean free paths: in a shorter box gases do not diffuse, they fly through each other."""
CORRELATED = 0.67
"""Relative change of D by correlated collisions, per packing fraction: molecular dynamics finds 1.2 times Enskog's D at
0.3 (Speedy 1987, doi:10.1080/00268978700102371), and 41 runs of this scene 0.8 +- 0.2 per packing fraction."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(12_000, "1", "number of molecules of both gases together", low=100, high=1_000_000)
    length: float = setting(150.0, "nm", "length of the box", low=10.0, high=10_000.0)
    mass_ratio: float = setting(
        1.0, "1", "mass of a molecule on the right, divided by that of one on the left", low=0.01, high=100.0
    )
    temperature: float = setting(15.0, "degC", "temperature of both gases", low=-200.0, high=1000.0)
    pressure: float = setting(
        1000.0, "hPa", "pressure that both would have if molecules were points", low=1.0, high=2e4
    )
    diameter: float = setting(1.3, "nm", "diameter of a molecule; that of air is 0.37 nm", low=0.1, high=3.0)
    duration: float = setting(3.0, "1", "how long to watch, in mixing times", low=0.5, high=50.0)

    def check(self) -> None:
        """Refuse a gas that is too dense, and a box so short or so narrow that its gases do not diffuse."""
        filled = math.pi / 6.0 * self.si.diameter**3 * self.si.pressure / (BOLTZMANN * self.si.temperature)
        if filled > 0.1:
            widest = math.floor(100.0 * self.diameter * (0.1 / filled) ** (1.0 / 3.0)) / 100.0
            raise self.refusal("diameter", f"is too wide for a gas of {self.pressure:g} hPa", at_most=widest)
        density, side = _box(self)
        path = float(law.mean_free_path(density, 1.0))
        paths = (self.si.length / self.si.diameter - 1.0) / path
        if paths < LEAST_PATHS:
            least = math.ceil((LEAST_PATHS * path + 1.0) * self.diameter)
            problem = f"is only {paths:.1f} mean free paths long, so that the gases fly through each other"
            raise self.refusal("length", problem, ", or a larger diameter or pressure", at_least=least)
        if side < 3.0:
            least = math.ceil(self.molecules * (3.0 / side) ** 2)
            raise self.refusal("molecules", f"fill a box only {side:.1f} diameters wide", at_least=least)


def _box(settings: Settings) -> tuple[float, float]:
    """Return the number density [1/diameter^3] and the width of the box [diameters]."""
    si = settings.si
    density = rounded(si.pressure * si.diameter**3 / (BOLTZMANN * si.temperature))
    return density, rounded(math.sqrt(settings.molecules / density / (si.length / si.diameter - 1.0)))


def _masses(settings: Settings) -> tuple[float, float]:
    return 1.0, settings.mass_ratio


def _contact(settings: Settings, *, ideal: bool) -> float:
    """Return by how much the gas has more collisions than a thin one: Enskog's contact value, less their correlation.

    The correlation is that of gases alike. Left out is that the flow around a molecule meets its own images in a box of
    width w, which lowers D by 2.837 kT / 6 pi mu w (Yeh and Hummer 2004, doi:10.1021/jp0477147): a quarter of the
    standard error of a run with any number of molecules.
    """
    if ideal:
        return 1.0
    filled = law.packing_fraction(_box(settings)[0], 1.0)
    return float(law.contact_value(filled) / (1.0 + (CORRELATED * filled if settings.mass_ratio == 1.0 else 0.0)))


def _diffusivity(settings: Settings, *, ideal: bool) -> float:
    """Return the mutual diffusion coefficient [reduced]."""
    contact = _contact(settings, ideal=ideal)
    return law.mutual_diffusivity(_box(settings)[0], 1.0, _masses(settings), 1.0, contact=contact)


def _rate(settings: Settings, *, ideal: bool) -> float:
    """Return the rate at which the slowest mode decays [reduced]."""
    reach = settings.si.length / settings.si.diameter - 1.0
    return law.mixing_decay_rate(_diffusivity(settings, ideal=ideal), reach)


def _scale(settings: Settings) -> Scale:
    return Scale(settings.si.diameter, DRY_AIR.molecule_mass, BOLTZMANN * settings.si.temperature)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return both gases at the moment when the wall is taken away."""
    n = settings.molecules
    scale, (density, side) = _scale(settings), _box(settings)
    length = (rounded(settings.si.length / scale.length), side, side)
    right = np.arange(n) >= n // 2
    mass = np.where(right, settings.mass_ratio, 1.0)
    rate = rounded(_rate(settings, ideal=engine.ideal))
    parcel = engine.begin(
        Start(n, (Scattered(numbered="along x"), Maxwell(1.0))),
        length=length,
        walls=(Specular(),) * 2 + (Periodic(),) * 4,
        mass=mass,
        seed=settings.seed,
    )
    path = float(law.mean_free_path(density, 1.0))
    facts = {
        "box": f"{settings.length:g} nm long, {side * scale.length * 1e9:.1f} nm wide, with periodic sides",
        "real molecules per simulated one": "1",
        "exaggeration": f"molecules {settings.si.diameter / DRY_AIR.diameter:.1f} times as wide as those of air",
        "degrees of freedom": "3: the molecules do not rotate",
        "mean free path": f"{path * scale.length * 1e9:.3g} nm, 1/{(length[0] - 1.0) / path:.0f} of the length",
        "mixing time": f"{scale.time / rate * 1e9:.3g} ns: the difference between left and right falls to 1/e",
        "noise": f"the diffusion coefficient of one run scatters by {100.0 * _spread(settings):.1f} %",
    }
    measured = Air(), Mixing(right, {name: moment / rate for name, moment in MOMENTS.items()}, BINS)
    return Setup(parcel, scale, settings.duration / rate, FRAMES, measured, facts=facts, right=right)


def _spread(settings: Settings) -> float:
    r"""Return the relative standard deviation of the decay rate of one run.

    The N molecules walk independently, so that the mode is an Ornstein-Uhlenbeck process with variance :math:`1/2N`
    that begins at :math:`2/\pi`; the relative error of its decay rate is :math:`\pi / \sqrt{2 N (1 - e^{-2T})}` after T
    mixing times.
    """
    return math.pi / math.sqrt(-2.0 * settings.molecules * math.expm1(-2.0 * settings.duration))


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the decay of the slowest mode, the entropy of mixing, and the shares across the box."""
    passed, ideal = _passed(dataset, settings), used(dataset).ideal
    edges = np.linspace(0.0, 1.0, BINS + 1)
    amplitude = _amplitude(passed, settings, ideal=ideal)
    found = {
        "mixing_amplitude_theory": amplitude,
        "mixing_entropy_theory": law.mixing_entropy(law.mixed_share(edges, _aged(amplitude))) / math.log(2.0),
    }
    for name, moment in MOMENTS.items():
        nearest = passed[np.abs(passed - moment).argmin()]
        found[f"left_gas_share_{name}_theory"] = law.mixed_share(edges, float(nearest))
    return found


def _passed(dataset: "xr.Dataset", settings: Settings) -> np.ndarray:
    """Return the times of the frames, in mixing times of theory."""
    rate = _rate(settings, ideal=used(dataset).ideal)
    return np.asarray(dataset.elapsed_time.values * 1e-9 / _scale(settings).time * rate)


def _amplitude(passed: np.ndarray, settings: Settings, *, ideal: bool) -> np.ndarray:
    """Return the slowest mode of theory after ``passed`` mixing times."""
    density = _box(settings)[0] * _contact(settings, ideal=ideal)
    wave_number = math.pi / (settings.si.length / settings.si.diameter - 1.0)
    times = passed / _rate(settings, ideal=ideal)
    return law.mixing_wave(_masses(settings), wave_number / density, times * density)


def _aged(amplitude: np.ndarray) -> np.ndarray:
    """Return the mixing times after which gases that differ only by a label have mixed to the same degree."""
    return np.asarray(-np.log(np.clip(np.abs(amplitude), 1e-300, 1.0)))


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the diffusion coefficient, and the entropy of mixing after one mixing time and at the end."""
    passed = _passed(dataset, settings)
    if len(passed) < SKIP + 20:
        return ()
    scale, ideal = _scale(settings), used(dataset).ideal
    expected = _diffusivity(settings, ideal=ideal)
    known = law.diffusivity_error(_masses(settings))
    reason = "D of unlike gases depends on how much there is of each" if known else CHANCE_ALONE
    unit = scale.length**2 / scale.time
    amplitude = _amplitude(passed, settings, ideal=ideal)
    # measured relative to the decay of theory, which differs from that by D alone if the diffusion carries heat
    ratio, error = (
        np.array(_decay(dataset.mixing_amplitude.values, passed, settings.molecules))
        / (_decay(amplitude, passed, settings.molecules)[0])
    )
    unit *= expected
    sizes = ratio * unit, error * unit, unit, known * unit
    found = [Headline("diffusion_coefficient", *sizes, reason, "m2 s-1", "mm2 s-1", "diffusion coefficient")]
    # theory includes heat and sound for small waves: if their effect after a mixing time is large, theory is too simple
    place = int(np.abs(passed - 1.0).argmin())
    with_heat, spread, _ = _entropy_spread(float(_aged(amplitude[place])), settings.molecules)
    linear = abs(with_heat - _entropy_spread(float(passed[place]), settings.molecules)[0]) <= CHANCE_LIMIT * spread
    for name, moment, label in (
        ("entropy_after_one_mixing_time", 1.0, "entropy of mixing / N k ln 2 after one mixing time"),
        ("entropy_at_the_end", passed[-1], "entropy of mixing / N k ln 2 at the end"),
    ):
        if passed[-1] < moment:
            continue
        place = int(np.abs(passed - moment).argmin())
        mean, spread, steep = _entropy_spread(float(_aged(amplitude[place])), settings.molecules)
        value, answer = float(dataset.mixing_entropy.values[place]), mean if linear else None
        found.append(Headline(name, value, spread, answer, known * steep, reason, "1", "1", label))
    return tuple(found)


def _decay(amplitude: np.ndarray, passed: np.ndarray, molecules: int) -> tuple[float, float]:
    r"""Return the decay rate of the slowest mode, over that of theory, and its standard error.

    From each frame to the next the mode is multiplied by r and gets a random part of variance
    :math:`(1 - r^2) \pi^2 / 8 N`; the best estimate of r is :math:`\sum A_i A_{i+1} / \sum A_i^2`.
    """
    before, after = amplitude[SKIP - 1 : -1], amplitude[SKIP:]
    step, weight = float(passed[1] - passed[0]), float(before @ before)
    factor = min(max(float(before @ after) / weight, 1e-6), 1.0 - 1e-12)
    error = math.sqrt((1.0 - factor**2) * math.pi**2 / (8.0 * molecules) / weight)
    return -math.log(factor) / step, error / (factor * step)


def _entropy_spread(passed: float, molecules: int) -> tuple[float, float, float]:
    """Return the entropy of mixing, its standard deviation, and its derivative by the logarithm of the decay rate.

    Two quantities scatter: the slowest mode, and the counts in the bins.
    """
    edges = np.linspace(0.0, 1.0, BINS + 1)
    low, mean, high = law.mixing_entropy(law.mixed_share(edges, passed * np.array([0.99, 1.0, 1.01]))) / math.log(2.0)
    slope = (high - low) / (0.02 * passed)  # by time; a relative change of the rate equals one of the time
    of_mode = math.sqrt(-math.expm1(-2.0 * passed) * math.pi**2 / (8.0 * molecules)) * math.exp(passed)
    of_counts = math.sqrt(2.0 * BINS) / (2.0 * molecules * math.log(2.0))
    return float(mean), math.hypot(slope * of_mode, of_counts), float(slope * passed)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the share across the box at three moments, and the entropy."""
    lasts = 1e9 * _scale(settings).time / _rate(settings, ideal=False)
    shares = {name: f"{moment * lasts:.2g} ns" for name, moment in MOMENTS.items()}
    entropy = over_time(
        "Mixing increases the entropy", {"mixing_entropy": "molecules"}, "entropy of mixing (1: fully mixed)",
        theory="theory", headline="entropy_after_one_mixing_time",
    )  # fmt: skip
    lines: list[Line] = []
    for name, label in shares.items():
        share = f"left_gas_share_{name}"
        lines += [Line("distance", share, label, error=f"{share}_se")]
        lines += [Line("distance", f"{share}_theory", "theory", "theory")]
    axes = "distance from the left wall", "share of the left gas", "nm", "percent"
    spreads = Panel(
        "line", "The left gas spreads to the right", tuple(lines), *axes, headlines=("diffusion_coefficient",)
    )
    return spreads, entropy
