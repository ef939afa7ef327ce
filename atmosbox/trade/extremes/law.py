r"""What is known of approximate engines: by which law each is off.

A step sees a contact only if it ends where the two overlap and still approach. Of all pairs that would touch
within a step in which they come closer by :math:`x` diameters, at all impact parameters, that is the share

.. math:: R(x) = 1 - \tfrac{1}{3} x^2 \quad (x \le 1), \qquad \frac{2}{3x} \quad (x > 1) .

With :math:`\delta = \Delta t \sqrt{kT/m}/\sigma` and the relative speeds of pairs that meet in a thin gas, its mean is
:math:`1 - \frac{8}{3}\delta^2` for short steps and :math:`\sqrt{\pi}/6\delta` for long ones: `seen_share`. Contacts
come late, too: the pressure of collisions is low by :math:`(4/\sqrt{\pi})\,\delta` of itself, and in a dense gas by an
amount proportional to the step, once that is much shorter than the time between two contacts.

Euler's fall makes the energy :math:`m g^2 \Delta t / 2` per molecule and time, and so does a floor that mirrors
what has gone through it. Direct simulation Monte Carlo knows nobody's place within a cell: its molecules
collide as often as points that are surrounded by nobody, and press as an ideal gas does.
"""

import math

from atmosbox.engine import Parcel
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong

__all__ = ["by_chance", "euler_heat", "heat_made", "judged_contacts", "seen_share", "step_of"]


def by_chance(parcel: Parcel) -> bool:
    """Return whether an engine lets molecules meet by chance and not where they are."""
    return parcel.ideal and bool(parcel.diameter.any())


def step_of(parcel: Parcel) -> float:
    """Return the length of a step [time], 0 for an engine without."""
    return parcel.time_step if isinstance(parcel, MarchingParcel) else 0.0


def seen_share(delta: float) -> float:
    r"""Return which share of the contacts of a thin gas is seen by steps of a length.

    Parameters
    ----------
    delta
        Length of a step, :math:`\Delta t \sqrt{kT/m} / \sigma`.

    Notes
    -----
    The mean of R over the relative speeds u of pairs that meet, :math:`u^3 \exp(-m u^2 / 4 k T)`.

    Examples
    --------
    >>> [round(seen_share(delta), 4) for delta in (0.0, 0.05, 1.0, 10.0)]
    [1.0, 0.9933, 0.2922, 0.0295]
    """
    if delta == 0.0:
        return 1.0
    a = 0.5 / delta
    fast = math.exp(-a * a)
    slow = 1.0 - (1.0 + a * a) * fast - 8.0 / 3.0 * delta**2 * (1.0 - (1.0 + a * a + 0.5 * a**4) * fast)
    return slow + (2.0 * fast / delta + 2.0 * math.sqrt(math.pi) * math.erfc(a)) / (12.0 * delta)


def judged_contacts(
    parcel: Parcel, what: str, value: float, expected: float, tolerance: float, distance: float = 1.0
) -> Verdict:
    """Return the verdict on contacts of a gas at kT = m = 1: as many as expected, or fewer by the law of the step.

    ``distance`` is that of the centres at a contact [length].
    """
    delta = step_of(parcel) / distance
    share = seen_share(delta)
    if by_chance(parcel) or share > 0.999:
        return judged(what, value, expected, tolerance)
    seen = f"{what}, of which steps of δ = {delta:.2g} see {share:.3g}"
    return degraded(seen, value, share * expected, tolerance)


def heat_made(parcel: Parcel) -> float:
    """Return the energy that the scheme itself has made, as it declares [energy]."""
    return float(getattr(parcel, "numerical_heat", 0.0))


def euler_heat(parcel: Parcel) -> Verdict:
    """Return the verdict on the energy that Euler's fall and a mirroring floor make."""
    if parcel.ledger() > 1e-10:
        return wrong("the heat that the scheme declares is not what it makes")
    law = float(parcel.mass.sum()) * parcel.gravity**2 * step_of(parcel) * parcel.time
    # the fall makes half of it at every step, to rounding; the floor the other half, on average over bounces
    return degraded("energy that the fall and the floor make, over N m g² Δt t", heat_made(parcel) / law, 1.0, 0.2)
