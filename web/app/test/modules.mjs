// Parts of the page that need no browser: node --test web/app/test/modules.mjs

import assert from "node:assert/strict";
import { test } from "node:test";
import { moduleOf } from "./instance.mjs";
import { withoutPlaceholders } from "../placeholders.mjs";
import { random } from "./models.mjs";

const numbers = await moduleOf("numbers.ts");
const replies = await moduleOf("reply.ts");
const about = await moduleOf("about.ts");
const models = await moduleOf("model.ts");
const copy = await moduleOf("copy.ts");
const overModule = await moduleOf("over.ts");
const paste = await moduleOf("paste.ts");
const link = await moduleOf("link.ts");

test("fractions of any length have a place", () => {
  assert.equal(numbers.float("1/10000"), 1e-4);
  assert.equal(numbers.float("1e-4"), 1e-4);
  assert.equal(numbers.float(`1${"0".repeat(400)}/2${"0".repeat(400)}`), 0.5);
  assert.ok(Math.abs(numbers.float(`-3${"1".repeat(700)}/2${"7".repeat(698)}`) / -112.0000000000004 - 1) < 1e-9);
  assert.ok(Number.isNaN(numbers.float(null)));
});

test("fractions that are short decimals are written as these, and nothing else is changed", () => {
  const cases = { "1/10000": "0.0001", "47/5000000": "9.4e-6", "-9/5000": "-0.0018", "1/3": "1/3", "1/2": "0.5", "1e-4": "1e-4", "0.10": "0.10", "1/0": "1/0", "K/2": "K/2", "6/4": "1.5", "1/1048576": "1/1048576" };
  for (const [text, expected] of Object.entries(cases)) assert.equal(numbers.plain(text), expected);
  const next = random(8);
  for (let k = 0; k < 500; k++) {
    const [p, q] = [Math.floor(next() * 1e6), 2 ** Math.floor(next() * 8) * 5 ** Math.floor(next() * 8)];
    assert.equal(Number(numbers.plain(`${p}/${q}`).split("/").reduce((a, b) => a / b)), p / q);
  }
});

test("a part of a root that is noise is not written", () => {
  assert.equal(numbers.complex(2.93874e-39, 0.707107), "0.707107i");
  assert.equal(numbers.complex(-0, -2), "−2i");
  assert.equal(numbers.complex(0.5, 1e-17), "0.5");
  assert.equal(numbers.complex(1e-9, -1), "1e−9 − 1i");
  assert.equal(numbers.complex(0, 0), "0");
});

test("what an end is a root or a zero of is a formula in the language of model files", () => {
  const { equation, over } = overModule;
  assert.equal(equation(["-6321", "2642"], "K"), "2642*K - 6321 = 0");
  assert.equal(equation(["5", "0", "-1", "1"], "T"), "T^3 - T^2 + 5 = 0");
  assert.equal(equation(["-1/2", "e_1 + 2", "-1"], "K"), "-K^2 + (e_1 + 2)*K - 1/2 = 0");
  assert.equal(equation(["0"], "K"), "0 = 0");
  assert.deepEqual(over({ symbols: { e_1: "exp(-T)" }, polynomial: ["1", "-e_1"] }, "K"), [["root of", "-e_1*K + 1 = 0"], ["with", "e_1 = exp(-T)"]]);
  assert.deepEqual(over({ function: "resultant of the half-size pair", pi: "pi", t1: "tan(1)" }, "K"), [["zero of", "resultant of the half-size pair"], ["with", "t1 = tan(1)"]]);
  const crossing = { omega2: { polynomial: ["-1", "1"], enclosure: ["1", "1"] }, theta: ["0", "1/10"], k: 2, direction: "+" };
  assert.deepEqual(over(crossing, "T").map(([, is]) => is), ["at ±iω with ω² = x", "x - 1 = 0", "1 and 1", "(θ + 4π)/ω", "0 and 1/10"]);
});

test("numbers stand as the text writes them, while they are the same", () => {
  const text = ["[constants]", "L = 9.4e-6 # H", "R = { value = '1.8e-3', tolerance = \"5%\" }", "a = 3", "[parameters]", "T = { nominal = 1e-4, min = 0 }", "K = \"1/3\"", "b = 7", "[parameters.c]", "min = 1", "nominal = 2.50"].join("\n");
  const parameter = (name, nominal) => ({ name, nominal, min: "1/10", max: null });
  const constant = (name, value) => ({ name, value, number: value });
  const model = {
    parameters: [parameter("T", "1/10000"), parameter("K", "1/3"), parameter("b", "8"), parameter("c", "5/2"), parameter("d", "1/8")],
    constants: [constant("L", "47/5000000"), constant("R", "9/5000"), constant("a", "1/2*K")],
    blocks: [["P", "u", "y", "1/2*s^3/2 + 1/(3/4*s) + x_1/2 + 9/5000/7"]],
  };
  const made = models.asWritten(model, text);
  assert.deepEqual(made.parameters.map((p) => p.nominal), ["1e-4", "1/3", "8", "2.50", "0.125"]);
  assert.deepEqual(made.parameters.map((p) => p.min), Array(5).fill("0.1"));
  assert.deepEqual(made.constants.map((c) => c.value), ["9.4e-6", "1.8e-3", "0.5*K"]);
  assert.equal(made.blocks[0][3], "0.5*s^3/2 + 1/(0.75*s) + x_1/2 + 9/5000/7");
});

