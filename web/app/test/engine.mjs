// The engine in Node against the program: the same questions, the same documents, byte for byte.
//
//   ENGINE=jurist_web.wasm JURIST=jurist node --test web/app/test/engine.mjs

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { MAPPED, limits } from "./examples.mjs";
import { instance } from "./instance.mjs";
import { randomModels } from "./models.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const jurist = process.env.JURIST ?? join(root, "target/release/jurist");
const folder = mkdtempSync(join(tmpdir(), "jurist-engine-"));
after(() => rmSync(folder, { recursive: true }));

const engine = await instance();

/** What the program writes about a text, and its exit status. */
function program(text, ...args) {
  const file = join(folder, "model.toml");
  writeFileSync(file, text);
  const [command, ...options] = args;
  const { status, stdout } = spawnSync(jurist, [command, file, ...options], { encoding: "utf8", maxBuffer: 1 << 28 });
  return { status, output: stdout };
}

/** The same in WebAssembly; a refusal has the program's status. */
function page(text, ...args) {
  const [command, ...options] = args;
  const reply = engine.ask({ ask: "program", model: text, arguments: [command, "-", ...options] });
  assert.equal(reply.defect, undefined, `${args.join(" ")}: ${reply.defect}`);
  if (reply.refused || reply.undefined !== undefined) return { status: 2, output: "" };
  return { status: reply.status, output: reply.output };
}

function same(name, text, ...args) {
  const expected = program(text, ...args);
  assert.notEqual(expected.status, 3, `${name}: the program does not decide jurist ${args.join(" ")}`);
  const found = page(text, ...args);
  assert.deepEqual(found, expected, `${name}: jurist ${args.join(" ")}`);
  return expected;
}

const examples = readdirSync(join(root, "examples")).filter((file) => file.endsWith(".toml"));

for (const file of examples) {
  const name = file.replace(".toml", "");
  test(`verdict, limits and map of ${name} are those of the program`, () => {
    const text = readFileSync(join(root, "examples", file), "utf8");
    const { model, check } = engine.ask({ ask: "describe", model: text });
    assert.ok(check.accepted && model, file);
    same(name, text, "verdict", "--json");
    const names = model.parameters.map((p) => p.name);
    for (const parameter of names.filter((p) => limits(name, p))) same(name, text, "intervals", "--param", parameter, "--json");
    if (MAPPED.has(name)) same(name, text, "map", "-x", names[0], "-y", names[1], "--json");
  });
}

test("five hundred random models have the answers of the program", () => {
  let decided = 0;
  for (const [k, text] of randomModels(500).entries()) {
    same(`model ${k}:\n${text}\n`, text, "verdict", "--json");
    const { output } = same(`model ${k}:\n${text}\n`, text, "intervals", "--param", "K", "--json");
    decided += Number(output.includes('"decimal"'));
  }
  assert.ok(decided > 100, `only ${decided} have a limit`);
});

test("a text that is no model is refused with the program's own words and places", () => {
  const text = 'time = "discrete"\n[parameters]\nK = { nominal = 1 }\n[loop]\ncharacteristic = "z^2 + K_x"\n';
  const { check, model, text: words } = engine.ask({ ask: "describe", model: text });
  assert.equal(model, null);
  assert.equal(check.diagnostics[0].code, "E-unknown-name");
  assert.deepEqual([check.diagnostics[0].place.line, check.diagnostics[0].place.column], [5, 25]);
  const file = join(folder, "model.toml");
  writeFileSync(file, text);
  const { stderr } = spawnSync(jurist, ["verdict", file], { encoding: "utf8", env: { ...process.env, NO_COLOR: "1" } });
  assert.equal(words, stderr.trimEnd().replaceAll(file, "model.toml"));
});

test("a certificate that the engine makes is accepted by the checker, and not with another limit", () => {
  const model = readFileSync(join(root, "examples/drive.toml"), "utf8");
  const { certificate } = engine.ask({ ask: "certificate", model, set: [["T", "1e-4"]], free: "K_pwm" });
  const { proved } = engine.ask({ ask: "check", model, certificate });
  assert.match(proved, /K_pwm/);
  const changed = certificate.replace(/"1\/10000"/, '"1/9999"');
  assert.notEqual(changed, certificate);
  assert.equal(engine.ask({ ask: "check", model, certificate: changed }).proved, undefined);
});

