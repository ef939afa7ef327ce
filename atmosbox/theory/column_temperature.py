"""The temperature of an isolated column in equilibrium: how its energy divides into motion and height."""

from atmosbox.theory.hydrostatic import hydrostatic_mean_height

__all__ = ["column_temperature"]


def column_temperature(
    energy: float,
    molecules_per_area: float,
    bottom: float,
    top: float,
    diameter: float = 0.0,
    *,
    mass: float = 1.0,
    gravity: float = 1.0,
    dimensions: int = 3,
    rotation: int = 0,
) -> float:
    r"""Return the temperature kT for a given energy per molecule, :math:`\tfrac{d + r}{2} kT + m g \bar z`.

    The mean height rises with temperature, so there is exactly one solution.

    Parameters
    ----------
    energy
        Kinetic and potential energy per molecule [energy].
    molecules_per_area
        As in :func:`hydrostatic_layers` [length^-2; in a plane, length^-1].
    bottom, top
        Lowest and highest place of a molecule's centre [length].
    diameter
        Diameter of a molecule [length]; zero for an ideal gas.
    mass, gravity
        Mass of a molecule [mass] and acceleration of gravity [length time^-2].
    dimensions
        3, or 2 for discs in a plane.
    rotation
        Degrees of freedom of rotation.

    Returns
    -------
    float
        Temperature as an energy [energy].

    Raises
    ------
    ValueError
        If the column would freeze at its floor, or is so dense that it would be less than half as warm as a gas of
        points.

    Examples
    --------
    In a very high column of points with 5/2 kT each, 3/2 kT are energy of motion and 1 kT is potential energy:

    >>> round(column_temperature(2.5, 1.0, 0.0, 60.0), 3)
    1.0
    """
    from scipy.optimize import brentq

    freedom = dimensions + rotation

    def missing(kT: float) -> float:
        column = molecules_per_area, bottom, top, kT, mass, gravity, diameter
        height = hydrostatic_mean_height(*column, dimensions=dimensions)
        return 0.5 * freedom * kT + mass * gravity * height - energy

    # all energy may be motion; in a high column of points kT per molecule is potential energy, of spheres a little more
    most = 2.0 * energy / freedom
    kT: float = brentq(missing, 0.5 * most * freedom / (freedom + 2.0), most, xtol=1e-14 * energy)
    return kT
