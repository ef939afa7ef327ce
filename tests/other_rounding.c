/* A C library whose functions round their last digit otherwise, three times in four: to be loaded before the real one. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static double moved(double y)
{
    uint64_t bits;
    if (!isfinite(y) || y == 0.0 || y == 1.0)
        return y;
    memcpy(&bits, &y, 8);
    bits = bits * 0x9E3779B97F4A7C15u >> 62;
    return bits == 0 ? y : nextafter(y, bits == 1 ? -INFINITY : INFINITY);
}

#define ONE(f)                                   \
    double f(double x)                           \
    {                                            \
        static double (*real)(double);           \
        if (!real)                               \
            real = dlsym(RTLD_NEXT, #f);         \
        return moved(real(x));                   \
    }
#define TWO(f)                                   \
    double f(double x, double y)                 \
    {                                            \
        static double (*real)(double, double);   \
        if (!real)                               \
            real = dlsym(RTLD_NEXT, #f);         \
        return moved(real(x, y));                \
    }
ONE(exp) ONE(exp2) ONE(expm1) ONE(log) ONE(log2) ONE(log10) ONE(log1p) ONE(sin) ONE(cos) ONE(tan) ONE(atan)
ONE(sinh) ONE(cosh) ONE(tanh) ONE(cbrt) ONE(lgamma) ONE(tgamma) TWO(pow) TWO(hypot) TWO(atan2)
