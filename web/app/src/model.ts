// What the engine says of a text that is a model.

import { isNumber, plain, plainIn, same } from "./numbers.js";
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

/** Texts of values by `section name`, where each stands in a line of its own, or in a table of its own. */
function literals(text: string): Map<string, string> {
  const found = new Map<string, string>();
  let [section, of]: (string | undefined)[] = ["", undefined];
  for (const line of text.split("\n")) {
    const head = /^\s*\[+\s*([^\]]+?)\s*\]/.exec(line)?.[1];
    if (head !== undefined) [section, of] = head.split(/\s*\.\s*/);
    const [, key, value = ""] = /^\s*["']?([\w-]+)["']?\s*=\s*(.*)$/.exec(line) ?? [];
    if (key === undefined || (of !== undefined && !/^(nominal|value)$/.test(key))) continue;
    const literal = value.startsWith("{") ? /\b(?:nominal|value)\s*=\s*("[^"]*"|'[^']*'|[^,}\s]+)/ : /^("[^"]*"|'[^']*'|[^#\s]+)/;
    const written = literal.exec(value)?.[1];
    if (written !== undefined) found.set(`${section} ${of ?? key}`, written.replace(/^["']|["']$/g, ""));
  }
  return found;
}

/** The same with its numbers as the text writes them, `1e-4` for `1/10000`; where it writes none, as people do. */
export function asWritten(model: Model, text: string): Model {
  const found = literals(text);
  const number = (value: string, key: string) => {
    const written = found.get(key);
    return written !== undefined && isNumber(written) && same(written, value) ? written : plainIn(plain(value));
  };
  const maybe = (value: string | null, key = "") => (value === null ? null : number(value, key));
  return {
    ...model,
    parameters: model.parameters.map((p) => ({ ...p, nominal: maybe(p.nominal, `parameters ${p.name}`), min: maybe(p.min), max: maybe(p.max) })),
    constants: model.constants.map((c) => ({ ...c, value: number(c.value, `constants ${c.name}`) })),
    blocks: model.blocks.map(([name, input, output, does]) => [name, input, output, plainIn(does)]),
  };
}

/** Where the loop may be cut: signals and parameters. */
export function signals({ blocks, parameters, cut }: Model): string[] {
  const names = parameters.map((p) => p.name);
  return [...new Set([...(cut === null ? [] : [cut]), ...blocks.flatMap((b) => b[2].split(", ")), ...names])].filter((n) => n !== "" && n !== "u" && n !== "y" || names.includes(n));
}
