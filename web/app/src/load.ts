// The module: compiled while it arrives; from a file, where nothing can be fetched, from a script that holds its bytes.

declare global {
  var juristEngine: string | undefined;
}

export async function load(): Promise<WebAssembly.Module> {
  if (location.protocol !== "file:") {
    const response = await fetch(ENGINE_FILE);
    if (!response.ok) throw new Error(`${ENGINE_FILE}: ${response.status}`);
    // A server may not know the type of the file.
    if (!response.headers.get("content-type")?.startsWith("application/wasm")) {
      return WebAssembly.compile(await response.arrayBuffer());
    }
    return WebAssembly.compileStreaming(response);
  }
  await script(ENGINE_SCRIPT);
  const packed = Uint8Array.from(atob(globalThis.juristEngine!), (c) => c.charCodeAt(0));
  globalThis.juristEngine = undefined;
  const bytes = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
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
