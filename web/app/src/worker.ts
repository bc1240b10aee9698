// The worker: one instance of the engine, one request after the other.

import { type Instance, instantiate } from "./instance.js";

/** The engine, its first part to begin with and the rest with it or later. */
interface Parts {
  module?: WebAssembly.Module;
  rest?: WebAssembly.Module;
}

interface Ask {
  id: number;
  request: unknown;
}

let instance: Instance | undefined;
let rest: WebAssembly.Module | undefined;
let current = 0;

async function begin(module: WebAssembly.Module): Promise<void> {
  const progress = (text: string) => postMessage({ id: current, progress: text });
  instance = await instantiate(module, progress);
  complete();
  postMessage({ ready: true });
}

/** The second part may come before the instance is there. */
function complete(): void {
  if (rest) instance?.complete(rest);
}

function answer({ id, request }: Ask): void {
  current = id;
  const begun = performance.now();
  try {
    const reply = instance!.ask(request);
    postMessage({ id, reply, took: performance.now() - begun });
  } catch (error) {
    // After a trap nothing in the instance can be relied upon: the page throws this worker away.
    if (!instance!.isWhole()) return postMessage({ id, incomplete: true });
    postMessage({ id, reply: { defect: instance!.lastWords() || String(error) }, took: performance.now() - begun, broken: true });
  }
}

onmessage = ({ data }: MessageEvent<Parts | Ask>) => {
  if ("request" in data) return answer(data);
  rest = data.rest ?? rest;
  complete();
  if (data.module) begin(data.module).catch((error: unknown) => postMessage({ failed: String(error) }));
};
