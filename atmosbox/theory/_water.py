r"""Water and air in units of the molecule: heat capacities in k, energies in K, water as molecules per molecule of air.

These functions are shared by the files on moist air. With :math:`\ell = L / kT`, the latent heat of one molecule over
kT, the law of Rankine and Kirchhoff is :math:`d \ln e_s / d \ln T = \ell`.
"""

from collections.abc import Callable

import numpy as np

from atmosbox.theory._array import FloatArray
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, WATER

AIR_HEAT: float = 2.5 + DRY_AIR.rotational_dof / 2.0
VAPOR_HEAT: float = 2.5 + WATER.rotational_dof / 2.0
LIQUID_HEAT = 9.14
EXCESS: float = LIQUID_HEAT - VAPOR_HEAT
TRIPLE_TEMPERATURE = 273.16
TRIPLE_PRESSURE = 611.2
TRIPLE_LATENT_HEAT = 2.50084e6
BINDING: float = TRIPLE_LATENT_HEAT * WATER.molar_mass / GAS_CONSTANT + EXCESS * TRIPLE_TEMPERATURE
CRITICAL_TEMPERATURE = 647.096
MASS_RATIO: float = WATER.molar_mass / DRY_AIR.molar_mass
REFERENCE_PRESSURE = 1e5
COLDEST = 1.0  # here the vapour pressure is zero in float64


def checked_temperature(temperature: FloatArray, name: str = "temperature") -> FloatArray:
    """Return the temperatures, or raise ``ValueError`` unless water can be liquid at all of them."""
    if not np.all((temperature >= 0.0) & (temperature <= CRITICAL_TEMPERATURE)):
        raise ValueError(f"{name} must lie from 0 K to the critical point of water, {CRITICAL_TEMPERATURE} K.")
    return temperature


def checked_positive(values: FloatArray, name: str) -> FloatArray:
    """Return the values, or raise ``ValueError`` unless all of them are finite and above zero."""
    if not np.all((values > 0.0) & np.isfinite(values)):
        raise ValueError(f"{name} must be finite and above 0.")
    return values


def checked_not_negative(values: FloatArray, name: str) -> FloatArray:
    """Return the values, or raise ``ValueError`` unless all of them are finite and at least zero."""
    if not np.all((values >= 0.0) & np.isfinite(values)):
        raise ValueError(f"{name} must be finite and at least 0.")
    return values


def latent(temperature: FloatArray) -> FloatArray:
    """Return the latent heat of a molecule over kT; below 1 K the value at 1 K."""
    return BINDING / np.maximum(temperature, COLDEST) - EXCESS


def saturation(temperature: FloatArray) -> FloatArray:
    """Return the saturation vapour pressure [Pa], infinite above the critical point."""
    t = np.minimum(np.maximum(temperature, COLDEST), CRITICAL_TEMPERATURE)
    exponent = BINDING * (1.0 / TRIPLE_TEMPERATURE - 1.0 / t) - EXCESS * np.log(t / TRIPLE_TEMPERATURE)
    pressure: FloatArray = np.where(temperature > CRITICAL_TEMPERATURE, np.inf, TRIPLE_PRESSURE * np.exp(exponent))
    return pressure


def saturated_vapor(pressure: FloatArray, temperature: FloatArray) -> FloatArray:
    """Return the molecules of vapour per molecule of air at saturation, infinite where water boils."""
    e = np.asarray(saturation(temperature))
    room = np.asarray(pressure - e)
    boils = room <= 0.0
    vapor: FloatArray = np.where(boils, np.inf, e / np.where(boils, 1.0, room))
    return vapor


