// Packs a page for the program: node pack.mjs FOLDER FILE.lzma
//
// A line `name length` for each file, an empty line, and what is in the files (src/cli/commands/page.rs). The scripts that hold a module's
// bytes as text are left out: the program makes them of the module. It needs xz.

import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [folder, file] = process.argv.slice(2);
if (!file) {
  console.error("usage: node pack.mjs FOLDER FILE.lzma");
  process.exit(2);
}
const isMade = (name) => name.endsWith(".js") && existsSync(join(folder, name.replace(/\.js$/, ".wasm")));
const files = readdirSync(folder).sort().filter((name) => !isMade(name)).map((name) => [name, readFileSync(join(folder, name))]);
const head = files.map(([name, content]) => `${name} ${content.length}\n`).join("");
const all = Buffer.concat([Buffer.from(`${head}\n`), ...files.map(([, content]) => content)]);
const packed = execFileSync("xz", ["--format=lzma", "-9e", "--stdout"], { input: all, maxBuffer: 1 << 28 });
writeFileSync(file, packed);
console.log(`${file}: ${packed.length} bytes for ${files.length} files`);
