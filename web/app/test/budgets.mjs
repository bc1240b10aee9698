// What the page takes, in figures: PAGE=target/page node web/app/test/budgets.mjs [starts]
//
// Nothing is asserted: figures depend on the machine and on what else it does, which stands in the first line. Of everything that is
// repeated the least, the middle and the most are told. Beside the time that passes stands the processor's time on the thread of the page.

import { readFileSync } from "node:fs";
import { cpus, loadavg } from "node:os";
import { join } from "node:path";
import { fromFile, opened, root, serve } from "./browser.mjs";

const starts = Number(process.argv[2] ?? 9);
const spread = (list, digits = 0) => {
  const sorted = [...list].sort((a, b) => a - b);
  return [0, (sorted.length - 1) >> 1, sorted.length - 1].map((k) => (sorted[k] ?? NaN).toFixed(digits)).join(" / ");
};
const most = (list) => Math.max(0, ...list).toFixed(1);
const sum = (list) => list.reduce((a, b) => a + b, 0);

/** Tasks of the page's thread while something is done: milliseconds that passed and that it worked. */
async function traced(page, work) {
  const begun = page.browser.events.length;
  await page.browser.send("Tracing.start", { traceConfig: { includedCategories: ["toplevel", "devtools.timeline", "disabled-by-default-devtools.timeline"] } });
  const value = await work();
  await page.browser.send("Tracing.end");
  const since = () => page.browser.events.slice(begun);
  while (!since().some((e) => e.method === "Tracing.tracingComplete")) await new Promise((r) => setTimeout(r, 20));
  const events = since().flatMap((e) => (e.method === "Tracing.dataCollected" ? e.params.value : []));
  const main = events.find((e) => e.name === "thread_name" && e.args.name === "CrRendererMain");
  const own = events.filter((e) => e.pid === main.pid && e.tid === main.tid);
  const tasks = own.filter((e) => e.name === "ThreadControllerImpl::RunTask" && e.dur);
  const parts = new Map();
  for (const e of own) if (e.tdur && e.ph === "X") parts.set(e.name, (parts.get(e.name) ?? 0) + e.tdur / 1e3);
  return { value, passed: tasks.map((e) => e.dur / 1e3), worked: tasks.map((e) => (e.tdur ?? 0) / 1e3), parts };
}

/** What happened when, counted from the moment at which the engine's bytes were there. */
const MOMENTS = `(() => {
  const bytes = performance.getEntriesByType("resource").find((e) => e.name.includes("/engine-")).responseEnd;
  const measure = performance.getEntriesByName("module")[0];
  const mark = (name) => performance.getEntriesByName(name)[0].startTime - bytes;
  return { module: measure.startTime + measure.duration - bytes, ready: mark("ready"), described: mark("described"), verdict: mark("verdict"), drawn: mark("drawn") };
})()`;

/** Frames a second while something is done in each. */
const frames = (page, seconds, each) => page.value(`(async () => {
  let frames = 0;
  const begun = performance.now();
  while (performance.now() - begun < ${seconds * 1000}) {
    await new Promise(requestAnimationFrame);
    (${each})(frames++);
  }
  return frames;
})()`);
const DRAG = '(k) => jurist.page.rows.get("K_pwm").enter(String(100 + (k % 300)), false)';

console.log(`${cpus().length} processors, load ${loadavg().map((l) => l.toFixed(1)).join(" ")}; least / middle / most`);
const server = await serve();
let page;
try {
  const found = [];
  for (let k = 0; k < starts; k++) {
    // Each visit is a first one: in a browser that keeps nothing, and has come to rest.
    const visit = await opened(server.url, { online: true, rest: 700 });
    found.push(await visit.value(MOMENTS));
    await visit.close();
  }
  const of = (name) => spread(found.map((f) => f[name]));
  console.log(`${starts} first visits, ms after the engine's bytes are there: module compiled ${of("module")}, worker ready ${of("ready")}, model described ${of("described")}, verdict ${of("verdict")}, drawn ${of("drawn")}`);

  page = await opened(fromFile, { online: true });
  const begin = await traced(page, async () => {
    await page.open(server.url);
    await page.settled();
  });
  console.log(`longest task while it begins: ${most(begin.passed)} ms, of which ${most(begin.worked)} ms of work; over 50 ms of work: ${begin.worked.filter((t) => t > 50).length}`);
  const warm = await page.value(`(async () => {
    const request = { ask: "program", model: jurist.page.text, arguments: ["verdict", "-", "--json"] };
    const times = [];
    for (let k = 0; k < 40; k++) { await jurist.engine.ask("quick", "warm", request); times.push(jurist.engine.times.warm); }
    return times;
  })()`);
  console.log(`warm verdict: ${spread(warm, 1)} ms`);

  const rates = [];
  const empty = [];
  for (let k = 0; k < 3; k++) {
    rates.push((await frames(page, 3, DRAG)) / 3);
    await page.settled();
    empty.push((await frames(page, 3, "() => {}")) / 3);
  }
  console.log(`frames a second while the drive is dragged: ${spread(rates)}; where nothing is done: ${spread(empty)}`);
  const drag = await traced(page, () => frames(page, 4, DRAG));
  const work = sum(drag.worked) / drag.value;
  console.log(`work in a frame: ${work.toFixed(1)} ms (traced, which costs by itself); longest task ${most(drag.passed)} ms, of which ${most(drag.worked)} ms of work; over 50 ms of work: ${drag.worked.filter((t) => t > 50).length}`);
  console.log(`of it ${[...drag.parts].sort((a, b) => b[1] - a[1]).slice(0, 14).map(([name, t]) => `${name} ${(t / drag.value).toFixed(2)}`).join(", ")}`);
  console.log(`milliseconds of the engine: ${Object.entries(await page.value("jurist.engine.times")).map(([lane, took]) => `${lane} ${took.toFixed(1)}`).join(", ")}`);

  const heavy = readFileSync(join(root, "examples/drive-filters-6.toml"), "utf8");
  await page.take(heavy, { map: false });
  const cancels = [];
  for (let k = 0; k < 9; k++) {
    cancels.push(await page.value(`(async () => {
      const { engine, page } = jurist;
      const [x, y] = page.mapAxes;
      engine.cancel();
      void engine.ask("long", "map", { ask: "map", model: page.text, set: [], x, y });
      while (engine.seats.long.busy !== "map") await new Promise((r) => setTimeout(r, 1));
      await new Promise((r) => setTimeout(r, 300));
      const begun = performance.now();
      engine.cancel();
      await engine.ask("long", "verdict", { ask: "program", model: page.text, arguments: ["verdict", "-", "--json"] });
      return performance.now() - begun;
    })()`));
  }
  console.log(`an answer after a map is cancelled in its middle: ${spread(cancels)} ms`);
} finally {
  await page?.close();
  await server.close();
}