def temperature_of_level(slope: FloatArray, binding: FloatArray, level: FloatArray) -> FloatArray:
    r"""Return T that solves :math:`s \ln(T/T_t) + b / T - b / T_t = q`, on the side where b / T > s.

    Newton's method for u = b / sT in :math:`u - \ln u = c`, which is convex: after the first step u decreases to the
    root. This is the branch -1 of Lambert's function, without its overflow. An infinite level gives 0 K.
    """
    s, b, q = np.broadcast_arrays(slope, binding, level)
    triple = b / (s * TRIPLE_TEMPERATURE)
    hot = np.maximum(b / (s * CRITICAL_TEMPERATURE), 1.0 + 1e-9)
    never = np.isinf(q)
    c = np.maximum(triple - np.log(triple) + np.where(never, 0.0, q) / s, hot - np.log(hot))
    u = np.maximum(c + np.log(c), hot)
    for _ in range(60):
        step = (u - np.log(u) - c) / (1.0 - 1.0 / u)
        u = u - step
        if np.all(np.abs(step) <= 1e-15 * u):
            break
    temperature: FloatArray = np.where(never, 0.0, np.minimum(b / (s * u), CRITICAL_TEMPERATURE))
    return temperature


def dewpoint_of(vapor_pressure: FloatArray) -> FloatArray:
    """Return the temperature of saturation at a vapour pressure, at most the critical one; 0 K without vapour."""
    with np.errstate(divide="ignore"):
        level = np.log(TRIPLE_PRESSURE) - np.log(vapor_pressure)
    return temperature_of_level(np.asarray(EXCESS), np.asarray(BINDING), level)


