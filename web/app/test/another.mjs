// Another model in the page while the one before is being computed: PAGE=target/page node --test web/app/test/another.mjs
//
// No panel shows anything of another model than the one in the text, or all of them are grey and a sentence says why. It is looked at
// after every change of the page, not at moments that a clock chooses.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fromFile, opened, root } from "./browser.mjs";
import { random } from "./models.mjs";

let page;
before(async () => {
  page = await opened(fromFile);
});
after(() => page?.close());

/** Models that have no word in common: a loop that is stable, one that is not, one with one parameter, one whose map takes minutes. */
const MODELS = {
  drive: readFileSync(join(root, "examples/drive.toml"), "utf8"),
  unstable: 'time = "continuous"\n[parameters]\nalpha = { nominal = -2, min = -5 }\nbeta = { nominal = 7, min = 0 }\ngamma = 3\n[loop]\ninputs = ["wish"]\noutputs = ["height"]\n[[block]]\nname = "ball"\ninput = "wish - height"\noutput = "height"\nnum = ["beta"]\nden = ["1", "alpha", "gamma"]\n',
  one: 'time = "discrete"\n[parameters]\nkappa = { nominal = "1/8", min = 0 }\n[loop]\ncharacteristic = "z^3 - kappa"\n',
};
const heavy = readFileSync(join(root, "examples/drive-filters-6.toml"), "utf8");

const WORD = /[\w.∞×°−]+/g;
/** What the panels say, shown or hidden, and what is drawn in them; not what the engine works at. */
const SAID = `(() => {
  const copy = document.getElementById("answers").cloneNode(true);
  for (const e of copy.querySelectorAll("#progress, #stale, #verdict-about, .waits, option")) e.remove();
  return [...copy.querySelectorAll("p, span, strong, td, th, text, label, button, pre, h3, caption, math *")].map((e) => e.textContent).join(" | ") + " | " +
    document.getElementById("announce").textContent + " | " + [...document.querySelectorAll("#panel-blocks td")].map((e) => e.textContent).join(" | ");
})()`;

/** Opens a model, drawers and tables too, and gives the words that the page has for it. */
async function wordsOf(text) {
  await page.open(fromFile);
  await page.take(text);
  await page.value('for (const d of document.querySelectorAll("#answers details")) d.open = true');
  await page.settled();
  return new Set((await page.value(SAID)).match(WORD));
}

/** Numbers and names that only one of the models has; sentences share words with those of any model. */
async function own() {
  const words = {};
  for (const [name, text] of Object.entries(MODELS)) words[name] = await wordsOf(text);
  const plain = (name, word) => /^[\d.−]{1,3}$/.test(word) || (/^[a-z.]*$/.test(word) && !(word.length > 3 && MODELS[name].includes(word)));
  const common = (name, word) => plain(name, word) || Object.entries(words).some(([other, all]) => other !== name && all.has(word));
  return Object.fromEntries(Object.entries(words).map(([name, all]) => [name, [...all].filter((word) => !common(name, word))]));
}

/** After every change: what is shown is about the page's text, and that is the editor's, or it is grey. */
const watch = (words) => `(() => {
  const [models, words] = [${JSON.stringify(MODELS)}, ${JSON.stringify(words)}];
  globalThis.wrong = [];
  globalThis.looked = 0;
  const look = () => {
    const { page } = jurist;
    globalThis.looked++;
    const grey = document.getElementById("answers").classList.contains("old");
    if (!grey && page.editor.get() !== page.text) wrong.push("not grey beside another text");
    const said = new Set(${SAID}.match(${WORD}));
    for (const [name, own] of Object.entries(words)) {
      // The heavy one is a drive, too.
      if (page.text === models[name] || (name === "drive" && page.text === ${JSON.stringify(heavy)})) continue;
      const found = own.filter((word) => said.has(word));
      if (found.length > 0) wrong.push("of " + name + ": " + found.slice(0, 6).join(" "));
    }
    const verdict = document.getElementById("verdict").className;
    if (page.text === models.unstable && verdict === "verdict stable" || page.text === models.drive && verdict === "verdict unstable") wrong.push(verdict);
  };
  globalThis.watcher?.disconnect();
  globalThis.watcher = new MutationObserver(look);
  watcher.observe(document.body, { subtree: true, childList: true, characterData: true, attributes: true });
})()`;

const wrong = () => page.value("[...new Set(wrong)]");

/** As somebody does it: into the box, and the button. */
const paste = (text) => page.value(`(() => { document.getElementById("pasted").value = ${JSON.stringify(text)}; document.getElementById("paste-use").click(); })()`);
const type = (text) => page.value(`jurist.page.editor.set(${JSON.stringify(text)})`);

