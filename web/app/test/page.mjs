// The page in headless Chromium.
//
//   PAGE=target/page JURIST=jurist node --test web/app/test/page.mjs
//
// PICTURES names a folder for pictures of it.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { gzipSync } from "node:zlib";
import { folder, fromFile, opened, root, serve } from "./browser.mjs";
import { MAPPED, page as answeredSoon } from "./examples.mjs";
import { random } from "./models.mjs";

const jurist = process.env.JURIST ?? join(root, "target/release/jurist");
const pictures = process.env.PICTURES;
if (pictures) mkdirSync(pictures, { recursive: true });
const scratch = mkdtempSync(join(tmpdir(), "jurist-page-"));
let page;
before(async () => {
  page = await opened(fromFile);
});
after(async () => {
  await page?.close();
  rmSync(scratch, { recursive: true });
});

const drive = readFileSync(join(root, "examples/drive.toml"), "utf8");
const shot = async (name) => pictures && writeFileSync(join(pictures, `${name}.png`), await page.whole());

/** The program's document. */
function program(text, ...args) {
  const file = join(scratch, "model.toml");
  writeFileSync(file, text);
  const [command, ...options] = args;
  const { status, stdout } = spawnSync(jurist, [command, file, ...options], { encoding: "utf8", maxBuffer: 1 << 28 });
  assert.notEqual(status, 3, `the program does not decide jurist ${args.join(" ")}`);
  return JSON.parse(stdout);
}

test("the drive is answered before a key is pressed", async () => {
  await page.open(fromFile);
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "stable");
  assert.equal(await page.value('document.getElementById("verdict-roots").textContent'), "6 of 6 roots inside the unit circle");
  const labels = await page.value('[...document.querySelectorAll(".ends button")].map((b) => b.textContent)');
  assert.ok(labels.includes("0.038101") && labels.includes("550.94"), labels.join());
  assert.match(await page.value('document.getElementById("map-sentence").textContent'), /stable region.* K_pwm = 110, T = 1e-4, stable/);
  assert.match(await page.value('document.getElementById("open-loop-sentence").textContent'), /gain margin 13.99 dB, lower −69.21 dB, phase margin 71.87°/);
  assert.ok((await page.value('document.querySelectorAll("#locus .root").length')) >= 6);
  assert.ok((await page.value('document.querySelectorAll("#response .line").length')) === 1);
  assert.ok((await page.value('document.querySelectorAll("#map .region").length')) >= 1);
  const ticks = await page.value('[...document.querySelectorAll("#open-loop .tick[text-anchor=end]")].map((e) => e.textContent)');
  assert.ok(ticks.includes("−180") && ticks.length >= 6, `ticks of the Bode plot: ${ticks}`);
  assert.deepEqual(page.complaints(), []);
  await shot("desk");
});

const examples = readdirSync(join(root, "examples")).filter((file) => file.endsWith(".toml"));

test("verdict and limits of the examples, and 200 points of their maps, are those of the program", async () => {
  const next = random(200);
  let points = 0;
  const each = 200 / MAPPED.size;
  for (const file of examples) {
    const name = file.replace(".toml", "");
    if (!answeredSoon(name)) continue;
    const text = readFileSync(join(root, "examples", file), "utf8");
    const expected = program(text, "analyze", "--json");
    await page.take(text, { map: MAPPED.has(name) });
    assert.equal(await page.value('document.getElementById("verdict-word").textContent'), expected.verdict.verdict, file);
    const shown = await page.value("[...jurist.page.sets].map(([name, stable]) => [name, stable])");
    // Where the model requires something, so does the page: that is a question for each parameter.
    const required = text.includes("[require]");
    const setOf = (p) => (required ? program(text, "intervals", "--param", p.parameter, "--json").stable : p.stable);
    assert.deepEqual(new Map(shown), new Map(expected.parameters.filter((p) => p.stable).map((p) => [p.parameter, setOf(p)])), file);
    await page.value('document.getElementById("map").scrollIntoView({ block: "center" })');
    for (let k = 0; MAPPED.has(name) && k < each; k++, points++) {
      const box = await page.value('(() => { const r = document.querySelector("#map .ground").getBoundingClientRect(); return { x: r.x, y: r.y, width: r.width, height: r.height }; })()');
      const at = { x: box.x + box.width * next(), y: box.y + box.height * next() };
      await page.mouse("mousePressed", at.x, at.y);
      await page.mouse("mouseReleased", at.x, at.y);
      await page.until("!jurist.engine.seats.quick.busy && jurist.engine.seats.quick.waiting.length === 0");
      const values = await page.value("[...jurist.page.values]");
      const found = program(text, "verdict", "--json", ...values.flatMap(([name, value]) => ["--set", `${name}=${value}`]));
      assert.equal(await page.value('document.getElementById("verdict-word").textContent'), found.verdict, `${file} at ${values}`);
    }
  }
  assert.equal(points, 200);
  assert.deepEqual(page.complaints(), []);
});

