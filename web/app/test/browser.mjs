// The page in headless Chromium, from a file and from a server of this test.

import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { dirname, join, normalize, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Browser, program } from "../../../tests/browser/devtools.mjs";

const here = dirname(fileURLToPath(import.meta.url));
export const root = join(here, "../../..");
export const folder = resolve(process.env.PAGE ?? join(root, "target/page"));
export const fromFile = pathToFileURL(join(folder, "index.html")).href;

const TYPES = { html: "text/html; charset=utf-8", js: "text/javascript", css: "text/css", wasm: "application/wasm" };

/** The folder on the loopback; `close` takes it away. */
export async function serve() {
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, "http://x").pathname).replace(/\/$/, "/index.html");
    try {
      const content = readFileSync(join(folder, path));
      response.writeHead(200, { "content-type": TYPES[path.split(".").pop()] ?? "text/plain" });
      response.end(content);
    } catch {
      response.writeHead(404);
      response.end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const close = () => new Promise((done) => {
    server.closeAllConnections();
    server.close(done);
  });
  return { url: `http://127.0.0.1:${server.address().port}/`, close };
}

/** Waits until an expression of the page holds; what it waits for is the page, not a clock: the end is for a page that hangs. */
async function until(browser, expression, what) {
  for (let k = 0; k < 12000; k++) {
    if (await browser.value(`Boolean(${expression})`).catch(() => false)) return;
    await new Promise((done) => setTimeout(done, 50));
  }
  throw new Error(`ten minutes without: ${what ?? expression}; ${await browser.value("document.body.innerText").catch(() => "")}`);
}

/** A browser with the page open and answered; `rest` is how long it has been there before, in milliseconds. */
export async function opened(url, { width = 1200, height = 900, mobile = false, online = false, rest = 0 } = {}) {
  const browser = new Browser(program());
  await browser.attach();
  if (online) await browser.send("Network.emulateNetworkConditions", { offline: false, latency: 0, downloadThroughput: -1, uploadThroughput: -1 });
  const page = {
    browser,
    value: (expression) => browser.value(expression),
    until: (expression, what) => until(browser, expression, what),
    async open(to, w = width, h = height) {
      await browser.open(to, w, h, 1, mobile);
      await page.answered();
      // Nothing waits for an answer either in the moment before the first map is asked for.
      const asked = '(() => { const e = document.getElementById("map-sentence"); return !e?.offsetParent || e.textContent !== "computing …"; })()';
      await page.until(asked, "the first map");
      await page.answered();
    },
    /** Until pictures are drawn: they are asked for with the sentences and come with the next frame. */
    drawn: () => browser.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"),
    /** Until there is nothing more to answer, but for a map that takes minutes. */
    async answered({ map = true } = {}) {
      await until(browser, `Object.entries(jurist.engine.seats).every(([name, s]) => (s.ready || !s.worker) && s.waiting.length === 0 && !s.busy || ${!map} && name === "long") && !jurist.page.laterTimer && ` + 'document.getElementById("verdict-word").textContent !== "…" && document.querySelector(".cm-content")', "answers");
      await page.drawn();
    },
    async take(text, options) {
      await browser.value(`jurist.page.open(${JSON.stringify(text)}, { m: "" })`);
      await page.settled(options);
    },
    /** Until what was asked after the last change is answered, too. */
    async settled(options) {
      await new Promise((done) => setTimeout(done, 150));
      await page.answered(options);
    },
    key: async (key, { shift = false } = {}) => {
      const codes = { Tab: 9, ArrowRight: 39, ArrowLeft: 37, ArrowUp: 38, ArrowDown: 40, Enter: 13, Escape: 27, Home: 36, End: 35, " ": 32 };
      const event = { key, code: key === " " ? "Space" : key, windowsVirtualKeyCode: codes[key], modifiers: shift ? 8 : 0, text: key === "Enter" ? "\r" : key === " " ? " " : undefined };
      await browser.send("Input.dispatchKeyEvent", { type: event.text ? "keyDown" : "rawKeyDown", ...event });
      await browser.send("Input.dispatchKeyEvent", { type: "keyUp", ...event, text: undefined });
    },
    mouse: (type, x, y) => browser.send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1 }),
    async picture() {
      return Buffer.from((await browser.send("Page.captureScreenshot", { format: "png" })).data, "base64");
    },
    async whole() {
      const { width: w, height: h } = await browser.value("({ width: document.documentElement.clientWidth, height: document.documentElement.scrollHeight })");
      return browser.picture({ x: 0, y: 0, width: w, height: h });
    },
    /** What the page complained about, and what it wanted from elsewhere. */
    complaints() {
      const found = [];
      for (const { method, params } of browser.events) {
        if (method === "Runtime.exceptionThrown") found.push(`exception: ${params.exceptionDetails.exception?.description ?? params.exceptionDetails.text}`);
        if (method === "Log.entryAdded" && params.entry.level === "error") found.push(`error: ${params.entry.text}`);
        if (method === "Runtime.consoleAPICalled" && params.type === "error") found.push("console.error was called");
        if (method === "Network.requestWillBeSent" && !/^(file|blob|data|about):|^http:\/\/127\.0\.0\.1/.test(params.request.url)) found.push(`request for ${params.request.url}`);
      }
      return found;
    },
    close: () => browser.close(),
  };
  await new Promise((done) => setTimeout(done, rest));
  await page.open(url);
  return page;
}