test("hostile requests get an answer and no trap", () => {
  const asks = [null, 1, [], {}, { ask: "nothing" }, { ask: "program", model: null, arguments: [] }];
  for (const request of asks) assert.equal(typeof engine.ask(request), "object");
  const deep = `time = "discrete"\n[parameters]\nK = 1\n[loop]\ncharacteristic = "${"(".repeat(20000)}z${")".repeat(20000)}"\n`;
  assert.equal(engine.ask({ ask: "describe", model: deep }).model, null);
  for (const text of ["\u0000", "\ud800", "=", "a".repeat(100000)]) assert.equal(engine.ask({ ask: "describe", model: text }).model, null);
});

test("a map by boxes has the boxes of the program, and the same ones each time that its work is counted", () => {
  const model = readFileSync(join(root, "examples/dead-time-pi.toml"), "utf8");
  const map = (more) => engine.ask({ ask: "map", model, set: [["T_i", "8"]], x: "K_c", y: "theta", ...more });
  const { output } = program(model, "map", "-x", "K_c", "-y", "theta", "--undecided", "1/20", "--json");
  const { boxes, areas, window } = JSON.parse(output);
  const found = map({ method: "auto", undecided: "1/20" });
  for (const verdict of ["stable", "unstable", "undecided"]) {
    assert.equal(found.boxes[verdict].length, boxes.filter((b) => b.verdict === verdict).length, verdict);
    const share = (t) => t.split("/").reduce((a, b) => a / b);
    assert.ok(Math.abs(Number(found.shares[verdict]) - 100 * share(areas[verdict]) / share(areas.window)) < 0.1, verdict);
  }
  assert.deepEqual([found.x.upper, found.y.upper, found.long, found.stopped], [Number(window.x[1]), Number(window.y[1]), false, false]);
  assert.match(found.text, /K_c .*against theta in s .*, by boxes/);
  // A third of the work is not enough for so little: what is undecided then is the same again.
  const part = map({ method: "boxes", undecided: "1/100", work: 1_000_000 });
  assert.equal(part.stopped, true);
  assert.ok(Number(part.shares.undecided) > 1);
  assert.deepEqual(map({ method: "boxes", undecided: "1/100", work: 1_000_000 }), part);
  // Such a loop has no exact map, and the engine says so.
  assert.equal(map({}).refused.diagnostics[0].code, "E-dead-time");
});

test("an exact map that takes more work than is allowed becomes boxes", () => {
  const model = readFileSync(join(root, "examples/drive.toml"), "utf8");
  const map = (more) => engine.ask({ ask: "map", model, set: [], x: "T", y: "K_pwm", undecided: "1/10", ...more });
  assert.ok(map({ method: "auto" }).walls.length > 0);
  const short = map({ method: "auto", work: 200_000 });
  assert.deepEqual([short.long, short.walls], [true, undefined]);
  assert.equal(map({ method: "exact", work: 200_000 }).boxes, undefined);
});

test("the rightmost roots, the response and the place to cut of a loop with dead time", () => {
  const model = readFileSync(join(root, "examples/dead-time-pi.toml"), "utf8");
  same("dead-time-pi", model, "roots", "--json");
  same("dead-time-pi", model, "margins", "--json");
  const { roots, response } = engine.ask({ ask: "point", model, set: [], response: true });
  assert.deepEqual(roots, { rightmost: true });
  const [{ name, points, final }] = response.signals;
  assert.deepEqual([name, response.unit, final], ["y", "s", 1]);
  assert.ok(points.length > 100 && Math.abs(points.at(-1) - 1) < 0.05, `${points.slice(-2)}`);
  // Nothing comes through before the dead time is over.
  assert.ok(points.every((v, k) => k % 2 === 0 || points[k - 1] > 2.9 || v === 0));
  const smith = model.replace('input = "r - y"', 'input = "r - y - w"') + '[[block]]\nname = "predictor"\ninput = "u"\noutput = "w"\ntransfer = "K_p*(1 - exp(-theta*s))/(T_p*s + 1)"\n';
  assert.equal(page(smith, "margins", "--json").status, 2);
  const { cut } = engine.ask({ ask: "describe", model: smith }).model;
  assert.equal(cut, "controller");
  same("smith", smith, "margins", "--at", cut, "--json");
});

test("the roots of a picture are those of the exact polynomial", () => {
  const model = 'time = "discrete"\n[parameters]\nK = 2\n[loop]\ncharacteristic = "(z - 1/2)^2*(z^2 + K)"\n';
  const { roots } = engine.ask({ ask: "point", model, set: [], response: true });
  const rounded = roots.at.map(([re, im, k]) => [Number(re.toFixed(12)), Number(im.toFixed(12)), k]);
  const root = Number(Math.SQRT2.toFixed(12));
  assert.deepEqual(rounded.sort((a, b) => a[1] - b[1]), [[0, -root, 1], [0.5, 0, 2], [0, root, 1]].map((r) => r.map((v) => v + 0)));
});
