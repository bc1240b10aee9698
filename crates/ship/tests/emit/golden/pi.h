/*
 * pi: a controller, direct form 1.
 *
 * Model: loop.toml, block C. Stable as stored.
 * SHA-256 of the model: 0123..
 *
 * Signals and states are integers of 16 bits, -32768 to 32767; 1 unit = 2^-10.
 * Each sum is exact, with at most 30 of 64 bits, and rounded once, to nearest, ties away from zero.
 * What does not fit becomes the greatest or the least number.
 * States are zero at first: call pi_init once, then pi_step at each sample.
 */

#ifndef PI_H
#define PI_H

#include <stdint.h>

static const int32_t PI_B0 = 4096; /* b0 = 0.5 */
static const int32_t PI_B1 = -4095; /* b1 = -0.4999 */

typedef struct {
    int16_t u_1;
    int16_t y_1;
} pi_state;

/* The controller at rest: all states are zero. */
static inline void pi_init(pi_state *s)
{
    s->u_1 = 0;
    s->y_1 = 0;
}

/* What does not fit becomes the greatest or the least number. */
static inline int64_t pi_fit(int64_t v)
{
    if (v > INT64_C(32767)) {
        return INT64_C(32767);
    } else if (v < -INT64_C(32768)) {
        return -INT64_C(32768);
    } else {
        return v;
    }
}

/* Divides by 2^13 and rounds to nearest, ties away from zero. */
static inline int64_t pi_round13(int64_t v)
{
    if (v < INT64_C(0)) {
        return (v - INT64_C(4096)) / INT64_C(8192);
    } else {
        return (v + INT64_C(4096)) / INT64_C(8192);
    }
}

/* One sample: the outputs from the inputs, and then the next states. */
static inline int16_t pi_step(pi_state *s, int16_t u)
{
    const int64_t y_sum =
        (int64_t)PI_B0 * (int64_t)u
        + (int64_t)PI_B1 * (int64_t)s->u_1
        + (int64_t)s->y_1 * INT64_C(8192);
    const int16_t y = (int16_t)pi_fit(pi_round13(y_sum));
    s->u_1 = u;
    s->y_1 = y;
    return y;
}

#endif /* PI_H */
