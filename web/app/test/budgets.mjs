// What the page takes, in figures: PAGE=target/page node web/app/test/budgets.mjs
//
// Beside the time that passes, in which the machine may do other things, stands the processor's time on the thread of the page.

import { fromFile, opened, serve } from "./browser.mjs";

const server = await serve();
const page = await opened(fromFile, { online: true });

/** Tasks of the page's thread while something is done: milliseconds that passed and that it worked. */
async function traced(work) {
  const begun = page.browser.events.length;
  await page.browser.send("Tracing.start", { traceConfig: { includedCategories: ["toplevel", "devtools.timeline", "disabled-by-default-devtools.timeline"] } });
  const value = await work();
  await page.browser.send("Tracing.end");
  const since = () => page.browser.events.slice(begun);
  while (!since().some((e) => e.method === "Tracing.tracingComplete")) await new Promise((r) => setTimeout(r, 20));
  const events = since().flatMap((e) => (e.method === "Tracing.dataCollected" ? e.params.value : []));
  const main = events.find((e) => e.name === "thread_name" && e.args.name === "CrRendererMain");
  const tasks = events.filter((e) => e.name === "ThreadControllerImpl::RunTask");
  const own = tasks.filter((e) => e.pid === main.pid && e.tid === main.tid && e.dur);
  const parts = new Map();
  for (const e of events) if (e.pid === main.pid && e.tid === main.tid && e.tdur && e.ph === "X") parts.set(e.name, (parts.get(e.name) ?? 0) + e.tdur / 1e3);
  return { value, passed: own.map((e) => e.dur / 1e3), worked: own.map((e) => (e.tdur ?? 0) / 1e3), parts };
}
const most = (list) => Math.max(0, ...list).toFixed(1);
const sum = (list) => list.reduce((a, b) => a + b, 0);

try {
  const begin = await traced(async () => {
    await page.open(server.url);
    await page.settled();
  });
  const { bytes, module, verdict } = await page.value(`({
    bytes: performance.getEntriesByType("resource").find((e) => e.name.includes("/engine-")).responseEnd,
    module: performance.getEntriesByName("module")[0].startTime + performance.getEntriesByName("module")[0].duration,
    verdict: performance.getEntriesByName("verdict")[0].startTime,
  })`);
  console.log(`after the bytes are there: module ready ${(module - bytes).toFixed(0)} ms, first verdict ${(verdict - bytes).toFixed(0)} ms`);
  console.log(`longest task while it begins: ${most(begin.passed)} ms, of which ${most(begin.worked)} ms of work; over 50 ms of work: ${begin.worked.filter((t) => t > 50).length}`);
  const warm = await page.value(`(async () => {
    const request = { ask: "program", model: jurist.page.text, arguments: ["verdict", "-", "--json"] };
    const times = [];
    for (let k = 0; k < 40; k++) { await jurist.engine.ask("quick", "warm", request); times.push(jurist.engine.times.warm); }
    return times.sort((a, b) => a - b);
  })()`);
  console.log(`warm verdict: ${warm[0].toFixed(1)} ms at best, ${warm[20].toFixed(1)} ms in the middle`);
  const seconds = 4;
  const drag = await traced(() => page.value(`(async () => {
    let frames = 0;
    const begun = performance.now();
    while (performance.now() - begun < ${seconds * 1000}) {
      await new Promise(requestAnimationFrame);
      jurist.page.entered("K_pwm", String(100 + (frames++ % 300)), false);
    }
    return frames;
  })()`));
  const work = sum(drag.worked) / drag.value;
  console.log(`dragging: ${(drag.value / seconds).toFixed(0)} frames a second, ${work.toFixed(1)} ms of work each (${(1000 / work).toFixed(0)} a second where nothing else is done)`);
  console.log(`longest task while dragging: ${most(drag.passed)} ms, of which ${most(drag.worked)} ms of work; over 50 ms of work: ${drag.worked.filter((t) => t > 50).length}`);
  console.log([...drag.parts].sort((a, b) => b[1] - a[1]).slice(0, 12).map(([name, t]) => `${name} ${(t / drag.value).toFixed(2)}`).join(", "));
} finally {
  await page.close();
  await server.close();
}
