// Makes the page of its parts: node build.mjs OUTPUT_FOLDER ENGINE.wasm [REST.wasm]
//
// The engine is whole, or what split.mjs made of it. Names of files hold a hash of their content. `engine-*.js` and `rest-*.js` hold
// its bytes as text, for a page that is opened from a file, where nothing can be fetched.

import { build } from "esbuild";
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync, gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const [output, ...parts] = process.argv.slice(2);
if (parts.length < 1 || parts.length > 2) {
  console.error("usage: node build.mjs OUTPUT_FOLDER ENGINE.wasm [REST.wasm]");
  process.exit(2);
}
rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });

const files = [];
/** Writes a file under its hashed name, and gives that. */
function put(name, ending, content) {
  const hash = createHash("sha256").update(content).digest("hex").slice(0, 10);
  const file = `${name}-${hash}.${ending}`;
  writeFileSync(join(output, file), content);
  files.push({ file, bytes: Buffer.byteLength(content), packed: gzipSync(content, { level: 9 }).length });
  return file;
}

async function bundle(entry, define = {}) {
  const result = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "utf8",
    legalComments: "none",
    define: Object.fromEntries(Object.entries(define).map(([name, value]) => [name, JSON.stringify(value)])),
  });
  return result.outputFiles[0].text;
}

const css = async (...names) => {
  const contents = names.map((name) => readFileSync(join(here, name), "utf8")).join("\n");
  const result = await build({ stdin: { contents, loader: "css" }, minify: true, write: false, charset: "utf8" });
  return result.outputFiles[0].text.trim();
};

/** A part of the engine, and the script that holds its bytes. */
function module(name, file) {
  const wasm = readFileSync(file);
  const packed = deflateSync(wasm, { level: 9 }).toString("base64");
  const named = put(name, "wasm", wasm);
  const script = named.replace(".wasm", ".js");
  writeFileSync(join(output, script), `globalThis.juristEngine="${packed}";`);
  return [named, script];
}
const [engine, engineScript] = module("engine", parts[0]);
const [rest, restScript] = parts[1] ? module("rest", parts[1]) : ["", ""];
const folder = join(root, "examples");
const names = readdirSync(folder).filter((name) => name.endsWith(".toml")).sort();
const texts = names.map((name) => [name, readFileSync(join(folder, name), "utf8")]);
const examples = put("examples", "js", `globalThis.juristExamples=${JSON.stringify(texts)};`);
const editor = put("editor", "js", await bundle("editor.ts"));
const script = put(
  "page",
  "js",
  await bundle("main.ts", {
    WORKER: await bundle("worker.ts"),
    DRIVE: readFileSync(join(folder, "drive.toml"), "utf8"),
    ENGINE_FILE: engine,
    ENGINE_SCRIPT: engineScript,
    REST_FILE: rest,
    REST_SCRIPT: restScript,
    EDITOR_SCRIPT: editor,
    EXAMPLES_SCRIPT: examples,
    PICTURE_STYLE: await css("picture.css"),
  }),
);
const style = put("page", "css", await css("style.css", "picture.css"));

// What is fetched before the script is there; from a file nothing can be.
const early = `if(location.protocol!=="file:")globalThis.juristFirst=fetch("${engine}")`;

// Nothing runs and nothing is loaded but the files of this folder; workers are made of the page's own text. The editor writes its
// rules into the page.
const policy = [
  "default-src 'none'",
  `script-src 'self' 'wasm-unsafe-eval' 'sha256-${createHash("sha256").update(early).digest("base64")}'`,
  "style-src 'self' 'unsafe-inline'",
  "img-src data: blob:",
  "connect-src 'self'",
  "worker-src 'self' blob:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");
const version = /^version = "(.*)"/m.exec(readFileSync(join(root, "Cargo.toml"), "utf8"))[1];
const filled = { POLICY: policy, EARLY: early, STYLE: style, SCRIPT: script, VERSION: version };
const page = readFileSync(join(here, "index.html"), "utf8").replace(/%([A-Z]+)%/g, (_, name) => filled[name]);
writeFileSync(join(output, "index.html"), page);

const kept = [engine, ...(rest ? [rest] : []), examples, editor, script, style];
const hash = createHash("sha256").update(page).update(kept.join()).digest("hex").slice(0, 10);
const service = await bundle("service.ts", { VERSION: `jurist-${hash}`, FILES: ["index.html", ...kept] });
writeFileSync(join(output, "service.js"), service);

for (const { file, bytes, packed } of files) console.log(`${file}: ${bytes} bytes, ${packed} compressed`);
