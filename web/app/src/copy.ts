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

/** The text with the nominal values of its parameters replaced, where they stand in a line of their own. */
export function withNominals(text: string, values: [string, string][]): string {
  const given = new Map(values);
  let section = "";
  const line = (one: string): string => {
    section = /^\s*\[+\s*([^\]]+?)\s*\]/.exec(one)?.[1] ?? section;
    if (section !== "parameters") return one;
    const [, before = "", name = "", rest = ""] = /^(\s*["']?([\w-]+)["']?\s*=\s*)(.*)$/.exec(one) ?? [];
    const value = given.get(name);
    if (value === undefined) return one;
    const quoted = JSON.stringify(value);
    if (rest.startsWith("{")) return before + rest.replace(/(\b(?:nominal|value)\s*=\s*)("[^"]*"|'[^']*'|[^,}\s]+)/, (_, key: string) => key + quoted);
    return before + rest.replace(/^("[^"]*"|'[^']*'|[^#\s]+)/, () => quoted);
  };
  return text.split("\n").map(line).join("\n");
}