test("two texts are one number or two, however they are written", () => {
  for (const [a, b] of [["1e-4", "1/10000"], ["0.5", ".5"], ["+2", "2."], ["-1.5e3", "-1500"], ["0.1/0.2", "1/2"], [null, null], ["1e9999", "1e9999"]]) assert.ok(numbers.same(a, b), `${a} ${b}`);
  for (const [a, b] of [["1e-4", "1e-5"], ["1/3", "0.333"], ["1", null], ["K", "1"], ["1/0", "2/0"], ["1e9999", "1e9998"]]) assert.ok(!numbers.same(a, b), `${a} ${b}`);
});

test("numbers are told from what is none", () => {
  for (const text of ["110", "1e-4", " 1/3 ", "-.5", "+2.", "1.5e3/2.5"]) assert.ok(numbers.isNumber(text), text);
  for (const text of ["", "e5", "1/", "--1", "1 2", "0x1", "inf", "1/2/3", "1,5"]) assert.ok(!numbers.isNumber(text), text);
});

test("a decimal comma is told from other mistakes", () => {
  assert.equal(numbers.hint("12,5"), "a decimal point, not a comma: 12.5");
  assert.equal(numbers.hint(" -,5"), "a decimal point, not a comma: -.5");
  for (const text of ["", "x", "1,2,3", "1/2,5", "12,"]) assert.equal(numbers.hint(text), "a number such as 110, 1e-4 or 1/3", text);
});

test("where there is no answer, it is said once and with what can be asked instead", () => {
  const refused = (message, help) => ({ refused: { diagnostics: [{ code: "E-dead-time", message, help }] } });
  assert.equal(replies.instead(refused("this cannot be asked", "what can be asked: verdict")), "This cannot be asked. What can be asked: verdict.");
  assert.equal(replies.instead(refused("this cannot be asked", null)), "this cannot be asked");
  assert.equal(replies.instead({ stopped: "cancelled" }), "undecided: cancelled");
  assert.equal(replies.instead({ output: "{}" }), undefined);
});

test("roots are counted in words, with dead time too", () => {
  assert.equal(about.counted({ time: "discrete", degree: 6, inside: 5, on: 0, outside: 1, infinite: 0 }), "5 of 6 roots inside the unit circle, 1 outside");
  const delayed = (on, outside) => about.counted({ time: "continuous", degree: 2, inside: null, on, outside, infinite: null });
  assert.equal(delayed(0, 0), "no roots in the right half plane");
  assert.equal(delayed(2, 1), "1 root in the right half plane, 2 on the axis");
});

test("the neighbour of an end is the next decimal on the side that is asked for", () => {
  assert.equal(numbers.beside("550.941166687", false), "550.94");
  assert.equal(numbers.beside("550.941166687", true), "550.942");
  assert.equal(numbers.beside("0.0381005333483", true), "0.0381006");
  assert.equal(numbers.beside("2", false), "1.99999");
  assert.equal(numbers.beside("-1", true), "-0.99999");
  assert.equal(numbers.beside("1.5e-9", true), "1.50001e-9");
});

test("decimals without loss are the decimals that they are", () => {
  const next = random(5);
  for (let k = 0; k < 2000; k++) {
    const digits = BigInt(Math.floor((next() - 0.5) * 1e9));
    const exponent = Math.floor(next() * 30) - 20;
    const text = numbers.decimalText(digits, exponent);
    const [mantissa, e = "0"] = text.split("e");
    const [whole, part = ""] = mantissa.split(".");
    const same = BigInt(whole + part) * 10n ** BigInt(60 + Number(e) - part.length);
    assert.equal(same, digits * 10n ** BigInt(60 + exponent), text);
    assert.ok(numbers.isNumber(text), text);
  }
});

