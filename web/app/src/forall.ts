// What holds for all values of other names: which question, and the program's arguments. The answer is the program's, in its own words.

/** The question about margins; the others are names of parameters. */
export const MARGINS = "how much of each margin";

/** The ranges of a line such as `L=0..5e-3 T=1e-4..2e-4`, or the word that is none. */
export function rangesOf(line: string): { ranges: string[] } | { wrong: string } {
  const words = line.split(/[\s,;]+/).filter((word) => word !== "");
  const wrong = words.find((word) => !/^[^=\s]+=.+\.\..+$/.test(word));
  return wrong === undefined ? { ranges: words } : { wrong };
}

/** A range to begin with: a tenth around the value of a parameter that is not asked about. */
export function firstRange(values: [string, string][], chosen: string[]): string {
  const other = [...values].reverse().find(([name, value]) => !chosen.includes(name) && Number(value) !== 0 && Number.isFinite(Number(value)));
  if (!other) return "";
  const [name, value] = other;
  const ends = [0.9, 1.1].map((part) => String(Number((Number(value) * part).toPrecision(6)))).sort((a, b) => Number(a) - Number(b));
  return `${name}=${ends[0]}..${ends[1]}`;
}

/** The program's arguments: a name that is free or has a range keeps no value. */
export function forAll(what: string, ranges: string[], values: [string, string][]): string[] {
  const ranged = ranges.map((range) => range.slice(0, range.indexOf("=")));
  const about = what === MARGINS ? ["margins", "-"] : ["intervals", "-", "--param", what];
  const others = values.filter(([name]) => name !== what && !ranged.includes(name)).flatMap(([name, value]) => ["--set", `${name}=${value}`]);
  return [...about, ...ranges.flatMap((range) => ["--for-all", range]), ...others];
}
