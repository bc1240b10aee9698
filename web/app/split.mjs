// Splits the engine in two: node split.mjs ENGINE.wasm FIRST.wasm REST.wasm
//
// The first part has the functions that the first screens call, the rest is loaded behind them. Which those are is seen by calling: the
// questions of the page are put to a copy of the engine that keeps account. It needs wasm-split of binaryen.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
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
} finally {
  rmSync(scratch, { recursive: true });
}

/** What the page asks about the drive before anything is touched, and about any other model until it has a verdict. */
function firstScreens(ask) {
  const program = (model, ...args) => ask({ ask: "program", model, arguments: args });
  const common = (model) => {
    const described = ask({ ask: "describe", model });
    program(model, "verdict", "-", "--json");
    ask({ ask: "point", model, set: [], response: true });
    return described.model?.parameters.map((p) => p.name) ?? [];
  };
  const read = (file) => readFileSync(join(examples, file), "utf8");
  const drive = read("drive.toml");
  const [y, x] = common(drive);
  for (const name of [x, y]) program(drive, "intervals", "-", "--param", name, "--json");
  ask({ ask: "map", model: drive, set: [], x, y });
  program(drive, "locus", "-", "--param", y, "--json");
  program(drive, "margins", "-", "--json");
  program(drive, "bode", "-", "--json");
  ask({ ask: "describe", model: drive.replace(`${y} = {`, "K = {") });
  program(null, "new", "--list");
  for (const file of readdirSync(examples)) if (file.endsWith(".toml")) common(read(file));
  for (const text of randomModels(100)) for (const name of common(text).slice(0, 1)) program(text, "intervals", "-", "--param", name, "--json");
}

/** Which functions were called, in the form that wasm-split reads. */
function account({ __write_profile: write, memory }) {
  const length = write(0, 0);
  const at = memory.grow(Math.ceil(length / 65536)) * 65536;
  write(at, length);
  return new Uint8Array(memory.buffer, at, length);
}
