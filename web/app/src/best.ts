// The best gains: which are free, and what is to be best. The answer is the program's, in its own words.

/** What the section [tune] of a text says of it, as far as a line each tells. */
function written(text: string): { free?: string[]; objective?: string } {
  const section = /^\s*\[tune\]\s*$([\s\S]*?)(?=^\s*\[|(?![\s\S]))/m.exec(text)?.[1] ?? "";
  const free = /^\s*free\s*=\s*(\[[^\]]*\]|"[^"]*"|'[^']*')/m.exec(section)?.[1];
  const objective = /^\s*objective\s*=\s*(?:"([^"]*)"|'([^']*)')/m.exec(section);
  const names = [...(free ?? "").matchAll(/["']([^"']+)["']/g)].map((m) => m[1]!);
  return { ...(names.length > 0 ? { free: names } : {}), ...(objective ? { objective: objective[1] ?? objective[2]! } : {}) };
}

/** The gains that are free: those of the text, else the axes of the map or the parameter in focus. */
export function gainsOf(text: string, chosen: string[]): string[] {
  return written(text).free ?? chosen.slice(0, 2);
}

/** What may be best, that of the text first. */
export function objectivesOf(text: string, gains: string[], time: string): string[] {
  const own = written(text).objective;
  const speed = time === "discrete" ? "min radius" : "max decay";
  const all = ["max modulus_margin", "max phase_margin", speed, "max tolerance absolute", ...gains.flatMap((name) => [`max ${name}`, `min ${name}`])];
  return [...new Set([...(own ? [own] : []), ...all])];
}

/** The program's arguments. */
export function tuning(gains: string[], objective: string, values: [string, string][]): string[] {
  const others = values.filter(([name]) => !gains.includes(name)).flatMap(([name, value]) => ["--set", `${name}=${value}`]);
  return ["tune", "-", ...gains.flatMap((name) => ["--free", name]), "--objective", objective, ...others];
}