test("a slider moves the value, its keys too, and the box takes exact fractions", async () => {
  await page.open(fromFile);
  const verdict = () => page.value('document.getElementById("verdict-word").textContent');
  const type = (text) => page.value(`(() => { const box = document.querySelector(".parameter input"); box.value = ${JSON.stringify(text)}; box.dispatchEvent(new Event("input", { bubbles: true })); box.dispatchEvent(new Event("change", { bubbles: true })); })()`);
  await type("551");
  await page.settled();
  assert.equal(await verdict(), "unstable");
  await type("1/3");
  await page.settled();
  assert.equal(await verdict(), "stable");
  assert.equal(await page.value('jurist.page.values.get("K_pwm")'), "1/3");
  await type("no number");
  assert.equal(await page.value('document.querySelector(".parameter input").getAttribute("aria-invalid")'), "true");
  assert.equal(await page.value('jurist.page.values.get("K_pwm")'), "1/3");
  await type("110");
  await page.settled();
  await page.value('document.querySelector(".slider").focus()');
  await page.key("ArrowRight", { shift: true });
  await page.settled();
  assert.equal(await page.value('jurist.page.values.get("K_pwm")'), "550.94");
  assert.equal(await verdict(), "stable");
  await page.key("ArrowRight");
  await page.settled();
  assert.equal(await verdict(), "unstable");
  assert.match(await page.value('document.querySelector(".slider").getAttribute("aria-valuetext")'), /unstable/);
});

test("a link holds everything, and one of version 1 opens for ever", async () => {
  await page.value('jurist.page.entered("K_pwm", "1/7", true)');
  await page.settled();
  await page.until('location.hash.startsWith("#1=")');
  const hash = await page.value("location.hash");
  await page.browser.open("about:blank", 1200, 900, 1, false);
  await page.open(fromFile + hash);
  assert.equal(await page.value('jurist.page.values.get("K_pwm")'), "1/7");
  assert.equal(await page.value("jurist.page.text"), drive);
  // {"m":"time = \"discrete\"\n[parameters]\nK = 1\n[loop]\ncharacteristic = \"z - K/2\"\n","v":{"K":"3"}}
  const old = "#1=" + OLD;
  await page.browser.open("about:blank", 1200, 900, 1, false);
  await page.open(fromFile + old);
  assert.equal(await page.value('jurist.page.values.get("K")'), "3");
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "unstable");
  for (const broken of ["#1=AAAA", "#9=abc", "#1=", "#nothing"]) {
    await page.browser.open("about:blank", 1200, 900, 1, false);
    await page.open(fromFile + broken);
    assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "stable", broken);
  }
});
const OLD = "q1bKVbJSKsnMTVWwVYhRSsksTi5KLUmNUYrJiy5ILErMBXKKimNj8ryB8oZAwZz8_AIgNzkDKJkMlMssLslMBuutUtBV8NY3AmlV0lEqU7KqVvIGmm2sVFsLAA";

test("a map is cancelled in its middle, and the next answer comes from a new worker", async (t) => {
  const heavy = readFileSync(join(root, "examples/drive-filters-6.toml"), "utf8");
  await page.open(fromFile);
  await page.take(heavy, { map: false });
  const done = await page.value(`(async () => {
    const { engine, page } = jurist;
    const [x, y] = page.mapAxes;
    engine.cancel();
    const before = engine.replaced;
    // From here on nothing is loaded and nothing compiled: the new worker is made of the module that is there.
    let anew = 0;
    for (const name of ["compile", "compileStreaming"]) WebAssembly[name] = () => { anew++; throw new Error("it is kept"); };
    globalThis.fetch = () => { anew++; throw new Error("it is kept"); };
    const map = engine.ask("long", "map", { ask: "map", model: page.text, set: [], x, y });
    while (engine.busy !== "map") await new Promise((r) => setTimeout(r, 1));
    await new Promise((r) => setTimeout(r, 20));
    const begun = performance.now();
    engine.cancel();
    const reply = await engine.ask("long", "verdict", { ask: "program", model: page.text, arguments: ["verdict", "-", "--json"] });
    return { anew, took: performance.now() - begun, map: (await map) === undefined, replaced: engine.replaced - before, verdict: JSON.parse(reply.output).verdict };
  })()`);
  t.diagnostic(`an answer ${done.took.toFixed(0)} ms after the cancel`);
  assert.deepEqual([done.map, done.replaced, done.verdict, done.anew], [true, 1, "stable", 0]);
  await page.open(fromFile);
});

