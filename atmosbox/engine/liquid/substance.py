"""The condensing substance, and the form of its liquid in the box: a mist, drops or a pool."""

import math
from dataclasses import dataclass

from atmosbox.engine.core.elementary import cbrt, exp, log
from atmosbox.engine.core.refusal import RefusedError, number, whole


@dataclass(frozen=True)
class Substance:
    """A condensing substance: its vapour is hard molecules, bound in the liquid by a constant energy.

    Parameters
    ----------
    mass, diameter
        Mass and diameter of a molecule of the vapour [mass, length].
    binding_energy
        Energy that is needed to take a molecule out of the liquid at zero temperature [energy].
    heat_capacity
        Heat capacity of the liquid per molecule, in units of k.
    volatility
        K in the vapour pressure K T^(c_p - c_l) exp(-binding_energy / T), where T is kT [energy].
    rotation
        Rotational degrees of freedom of the vapour.

    Raises
    ------
    RefusedError
        If a number is impossible.

    Examples
    --------
    >>> round(Substance(0.62, 1.0, 20.0, 9.0, 1e6).saturation_pressure(1.0), 6)
    0.002061
    """

    mass: float
    diameter: float
    binding_energy: float
    heat_capacity: float
    volatility: float
    rotation: float = 3.0

    def __post_init__(self) -> None:
        for name in ("mass", "binding_energy", "heat_capacity", "volatility"):
            number(getattr(self, name), f"{name} of the substance", above=0.0)
        number(self.diameter, "diameter of the substance", least=0.0)
        if self.rotation not in (0.0, 2.0, 3.0):
            raise RefusedError(f"rotation of the substance = {self.rotation}: give 0, 2 or 3 degrees of freedom")

    @property
    def vapour_heat_capacity(self) -> float:
        """Heat capacity of the vapour at constant pressure, per molecule, in units of k."""
        return 2.5 + 0.5 * self.rotation

    def saturation_pressure(self, kT: float) -> float:
        """Return the saturation pressure over a flat surface of the liquid at kT [energy/length^3]."""
        power = self.vapour_heat_capacity - self.heat_capacity
        pressure: float = float(self.volatility * exp(power * log(kT) - self.binding_energy / kT))
        return pressure


@dataclass(frozen=True)
class Liquid:
    """Liquid in a box: its substance, amount and temperature.

    Parameters
    ----------
    substance
        What it consists of.
    number
        Number of molecules in it at the start.
    kT
        Its temperature at the start [energy].
    nuclei
        Heat capacity of the nuclei of the droplets, in units of k.
    sticking
        Fraction of the vapour molecules that hit the liquid and stay, above 0 up to 1.
    rain
        Rate at which each molecule above ``keeps`` falls out of the box [1/time].
    keeps
        Number of molecules that the liquid holds before it rains.

    Raises
    ------
    RefusedError
        If a number is impossible.
    """

    substance: Substance
    number: int = 0
    kT: float = 1.0
    nuclei: float = 0.0
    sticking: float = 1.0
    rain: float = 0.0
    keeps: int = 0

    def __post_init__(self) -> None:
        whole(self.number, "number of molecules in the liquid", least=0)
        number(self.kT, "kT of the liquid", least=0.0)
        number(self.nuclei, "heat capacity of the nuclei", least=0.0)
        number(self.rain, "rain", least=0.0)
        whole(self.keeps, "number of molecules that the liquid keeps", least=0)
        number(self.sticking, "sticking", above=0.0, most=1.0)


@dataclass(frozen=True)
class Mist(Liquid):
    r"""Droplets too fine to be drawn, spread evenly and moving with the air.

    A molecule of speed w relative to the air meets a droplet at the rate :math:`A w Z / 4 V`. So, as with a pool, the
    liquid is in equilibrium with the partial pressure, the vapour's share of n k T Z.

    Parameters
    ----------
    area
        Total area of all droplets [length^2].
    """

    area: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        number(self.area, "area of the mist", above=0.0)


@dataclass(frozen=True)
class Pool(Liquid):
    """The floor of the box is the surface of the liquid, whose volume is neglected."""


@dataclass(frozen=True)
class Drops(Liquid):
    """Visible drops: spheres that fly, are hit by molecules, grow, shrink and merge.

    Each drop has a nucleus and a number of molecules; all drops have one temperature. The molecules in the liquid at
    the start are shared evenly among them. Without surface tension and dissolved particles the vapour pressure over
    drops is that over a flat surface; see `drop_shape`.

    Parameters
    ----------
    position
        Centres of the nuclei at the start [length], where there is no molecule; the drops start at rest.
    nucleus
        Radius of all nuclei, or of each one [length].
    nucleus_mass
        Mass of a nucleus [mass].
    molecule_radius
        Radius of the sphere by whose volume a molecule enlarges its drop [length].
    surface_tension
        Energy per area of surface [energy/length^2].
    dissolved
        Number of particles that each nucleus gives into solution, two for a pair of ions; none if empty.

    Raises
    ------
    RefusedError
        If there is no nucleus, a number is impossible, or a table does not fit the number of nuclei.
    """

    position: tuple[tuple[float, float, float], ...] = ()
    nucleus: float | tuple[float, ...] = 1.0
    nucleus_mass: float = 10.0
    molecule_radius: float = 0.5
    surface_tension: float = 0.0
    dissolved: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.position:
            raise RefusedError("drops need nuclei: give the position of one at least")
        for radius in self.nuclei_radii:
            number(radius, "radius of the nuclei", above=0.0)
        for particles in self.dissolved:
            number(particles, "number of particles dissolved in a drop", least=0.0)
        for name, values in (("radii", self.nuclei_radii), ("numbers of dissolved particles", self.particles)):
            if len(values) != len(self.position):
                raise RefusedError(f"there are {len(values)} {name} for {len(self.position)} nuclei: give one for each")
        number(self.nucleus_mass, "mass of the nuclei", above=0.0)
        number(self.molecule_radius, "radius of a molecule in a drop", least=0.0)
        number(self.surface_tension, "surface tension of the drops", least=0.0)
        self._refuse_what_is_not_bound()
        if self.rain:
            raise RefusedError("drops do not rain: leave rain at 0, or take a mist")

    def _refuse_what_is_not_bound(self) -> None:
        """Refuse a surface tension at which the first molecule on the smallest nucleus would not be bound."""
        core, ball = (float(length) ** 3 for length in (min(self.nuclei_radii), self.molecule_radius))
        grown = 4.0 * math.pi * (float(cbrt(core + ball)) ** 2 - float(cbrt(core)) ** 2)
        bound = self.substance.binding_energy
        if not self.surface_tension * grown < bound:
            raise RefusedError(
                f"surface_tension = {self.surface_tension:.4g} gives a nucleus of radius {min(self.nuclei_radii):.4g} "
                f"more surface energy with its first molecule than the {bound:.4g} that binds it: "
                f"give less than {bound / grown:.4g}, or larger nuclei"
            )

    @property
    def nuclei_radii(self) -> tuple[float, ...]:
        """Radius of each nucleus [length]."""
        return self.nucleus if isinstance(self.nucleus, tuple) else (self.nucleus,) * len(self.position)

    @property
    def particles(self) -> tuple[float, ...]:
        """Number of particles dissolved in each drop at the start."""
        return self.dissolved or (0.0,) * len(self.position)
