r"""The adiabats of saturated air: reference values for a lifted parcel and a wet bulb (Emanuel 1994, chapter 4).

On the reversible adiabat the parcel carries all its liquid; on the pseudo-adiabat the liquid leaves as it forms.
Units are SI; mixing ratios are kg per kg of dry air; `nuclei_heat` is a heat capacity per molecule of air, in k.
"""

import numpy as np

from atmosbox.theory import _water
from atmosbox.theory._water import AIR_HEAT, BINDING, EXCESS, MASS_RATIO
from atmosbox.theory.constants import GAS_CONSTANT, WATER
from atmosbox.theory.environment import DRY_AIR_GAS_CONSTANT


def water_latent_heat_vaporization(temperature):
    """Return the latent heat of vaporisation [J/kg], by Kirchhoff's law."""
    return (BINDING - EXCESS * np.asarray(temperature)) * (GAS_CONSTANT / WATER.molar_mass)


def moist_entropy(pressure, temperature, total_water, nuclei_heat=0.0):
    """Return the entropy of air with its vapour and liquid [J/(kg K)]; it is conserved in an ascent without rain."""
    p, t, water = (np.asarray(each, float) for each in (pressure, temperature, total_water))
    return DRY_AIR_GAS_CONSTANT * _water.entropy(p, t, water / MASS_RATIO, np.asarray(AIR_HEAT + nuclei_heat))


def reversible_adiabat(pressure, pressure0, temperature0, total_water, nuclei_heat=0.0):
    """Return the temperature of air that is lifted and keeps all its water [K]."""
    p, p0, t0, water = (np.asarray(each, float) for each in (pressure, pressure0, temperature0, total_water))
    water, heat = water / MASS_RATIO, np.asarray(AIR_HEAT + nuclei_heat)
    return _water.temperature_of_entropy(_water.entropy(p0, t0, water, heat), p, water, heat)


def pseudoadiabat(pressure, pressure0, temperature0, nuclei_heat=0.0):
    """Return the temperature of air that stays just saturated [K]."""
    p = np.asarray(pressure, float)
    heat = AIR_HEAT + nuclei_heat
    return _water.rained_temperature(p.ravel(), float(pressure0), float(temperature0), 0.0, heat).reshape(p.shape)
