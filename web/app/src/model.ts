// What the engine says of a text that is a model.

import { plain } from "./numbers.js";
import type { Parameter } from "./parameters.js";

export interface Model {
  title: string | null;
  time: "discrete" | "continuous";
  rules: string;
  parameters: Parameter[];
  constants: { name: string; value: string; number: string | null }[];
  inputs: string[];
  outputs: string[];
  blocks: [string, string, string, string][];
  tolerances: boolean;
  /** Where the loop is cut at first, where the program does not choose: the block that compares, else a signal that comes back. */
  cut: string | null;
}

/** The same with its numbers as people write them: `0.0001` for `1/10000`. */
export function withDecimals(model: Model): Model {
  const text = (t: string | null) => (t === null ? null : plain(t));
  return {
    ...model,
    parameters: model.parameters.map((p) => ({ ...p, nominal: text(p.nominal), min: text(p.min), max: text(p.max) })),
    constants: model.constants.map((c) => ({ ...c, value: plain(c.value) })),
  };
}

/** Where the loop may be cut: signals and parameters. */
export function signals({ blocks, parameters, cut }: Model): string[] {
  const names = parameters.map((p) => p.name);
  return [...new Set([...(cut === null ? [] : [cut]), ...blocks.flatMap((b) => b[2].split(", ")), ...names])].filter((n) => n !== "" && n !== "u" && n !== "y" || names.includes(n));
}
