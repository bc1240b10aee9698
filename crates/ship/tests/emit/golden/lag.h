/*
 * lag: a controller, direct form 2 transposed.
 *
 * Signals and states are numbers of 32 bits of IEEE 754, not scaled: 1 is 1.
 * Each product and each sum is rounded, to nearest with ties to even, in the order that is written.
 * States are zero at first: call lag_init once, then lag_step at each sample.
 * Compile with -ffp-contract=off where the compiler is gcc, which does not know the pragma STDC FP_CONTRACT.
 */

#ifndef LAG_H
#define LAG_H

#include <float.h>

#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "intermediate results must have the precision of their type: on x86 compile with -msse2 -mfpmath=sse"
#endif
#if FLT_RADIX != 2 || FLT_MANT_DIG != 24 || FLT_MAX_EXP != 128
#error "numbers of floating point must be those of IEEE 754"
#endif
#ifdef __FAST_MATH__
#error "compile without -ffast-math: the order of operations and their rounding count"
#endif

static const float LAG_B1 = 0x1.555556p-2f; /* b1 = 1/3 */
static const float LAG_A1 = -0x1.555556p-1f; /* a1 = -2/3 */

typedef struct {
    float s_1;
} lag_state;

/* The controller at rest: all states are zero. */
static inline void lag_init(lag_state *s)
{
    s->s_1 = 0x0p+0f;
}

/* One sample: the outputs from the inputs, and then the next states. */
static inline float lag_step(lag_state *s, float u)
{
#if defined(__clang__) || !defined(__GNUC__)
#pragma STDC FP_CONTRACT OFF
#endif
    const float y = s->s_1;
    const float next_1 =
        LAG_B1 * u
        - LAG_A1 * y;
    s->s_1 = next_1;
    return y;
}

#endif /* LAG_H */
