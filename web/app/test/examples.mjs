// Which questions about the examples are asked twice, of the program and of the page. A list, and not a time limit: what is asked
// must not depend on how fast or busy the machine is.

/** The program itself thinks about these for a second and more, WebAssembly ten times as long: dead times, holds, filters of high order. */
const LIMITS_TAKE_LONG = new Map([
  ["anti-alias-filter", ["w_f"]],
  ["dc-servo", ["T_m"]],
  ["drive-hold", ["T"]],
  ["drive-pwm", ["K_pwm", "T"]],
  ["drive-ship", ["T"]],
  ["drive-two-rates", ["K_ps"]],
  ["lcl-inverter", ["Lg"]],
  ["two-mass-drive", ["J_l"]],
]);

/** Whether the limits of a parameter are there in a second or two. */
export const limits = (example, parameter) => !LIMITS_TAKE_LONG.get(example)?.includes(parameter);

/** Whether the page, which asks for the limits of all parameters at once, has them all in that time. */
export const page = (example) => !LIMITS_TAKE_LONG.has(example);

/** The map of the first two parameters is there after a second. */
export const MAPPED = new Set([
  "de-gaston-safonov",
  "digital-pll",
  "drive",
  "drive-blocks",
  "heavy-ball",
  "lcl-active-damping",
  "lcl-grid-current",
  "pmsm-current-loop",
  "unstable-disc",
  "vicino-tesi-milanese",
]);
