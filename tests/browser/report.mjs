// Opens the report of `jurist paper` from disk, off the network, as a phone and a desk see it and as
// it prints, and looks for what is wrong: errors, requests, a page wider than its window, words over
// words, words cut off, words too small or too pale.
//
//   node tests/browser/report.mjs REPORT_FOLDER [PICTURES_FOLDER] [--figures]
//
// PICTURES_FOLDER gets page-WIDTH.png (in parts) and report.pdf, with --figures every figure alone.
// CHROMIUM names the browser, else chromium, chromium-browser or google-chrome is looked for.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Browser, complaints, program } from "./devtools.mjs";

const WINDOWS = [
  { name: "phone", width: 390, height: 844, scale: 2, mobile: true },
  { name: "desk", width: 1280, height: 900, scale: 1, mobile: false },
];
// Taller pictures than this are written in parts.
const PART = 3000;
const A4 = { paperWidth: 8.27, paperHeight: 11.69, marginTop: 0.6, marginBottom: 0.6, marginLeft: 0.6, marginRight: 0.6 };

const plain = process.argv.slice(2).filter((a) => !a.startsWith("--"));
const alone = process.argv.includes("--figures");
const [folder, pictures] = plain;
if (!folder) {
  console.error("usage: node tests/browser/report.mjs REPORT_FOLDER [PICTURES_FOLDER] [--figures]");
  process.exit(2);
}

const url = pathToFileURL(resolve(folder, "report.html")).href;
const ask = readFileSync(join(dirname(fileURLToPath(import.meta.url)), "page.js"), "utf8");
const browser = new Browser(program());
const faults = [];
try {
  await browser.attach();
  if (pictures) mkdirSync(pictures, { recursive: true });
  for (const { name, width, height, scale, mobile } of WINDOWS) {
    await browser.open(url, width, height, scale, mobile);
    const page = await browser.value(ask);
    if (page.figures === 0) faults.push(`${name}: the page has no figure`);
    faults.push(...page.faults.map((f) => `${name}: ${f}`));
    console.log(`${name}: ${page.figures} figures, ${page.height} px high at ${width} px`);
    if (!pictures) continue;
    for (let y = 0, k = 1; y < page.height; y += PART, k++) {
      const part = { x: 0, y, width, height: Math.min(PART, page.height - y) };
      writeFileSync(join(pictures, `page-${width}-${String(k).padStart(2, "0")}.png`), await browser.picture(part));
    }
    if (!alone) continue;
    const boxes = await browser.value(
      `[...document.querySelectorAll("figure")].map((f) => { const b = f.getBoundingClientRect();
        return { x: b.x + scrollX, y: b.y + scrollY, width: b.width, height: b.height }; })`,
    );
    for (const [k, box] of boxes.entries()) {
      writeFileSync(join(pictures, `figure-${width}-${String(k + 1).padStart(2, "0")}.png`), await browser.picture(box));
    }
  }
  const pdf = await browser.print(A4);
  if (pdf.subarray(0, 5).toString() !== "%PDF-") faults.push("the page does not print");
  console.log(`print: ${pdf.length} bytes`);
  if (pictures) writeFileSync(join(pictures, "report.pdf"), pdf);
  faults.push(...complaints(browser.events, (asked) => [url, "about:blank"].includes(asked)));
} finally {
  await browser.close();
}
for (const fault of faults) console.error(fault);
console.log(faults.length === 0 ? "nothing wrong" : `${faults.length} faults`);
process.exit(faults.length === 0 ? 0 : 1);