test("a loop with dead time has all its panels, and its map is by boxes", async () => {
  const text = readFileSync(join(root, "examples/dead-time-pi.toml"), "utf8");
  await page.open(fromFile);
  await page.take(text);
  const said = (id) => page.value(`document.getElementById("${id}-sentence").textContent`);
  const count = (what) => page.value(`document.querySelectorAll(${JSON.stringify(what)}).length`);
  assert.equal(await page.value('document.getElementById("verdict-roots").textContent'), "no roots in the right half plane");
  assert.match(await said("map"), /^K_c and T_i by boxes: [\d.]+ % of the window is proved stable, [\d.]+ % unstable, 0.\d+ % is undecided \(hatched\). There is no exact map of such a loop. The point is at K_c = 1, T_i = 8, stable.$/);
  assert.match(await page.value('document.querySelector("#map svg").textContent'), /by boxes, 0.\d+ % undecided/);
  assert.deepEqual([await count("#map .region"), await count("#map path.open"), await count("#map .outside")], [1, 1, 1]);
  assert.match(await said("locus"), /^The 10 rightmost of infinitely many roots, a pair counted once: all others are left of Re s = −1.5, proved./);
  assert.equal(await count("#locus .root"), 19);
  assert.match(await said("response"), /^y \(unit step of r\): largest/);
  assert.match(await said("open-loop"), /^Cut at controller: gain margin 8.0\d* dB.* phase margin/);
  assert.equal(await count("#open-loop .line"), 2);
  assert.equal(await page.value('[...document.querySelectorAll(".canvas")].filter((e) => !e.offsetParent).length'), 0);
  await overflow("dead time");
  await shot("dead-time");
  // What a box is proved to be is what the program says of its points.
  const next = random(7);
  const boxes = await page.value('jurist.page.known("finer map").reply');
  for (const kind of ["stable", "unstable"]) {
    for (let k = 0; k < 10; k++) {
      const [u, v, r, t] = boxes.boxes[kind][Math.floor(next() * boxes.boxes[kind].length)];
      const at = ({ lower, upper }, a, b) => String(lower + (upper - lower) * (a + (b - a) * (0.1 + 0.8 * next())));
      const [K, T] = [at(boxes.x, u, r), at(boxes.y, v, t)];
      const { verdict } = program(text, "verdict", "--json", "--set", `K_c=${K}`, "--set", `T_i=${T}`);
      assert.equal(verdict === "stable", kind === "stable", `${kind} at K_c = ${K}, T_i = ${T}: ${verdict}`);
    }
  }
  // Smaller ones for who wants them, until something else is looked at.
  const smaller = '[...document.querySelectorAll("#map .controls button")].find((b) => b.textContent === "smaller boxes")';
  assert.equal(await page.value(`${smaller}.hidden`), false);
  await page.value(`${smaller}.click()`);
  await page.settled();
  assert.match(await said("map"), /, 0\.[12]\d* % is undecided \(hatched\)\. There is no exact map/);
  assert.equal(await page.value(`${smaller}.hidden`), true);
  await page.value('jurist.page.entered("theta", "4", true)');
  await page.settled();
  assert.match(await said("map"), /, 0\.[5-9]\d* % is undecided/);
  assert.equal(await page.value(`${smaller}.hidden`), false);
  await page.value('jurist.page.entered("theta", "3", true)');
  await page.value('jurist.page.entered("K_c", "3", true)');
  await page.settled();
  assert.equal(await page.value('document.getElementById("verdict-roots").textContent'), "2 roots in the right half plane");
  assert.match(await said("locus"), /The root farthest right is 0\.\d+ \+ 0\.\d+i/);
  assert.deepEqual(page.complaints(), []);
});

test("dead times that cancel leave finitely many roots, and a neutral loop says which line they come near to", async () => {
  const said = (id) => page.value(`document.getElementById("${id}-sentence").textContent`);
  await page.open(fromFile);
  const smith = readFileSync(join(root, "examples/smith-predictor.toml"), "utf8");
  await page.take(smith.replace(/theta_process = 6/, "theta_process = 5"));
  assert.match(await said("locus"), /^The loop has \d roots: its dead times cancel. The root farthest right is −[\d.]+\./);
  await page.take(readFileSync(join(root, "examples/neutral-loop.toml"), "utf8"));
  assert.match(await said("locus"), /Infinitely many come near to the line Re s = −0\.69\d+\. The root/);
  assert.deepEqual(page.complaints(), []);
});