test("a place on a track and its value are inverse to each other", () => {
  for (const scale of [{ lower: -3, upper: 5, log: false }, { lower: 1e-6, upper: 20, log: true }]) {
    for (let k = 0; k <= 100; k++) {
      const at = numbers.place(scale, Number(numbers.decimalAt(scale, k / 100)));
      assert.ok(Math.abs(at - k / 100) < 1e-3, `${k}: ${at}`);
    }
  }
});

test("ticks are round, inside of their axis, and parts of a turn where it is in degrees", () => {
  assert.deepEqual(numbers.ticks({ lower: -1.6, upper: 1.6, log: false }, 3.5), [-1, 0, 1]);
  assert.deepEqual(numbers.ticks({ lower: -200, upper: 210, log: false, degrees: true }, 2.5), [-180, 0, 180]);
  assert.deepEqual(numbers.ticks({ lower: -52, upper: 71, log: false, decibels: true }, 3.5), [-40, 0, 40]);
  assert.deepEqual(numbers.ticks({ lower: 0.02, upper: 5000, log: true }, 3), [0.1, 10, 1000]);
});

test("nominal values are replaced in the section of the parameters and nowhere else", () => {
  const text = '[constants]\nK = 1\n[parameters]\nK = { nominal = 2, min = 0 } # K = 3\n"T" = 1e-4 # s\na = { min = 0, nominal = "1/3" }\n[loop]\nK = 1\n';
  const expected = '[constants]\nK = 1\n[parameters]\nK = { nominal = "5/7", min = 0 } # K = 3\n"T" = "2e-4" # s\na = { min = 0, nominal = "1/2" }\n[loop]\nK = 1\n';
  assert.equal(copy.withNominals(text, [["K", "5/7"], ["T", "2e-4"], ["a", "1/2"]]), expected);
});