def root(
    function: Callable[[FloatArray], tuple[FloatArray, FloatArray]], lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """Return the zero of an increasing function, by Newton's method from above, or bisection outside the bracket.

    `function` returns the value and the derivative. A root above the bracket is refused with ``ValueError``.
    """
    low, high = np.broadcast_arrays(lower, upper)
    value, derivative = function(high)
    if np.any(-value > 1e-9 * derivative * np.maximum(np.abs(high), 1.0)):
        raise ValueError("the answer would lie above the critical point of water, where there is no liquid.")
    x = high
    for _ in range(200):
        low, high = np.where(value < 0.0, x, low), np.where(value < 0.0, high, x)
        new = x - value / derivative
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        done = np.all(np.abs(new - x) <= 1e-13 * np.maximum(np.abs(x), 1.0))  # the next step would be rounding error
        x = new
        if done:
            break
        value, derivative = function(x)
    return x


def entropy(pressure: FloatArray, temperature: FloatArray, water: FloatArray, heat: FloatArray) -> FloatArray:
    """Return the entropy of air, its vapour and its liquid per molecule of air, in k.

    `heat` is the heat capacity of the air and of condensation nuclei per molecule of air, in k.
    """
    vapor = np.minimum(saturated_vapor(pressure, temperature), water)
    wet = vapor < water
    y = np.log(temperature / TRIPLE_TEMPERATURE)
    e = pressure * vapor / (1.0 + vapor)
    air = heat * y - np.log((pressure - e) / REFERENCE_PRESSURE)
    triple = BINDING / TRIPLE_TEMPERATURE - EXCESS
    cloudy = LIQUID_HEAT * water * y + vapor * latent(temperature)
    clear = water * (VAPOR_HEAT * y + triple) - _x_log_y(water, e / TRIPLE_PRESSURE)
    total: FloatArray = air + np.where(wet, cloudy, clear)
    return total


def temperature_of_entropy(target: FloatArray, pressure: FloatArray, water: FloatArray, heat: FloatArray) -> FloatArray:
    """Return the temperature at which air and water have the entropy ``target`` per molecule of air."""
    s, p, w, c = np.broadcast_arrays(target, pressure, water, heat)
    e = p * w / (1.0 + w)
    triple = BINDING / TRIPLE_TEMPERATURE - EXCESS
    rest = s + np.log((p - e) / REFERENCE_PRESSURE) + _x_log_y(w, e / TRIPLE_PRESSURE) - w * triple
    clear = TRIPLE_TEMPERATURE * np.exp(rest / (c + VAPOR_HEAT * w))
    cloudy = saturation(clear) < e
    temperature: FloatArray = np.array(clear)
    if np.any(cloudy):
        s, p, w, c = s[cloudy], p[cloudy], w[cloudy], c[cloudy]

        def excess(y: FloatArray) -> tuple[FloatArray, FloatArray]:
            t = TRIPLE_TEMPERATURE * np.exp(y)
            vapor = saturated_vapor(p, t)
            return _saturated_entropy(p, vapor, t, w, c) - s, heat_of_saturated(vapor, t, w, c)

        bounds = [np.log(t / TRIPLE_TEMPERATURE) for t in (clear[cloudy], dewpoint_of(e[cloudy]))]
        temperature[cloudy] = TRIPLE_TEMPERATURE * np.exp(root(excess, *bounds))
    return temperature


def _x_log_y(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return x ln y, which is 0 where x is 0."""
    product: FloatArray = x * np.log(np.where(x > 0.0, y, 1.0))
    return product


def _saturated_entropy(
    pressure: FloatArray, vapor: FloatArray, temperature: FloatArray, water: FloatArray, heat: FloatArray
) -> FloatArray:
    y = np.log(temperature / TRIPLE_TEMPERATURE)
    dry = np.log(pressure / (1.0 + vapor) / REFERENCE_PRESSURE)
    total: FloatArray = (heat + LIQUID_HEAT * water) * y - dry + vapor * latent(temperature)
    return total


def heat_of_saturated(vapor: FloatArray, temperature: FloatArray, water: FloatArray, heat: FloatArray) -> FloatArray:
    """Return the heat capacity at constant pressure of saturated air with all its water, including the latent heat."""
    warm = latent(temperature)
    total: FloatArray = heat + VAPOR_HEAT * vapor + LIQUID_HEAT * (water - vapor) + vapor * (1.0 + vapor) * warm * warm
    return total


def saturated_slope(pressure: FloatArray, temperature: FloatArray, liquid: FloatArray, heat: FloatArray) -> FloatArray:
    """Return d ln T / d ln p of saturated air that is lifted with this liquid, whether new liquid stays or leaves."""
    vapor = saturated_vapor(pressure, temperature)
    capacity = heat_of_saturated(vapor, temperature, vapor + liquid, heat)
    slope: FloatArray = (1.0 + vapor) * (1.0 + vapor * latent(temperature)) / capacity
    return slope


def rained_temperature(
    pressure: FloatArray, pressure0: float, temperature0: float, liquid: float, heat: float
) -> FloatArray:
    """Return the temperature of saturated air with a constant amount of liquid, along pressures that rise or fall.

    The water that condenses leaves with its entropy. Runge-Kutta method of order 8 for ln T over ln p.
    """
    from scipy import integrate  # loads slowly

    water, warm = np.asarray(liquid), np.asarray(heat)

    def slope(log_pressure: float, y: FloatArray) -> FloatArray:
        t = np.minimum(np.exp(y), CRITICAL_TEMPERATURE)
        return saturated_slope(np.exp(np.asarray(log_pressure)), t, water, warm)

    where = np.log(pressure)
    start, values = np.log(pressure0), np.full(pressure.shape, np.log(temperature0))
    for side in (where < start, where > start):
        if np.any(side):
            end = where[side][np.argmax(np.abs(where[side] - start))]
            curve = integrate.solve_ivp(
                slope, (start, end), [np.log(temperature0)], "DOP853", dense_output=True, rtol=1e-12, atol=1e-13
            )
            values[side] = curve.sol(where[side])[0]
            if not (curve.success and np.all(values[side] <= np.log(CRITICAL_TEMPERATURE))):
                raise ValueError(
                    f"no saturated air of this curve has {float(np.exp(end)):g} Pa: no liquid is that warm."
                )
    temperature: FloatArray = np.exp(values)
    return temperature
