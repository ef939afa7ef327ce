r"""Elementary functions from +, -, \*, /, square roots and whole-number arithmetic alone.

C libraries differ in the last digit of a logarithm, and so do numpy's own loops between processors. IEEE 754 fixes each
of the five operations above to the last bit. So a function that is made of them alone, in one order, gives the same
bits on every processor and in every browser, compiled or not. Each function here is within one unit in the last place
of the true value, `lgamma` from 2 on within 1.5 (a test compares them with 60-digit arithmetic).

Python runs them as they are written; a kernel that calls them has them compiled into it: the bits are the same.
`log_of_normal`, `log1p`, `expm1` and `circle` also take arrays when Python calls them.

References
----------
The polynomials, and how arguments are reduced, are those of fdlibm 5.3 as found in FreeBSD's msun and in musl 1.2:
"Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved. Developed at SunSoft, a Sun Microsystems, Inc.
business. Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is
preserved." The cube root is by B. D. Evans (FreeBSD) after W. Kahan.
"""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel

_LN2_HIGH = 6.93147180369123816490e-01
_LN2_LOW = 1.90821492927058770002e-10
_SMALLEST_NORMAL = 2.0**-1022
_ONE = 0x3FF0000000000000
_ROOT_HALF = 0x3FE6A09E00000000
_MANTISSA = 0x000FFFFFFFFFFFFF
_TURN = 2.0 * math.pi
_TURN_HIGH, _TURN_LOW, _TURN_REST = 6.283185243606567, 6.357301884918343e-08, 2.4492935982947064e-16


@kernel(plain=True)
def _polynomial(x, coefficients):
    """Return c0 + c1 x + c2 x^2 + ..., from the highest power down."""
    total = coefficients[len(coefficients) - 1]
    for k in range(len(coefficients) - 2, -1, -1):
        total = coefficients[k] + x * total
    return total


_LOG_ODD = (3.999999999940941908e-01, 2.222219843214978396e-01, 1.531383769920937332e-01)
_LOG_EVEN = (6.666666666666735130e-01, 2.857142874366239149e-01, 1.818357216161805012e-01, 1.479819860511658591e-01)


@kernel(plain=True)
def _log_near_one(f, c):
    """Return log(1 + f) - f, for 1 + f from sqrt(1/2) to sqrt(2); c is added where it is small."""
    half = 0.5 * f * f
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    return s * (half + (z * _polynomial(w, _LOG_EVEN) + w * _polynomial(w, _LOG_ODD))) + c - half


@kernel(plain=True)
def log_of_normal(x):
    """Return the natural logarithm of a finite number of at least 2^-1022.

    >>> [float(each) for each in log_of_normal(np.array([1.0, 2.0]))]
    [0.0, 0.6931471805599453]
    """
    bits = np.float64(x).view(np.int64) + (_ONE - _ROOT_HALF)
    k = (bits >> 52) - 0x3FF
    f = np.int64((bits & _MANTISSA) + _ROOT_HALF).view(np.float64) - 1.0
    return _log_near_one(f, k * _LN2_LOW) + f + k * _LN2_HIGH


@kernel(plain=True)
def log(x):
    """Return the natural logarithm: ``-inf`` of 0, NaN below.

    >>> float(log(10.0)), float(log(0.0))
    (2.302585092994046, -inf)
    """
    if x >= _SMALLEST_NORMAL:
        return log_of_normal(x) if x < math.inf else math.inf
    if x > 0.0:
        return log_of_normal(x * 2.0**54) - 54.0 * (_LN2_HIGH + _LN2_LOW)
    return -math.inf if x == 0.0 else math.nan


@kernel(plain=True)
def log1p(x):
    """Return log(1 + x) of a finite number above -1, accurate where x is small.

    >>> float(log1p(1e-20))
    1e-20
    """
    u = 1.0 + x
    v = u - 1.0
    c = ((1.0 - (u - v)) + (x - v)) / u  # the rounding error of the sum, exactly, over u
    bits = np.float64(u).view(np.int64) + (_ONE - _ROOT_HALF)
    k = (bits >> 52) - 0x3FF
    f = np.int64((bits & _MANTISSA) + _ROOT_HALF).view(np.float64) - 1.0
    return _log_near_one(f, k * _LN2_LOW + c) + f + k * _LN2_HIGH


