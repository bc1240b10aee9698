// Which questions about the examples are asked twice: what the program itself answers in a second or two.

/** Undecided after seconds, in the program too: only the verdict is asked for. */
export const LONG = new Set(["anti-alias-filter", "dc-servo", "drive-hold", "lcl-inverter", "smith-predictor", "neutral-loop", "fiat-dedra", "two-mass-drive"]);

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
