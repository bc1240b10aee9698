// Opens the page of 'jurist map -z ... -o PAGE' from disk, off the network, as a phone and a desk see it: looks for what is wrong
// with it (tests/browser/page.js), moves the slider by its keys, and compares the verdicts that the page looks up with those of
// 'jurist verdict'.
//
//   node tests/browser/body_page.mjs JURIST [PICTURES_FOLDER]
//
// CHROMIUM names the browser, else chromium, chromium-browser or google-chrome is looked for.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Browser, complaints, program } from "./devtools.mjs";

const WINDOWS = [
  { name: "phone", width: 390, height: 844, scale: 2, mobile: true },
  { name: "desk", width: 1200, height: 900, scale: 1, mobile: false },
];
const [jurist, pictures] = process.argv.slice(2);
if (!jurist) {
  console.error("usage: node tests/browser/body_page.mjs JURIST [PICTURES_FOLDER]");
  process.exit(2);
}
const here = dirname(fileURLToPath(import.meta.url));
const model = resolve(here, "../../examples/pid-body.toml");
const folder = mkdtempSync(join(tmpdir(), "jurist-body-"));
const file = join(folder, "body.html");
execFileSync(jurist, ["map", model, "-x", "K_i", "-y", "K_d", "-z", "K_p=-1..2:13", "-o", file]);
const url = pathToFileURL(file).href;
const ask = readFileSync(join(here, "page.js"), "utf8");

// The picture that is seen, as one number that changes with it, and what stands beside it.
const STATE = `(() => {
  const seen = [...document.querySelectorAll(".slice")].filter((s) => s.getClientRects().length > 0);
  const svg = [...seen[0].querySelectorAll("svg")].find((s) => s.getClientRects().length > 0);
  const drawn = svg.cloneNode(true);
  drawn.querySelector(".pointer").remove();
  const text = drawn.innerHTML;
  let hash = 0;
  for (let k = 0; k < text.length; k++) hash = (hash * 31 + text.charCodeAt(k)) | 0;
  return { seen: seen.length, hash, at: document.getElementById("at").textContent, value: document.getElementById("slice").value,
    words: document.getElementById("slice").getAttribute("aria-valuetext"), row: document.querySelector("#slices [aria-current=true]").textContent,
    verdict: document.getElementById("verdict").textContent, roots: document.getElementById("roots").textContent };
})()`;

const faults = [];
const expect = (what, is, wanted) => {
  if (is !== wanted) faults.push(`${what}: '${is}' instead of '${wanted}'`);
};
const browser = new Browser(program());
const drawn = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))";
try {
  await browser.attach();
  if (pictures) mkdirSync(pictures, { recursive: true });
  for (const { name, width, height, scale, mobile } of WINDOWS) {
    await browser.open(url, width, height, scale, mobile);
    const state = async () => (await browser.value(drawn), await browser.value(STATE));
    const key = async (named) => {
      for (const type of ["keyDown", "keyUp"]) {
        await browser.send("Input.dispatchKeyEvent", { type, key: named, code: named, windowsVirtualKeyCode: { Home: 36, End: 35, ArrowLeft: 37, ArrowRight: 39 }[named] });
      }
      return state();
    };
    const page = await browser.value(ask);
    faults.push(...page.faults.map((f) => `${name}: ${f}`));
    const first = await state();
    expect(`${name}: slices seen at first`, first.seen, 1);
    expect(`${name}: the first slice is the nominal one`, first.at, "K_p = 0.5");
    expect(`${name}: verdict at first`, first.verdict, "stable");
    await new Promise((done) => setTimeout(done, 400));
    const near = await browser.value(`document.getElementById("near").textContent`);
    if (!near.includes("0 < K_i < 0.75; -0.5625 < K_d < 0.6")) faults.push(`${name}: one parameter alone: ${near}`);
    await browser.value(`document.getElementById("slice").focus()`);
    const next = await key("ArrowRight");
    expect(`${name}: after the arrow`, `${next.seen} ${next.at} ${next.words}`, "1 K_p = 0.75 K_p = 0.75");
    if (next.hash === first.hash) faults.push(`${name}: the picture did not change with the slider`);
    if (!next.row.startsWith("0.75")) faults.push(`${name}: the table marks '${next.row}'`);
    expect(`${name}: after Home`, (await key("Home")).at, "K_p = \u22121");
    expect(`${name}: verdict there`, (await state()).verdict, "unstable");
    expect(`${name}: after End`, (await key("End")).at, "K_p = 2");
    expect(`${name}: back at the first slice`, (await browser.value(`(() => { const s = document.getElementById("slice"); s.value = 6;
      s.dispatchEvent(new Event("input")); })()`), (await state()).hash), first.hash);
    const again = await browser.value(ask);
    faults.push(...again.faults.map((f) => `${name}, another slice: ${f}`));
    console.log(`${name}: ${page.height} px high at ${width} px`);
    if (pictures) writeFileSync(join(pictures, `body-${width}.png`), await browser.picture({ x: 0, y: 0, width, height: page.height }));
  }
  for (const [p, i, d] of [["1/2", "1/4", "0"], ["1/2", "1/2", "-1/2"], ["5/4", "1", "1/4"], ["5/4", "1", "3/4"], ["-1/2", "1/8", "1/2"], ["0", "2/3", "-1/3"], ["1.5", "1e-3", "-0.5"], ["2", "1", "1"]]) {
    const run = spawnSync(jurist, ["verdict", model, "--json", ...[`K_p=${p}`, `K_i=${i}`, `K_d=${d}`].flatMap((set) => ["--set", set])], { encoding: "utf8" });
    const known = JSON.parse(run.stdout);
    await browser.open("about:blank", 1200, 900, 1, false);
    await browser.open(`${url}#K_i=${i}&K_d=${d}&K_p=${p}`, 1200, 900, 1, false);
    await browser.value(drawn);
    const { verdict, roots } = await browser.value(STATE);
    const place = `K_p=${p} K_i=${i} K_d=${d}`;
    const wanted = known.verdict === "marginal" ? "on a boundary: not stable" : known.verdict;
    expect(place, verdict, wanted);
    const outside = known.outside;
    const count = outside === 0 ? "all 4 roots inside" : outside === 4 ? "all 4 roots outside" : `${outside} of 4 roots outside`;
    if (wanted === known.verdict && !roots.startsWith(count)) faults.push(`${place}: '${roots}' instead of '${count}'`);
  }
  faults.push(...complaints(browser.events, (asked) => asked === "about:blank" || asked.split("#")[0] === url));
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
for (const fault of faults) console.error(fault);
console.log(faults.length === 0 ? "nothing wrong" : `${faults.length} faults`);
process.exit(faults.length === 0 ? 0 : 1);