test("smaller boxes are cancelled and the larger ones stay; an exact map can be waited for", async () => {
  await page.open(fromFile);
  await page.take(readFileSync(join(root, "examples/drive-hold.toml"), "utf8"), { map: false });
  const said = () => page.value('document.getElementById("map-sentence").textContent');
  await page.until('jurist.engine.busy === "finer map" || jurist.page.known("finer map").now');
  await page.value("jurist.engine.cancel(true)");
  await page.settled();
  assert.match(await said(), /^K_pwm and T by boxes: .* % is undecided \(hatched\).* There is no exact map of such a loop. (Smaller boxes: undecided: cancelled. )?The point is at K_pwm = 110, T = 1e-4, stable/);
  assert.equal(await page.value('document.querySelectorAll("#map path.open").length'), 1);
  // Where the loop is cut: at the error, which the program does not choose of two loops.
  assert.equal(await page.value('document.querySelector("#open-loop select").value'), "speed controller");
  assert.match(await page.value('document.getElementById("open-loop-sentence").textContent'), /^Cut at speed controller: gain margin/);
  await overflow("behind a hold");
  await shot("hold");
  await page.take(drive.replace(/^/, "# the same once more\n"));
  const exact = 'document.querySelector("#map .controls button")';
  assert.equal(await page.value(`${exact}.hidden`), true);
  await page.value(`(() => {
    const { page } = jurist;
    const known = page.questions.known.bind(page.questions);
    const reply = { ...known("map").reply, long: true };
    page.questions.known = (lane) => (lane === "map" ? { ...known(lane), reply } : known(lane));
    page.map.show();
  })()`);
  assert.equal(await page.value(`${exact}.hidden`), false);
  await page.value(`${exact}.click()`);
  assert.equal(await page.value('jurist.page.questions.lanes().find((q) => q.lane === "map").request.work'), undefined);
  await page.open(fromFile);
});

test("where the exact map takes more than the first of the work, there are boxes until somebody waits for it", async () => {
  await page.open(fromFile);
  await page.take(readFileSync(join(root, "examples/drive-filters-4.toml"), "utf8"));
  const said = () => page.value('document.getElementById("map-sentence").textContent');
  const button = (words) => `[...document.querySelectorAll("#map .controls button")].find((b) => b.textContent === "${words}")`;
  assert.match(await said(), /by boxes: .* 0\.\d+ % is undecided \(hatched\)\. The exact map takes longer than that\./);
  assert.deepEqual([await page.value(`${button("exact map")}.hidden`), await page.value(`${button("smaller boxes")}.hidden`)], [false, false]);
  await page.value(`${button("exact map")}.click()`);
  await page.settled();
  assert.match(await said(), /: .*stable regions?, drawn green. The point is at/);
  assert.deepEqual([await page.value(`${button("exact map")}.hidden`), await page.value(`${button("smaller boxes")}.hidden`)], [true, true]);
});

