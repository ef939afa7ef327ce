"""A weakly stirred column: its temperature gradient, to first order in the rate of stirring, by quadrature."""

import math

from scipy.integrate import quad


def gradient_of_weak_stirring(share, depth, conductivity, *, freedom, parcel, lifts):
    r"""Return dT/dz over the rate of exchanges by any of the lifts, at the height with a share of the molecules below.

    Mass, kT, gravity and molecules per area are 1. Parcels that come to an isothermal column with the potential
    temperature of elsewhere bring the energy :math:`\tfrac f2 [(p/p')^{R/c_p} - 1]`. What is brought above a height
    must be conducted through it, for nothing passes the ceiling: dT/dz is that sum over the conductivity.
    """
    ceiling = math.exp(-depth) / -math.expm1(-depth)
    power = 2.0 / (freedom + 2.0)

    def pressure(r):
        return ceiling + 1.0 - r

    def climbs(r, lift):
        room = 1.0 - lift - parcel
        return max(min(r, room) - max(r - parcel, 0.0), 0.0) / room

    def brought(r, lift):
        total = 0.0
        for other, rate in ((r + lift, climbs(r, lift)), (r - lift, climbs(r - lift, lift))):
            if rate > 0.0:
                total += 0.5 * freedom * rate * ((pressure(r) / pressure(other)) ** power - 1.0)
        return total

    total = 0.0
    for lift in lifts:
        corners = {parcel, lift, lift + parcel, 1.0 - lift - parcel, 1.0 - lift, 1.0 - parcel}
        inside = [corner for corner in sorted(corners) if share < corner < 1.0]
        total += quad(brought, share, 1.0, args=(lift,), points=inside or None, limit=200)[0]
    return total / len(lifts) / conductivity
