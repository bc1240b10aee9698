// The worker: one instance of the engine, one request after the other.

import { type Instance, instantiate } from "./instance.js";

interface Begin {
  module?: WebAssembly.Module;
  bytes?: ArrayBuffer;
}

interface Ask {
  id: number;
  request: unknown;
}

let instance: Instance | undefined;
let current = 0;

async function begin({ module, bytes }: Begin): Promise<void> {
  const compiled = module ?? (await WebAssembly.compile(bytes!));
  instance = await instantiate(compiled, (text) => postMessage({ id: current, progress: text }));
  postMessage({ ready: true });
}

function answer({ id, request }: Ask): void {
  current = id;
  const begun = performance.now();
  try {
    const reply = instance!.ask(request);
    postMessage({ id, reply, took: performance.now() - begun });
  } catch (error) {
    // After a trap nothing in the instance can be relied upon: the page throws this worker away.
    postMessage({ id, reply: { defect: instance!.lastWords() || String(error) }, took: performance.now() - begun, broken: true });
  }
}

onmessage = ({ data }: MessageEvent<Begin | Ask>) => {
  if ("request" in data) answer(data);
  else begin(data).catch((error: unknown) => postMessage({ failed: String(error) }));
};