@kernel(plain=True)
def _power_of_two(k):
    """Return 2^k for k from -1022 to 1023."""
    return np.int64((k + 0x3FF) << 52).view(np.float64)


_EXP = (
    1.66666666666666019037e-01, -2.77777777770155933842e-03, 6.61375632143793436117e-05, -1.65339022054652515390e-06,
    4.13813679705723846039e-08,
)  # fmt: skip
_EXPM1 = (
    1.0, -3.33333333333331316428e-02, 1.58730158725481460165e-03, -7.93650757867487942473e-05,
    4.00821782732936239552e-06, -2.01099218183624371326e-07,
)  # fmt: skip


@kernel(plain=True)
def exp(x):
    """Return the exponential.

    >>> float(exp(0.0)), float(exp(-1000.0)), float(exp(1000.0))
    (1.0, 0.0, inf)
    """
    x = min(max(x, -800.0), 800.0) if x == x else x
    k = np.rint(1.44269504088896338700e00 * x) if x == x else 0.0
    high = x - k * _LN2_HIGH
    low = k * _LN2_LOW
    r = high - low
    z = r * r
    c = r - z * _polynomial(z, _EXP)
    y = 1.0 + (r * c / (2.0 - c) - low + high)
    # in two steps, as 2^k itself may lie beyond the largest number, or below the smallest normal one
    first = np.int64(k) >> 1
    return y * _power_of_two(first) * _power_of_two(np.int64(k) - first)


@kernel(plain=True)
def expm1(x):
    """Return exp(x) - 1, accurate where x is small, for x up to 709.

    >>> float(expm1(1e-20)), float(expm1(-1000.0))
    (1e-20, -1.0)
    """
    x = np.maximum(x, -60.0)
    k = np.rint(1.44269504088896338700e00 * x)
    high = x - k * _LN2_HIGH
    low = k * _LN2_LOW
    r = high - low
    c = (high - r) - low
    half = 0.5 * r
    square = r * half
    q = _polynomial(square, _EXPM1)
    t = 3.0 - q * half
    e = square * ((q - t) / (6.0 - r * t))
    e = (r * (e - c) - c) - square
    scale = _power_of_two(np.int64(k))
    half_off = (k == 1.0) & (r < -0.25)  # 2 (r + 1/2), where the sum is exact, and not 2 r + 1
    return scale * ((r + half_off * 0.5) - e) + (1 - half_off) * (scale - 1.0)


_SINE = (8.33333333332248946124e-03, -1.98412698298579493134e-04, 2.75573137070700676789e-06)
_COSINE = (4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05)
_COSINE_HIGH = (-2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11)


@kernel(plain=True)
def circle(turns):
    """Return cosine and sine of an angle given in turns (one turn is 2 pi), from 0 to 1.

    >>> tuple(float(each) for each in circle(0.125))
    (0.7071067811865476, 0.7071067811865476)
    """
    quarter = np.rint(4.0 * turns)
    y = turns - 0.25 * quarter  # exact, and at most an eighth
    # 2 pi y in two parts: the products of the halves of both factors are exact
    x = _TURN * y
    large = y * 134217729.0
    high = large - (large - y)
    low = y - high
    rest = ((_TURN_HIGH * high - x) + _TURN_LOW * high + _TURN_HIGH * low) + _TURN_LOW * low + _TURN_REST * y
    z = x * x
    w = z * z
    r = _polynomial(z, _SINE) + z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)
    v = z * x
    sine = x - ((z * (0.5 * rest - v * r) - rest) + v * 1.66666666666666324348e-01)
    r = z * _polynomial(z, _COSINE) + w * w * _polynomial(z, _COSINE_HIGH)
    half = 0.5 * z
    w = 1.0 - half
    cosine = w + (((1.0 - w) - half) + (z * r - x * rest))
    # by quarters of a turn: whether the two are swapped, and their signs; adding zero is exact
    n = np.int64(quarter)
    odd = np.float64(n & 1)
    even = 1.0 - odd
    first = np.float64(1 - ((n + 1) & 2))
    second = np.float64(1 - (n & 2))
    return first * (even * cosine + odd * sine), second * (even * sine + odd * cosine)


