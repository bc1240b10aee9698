// Splits the engine in two: node split.mjs ENGINE.wasm FIRST.wasm REST.wasm
//
// The first part has the functions that the first screens call, the rest is loaded behind them. Which those are is seen by calling: the
// questions of the page are put to a copy of the engine that keeps account. It needs wasm-split of binaryen.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { withoutPlaceholders } from "./placeholders.mjs";
import { randomModels } from "./test/models.mjs";
import { moduleOf } from "./test/instance.mjs";

const [engine, first, rest] = process.argv.slice(2);
if (!rest) {
  console.error("usage: node split.mjs ENGINE.wasm FIRST.wasm REST.wasm");
  process.exit(2);
}
const examples = join(dirname(fileURLToPath(import.meta.url)), "../../examples");
const scratch = mkdtempSync(join(tmpdir(), "jurist-split-"));
const counting = join(scratch, "counting.wasm");
const profile = join(scratch, "profile");
const split = (...args) => execFileSync("wasm-split", ["--all-features", ...args]);

try {
  split("--instrument", engine, "-o", counting);
  const { instantiate } = await moduleOf("instance.ts");
  const instance = await instantiate(await WebAssembly.compile(readFileSync(counting)));
  firstScreens(instance.ask);
  writeFileSync(profile, account(instance.exports));
  split(engine, `--profile=${profile}`, "-o1", first, "-o2", rest);
  writeFileSync(first, withoutPlaceholders(readFileSync(first)));
} finally {
  rmSync(scratch, { recursive: true });
}

/** What the page asks about the drive before anything is touched and while it is dragged, and about any other model until it has a verdict. */
function firstScreens(ask) {
  const program = (model, ...args) => ask({ ask: "program", model, arguments: args });
  const options = (set) => set.flatMap(([name, value]) => ["--set", `${name}=${value}`]);
  const at = (model, set) => {
    program(model, "verdict", "-", "--json", ...options(set));
    ask({ ask: "point", model, set, response: true });
  };
  const common = (model) => {
    const described = ask({ ask: "describe", model });
    const set = (described.model?.parameters ?? []).filter((p) => p.nominal !== null).map((p) => [p.name, p.nominal]);
    // At the nominal values the page names none.
    for (const given of [[], options(set)]) program(model, "verdict", "-", "--json", ...given);
    return set;
  };
  const read = (file) => readFileSync(join(examples, file), "utf8");
  const drive = read("drive.toml");
  const set = common(drive);
  at(drive, set);
  const [y, x] = set.map(([name]) => name);
  const but = (...names) => set.filter(([name]) => !names.includes(name));
  const along = (name, set) => {
    program(drive, "intervals", "-", "--param", name, "--json", ...options(set));
    program(drive, "locus", "-", "--param", name, "--json", "--quiet", ...options(set));
  };
  for (const name of [x, y]) along(name, but(name));
  // Few values of a parameter call the rare branches of a locus.
  for (const value of ["0.01", "1/3", "549.99", "551", ...Array.from({ length: 24 }, (_, k) => `${25 * (k + 1)}`)]) {
    at(drive, [[y, value], ...but(y)]);
    along(x, [[y, value]]);
  }
  for (const [across, up] of [[x, y], [y, x]]) ask({ ask: "map", model: drive, set: [], x: across, y: up, method: "auto", undecided: "1/20", work: 1e9 });
  for (const command of ["margins", "bode"]) program(drive, command, "-", "--json", ...options(set));
  ask({ ask: "describe", model: drive.replace(`${y} = {`, "K = {") });
  program(null, "new", "--list");
  for (const file of readdirSync(examples)) if (file.endsWith(".toml")) common(read(file));
  for (const text of randomModels(100)) {
    const [[name]] = common(text);
    program(text, "intervals", "-", "--param", name, "--json");
  }
}

/** Which functions were called, in the form that wasm-split reads. */
function account({ __write_profile: write, memory }) {
  const length = write(0, 0);
  const at = memory.grow(Math.ceil(length / 65536)) * 65536;
  write(at, length);
  return new Uint8Array(memory.buffer, at, length);
}
