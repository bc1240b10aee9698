// An instance of the engine in Node, by the page's own code.

import { build } from "esbuild";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../../..");

/** A module of the page, as a module for Node. */
export async function moduleOf(file, define = {}) {
  const options = { bundle: true, write: false, format: "esm", define };
  const result = await build({ entryPoints: [join(here, "../src", file)], ...options });
  return import(`data:text/javascript,${encodeURIComponent(result.outputFiles[0].text)}`);
}

/** ENGINE names the module, whole or its first part, REST the second. */
export async function instance() {
  const file = process.env.ENGINE ?? join(root, "target/wasm/wasm32-unknown-unknown/web/jurist_web.wasm");
  const compiled = (name) => WebAssembly.compile(readFileSync(name));
  const rest = process.env.REST && (await compiled(process.env.REST));
  const { instantiate } = await moduleOf("instance.ts");
  const made = await instantiate(await compiled(file));
  if (rest) made.complete(rest);
  return made;
}