@kernel(plain=True)
def cbrt(x):
    """Return the cube root of 0 or a normal number above 0.

    >>> float(cbrt(27.0)), float(cbrt(0.0))
    (3.0, 0.0)
    """
    if not 0.0 < x < math.inf:
        return x
    # to five digits, then to 23 bits, then one step of Newton's method
    word = (np.float64(x).view(np.int64) >> 32) // 3 + 715094163
    t = np.int64(word << 32).view(np.float64)
    r = (t * t) * (t / x)
    t *= (1.87595182427177009643 + r * (-1.88497979543377169875 + r * 1.621429720105354466140)) + (r * r) * r * (
        -0.758397934778766047437 + r * 0.145996192886612446982
    )
    t = np.int64((np.float64(t).view(np.int64) + 0x80000000) & -0x40000000).view(np.float64)
    r = x / (t * t)
    return t + t * ((r - t) / (t + t + r))


@kernel(plain=True)
def root(x, degree):
    """Return the first, second or third root of a number that is not negative.

    >>> [float(root(64.0, degree)) for degree in (1, 2, 3)]
    [64.0, 8.0, 4.0]
    """
    return x if degree == 1 else math.sqrt(x) if degree == 2 else cbrt(x)


@kernel(plain=True)
def _log_in_parts(x):
    """Return the natural logarithm of a normal number as a sum of two, to some 70 bits."""
    bits = np.float64(x).view(np.int64) + (_ONE - _ROOT_HALF)
    k = (bits >> 52) - 0x3FF
    f = np.int64((bits & _MANTISSA) + _ROOT_HALF).view(np.float64) - 1.0
    large = k * _LN2_HIGH  # exact
    high = large + f
    part = high - large
    lost = (large - (high - part)) + (f - part)
    return high, _log_near_one(f, k * _LN2_LOW) + lost


_STIRLING = (
    8.33333333333329678849e-02, -2.77777777728775536470e-03, 7.93650558643019558500e-04, -5.95187557450339963135e-04,
    8.36339918996282139126e-04, -1.63092934096575273989e-03,
)  # fmt: skip
_TWO_UP = (
    -7.72156649015328655494e-02, 2.14982415960608852501e-01, 3.25778796408930981787e-01, 1.46350472652464452805e-01,
    2.66422703033638609560e-02, 1.84028451407337715652e-03, 3.19475326584100867617e-05,
)  # fmt: skip
_TWO_DOWN = (
    1.0, 1.39200533467621045958e+00, 7.21935547567138069525e-01, 1.71933865632803078993e-01,
    1.86459191715652901344e-02, 7.77942496381893596434e-04, 7.32668430744625636189e-06,
)  # fmt: skip


@kernel(plain=True)
def lgamma(x):
    r"""Return :math:`\ln \Gamma(x)` for x from 1e-300 to 1e290; below 2, where it has zeros, the error is absolute.

    >>> float(lgamma(2.0)), round(float(lgamma(11.0)), 9), round(math.log(math.factorial(10)), 9)
    (0.0, 15.104412573, 15.104412573)
    """
    if x < 2.0:
        return _lgamma_to_eight(x + 2.0) - log(x * (x + 1.0))
    if x < 8.0:
        return _lgamma_to_eight(x)
    z = 1.0 / x
    y = z * z
    w = 4.18938533204672725052e-01 + z * _polynomial(y, _STIRLING)
    # Stirling: (x - 1/2) (ln x - 1) + w, the product in two parts (Dekker 1971, doi:10.1007/BF01397083)
    high, low = _log_in_parts(x)
    b = high - 1.0
    low += (high - b) - 1.0
    a = x - 0.5
    product = a * b
    large = a * 134217729.0
    a_high = large - (large - a)
    a_low = a - a_high
    large = b * 134217729.0
    b_high = large - (large - b)
    b_low = b - b_high
    lost = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
    return product + (lost + a * low + w)


@kernel(plain=True)
def _lgamma_to_eight(x):
    """Return ln gamma from 2 to 8: that of 2 + y, y below 1, and the logarithm of what lies between."""
    n = np.floor(x)
    y = x - n
    p = y * _polynomial(y, _TWO_UP)
    q = _polynomial(y, _TWO_DOWN)
    z = 1.0
    while n > 2.0:
        n -= 1.0
        z *= y + n
    high, low = _log_in_parts(z)
    return high + (0.5 * y + (p / q + low))
