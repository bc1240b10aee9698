// Polynomials as MathML, from the document of `charpoly --json`.

import { m } from "./dom.js";

/** Powers, and the number before them; of a complex loop its real and its imaginary part. */
type Term = [number[], string | [string, string]];
interface Coefficient {
  numerator: Term[];
  denominator: Term[];
}

function name(text: string): Element {
  const [base, ...rest] = text.split("_");
  if (!base || rest.length === 0) return m("mi", {}, text);
  return m("msub", {}, m("mi", {}, base), m("mi", {}, rest.join("_")));
}

function power(base: Element, exponent: number): Element {
  return exponent === 1 ? base : m("msup", {}, base, m("mn", {}, String(exponent)));
}

function number(text: string): Element {
  const [p, q] = text.split("/");
  return q === undefined ? m("mn", {}, p!) : m("mfrac", {}, m("mn", {}, p!), m("mn", {}, q));
}

/** Each term with one number; that of an imaginary part has the unit as a factor. */
function apart(terms: Term[]): [number[], string, boolean][] {
  return terms.flatMap(([powers, value]): [number[], string, boolean][] => {
    if (typeof value === "string") return [[powers, value, false]];
    const parts: [number[], string, boolean][] = value.map((part, i) => [powers, part, i === 1]);
    return parts.filter(([, part]) => part !== "0");
  });
}

function sum(terms: Term[], names: string[]): Element[] {
  const out: Element[] = [];
  for (const [k, [powers, coefficient, imaginary]] of apart(terms).entries()) {
    const negative = coefficient.startsWith("-");
    if (negative || k > 0) out.push(m("mo", {}, negative ? "−" : "+"));
    const size = negative ? coefficient.slice(1) : coefficient;
    const factors = powers.flatMap((e, i) => (e > 0 ? [power(name(names[i] ?? "?"), e)] : []));
    if (imaginary) factors.unshift(m("mi", {}, "j"));
    if (size !== "1" || factors.length === 0) out.push(number(size));
    out.push(...factors);
  }
  return out.length > 0 ? out : [m("mn", {}, "0")];
}

/** One line for each coefficient, from the highest power down. */
export function coefficients(document: any): Element[] {
  const names: string[] = [...(document.parameters ?? []), ...Object.keys(document.symbols ?? {})];
  const all: Coefficient[] = document.coefficients ?? [];
  const lines = all.map((coefficient, k) => {
    const one = coefficient.denominator.length === 1 && coefficient.denominator[0]![1] === "1" && coefficient.denominator[0]![0].every((e) => e === 0);
    const top = m("mrow", {}, ...sum(coefficient.numerator, names));
    const value = one ? top : m("mfrac", {}, top, m("mrow", {}, ...sum(coefficient.denominator, names)));
    return m("math", { display: "block" }, m("mrow", {}, m("msub", {}, m("mi", {}, "a"), m("mn", {}, String(k))), m("mo", {}, "="), value));
  });
  const variable = document.variable ?? "s";
  const whole = all.flatMap((_, k) => {
    const e = all.length - 1 - k;
    const a = m("msub", {}, m("mi", {}, "a"), m("mn", {}, String(e)));
    const term = e === 0 ? [a] : [a, power(m("mi", {}, variable), e)];
    return k === 0 ? term : [m("mo", {}, "+"), ...term];
  });
  return [m("math", { display: "block" }, m("mrow", {}, ...whole)), ...lines.reverse()];
}