test("numbers are written as in the text, and limits are roots of equations", async () => {
  await page.open(fromFile);
  assert.equal(await page.value('document.querySelectorAll(".parameter input")[1].value'), "1e-4");
  await page.value('document.getElementById("details").open = true');
  await page.until('document.querySelectorAll("#details-body h3").length === 2');
  await page.settled();
  const [first] = await page.value('[...document.querySelectorAll("#details-body tr")].filter((r) => /^root of/.test(r.textContent)).map((r) => r.querySelector("td").textContent)');
  assert.match(first, /^-?\d+\*K_pwm\^\d+ [+-] [^\[{"]* = 0$/);
  // A limit behind a hold is a zero of what is said in words.
  await page.take(readFileSync(join(root, "examples/drive-hold.toml"), "utf8"), { map: false });
  await page.until('document.querySelectorAll("#details-body h3").length === 2 && document.getElementById("details-body").textContent.includes("stable set of T")');
  const text = await page.value('document.getElementById("details-body").textContent');
  assert.match(text, /zero of|root of/);
  assert.doesNotMatch(text, /[{}"]/);
  await page.value('jurist.engine.cancel(true)');
  await page.value('document.getElementById("details").open = false');
});

test("the best gains within what is required come at a press of a button", async () => {
  await page.open(fromFile);
  await page.take(readFileSync(join(root, "examples/pi-sensitivity.toml"), "utf8"), { map: false });
  await page.value('document.getElementById("best").open = true');
  await page.until('document.getElementById("find-best") !== null');
  await page.value('document.getElementById("find-best").click()');
  await page.until('document.querySelector("#best-body pre").textContent.includes("type in")', "an answer");
  const text = await page.value('document.querySelector("#best-body pre").textContent');
  assert.match(text, /largest ki: 0\.325317411668\n/);
  assert.match(text, /at k = 0\.632974269436\n/);
  await page.value('document.getElementById("best").open = false');
});

test("what holds for all values of a name comes at a press of a button", async () => {
  await page.open(fromFile);
  await page.take(readFileSync(join(root, "examples/dc-servo.toml"), "utf8"), { map: false });
  await page.value('document.getElementById("for-all").open = true');
  await page.until('document.getElementById("find-for-all") !== null');
  await page.value('document.getElementById("for-all-ranges").value = "T_m=0.02..0.05"');
  await page.value('document.getElementById("find-for-all").click()');
  await page.until('document.querySelector("#for-all-body pre").textContent.includes("disk margin")', "an answer");
  const text = await page.value('document.querySelector("#for-all-body pre").textContent');
  assert.match(text, /for all T_m from 0\.02 to 0\.05: stable\n/);
  assert.match(text, /gain margin: at least 12\.\d+; 12\.7213/);
  await page.value('document.getElementById("for-all-ranges").value = "T_m"');
  await page.value('document.getElementById("find-for-all").click()');
  await page.until('document.querySelector("#for-all-body pre").textContent.includes("is no range")', "a refusal");
  await page.value('document.getElementById("for-all").open = false');
});

test("on a phone a model is pasted from the first screen, and its answers come into sight", async () => {
  await page.open(fromFile, 390, 844);
  const seen = (id) => page.value(`(() => { const { top, bottom, width } = document.getElementById("${id}").getBoundingClientRect(); return width > 0 && top >= -1 && bottom <= innerHeight + 1; })()`);
  assert.equal(await seen("paste-here"), true);
  await page.value('document.getElementById("paste-here").click()');
  await page.until('document.activeElement.id === "pasted"');
  await page.drawn();
  assert.deepEqual([await seen("pasted"), await seen("paste-use")], [true, true]);
  await page.value('(() => { document.getElementById("pasted").value = "z^2 + (K - 1)*z + 1/2"; document.getElementById("paste-use").click(); })()');
  await page.settled();
  assert.equal(await seen("verdict"), true);
  assert.equal(await page.value("jurist.page.model.parameters[0].name"), "K");
  await page.open(fromFile);
  assert.equal(await page.value('document.getElementById("paste-here").offsetParent'), null);
});

test("each card is printed whole, on a page or two, with every picture, from whatever width", async () => {
  await page.open(fromFile, 390, 844);
  await page.browser.send("Emulation.setEmulatedMedia", { media: "print" });
  await page.drawn();
  const cards = await page.value(`[...document.querySelectorAll(".figure")].map((f) => {
    const { width, height } = f.querySelector("svg").getBoundingClientRect();
    return { breaks: getComputedStyle(f).breakInside, drawn: f.querySelectorAll("svg .line, svg .root, svg .region").length > 0, wide: width > 100 && height > 100 };
  })`);
  assert.deepEqual(cards, Array(4).fill({ breaks: "avoid", drawn: true, wide: true }));
  await page.browser.send("Emulation.setEmulatedMedia", { media: "" });
  const paper = await page.browser.print({ printBackground: true });
  const pages = paper.toString("latin1").match(/\/Type \/Page\b/g).length;
  assert.ok(pages <= 3, `${pages} pages`);
  if (pictures) writeFileSync(join(pictures, "print.pdf"), paper);
});

test("a decimal comma is answered with the point", async () => {
  await page.open(fromFile);
  await page.value('(() => { const box = document.querySelector(".parameter input"); box.value = "12,5"; box.dispatchEvent(new Event("input", { bubbles: true })); })()');
  assert.equal(await page.value('document.querySelector(".parameter .wrong").textContent'), "a decimal point, not a comma: 12.5");
  assert.equal(await page.value('jurist.page.values.get("K_pwm")'), "110");
});

test("a defect takes its worker with it and not the page", async () => {
  await page.open(fromFile);
  // What a trap looks like from outside: the worker says so and is thrown away.
  const after = await page.value(`(async () => {
    const seat = jurist.engine.seats.quick;
    const before = jurist.engine.replaced;
    const lost = jurist.engine.ask("quick", "lost", { ask: "program", model: jurist.page.text, arguments: ["map", "-", "-x", "T", "-y", "K_pwm"] });
    while (!seat.running) await new Promise((r) => setTimeout(r, 1));
    seat.told({ id: seat.running.id, reply: { defect: "unreachable" }, took: 1, broken: true });
    const said = (await lost).defect;
    const reply = await jurist.engine.ask("quick", "again", { ask: "program", model: jurist.page.text, arguments: ["verdict", "-", "--json"] });
    return [said, jurist.engine.replaced - before, JSON.parse(reply.output).verdict];
  })()`);
  assert.deepEqual(after, ["unreachable", 1, "stable"]);
});

test("what is pasted becomes a model", async () => {
  const cases = [
    ["z^2 + (K - 1)*z + 1/2", "stable", "K"],
    ["s**3 + 3*s**2 + 3*s + 1 + K = 0;", "stable", "K"],
    ["G = tf([1], [1 2 1 0])", "stable", "K"],
    ["ct.tf([0.1, 0.09], [1, -1.9, 0.9], 0.1)", undefined, "K"],
    ["[1 6 11 6]", "stable", undefined],
  ];
  for (const [pasted, verdict, name] of cases) {
    await page.open(fromFile);
    await page.value(`(() => { document.getElementById("pasted").value = ${JSON.stringify(pasted)}; document.getElementById("paste-use").click(); })()`);
    await page.settled();
    assert.equal(await page.value('document.getElementById("paste-wrong").textContent'), "", pasted);
    if (verdict) assert.equal(await page.value('document.getElementById("verdict-word").textContent'), verdict, pasted);
    assert.equal(await page.value("jurist.page.model.parameters[0]?.name"), name, pasted);
  }
  await page.value('(() => { document.getElementById("pasted").value = "hello world"; document.getElementById("paste-use").click(); })()');
  assert.match(await page.value('document.getElementById("paste-wrong").textContent'), /no polynomial/);
});

test("a text that is no model shows the program's words at their place and keeps the last answers, in grey", async () => {
  await page.open(fromFile);
  await page.value(`jurist.page.editor.set(${JSON.stringify(drive.replace("K_pwm = {", "K_pmw = {"))})`);
  await page.until('!document.getElementById("stale").hidden');
  assert.match(await page.value('document.querySelector("#remarks pre").textContent'), /error\[E-unknown-name\]: unknown name 'K_pwm'[^]*did you mean 'K_pmw'/);
  assert.ok((await page.value('document.querySelectorAll(".cm-lintRange-error").length')) > 0);
  assert.match(await page.value('document.getElementById("stale").textContent'), /no model at the moment. What is shown below is about the last text that was a model/);
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "stable");
});

test("certificates are made, checked and told from wrong ones in the page", async () => {
  await page.open(fromFile);
  await page.value('document.getElementById("details").open = true');
  await page.until('document.querySelectorAll("#details-body h3").length === 2');
  await page.settled();
  await page.value('[...document.querySelectorAll("#details-body button")].find((b) => b.textContent.includes("stable set of K_pwm")).click()');
  await page.until('document.getElementById("details-body").textContent.includes("Proved by the checker")', "a proved certificate");
  await page.value('document.getElementById("polynomial").open = true');
  await page.until('document.querySelectorAll("#polynomial-body math").length > 6');
  await shot("drawers");
});

test("hostile text runs nothing and stays in its place", async () => {
  await page.open(fromFile);
  const evil = `<img src=x onerror="window.hit=1"><script>window.hit=1</script>`;
  const string = JSON.stringify(evil + "x".repeat(3000));
  const text = `title = ${string}\ntime = "discrete"\n[parameters]\nK = { nominal = 1, unit = ${string}, description = ${string} }\n${"n".repeat(2000)} = 1\n[loop]\ninputs = ["r"]\noutputs = ["y"]\n[[block]]\nname = ${string}\ninput = "r - y"\noutput = "y"\ntransfer = "K*${"n".repeat(2000)}/(4*z)"\n`;
  await page.take(text);
  await page.value('(() => { for (const id of ["tab-blocks", "tab-examples", "tab-text"]) document.getElementById(id).click(); for (const d of document.querySelectorAll("details")) d.open = true; })()');
  await page.settled();
  assert.equal(await page.value("jurist.page.model?.title"), evil + "x".repeat(3000));
  assert.equal(await page.value("window.hit"), undefined);
  assert.equal(await page.value('document.querySelectorAll("img:not(.cm-widgetBuffer), iframe, object, embed").length'), 0);
  assert.equal(await page.value('document.querySelectorAll("body script").length'), 1);
  await overflow("hostile");
  await shot("hostile");
  await page.take(`title = ${string}\ntime = ${string}\n[loop]\ncharacteristic = ${string}\n`);
  assert.equal(await page.value("window.hit"), undefined);
  await overflow("hostile error");
});

async function overflow(what) {
  const wide = await page.value(`(() => {
    const width = document.documentElement.clientWidth;
    if (document.documentElement.scrollWidth <= width) return [];
    return [...document.querySelectorAll("body *")].filter((e) => e.getBoundingClientRect().right > width + 1 && !e.closest(".plots, .table, .scroll, pre, math, .cm-editor, textarea")).slice(0, 3).map((e) => e.outerHTML.slice(0, 120));
  })()`);
  assert.deepEqual(wide, [], what);
  assert.ok(await page.value("document.documentElement.scrollWidth <= document.documentElement.clientWidth"), `${what}: wider than its window`);
}

for (const [name, width, height, scheme] of [["phone", 390, 844, "light"], ["phone-dark", 390, 844, "dark"], ["tablet", 820, 1180, "light"], ["desk", 1200, 900, "light"], ["desk-dark", 1200, 900, "dark"]]) {
  test(`nothing overflows and axe finds nothing: ${name}, ${width} x ${height}`, async () => {
    await page.browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: scheme }, { name: "prefers-reduced-motion", value: "reduce" }] });
    await page.open(fromFile, width, height);
    await page.value('(() => { for (const id of ["details", "polynomial"]) document.getElementById(id).open = true; for (const d of document.querySelectorAll(".figure details")) d.open = true; })()');
    await page.settled();
    await overflow(name);
    await axe(name);
    await shot(name);
    if (pictures) writeFileSync(join(pictures, `${name}-first.png`), await page.picture());
    if (name.startsWith("phone")) {
      const small = await page.value(`[...document.querySelectorAll("button, select, .slider, summary, .value input")].filter((e) => e.offsetParent && !e.closest(".ends, .cm-editor, .figure details, .more") && Math.min(e.getBoundingClientRect().width, e.getBoundingClientRect().height) < 43.5).map((e) => e.outerHTML.slice(0, 100))`);
      assert.deepEqual(small, [], "targets below 44 px");
    }
    await page.value('document.getElementById("tab-examples").click()');
    await page.until('document.querySelectorAll("#panel-examples button").length > 10');
    await axe(`${name}, examples`);
    await page.value('document.getElementById("tab-paste").click()');
    await page.value(`jurist.page.editor.set("time = 1")`);
    await page.until('!document.getElementById("stale").hidden');
    await axe(`${name}, errors`);
    await overflow(`${name}, errors`);
    await page.browser.send("Emulation.setEmulatedMedia", { features: [] });
  });
}

async function axe(what) {
  const source = readFileSync(join(root, "web/app/node_modules/axe-core/axe.min.js"), "utf8");
  await page.value(`${source};0`);
  const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];
  const found = await page.value(`axe.run(document, { preload: false, runOnly: ${JSON.stringify(tags)} }).then((r) => r.violations.map((v) => v.id + ": " + v.nodes.slice(0, 3).map((n) => n.html.slice(0, 140) + " " + (n.any[0]?.message ?? n.failureSummary)).join(" | ")))`);
  assert.deepEqual(found, [], what);
}

