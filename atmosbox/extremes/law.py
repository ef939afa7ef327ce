r"""What is known of approximate engines: by which law each is off.

A step sees a contact late by up to its length :math:`\Delta t`, and misses pairs that graze in passing. With
:math:`\delta = \Delta t \sqrt{kT/m}/\sigma`, in a dilute gas,

.. math:: \frac{\nu}{\nu_{exact}} = 1 - \frac{8}{3} \delta^2, \qquad
          \frac{Z - 1}{Z_{exact} - 1} = 1 - \frac{4}{\sqrt{\pi}} \delta ,

and in a dense one an error that is proportional to the step, once that is much shorter than the way between two
contacts.

Euler's fall makes the energy :math:`m g^2 \Delta t / 2` per molecule and time, and so does a floor that mirrors
what has gone through it. Direct simulation Monte Carlo knows nobody's place within a cell: its molecules
collide as often as points that are surrounded by nobody, and press as an ideal gas does.
"""

from atmosbox.engine.marching import MarchingParcel
from atmosbox.engine.parcel import Parcel
from atmosbox.extremes.verdict import Verdict, degraded, judged, wrong

__all__ = ["by_chance", "euler_heat", "heat_made", "judged_contacts", "step_of"]


def by_chance(parcel: Parcel) -> bool:
    """Return whether an engine lets molecules meet by chance and not where they are."""
    return parcel.ideal and bool(parcel.diameter.any())


def step_of(parcel: Parcel) -> float:
    """Return the length of a step [time], 0 for an engine without."""
    return parcel.time_step if isinstance(parcel, MarchingParcel) else 0.0


def judged_contacts(
    parcel: Parcel, what: str, value: float, expected: float, tolerance: float, distance: float = 1.0
) -> Verdict:
    """Return the verdict on contacts of a gas at kT = m = 1: as many as expected, or fewer by the law of the step.

    ``distance`` is that of the centres at a contact [length].
    """
    delta = step_of(parcel) / distance
    share = 1.0 - 8.0 / 3.0 * delta**2
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
