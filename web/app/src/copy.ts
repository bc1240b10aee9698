// The same question for other places: the command line, Python, a model file.

const plain = (text: string) => /^[\w@%+=:,./-]+$/.test(text);
const shell = (text: string) => (plain(text) ? text : `'${text.replaceAll("'", String.raw`'\''`)}'`);

/** Options that give parameters their values. */
export function sets(values: [string, string][]): string[] {
  return values.flatMap(([name, value]) => ["--set", `${name}=${value}`]);
}

export function commandLine(parameter: string | undefined, values: [string, string][]): string {
  const verdict = ["jurist", "verdict", "model.toml", ...sets(values)].map(shell).join(" ");
  if (!parameter) return `${verdict}\n`;
  const others = values.filter(([name]) => name !== parameter);
  return `${verdict}\n${["jurist", "intervals", "model.toml", "--param", parameter, ...sets(others)].map(shell).join(" ")}\n`;
}

export function python(text: string, parameter: string | undefined, values: [string, string][]): string {
  const string = (t: string) => JSON.stringify(t).replace(/[\u007f-\uffff]/g, (c) => `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`);
  const given = (all: [string, string][]) => (all.length > 0 ? `{${all.map(([n, v]) => `${string(n)}: ${string(v)}`).join(", ")}}` : "");
  const lines = ["import jurist", "", `loop = jurist.Loop.from_toml(${string(text)})`, `print(loop.verdict(${given(values)}))`];
  if (parameter) {
    const others = given(values.filter(([name]) => name !== parameter));
    lines.push(`print(loop.intervals(${string(parameter)}${others ? `, ${others}` : ""}))`);
  }
  return `${lines.join("\n")}\n`;
}

/** The text with the nominal values of its parameters replaced, where that can be done without reading it anew. */
export function withNominals(text: string, values: [string, string][]): string {
  let out = text;
  for (const [name, value] of values) {
    const escaped = name.replace(/[.*+?^${}()|[\]\\]/g, String.raw`\$&`);
    const line = new RegExp(String.raw`^(\s*${escaped}\s*=\s*\{[^}\n]*?\bnominal\s*=\s*)("[^"\n]*"|'[^'\n]*'|[^,}\s]+)`, "m");
    out = out.replace(line, (_, before: string) => `${before}${JSON.stringify(value)}`);
  }
  return out;
}