test("everything is reached with the keyboard alone", async () => {
  await page.open(fromFile);
  await page.value("document.activeElement.blur()");
  const seen = new Set();
  for (let k = 0; k < 120; k++) {
    await page.key("Tab");
    const at = await page.value(`(() => { const e = document.activeElement; return e === document.body ? "" : e.closest(".cm-editor") ? "editor" : e.id || e.closest("[id]")?.id + " " + (e.className.baseVal ?? e.className) + " " + (e.getAttribute("aria-label") ?? e.textContent).slice(0, 20); })()`);
    if (at === "" && k > 20) break;
    seen.add(at);
    // The editor keeps the key for itself: Escape, then Tab leaves it.
    if (at === "editor") await page.key("Escape");
  }
  const all = [...seen].join("\n");
  for (const wanted of ["share", "slider", "tab-text", "editor", "map", "Bode", "zoom in", "details"]) assert.ok(all.includes(wanted), `${wanted} is not reached:\n${all}`);
  await page.value('document.querySelector("#map svg").focus()');
  const before = await page.value('jurist.page.values.get("K_pwm")');
  await page.key("ArrowRight");
  await page.settled();
  assert.notEqual(await page.value('jurist.page.values.get("K_pwm")'), before);
  assert.equal(await page.value('document.activeElement === document.querySelector("#map svg")'), true);
  await page.value('document.getElementById("tab-text").focus()');
  await page.key("ArrowRight");
  assert.equal(await page.value("document.activeElement.id"), "tab-blocks");
  assert.equal(await page.value('document.getElementById("panel-blocks").hidden'), false);
});

