// What is asked about a model with its values: one question for each lane.

import { sets } from "./copy.js";
import type { Speed } from "./engine.js";
import type { Question } from "./questions.js";

/** A text that is a model, and what is chosen about it. */
export interface Chosen {
  text: string;
  /** Names and values as they are set. */
  values: [string, string][];
  /** Those of them that differ from nominal. */
  differing: [string, string][];
  /** The parameter of the root locus; none is empty. */
  focus: string;
  /** Where the loop is cut; empty for what the program chooses. */
  cut: string;
  axes: [string, string] | undefined;
  /** How the map is made: what the engine chooses, or exactly, however long that takes. */
  method: "auto" | "exact";
  /** What the answers so far ask for beside the rest. */
  also: Also;
}

/** What is asked once an answer says that there is more of it. */
export interface Also {
  /** The rightmost roots, of a loop that has infinitely many. */
  rightmost: boolean;
  /** Smaller boxes, as often: once of themselves, and once more where somebody waits for them. */
  finer: number;
}

/** The share of the window that boxes may leave undecided, and the work that they and an exact map may take: first to see something soon, then
 * to see more. The work is counted in the engine's units, so that the same answer comes from every machine; of the examples ten million took
 * 0.2 to 2.1 seconds, a hundred million 0.1 to 6. What somebody asks for may take a minute. */
const COARSE = { undecided: "1/20", work: 10_000_000 };
const FINE = { undecided: "1/100", work: 100_000_000 };
const SMALL = { undecided: "1/400", work: 1_000_000_000 };

/** The lanes of a map, each of more than the one before. */
export const MAPS = ["map", "finer map", "map of smaller boxes"] as const;

function program(lane: string, speed: Speed, model: string, ...args: string[]): Question {
  const request = { ask: "program", model, arguments: args };
  return { lane, speed, request };
}

/** The verdict alone, which is asked for before the model is known. */
export function verdictOf(text: string, differing: [string, string][]): Question {
  return program("verdict", "quick", text, "verdict", "-", "--json", ...sets(differing));
}

/** Everything that the panels show: the verdict and the pictures that move at once, then what takes longer. */
export function questionsAbout({ text, values, differing, focus, cut, axes, method, also }: Chosen): Question[] {
  const without = (...names: string[]) => values.filter(([name]) => !names.includes(name));
  const point = { ask: "point", model: text, set: values, response: true };
  const all: Question[] = [verdictOf(text, differing), { lane: "point", speed: "quick", request: point }];
  for (const [name] of values) {
    all.push(program(`intervals ${name}`, "quick", text, "intervals", "-", "--param", name, "--json", ...sets(without(name))));
  }
  if (focus) {
    const locus = program("locus", "slow", text, "locus", "-", "--param", focus, "--json", "--quiet", ...sets(without(focus)));
    all.push({ ...locus, subject: focus });
  }
  if (also.rightmost) all.push(program("roots", "slow", text, "roots", "-", "--json", ...sets(values)));
  const at = cut ? ["--at", cut] : [];
  for (const [lane, command] of [["frequency response", "bode"], ["margins", "margins"]] as const) {
    all.push({ ...program(lane, "slow", text, command, "-", "--json", ...at, ...sets(values)), subject: cut });
  }
  if (axes) {
    const map = { ask: "map", model: text, set: without(...axes), x: axes[0], y: axes[1] };
    const subject = JSON.stringify(axes);
    const requests = [method === "auto" ? { ...map, method, ...COARSE } : map, { ...map, method: "boxes", ...FINE }, { ...map, method: "boxes", ...SMALL }];
    for (const [k, request] of requests.slice(0, 1 + also.finer).entries()) all.push({ lane: MAPS[k]!, speed: "long", subject, request });
  }
  return all;
}
