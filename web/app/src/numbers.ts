// Numbers as texts, and their places in pictures. What is asked of the engine is always the text; the floating point is for places.

/** `110`, `1e-4`, `1/3`: what the engine reads as a number. */
const NUMBER = /^\s*[+-]?(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?\s*(\/\s*(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?\s*)?$/i;

export function isNumber(text: string): boolean {
  return NUMBER.test(text) && text.length < 4000;
}

/** What is wrong with a text that is no number. */
export function hint(text: string): string {
  const [, whole, part] = /^\s*([+-]?\d*),(\d+)\s*$/.exec(text) ?? [];
  if (part !== undefined) return `a decimal point, not a comma: ${whole || "0"}.${part}`;
  return "a number such as 110, 1e-4 or 1/3";
}

/** About. `p/q` of any length: both sides are scaled by their lengths. */
export function float(text: string | null | undefined): number {
  if (text === null || text === undefined) return NaN;
  const [p, q] = text.split("/");
  const whole = Number(p);
  if (q === undefined) return whole;
  const parts = Number(q);
  if (Number.isFinite(whole) && Number.isFinite(parts)) return whole / parts;
  const digits = (t: string) => t.trim().replace(/^[+-]/, "");
  const cut = (t: string) => Number(`0.${digits(t).slice(0, 20)}`);
  const sign = p!.trim().startsWith("-") ? -1 : 1;
  return sign * (cut(p!) / cut(q)) * 10 ** (digits(p!).length - digits(q).length);
}

/** A float in so many digits, for people. */
export function short(value: number, digits = 4): string {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : value < 0 ? "−∞" : "undefined";
  const size = Math.abs(value);
  const text = size >= 1e-4 && size < 1e6 ? String(Number(value.toPrecision(digits))) : trimmed(value.toExponential(digits - 1));
  return text.replace("-", "−").replace("e-", "e−");
}

/** A root in floating point. A part that is below the last digit of the other is noise. */
export function complex(re: number, im: number): string {
  const noise = Number.EPSILON * Math.hypot(re, im);
  if (Math.abs(im) <= noise) return short(re, 6);
  const imaginary = `${short(Math.abs(im), 6)}i`;
  if (Math.abs(re) <= noise) return im < 0 ? `−${imaginary}` : imaginary;
  return `${short(re, 6)} ${im < 0 ? "−" : "+"} ${imaginary}`;
}

function trimmed(text: string): string {
  return text.replace(/\.?0+e/, "e").replace("e+", "e");
}

/** A decimal of the engine cut to so many digits, for a label. */
export function label(decimal: string, digits = 5): string {
  const value = Number(decimal);
  return Number.isFinite(value) ? short(value, digits) : decimal;
}

/** The next decimal with so many digits above or below: an exact neighbour of a rounded end. */
export function beside(decimal: string, up: boolean, digits = 6): string {
  const [mantissa, exponent] = Number(decimal).toExponential(digits - 1).split("e");
  const scaled = BigInt(mantissa!.replace(".", "")) + (up ? 1n : -1n);
  return decimalText(scaled, Number(exponent) - (digits - 1));
}

/** `digits * 10^exponent` as a text without loss. */
export function decimalText(digits: bigint, exponent: number): string {
  const sign = digits < 0n ? "-" : "";
  let text = (digits < 0n ? -digits : digits).toString();
  while (exponent < 0 && text.length > 1 && text.endsWith("0")) {
    text = text.slice(0, -1);
    exponent++;
  }
  if (text === "0") return "0";
  if (exponent >= 0 && text.length + exponent <= 9) return sign + text + "0".repeat(exponent);
  if (exponent < 0 && text.length + exponent > 0) return `${sign}${text.slice(0, exponent)}.${text.slice(exponent)}`;
  if (exponent < 0 && text.length + exponent > -4) return `${sign}0.${"0".repeat(-exponent - text.length)}${text}`;
  return `${sign}${text[0]}${text.length > 1 ? `.${text.slice(1)}` : ""}e${exponent + text.length - 1}`;
}

/** Longer decimals than this are no easier to read than their fraction. */
const READABLE = 12;

/** A fraction as a decimal, where it is a short one; everything else as it is. */
export function plain(text: string): string {
  const [, sign, p, q] = /^([+-]?)(\d{1,40})\/(\d{1,40})$/.exec(text.trim()) ?? [];
  if (p === undefined || q === undefined || BigInt(q) === 0n) return text;
  const digits = (k: number) => BigInt(p) * 10n ** BigInt(k);
  const places = Array.from({ length: 41 }, (_, k) => k).find((k) => digits(k) % BigInt(q) === 0n);
  if (places === undefined) return text;
  const decimal = decimalText(digits(places) / BigInt(q), -places);
  return decimal.length > READABLE ? text : (sign === "-" ? "-" : "") + decimal;
}

/** Powers of ten beyond this are compared as they are written. */
const FAR = 400;

/** A number as numerator and denominator. */
function fraction(text: string): [bigint, bigint] | undefined {
  if (!isNumber(text)) return undefined;
  const one = (t: string): [bigint, bigint] | undefined => {
    const [mantissa = "", exponent = "0"] = t.trim().toLowerCase().split("e");
    const [whole = "", part = ""] = mantissa.split(".");
    const power = Number(exponent) - part.length;
    if (Math.abs(power) > FAR) return undefined;
    const digits = BigInt((whole + part).replace("+", ""));
    return power < 0 ? [digits, 10n ** BigInt(-power)] : [digits * 10n ** BigInt(power), 1n];
  };
  const [p, q = [1n, 1n]] = text.split("/").map(one);
  return p && q && [p[0] * q[1], p[1] * q[0]];
}

/** Whether two texts are the same number, however it is written. */
export function same(a: string | null | undefined, b: string | null | undefined): boolean {
  if (a === b) return true;
  const [p, q] = [fraction(a ?? ""), fraction(b ?? "")];
  return p !== undefined && q !== undefined && p[1] !== 0n && q[1] !== 0n && p[0] * q[1] === q[0] * p[1];
}

/** The same in a formula: only what stands for itself, as no part of a power or of another quotient. */
export function plainIn(formula: string): string {
  return formula.replace(/(?<![\w.^/]|\^-)\d+\/\d+(?![\w.^/])/g, plain);
}

/** An axis from one value to another. */
export interface Scale {
  lower: number;
  upper: number;
  log: boolean;
  /** Degrees: round values are parts of a turn. */
  degrees?: boolean;
  /** Decibels: round values are parts of twenty, or twenties. */
  decibels?: boolean;
}

export function place(scale: Scale, value: number): number {
  if (scale.log) return value <= 0 ? -1 : Math.log(value / scale.lower) / Math.log(scale.upper / scale.lower);
  return (value - scale.lower) / (scale.upper - scale.lower);
}

export function value(scale: Scale, at: number): number {
  return scale.log ? scale.lower * (scale.upper / scale.lower) ** at : scale.lower + (scale.upper - scale.lower) * at;
}

/** The shortest decimal that a step of the track can tell from its neighbours. */
export function decimalAt(scale: Scale, at: number): string {
  const exact = value(scale, at);
  const step = Math.abs(value(scale, Math.min(1, at + 0.001)) - value(scale, Math.max(0, at - 0.001))) / 2;
  if (!(step > 0) || !Number.isFinite(step)) return String(exact);
  const exponent = Math.floor(Math.log10(step));
  const scaled = exact / 10 ** exponent;
  return decimalText(BigInt(Math.round(scaled)), exponent);
}

/** Round values on an axis: at most about `count`. */
export function ticks({ lower, upper, log, degrees, decibels }: Scale, count: number): number[] {
  if (!(upper > lower)) return [];
  if (log) {
    const [from, to] = [Math.ceil(Math.log10(lower) - 1e-9), Math.floor(Math.log10(upper) + 1e-9)];
    const decades = to - from + 1;
    if (decades >= 2) {
      const every = Math.max(1, Math.ceil(decades / count));
      return Array.from({ length: decades }, (_, k) => from + k).filter((k) => (k - from) % every === 0).map((k) => Number(`1e${k}`));
    }
    const all: number[] = [];
    for (let k = from - 1; k <= to; k++) for (const f of [1, 2, 5]) all.push(f * 10 ** k);
    const inside = all.filter((t) => t >= lower && t <= upper);
    if (inside.length >= 2) return inside;
  }
  const raw = (upper - lower) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const usual = degrees ? [15, 30, 45, 90, 180, 360, 720, 1440] : decibels ? [1, 2, 5, 10, 20, 40, 60, 80, 100, 200, 400] : [];
  const step = usual.find((f) => f >= raw) ?? ([1, 2, 5, 10].find((f) => f * power >= raw) ?? 10) * power;
  const first = Math.ceil(lower / step - 1e-9);
  const list: number[] = [];
  for (let k = first; k * step <= upper + step * 1e-9; k++) list.push(Number((k * step).toPrecision(12)));
  return list;
}
