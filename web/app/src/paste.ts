// What people have at hand, as a model: TOML as it is, polynomials, `tf(...)` of MATLAB and python-control. Numbers stay the texts
// they were written as.

const LIST = String.raw`\[([^\]\[]*)\]`;
const TF = new RegExp(String.raw`\btf\s*\(\s*${LIST}\s*,\s*${LIST}\s*(?:,\s*(?:dt\s*=\s*)?([^,)\s]+)\s*)?[,)]`);
const ONE_LIST = new RegExp(String.raw`^\s*(?:[A-Za-z_]\w*\s*=\s*)?(?:np\.array\s*\(\s*)?${LIST}\s*\)?\s*;?\s*$`);
const NUMBER = /^[+-]?(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?$/i;
const NAME = /[A-Za-z_]\w*/g;
const FUNCTIONS = new Set(["pi", "sqrt", "exp", "sin", "cos", "tan"]);

function numbers(text: string): string[] {
  const parts = text.trim().replaceAll(",", " ").split(/\s+/).filter((t) => t !== "");
  if (parts.length === 0) throw new Error("the list of coefficients is empty");
  for (const part of parts) if (!NUMBER.test(part)) throw new Error(`'${part}' is not a number`);
  return parts;
}

const quoted = (text: string) => JSON.stringify(text);
const list = (all: string[]) => `[${all.map(quoted).join(", ")}]`;

function parameters(names: Iterable<string>): string {
  const lines = [...names].map((name) => `${name} = { nominal = 1, min = 0 }`);
  return lines.length > 0 ? `\n[parameters]\n${lines.join("\n")}\n` : "\n[parameters]\n";
}

/** A model's text of a pasted text; an error says what was not understood. */
export function asModel(pasted: string): string {
  const text = pasted.trim();
  if (/^\s*\[(loop|\[block\]|parameters|constants)\]/m.test(text) || /^\s*(time|loop\.\w+)\s*=/m.test(text)) return pasted;
  const tf = TF.exec(text);
  if (tf) return transfer(numbers(tf[1]!), numbers(tf[2]!), tf[3]);
  const one = ONE_LIST.exec(text);
  if (one) {
    const terms = numbers(one[1]!);
    const power = (k: number) => (k === 0 ? "" : k === 1 ? "*s" : `*s^${k}`);
    return polynomial(terms.map((c, k) => `(${c})${power(terms.length - 1 - k)}`).join(" + "), "s");
  }
  const body = text.replace(/^[A-Za-z_]\w*\s*(\([zs]\))?\s*=(?!=)/, "").replace(/=\s*0\s*;?\s*$/, "").replaceAll("**", "^").replace(/;\s*$/, "").trim();
  const names = new Set(body.match(NAME) ?? []);
  if (/^[\w\s+\-*/^().]+$/.test(body) && (names.has("z") || names.has("s"))) return polynomial(body, names.has("z") ? "z" : "s");
  throw new Error("this is no model file, no polynomial in z or s, and no tf(...)");
}

function polynomial(body: string, variable: "z" | "s"): string {
  const names = new Set((body.match(NAME) ?? []).filter((name) => name !== variable && !FUNCTIONS.has(name) && !/^e\d*$/i.test(name)));
  // A polynomial without a name has nothing to ask for: its own scale is.
  const free = names.size > 0 ? names : undefined;
  const shown = free ? body : body;
  return `time = "${variable === "z" ? "discrete" : "continuous"}"\n${free ? parameters(free) : ""}\n[loop]\ncharacteristic = ${quoted(shown)}\n`;
}

function transfer(num: string[], den: string[], time: string | undefined): string {
  const step = time === undefined || time === "0" || time === "None" ? undefined : time === "True" || time === "-1" ? "" : time;
  if (step !== undefined && step !== "" && !NUMBER.test(step)) throw new Error(`'${step}' is not a sample time`);
  const discrete = step !== undefined;
  return [
    "# The loop of a gain K and what was pasted, closed with negative feedback.",
    `time = "${discrete ? "discrete" : "continuous"}"`,
    ...(step ? [`sample_time = ${quoted(step)}`] : []),
    "",
    "[parameters]",
    "K = { nominal = 1, min = 0 }",
    "",
    "[loop]",
    'inputs = ["r"]',
    'outputs = ["y"]',
    "",
    "[[block]]",
    'name = "gain"',
    'input = "r - y"',
    'output = "u"',
    'gain = "K"',
    "",
    "[[block]]",
    'name = "plant"',
    'input = "u"',
    'output = "y"',
    `num = ${list(num)}`,
    `den = ${list(den)}`,
    "",
  ].join("\n");
}
