// What an end is a root or a zero of, as a formula in the language of model files, and in words.

/** `2*K^3 - K + 5 = 0` of coefficients from the constant term up. */
export function equation(coefficients: string[], name: string): string {
  let text = "";
  for (const [k, coefficient] of [...coefficients.entries()].reverse()) {
    if (coefficient === "0") continue;
    const single = /^-?[\w./]+$/.test(coefficient);
    const negative = single && coefficient.startsWith("-");
    const size = negative ? coefficient.slice(1) : single ? coefficient : `(${coefficient})`;
    const power = k === 0 ? "" : k === 1 ? name : `${name}^${k}`;
    const term = power === "" ? size : size === "1" ? power : `${size}*${power}`;
    text += text === "" ? (negative ? `-${term}` : term) : `${negative ? " - " : " + "}${term}`;
  }
  return `${text || "0"} = 0`;
}

/** Rows of a table about an end of the set of a parameter: what, and which. */
export function over(of: any, name: string): [string, string][] {
  const named = (all: Record<string, string>) => Object.entries(all).filter(([what, is]) => what !== is).map(([what, is]) => `${what} = ${is}`).join(", ");
  const where = (all: Record<string, string>): [string, string][] => (named(all) === "" ? [] : [["with", named(all)]]);
  if (of.polynomial) return [["root of", equation(of.polynomial, name)], ...where(of.symbols)];
  if (of.function) {
    const { function: what, ...details } = of;
    return [["zero of", what], ...where(details)];
  }
  const { omega2, theta, k } = of;
  return [
    ["a pair of roots on the axis", "at ±iω with ω² = x"],
    ["x is a root of", equation(omega2.polynomial, "x")],
    ["x between", omega2.enclosure.join(" and ")],
    ["the end is", k === 0 ? "θ/ω" : `(θ + ${2 * k}π)/ω`],
    ["θ between", theta.join(" and ")],
  ];
}
