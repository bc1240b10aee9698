// How the page begins.

import { by } from "./dom.js";
import { Engine } from "./engine.js";
import { loadFirst, loadRest } from "./load.js";
import { Page } from "./page.js";
import { wire } from "./wire.js";

declare const DRIVE: string;
declare const WORKER: string;

function fail(why: unknown): void {
  const place = by("failure");
  place.hidden = false;
  place.textContent = `The engine cannot be started here: ${why instanceof Error ? why.message : String(why)}. The program does the same without a browser.`;
}

async function begin(): Promise<void> {
  const asked = performance.now();
  const module = loadFirst();
  // The worker begins while the module is on its way.
  const engine = new Engine(WORKER, module, loadRest);
  engine.failed = fail;
  module.then(() => performance.measure("module", { start: asked, end: performance.now() }), fail);
  const page = new Page(engine);
  // For those who look into the page, and for its tests.
  Object.assign(globalThis, { jurist: { page, engine } });
  wire(page);
  await page.follow();
  if (!location.hash) await page.open(DRIVE, { m: DRIVE });
  await page.answered();
  await Promise.all([page.improve(), engine.whole()]).catch(() => {});
  if ("serviceWorker" in navigator && location.protocol.startsWith("http")) {
    await navigator.serviceWorker.register("service.js").catch(() => {});
  }
}

begin().catch(fail);