test("from a server it is kept, and opens again without one", async () => {
  const server = await serve();
  const served = await opened(server.url, { online: true });
  try {
    await served.value("navigator.serviceWorker.ready.then(() => 1)");
    await served.until("navigator.serviceWorker.controller", "a service worker");
    await server.close();
    await served.open(server.url);
    assert.equal(await served.value('document.getElementById("verdict-word").textContent'), "stable");
    assert.deepEqual(served.complaints(), []);
  } finally {
    await served.close();
  }
});

test("the first screens, and dragging, need nothing of the second part of the engine", async () => {
  await page.open(fromFile);
  await page.value(`(async () => {
    const { engine, page } = jurist;
    Object.assign(globalThis, { whole: engine.rest });
    engine.rest = undefined;
    engine.arriving = new Promise(() => {});
    for (const seat of Object.values(engine.seats)) seat.replace();
    page.questions.about("");
    page.questions.about(page.text);
    page.ask();
  })()`);
  await page.settled();
  for (const value of ["0.02", "300", "550.9", "560"]) {
    await page.value(`jurist.page.entered("K_pwm", "${value}", false)`);
    await page.settled();
  }
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "unstable");
  await page.value("jurist.engine.rest = whole");
});

test("what needs the second part of the engine before that is there waits for it", async () => {
  const pending = await page.value(`(async () => {
    const { engine, page } = jurist;
    const whole = engine.rest;
    let arrive;
    engine.rest = undefined;
    engine.arriving = undefined;
    engine.loadRest = () => new Promise((done) => (arrive = () => done(whole)));
    engine.cancel();
    engine.seats.quick.replace();
    const request = { ask: "program", model: page.text, arguments: ["charpoly", "-", "--format", "latex"] };
    const late = engine.ask("quick", "late", request);
    while (!arrive) await new Promise((r) => setTimeout(r, 1));
    const verdict = engine.ask("quick", "verdict", { ask: "program", model: page.text, arguments: ["verdict", "-", "--json"] });
    arrive();
    return [(await late).output, JSON.parse((await verdict).output).verdict];
  })()`);
  assert.match(pending[0], /z\^\{?6/);
  assert.equal(pending[1], "stable");
  assert.equal(await page.value('document.getElementById("failure").hidden'), true);
});

test("its engine and its script are within their budgets, and sizes and times are told", async (t) => {
  const packed = (pattern) => readdirSync(folder).filter((f) => pattern.test(f)).reduce((sum, f) => sum + gzipSync(readFileSync(join(folder, f)), { level: 9 }).length, 0);
  const [engine, rest, script] = [packed(/^engine-.*\.wasm$/), packed(/^rest-.*\.wasm$/), packed(/^page-.*\.js$/)];
  t.diagnostic(`engine ${engine} bytes compressed by gzip and ${rest} behind them, script before the editor ${script}`);
  assert.ok(engine <= 1.4e6, `the engine has ${engine} bytes`);
  assert.ok(script <= 60e3, `the script has ${script} bytes`);
  await page.open(fromFile);
  const times = await page.value(`(async () => {
    const long = [];
    new PerformanceObserver((list) => long.push(...list.getEntries().map((e) => Math.round(e.duration)))).observe({ type: "longtask" });
    const request = { ask: "program", model: jurist.page.text, arguments: ["verdict", "-", "--json"] };
    const warm = [];
    for (let k = 0; k < 20; k++) { await jurist.engine.ask("quick", "warm", request); warm.push(jurist.engine.times.warm); }
    let frames = 0, begun = performance.now();
    while (performance.now() - begun < 2000) {
      await new Promise(requestAnimationFrame);
      jurist.page.entered("K_pwm", String(100 + (frames++ % 300)), false);
    }
    const rate = frames / ((performance.now() - begun) / 1000);
    await new Promise((r) => setTimeout(r, 300));
    warm.sort((a, b) => a - b);
    return { warm: warm[10], rate, long, first: performance.getEntriesByName("module")[0]?.duration, lanes: jurist.engine.times };
  })()`);
  t.diagnostic(`module ready after ${times.first?.toFixed(0)} ms, warm verdict ${times.warm.toFixed(1)} ms, ${times.rate.toFixed(0)} frames a second while dragging, tasks over 50 ms: [${times.long}]`);
  t.diagnostic(`milliseconds in the lanes: ${Object.entries(times.lanes).map(([lane, took]) => `${lane} ${took.toFixed(0)}`).join(", ")}`);
});