test("a command line and a line of Python survive any text", () => {
  assert.equal(copy.commandLine("K", [["K", "1"], ["T", "1/3"]]), "jurist verdict model.toml --set K=1 --set T=1/3\njurist intervals model.toml --param K --set T=1/3\n");
  assert.match(copy.commandLine(undefined, [["a'b", "1"]]), /--set 'a'\\''b=1'/);
  const python = copy.python('title = "\u{1f600} \\" """"', "K", [["K", "1"], ["T", "2"]]);
  assert.match(python, /Loop\.from_toml\("title = \\"\\ud83d\\ude00 \\\\\\" \\"\\"\\"\\""\)/);
  assert.match(python, /loop\.intervals\("K", \{"T": "2"\}\)/);
});

test("what is pasted is understood or refused", () => {
  assert.match(paste.asModel("z^2 + (K - 1)*z + 1/2"), /time = "discrete"[^]*K = \{ nominal = 1[^]*characteristic = "z\^2 \+ \(K - 1\)\*z \+ 1\/2"/);
  assert.match(paste.asModel("s**2 + 2*s + k1 = 0"), /time = "continuous"[^]*k1 = [^]*"s\^2 \+ 2\*s \+ k1"/);
  assert.match(paste.asModel("sys = tf([1 2],[1 3 2]);"), /num = \["1", "2"\]\nden = \["1", "3", "2"\]/);
  assert.match(paste.asModel("control.tf([1], [1, -0.5], 0.01)"), /time = "discrete"\nsample_time = "0.01"/);
  assert.match(paste.asModel("tf([1], [1, -0.5], dt=True)"), /time = "discrete"\n\n/);
  assert.match(paste.asModel("[1, 2, 3]"), /\(1\)\*s\^2 \+ \(2\)\*s \+ \(3\)/);
  const model = 'time = "discrete"\n[loop]\ncharacteristic = "z"\n';
  assert.equal(paste.asModel(model), model);
  for (const text of ["", "hello", "tf([a],[1])", "tf([],[1])", "<script>", "z; alert(1)", "require('x')"]) assert.throws(() => paste.asModel(text), text);
});

test("links hold what was put into them, and broken ones are refused", async () => {
  const next = random(9);
  for (let k = 0; k < 50; k++) {
    const m = Array.from({ length: Math.floor(next() * 3000) }, () => String.fromCodePoint(32 + Math.floor(next() * 0x2fff))).join("");
    const shared = { m, v: { K: "1/3", __proto__x: "2" }, p: "K", c: "u", a: ["K", "T"] };
    const packed = await link.pack(shared);
    assert.match(packed, /^#1=[\w-]+$/);
    assert.deepEqual({ ...(await link.unpack(packed)), v: shared.v }, shared);
  }
  assert.equal(await link.unpack("#answers"), undefined);
  for (const broken of ["#1=", "#1=AAAA", "#2=AAAA", `#1=${"A".repeat(50)}`]) await assert.rejects(link.unpack(broken), broken);
  const bomb = await link.pack({ m: "a".repeat(3 << 20) });
  await assert.rejects(link.unpack(bomb), /more than a megabyte/);
  await assert.rejects(link.unpack(await link.pack({ m: 1 })), /no model/);
});

test("what stands for a function of the second part traps, until that part puts the function into its place", async () => {
  const [i32, func] = [0x7f, 0x60];
  const bytes = (...parts) => Buffer.from(parts.flat());
  const text = (t) => [t.length, ...Buffer.from(t)];
  const section = (id, ...content) => [id, content.flat().length, ...content.flat()];
  const head = [0, 0x61, 0x73, 0x6d, 1, 0, 0, 0];
  // Imports `page.progress` and two placeholders; `call` calls the first function of a table, which is a placeholder, `own` gives 7.
  const first = bytes(
    head,
    section(1, 2, [func, 0, 1, i32], [func, 2, i32, i32, 0]),
    section(2, 3, [...text("page"), ...text("progress"), 0, 1], [...text("placeholder"), ...text("0"), 0, 0], [...text("placeholder"), ...text("1"), 0, 1]),
    section(3, 2, 0, 0),
    section(4, 1, 0x70, 0, 1),
    section(7, 3, [...text("call"), 0, 3], [...text("own"), 0, 4], [...text("table"), 1, 0]),
    section(9, 1, 0, 0x41, 0, 0x0b, 1, 1),
    section(10, 2, [7, 0, 0x41, 0, 0x11, 0, 0, 0x0b], [4, 0, 0x41, 7, 0x0b]),
  );
  // Puts a function that gives 40 more than `own` there.
  const second = bytes(
    head,
    section(1, 1, func, 0, 1, i32),
    section(2, 2, [...text("primary"), ...text("own"), 0, 0], [...text("primary"), ...text("table"), 1, 0x70, 0, 1]),
    section(3, 1, 0),
    section(9, 1, 0, 0x41, 0, 0x0b, 1, 1),
    section(10, 1, [7, 0, 0x10, 0, 0x41, 40, 0x6a, 0x0b]),
  );
  const made = await WebAssembly.compile(withoutPlaceholders(first));
  assert.deepEqual(WebAssembly.Module.imports(made).map((i) => i.name), ["progress"]);
  const { exports } = await WebAssembly.instantiate(made, { page: { progress: () => {} } });
  assert.equal(exports.own(), 7);
  assert.throws(() => exports.call(), WebAssembly.RuntimeError);
  await WebAssembly.instantiate(await WebAssembly.compile(second), { primary: exports });
  assert.equal(exports.call(), 47);
});

test("ranges are read from a line, and what has one keeps no value", async () => {
  const { MARGINS, firstRange, forAll, rangesOf } = await moduleOf("forall.ts");
  assert.deepEqual(rangesOf(" L=0..5e-3, T=1..2 "), { ranges: ["L=0..5e-3", "T=1..2"] });
  assert.deepEqual(rangesOf("L=0..1 T"), { wrong: "T" });
  assert.equal(firstRange([["K", "2"], ["L", "-1"], ["T", "0"]], ["K"]), "L=-1.1..-0.9");
  assert.equal(firstRange([["K", "1/3"]], []), "");
  const values = [["K", "1"], ["L", "2"], ["T", "3"]];
  assert.deepEqual(forAll(MARGINS, ["L=1..2"], values), ["margins", "-", "--for-all", "L=1..2", "--set", "K=1", "--set", "T=3"]);
  assert.deepEqual(forAll("K", ["L=1..2"], values), ["intervals", "-", "--param", "K", "--for-all", "L=1..2", "--set", "T=3"]);
});

test("the best gains are those of the text, else those in the picture", async () => {
  const { gainsOf, objectivesOf, tuning } = await moduleOf("best.ts");
  const text = ["[parameters]", "free = 1", "[tune]", "free = ['ki', \"k\"]", "objective = \"max ki\"   # as written", "[require]", "objective = 'max other'"].join("\n");
  assert.deepEqual(gainsOf(text, ["a", "b"]), ["ki", "k"]);
  assert.deepEqual(gainsOf("[parameters]\nfree = 'x'", ["a", "b", "c"]), ["a", "b"]);
  assert.equal(objectivesOf(text, ["ki"], "continuous")[0], "max ki");
  assert.equal(objectivesOf(text, ["ki"], "continuous").filter((o) => o === "max ki").length, 1);
  assert.ok(objectivesOf("", ["K"], "discrete").includes("min radius") && !objectivesOf("", ["K"], "discrete").includes("max decay"));
  assert.deepEqual(tuning(["k"], "max k", [["k", "1"], ["T", "1e-4"]]), ["tune", "-", "--free", "k", "--objective", "max k", "--set", "T=1e-4"]);
});
