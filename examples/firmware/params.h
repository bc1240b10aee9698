/* Gains of the speed controller, as the firmware is compiled with them. */
#ifndef SPEED_PARAMS_H
#define SPEED_PARAMS_H

#define SPEED_TS    0.0005f         /* sample time, s */
#define SPEED_KP    (0.35f)         /* A s/rad */
#define SPEED_KI    12.0f           /* A/rad */

static const float SPEED_ALPHA = 0.25f; /* share of a new sample in the speed filter */

#endif
