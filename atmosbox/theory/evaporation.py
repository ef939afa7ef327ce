r"""The end of evaporation and condensation: temperature and vapour of air in equilibrium with water.

Evaporation takes its heat from the air, the vapour and the liquid. It ends at saturation, or when no liquid is left.
Units are SI; heat capacities of single bodies are in k.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import (
    AIR_HEAT,
    LIQUID_HEAT,
    VAPOR_HEAT,
    checked_not_negative,
    checked_positive,
    checked_temperature,
)

__all__ = ["EvaporationEquilibrium", "evaporation_equilibrium", "wet_bulb_temperature"]


class EvaporationEquilibrium(NamedTuple):
    """Air, vapour and liquid in equilibrium."""

    temperature: FloatArray
    """Temperature [K]."""
    vapor_pressure: FloatArray
    """Vapour pressure [Pa]: that of saturation while there is liquid."""
    vapor: FloatArray
    """Molecules of vapour [1]."""
    liquid: FloatArray
    """Molecules of liquid [1]; 0 if the pool has dried up."""


def evaporation_equilibrium(
    pressure: ArrayLike,
    temperature: ArrayLike,
    air: ArrayLike,
    vapor: ArrayLike,
    liquid: ArrayLike,
    liquid_temperature: ArrayLike | None = None,
    nuclei_heat: ArrayLike = 0.0,
) -> EvaporationEquilibrium:
    r"""Return the final state of a pool under air at constant pressure, without heat from outside.

    The enthalpy is constant, :math:`(N_a c_{pd} + N_v c_{pv} + n c_l + C) T - n \varphi`, and
    :math:`N_v / N_a = e / (p - e)`, where e is :math:`e_s(T)` or, if all of the pool has evaporated, less. The enthalpy
    rises with temperature, at saturation including the latent heat, so there is exactly one solution, found to rounding
    (Bohren and Albrecht 1998, Atmospheric Thermodynamics, chapter 6).

    Parameters
    ----------
    pressure, temperature
        Pressure of the gas p [Pa], and temperature of air and vapour at the start [K].
    air
        Molecules of air :math:`N_a`.
    vapor
        Molecules of vapour at the start, :math:`N_a e / (p - e)` at a vapour pressure e. An excess over saturation
        condenses.
    liquid
        Molecules of liquid at the start n.
    liquid_temperature
        Temperature of the liquid at the start [K]; that of the air if none is given.
    nuclei_heat
        Total heat capacity C of condensation nuclei at the temperature of the liquid [k].

    Raises
    ------
    ValueError
        If there is no air, a temperature lies outside 0 to 647.096 K, or a number is negative.

    Examples
    --------
    Half saturated air of 20 degC over a pool of a tenth as many molecules as the air has, and of a thousandth:

    >>> vapor = 1e5 * 1169.0 / (1000e2 - 1169.0)
    >>> end = evaporation_equilibrium(1000e2, 293.15, 1e5, vapor, [1e4, 1e2])
    >>> (end.temperature - 273.15).round(1), end.liquid.round(-1)
    (array([14.3, 18.5]), array([9530.,    0.]))
    """
    p = checked_positive(as_floats(pressure), "pressure")
    gas = checked_positive(checked_temperature(as_floats(temperature)), "temperature")
    given = gas if liquid_temperature is None else as_floats(liquid_temperature)
    pool = checked_positive(checked_temperature(given, "liquid_temperature"), "liquid_temperature")
    n_air = checked_positive(as_floats(air), "air")
    v0 = checked_not_negative(as_floats(vapor), "vapor") / n_air
    n0 = checked_not_negative(as_floats(liquid), "liquid") / n_air
    nuclei = checked_not_negative(as_floats(nuclei_heat), "nuclei_heat") / n_air

    water = v0 + n0
    heat = AIR_HEAT + nuclei
    enthalpy = (AIR_HEAT + VAPOR_HEAT * v0) * gas + (LIQUID_HEAT * n0 + nuclei) * pool - n0 * _water.BINDING
    p, water, heat, enthalpy, n_air = np.broadcast_arrays(p, water, heat, enthalpy, n_air)
    all_vapor = enthalpy / (heat + VAPOR_HEAT * water)
    e = p * water / (1.0 + water)
    wet = (all_vapor <= 0.0) | (_water.saturation(all_vapor) < e)
    t: FloatArray = np.array(all_vapor)
    if np.any(wet):
        p_wet, w_wet, c_wet, h_wet = p[wet], water[wet], heat[wet], enthalpy[wet]

        def excess(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            v = _water.saturated_vapor(p_wet, x)
            held = (c_wet + VAPOR_HEAT * v + LIQUID_HEAT * (w_wet - v)) * x - (w_wet - v) * _water.BINDING
            return held - h_wet, _water.heat_of_saturated(v, x, w_wet, c_wet)

        t[wet] = _water.root(excess, np.maximum(all_vapor[wet], _water.COLDEST), _water.dewpoint_of(e[wet]))
    v = np.where(wet, np.minimum(_water.saturated_vapor(p, t), water), water)
    return EvaporationEquilibrium(t, p * v / (1.0 + v), n_air * v, n_air * (water - v))


def wet_bulb_temperature(pressure: ArrayLike, temperature: ArrayLike, dewpoint: ArrayLike) -> FloatArray:
    r"""Return the thermodynamic wet-bulb temperature: that of air saturated by water of the final temperature [K].

    Adiabatic saturation at constant pressure (American Meteorological Society, Glossary of Meteorology). Per molecule
    of air, with v molecules of vapour,

    .. math:: (c_{pd} + v c_{pv}) (T - T_w) = (v_s(T_w) - v)\, L(T_w) .

    Parameters
    ----------
    pressure, temperature
        Pressure [Pa] and temperature T [K].
    dewpoint
        Dewpoint [K], not above the temperature; 0 K in dry air.

    Raises
    ------
    ValueError
        If the air is supersaturated, or water boils at its dewpoint.

    Notes
    -----
    MetPy's ``wet_bulb_temperature`` is another quantity, Normand's: the cloud base is brought down along a
    pseudo-adiabat (Knox, Nevius and Knox 2017, doi:10.1175/BAMS-D-16-0246.1). In air of 0 to 30 degC that is not very
    dry it is lower by 0.05 to 0.3 K; at 40 degC and a dewpoint of -10 degC, by 0.9 K. A psychrometer shows the result
    of the exchange of heat and vapour at its bulb: with the coefficient of the WMO, 6.53e-4 (1 + 9.44e-4 t) K^-1, it
    reads 0.1 K above this temperature at 20 degC and a dewpoint of 0 degC, and 0.2 K at 40 degC.

    Examples
    --------
    >>> round(float(wet_bulb_temperature(993e2, 305.15, 288.15)) - 273.15, 2)
    20.65
    """
    p = checked_positive(as_floats(pressure), "pressure")
    t = checked_positive(checked_temperature(as_floats(temperature)), "temperature")
    td = checked_temperature(as_floats(dewpoint), "dewpoint")
    if not np.all(td <= t):
        raise ValueError("dewpoint must not exceed temperature: supersaturated air has no wet-bulb temperature.")
    p, t, td = np.broadcast_arrays(p, t, td)
    v = _water.saturated_vapor(p, td)
    if not np.all(np.isfinite(v)):
        raise ValueError("dewpoint is so high that water boils at this pressure: there would be no air.")
    heat = AIR_HEAT + VAPOR_HEAT * v

    def excess(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        saturated, warm = _water.saturated_vapor(p, x), _water.latent(x)
        more = saturated - v
        slope = heat + saturated * (1.0 + saturated) * warm * warm - _water.EXCESS * more
        return more * warm * x - heat * (t - x), slope

    boiling = _water.dewpoint_of(p * (1.0 - 1e-9))
    return _water.root(excess, np.maximum(td, min(1.0, float(np.min(t)))), np.minimum(t, boiling))
