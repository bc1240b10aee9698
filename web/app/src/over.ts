// What an end that is no algebraic number is a zero of, in words.

/** Rows of a table: what, and which. */
export function over(of: any): [string, string][] {
  const named = (all: Record<string, string>) => Object.entries(all).map(([name, is]) => `${name} = ${is}`).join(", ");
  const list = (all: string[]) => `[${all.join(", ")}]`;
  if (of.polynomial) return [["root of, from the constant term up", list(of.polynomial)], ["with", named(of.symbols)]];
  if (of.function) {
    const { function: name, ...details } = of;
    return [["zero of", name], ...(Object.keys(details).length > 0 ? [["with", named(details)] as [string, string]] : [])];
  }
  const { omega2, theta, k } = of;
  return [
    ["a pair of roots on the axis, at ±iω; ω² is a root of, from the constant term up", list(omega2.polynomial)],
    ["ω² between", omega2.enclosure.join(" and ")],
    ["the end is (θ + 2πk)/ω with θ between", theta.join(" and ")],
    ["k", String(k)],
  ];
}
