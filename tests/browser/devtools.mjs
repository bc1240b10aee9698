// Chromium, headless, spoken to through its DevTools protocol over two pipes: no package is needed.

import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const FLAGS = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--hide-scrollbars", "--remote-debugging-pipe",
];

/** A browser with one page; `events` collects what the page tells. */
export class Browser {
  constructor(program) {
    this.profile = mkdtempSync(join(tmpdir(), "jurist-browser-"));
    this.child = spawn(program, [...FLAGS, `--user-data-dir=${this.profile}`, "about:blank"], {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
    });
    this.ended = new Promise((resolve) => this.child.once("exit", resolve));
    this.child.once("error", (error) => this.fail(error));
    this.child.once("exit", () => this.fail(new Error("the browser ended")));
    this.waiting = new Map();
    this.events = [];
    this.next = 1;
    let rest = "";
    this.child.stdio[4].setEncoding("utf8");
    this.child.stdio[4].on("data", (chunk) => {
      const messages = (rest + chunk).split("\0");
      rest = messages.pop();
      for (const text of messages) this.receive(JSON.parse(text));
    });
  }

  receive(message) {
    const asked = this.waiting.get(message.id);
    if (!asked) {
      this.events.push(message);
      return;
    }
    this.waiting.delete(message.id);
    if (message.error) asked.reject(new Error(message.error.message));
    else asked.resolve(message.result);
  }

  fail(error) {
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
  }

  send(method, params = {}) {
    const id = this.next++;
    const message = { id, method, params };
    if (this.session && !method.startsWith("Target.") && method !== "Browser.close") message.sessionId = this.session;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.child.stdio[3].write(JSON.stringify(message) + "\0");
    });
  }

  /** Attaches to the page; from now on it is off the network. */
  async attach() {
    const { targetInfos } = await this.send("Target.getTargets");
    const { targetId } = targetInfos.find((t) => t.type === "page");
    this.session = (await this.send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await this.send(`${domain}.enable`);
    const offline = { offline: true, latency: 0, downloadThroughput: 0, uploadThroughput: 0 };
    await this.send("Network.emulateNetworkConditions", offline);
  }

  /** Opens an address in a window of that width and waits until it is drawn. */
  async open(url, width, height, scale, mobile) {
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: scale, mobile });
    const before = this.events.length;
    await this.send("Page.navigate", { url });
    const loaded = () => this.events.slice(before).some((e) => e.method === "Page.loadEventFired");
    for (let k = 0; !loaded(); k++) {
      if (k > 600) throw new Error(`${url} did not load in a minute`);
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
  }

  /** The value of a JavaScript expression in the page. */
  async value(expression) {
    const options = { expression, returnByValue: true, awaitPromise: true };
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", options);
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** A PNG of a part of the page, in the page's own pixels. */
  async picture(clip) {
    const options = { format: "png", captureBeyondViewport: true, clip: { ...clip, scale: 1 } };
    return Buffer.from((await this.send("Page.captureScreenshot", options)).data, "base64");
  }

  /** The page as it prints. */
  async print(paper) {
    return Buffer.from((await this.send("Page.printToPDF", paper)).data, "base64");
  }

  async close() {
    await this.send("Browser.close").catch(() => {});
    const late = setTimeout(() => this.child.kill(), 5000);
    await this.ended;
    clearTimeout(late);
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** The browser that CHROMIUM names, or the first that is found. */
export function program() {
  const names = process.env.CHROMIUM ? [process.env.CHROMIUM] : ["chromium", "chromium-browser", "google-chrome"];
  for (const name of names) {
    try {
      return execFileSync("sh", ["-c", 'command -v "$1"', "sh", name], { encoding: "utf8" }).trim();
    } catch {
      // The next one.
    }
  }
  throw new Error(`no browser: ${names.join(", ")}`);
}

/** What a page complained about, and what it wanted from elsewhere than it may. */
export function complaints(events, allowed) {
  const found = [];
  for (const { method, params } of events) {
    if (method === "Runtime.exceptionThrown") found.push(`exception: ${params.exceptionDetails.text}`);
    if (method === "Log.entryAdded" && params.entry.level === "error") found.push(`error: ${params.entry.text}`);
    if (method === "Runtime.consoleAPICalled" && params.type === "error") found.push("console.error was called");
    if (method === "Network.requestWillBeSent" && !allowed(params.request.url)) found.push(`request for ${params.request.url}`);
  }
  return found;
}