test("a second model is pasted while the first is being computed", async () => {
  const words = await own();
  for (const [name, own] of Object.entries(words)) assert.ok(own.length > (name === "one" ? 5 : 20), `${name} is known by ${own}`);
  assert.ok(words.drive.includes("K_pwm") && words.drive.includes("550.94") && words.unstable.includes("alpha"), JSON.stringify(words));
  await page.open(fromFile);
  await page.take(MODELS.unstable);
  await page.value('for (const d of document.querySelectorAll("#answers details")) d.open = true');
  await page.settled();
  await page.value(watch(words));
  // One is drawn; the map of the next takes minutes: nothing of the first one's map stays.
  await paste(heavy);
  await page.until(`jurist.page.text === ${JSON.stringify(heavy)} && jurist.engine.busy === "map"`);
  await page.value("new Promise(requestAnimationFrame).then(() => new Promise(requestAnimationFrame))");
  assert.equal(await page.value('document.querySelectorAll("#map .region, #map .wall").length'), 0);
  assert.equal(await page.value('document.getElementById("map-sentence").textContent'), "computing …");
  assert.equal(await page.value('document.querySelector("#map svg").textContent'), "computing …");
  // While that is being computed the next is pasted, and answered.
  await paste(MODELS.drive);
  await page.until(`jurist.page.text === ${JSON.stringify(MODELS.drive)}`);
  await page.settled();
  assert.match(await page.value('document.getElementById("map-sentence").textContent'), /^K_pwm and T: .* The point is at K_pwm = 110, T = 1e-4, stable/);
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "stable");
  assert.deepEqual(await wrong(), []);
  // A model with one parameter says so, and the next one with three does not.
  await paste(MODELS.one);
  await page.until(`jurist.page.text === ${JSON.stringify(MODELS.one)}`);
  assert.match(await page.value('document.getElementById("map-sentence").textContent'), /two parameters, and this model has one/);
  await paste(MODELS.unstable);
  await page.until(`jurist.page.text === ${JSON.stringify(MODELS.unstable)}`);
  assert.ok(!(await page.value('document.getElementById("map").textContent')).includes("two parameters."));
  assert.deepEqual(await wrong(), []);
});

test("answers that come late, in any order, cancelled or failed, leave nothing of another model", async () => {
  const words = await own();
  await page.open(fromFile);
  await page.value('for (const d of document.querySelectorAll("#answers details")) d.open = true');
  await page.settled();
  // Every answer but that to what a text says waits until it is let through.
  await page.value(`(() => {
    const ask = jurist.engine.ask.bind(jurist.engine);
    globalThis.gates = [];
    jurist.engine.ask = async (speed, lane, request) => {
      const reply = await ask(speed, lane, request);
      if (lane === "describe" || globalThis.through) return reply;
      return new Promise((open) => gates.push((instead) => open(instead ?? reply)));
    };
  })()`);
  await page.value(watch(words));
  const next = random(32);
  const pick = (list) => list[Math.floor(next() * list.length)];
  for (let step = 0; step < 60; step++) {
    const what = next();
    const text = pick(Object.values(MODELS));
    if (what < 0.25) await paste(text);
    else if (what < 0.35) await type(text);
    else if (what < 0.4) await type("time = 1");
    else if (what < 0.5) await page.value('(() => { const [name] = [...jurist.page.rows.keys()]; jurist.page.entered(name, String(1 + Math.floor(100 * Math.random())), true); })()');
    else if (what < 0.6) await page.value("jurist.engine.cancel(true)");
    else await page.value(`gates.splice(${Math.floor(next() * 8)} % Math.max(1, gates.length), 1)[0]?.(${pick(["undefined", "undefined", '{ stopped: "cancelled" }', '{ defect: "broken" }'])})`);
    await new Promise((done) => setTimeout(done, pick([0, 0, 30, 350])));
  }
  await page.value("(globalThis.through = true, gates.splice(0).forEach((open) => open()))");
  assert.deepEqual(await wrong(), []);
  assert.ok((await page.value("looked")) > 100);
  // In the end everything is answered.
  await page.take(MODELS.drive);
  await page.until('document.getElementById("map-sentence").textContent.startsWith("K_pwm and T: ")');
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "stable");
  assert.deepEqual([...(await wrong()), ...page.complaints()], []);
});

test("while the text is no model, or not read, all that is shown is grey and a sentence says what it is about", async () => {
  await page.open(fromFile);
  const colour = () => page.value('getComputedStyle(document.getElementById("verdict")).backgroundColor');
  const green = await colour();
  const stale = () => page.value('[document.getElementById("answers").classList.contains("old"), document.getElementById("verdict-about").hidden, document.getElementById("stale").hidden]');
  assert.deepEqual(await stale(), [false, true, true]);
  await type("time = 1");
  // At once: before it is known what the text is.
  assert.deepEqual((await stale()).slice(0, 2), [true, false]);
  await page.until('!document.getElementById("stale").hidden');
  await page.until('document.getElementById("stale").textContent.startsWith("The text is no model at the moment.")');
  assert.notEqual(await colour(), green);
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "stable");
  await page.value('jurist.page.entered("K_pwm", "600", true)');
  await page.settled();
  assert.equal(await page.value('document.getElementById("verdict-word").textContent'), "unstable");
  assert.deepEqual(await stale(), [true, false, false]);
  await type(MODELS.drive);
  assert.deepEqual(await stale(), [false, true, true]);
  await page.value('jurist.page.entered("K_pwm", "110", true)');
  await page.settled();
  assert.equal(await colour(), green);
});

test("a text that is written and taken back within a moment is not read", async () => {
  await page.open(fromFile);
  await page.value(`(() => { const { editor } = jurist.page; editor.set("time = 1"); editor.set(${JSON.stringify(MODELS.drive)}); })()`);
  await page.settled();
  await new Promise((done) => setTimeout(done, 400));
  assert.deepEqual(await page.value('[jurist.page.text === jurist.page.editor.get(), document.getElementById("stale").hidden]'), [true, true]);
});

test("a verdict that takes long is not awaited behind the one of other values", async () => {
  await page.open(fromFile);
  await page.value(`(() => {
    const ask = jurist.engine.ask.bind(jurist.engine);
    jurist.engine.ask = (speed, lane, request) => (lane === "verdict" || lane === "map" ? new Promise(() => {}) : ask(speed, lane, request));
    jurist.page.entered("K_pwm", "600", true);
  })()`);
  await page.until('document.getElementById("verdict-word").textContent === "…"');
  assert.equal(await page.value('document.getElementById("verdict").className'), "verdict");
  assert.match(await page.value('document.getElementById("map-sentence").textContent'), /K_pwm = 600, T = 1e-4\.$/);
});
