// What the engine says of a text that is a model.

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
}
