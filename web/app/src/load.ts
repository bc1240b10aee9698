// The engine's two modules: compiled while they arrive; from a file, where nothing can be fetched, from scripts that hold their bytes.

declare global {
  var juristEngine: string | undefined;
  /** What the page asked for before its script was there. */
  var juristFirst: Promise<Response> | undefined;
}

/** What the first screens need. */
export const loadFirst = () => load(ENGINE_FILE, ENGINE_SCRIPT, globalThis.juristFirst);

/** All else; nothing where the engine is in one part. */
export const loadRest = () => (REST_FILE ? load(REST_FILE, REST_SCRIPT) : Promise.resolve(undefined));

async function load(file: string, packedFile: string, asked?: Promise<Response>): Promise<WebAssembly.Module> {
  if (location.protocol !== "file:") {
    const response = await (asked ?? fetch(file));
    if (!response.ok) throw new Error(`${file}: ${response.status}`);
    // A server may not know the type of the file.
    if (!response.headers.get("content-type")?.startsWith("application/wasm")) {
      return WebAssembly.compile(await response.arrayBuffer());
    }
    return WebAssembly.compileStreaming(response);
  }
  await script(packedFile);
  const packed = Uint8Array.from(atob(globalThis.juristEngine!), (c) => c.charCodeAt(0));
  globalThis.juristEngine = undefined;
  const bytes = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return WebAssembly.compile(await new Response(bytes).arrayBuffer());
}

/** Runs another file of the page. */
export function script(file: string): Promise<void> {
  return new Promise((resolve, reject) => {
    const element = document.createElement("script");
    element.src = file;
    element.onload = () => resolve();
    element.onerror = () => reject(new Error(`${file} cannot be loaded`));
    document.head.append(element);
  });
}

declare const ENGINE_FILE: string;
declare const ENGINE_SCRIPT: string;
declare const REST_FILE: string;
declare const REST_SCRIPT: string;
