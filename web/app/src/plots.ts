// The pictures of a point: root locus and time response; what all pictures share.

import { h, s, table } from "./dom.js";
import { type Scale, complex, float, label, short } from "./numbers.js";
import { type Axes, type Box, Figure, around, axes, cut, equal, path } from "./plot.js";
import type { Known } from "./questions.js";
import { documentOf, instead, no } from "./reply.js";

const LEFT = 58;
export const BELOW = 38;
export const ABOVE = 24;

export function whole(width: number, height: number, left = LEFT): Box {
  return { left, top: ABOVE, width: Math.max(20, width - left - 14), height: Math.max(20, height - ABOVE - BELOW) };
}

export function named(name: string, unit: string | null | undefined): string {
  return unit ? `${name} (${unit})` : name;
}

export function waiting(svg: SVGSVGElement, width: number, height: number, text: string): void {
  const lines = text.match(new RegExp(`.{1,${Math.max(20, Math.floor(width / 7.5))}}(\\s|$)|\\S+`, "g")) ?? [text];
  for (const [k, line] of lines.slice(0, 6).entries()) {
    svg.append(s("text", { class: "name", x: width / 2, y: height / 2 + (k - lines.length / 2) * 18, "text-anchor": "middle" }, cut(line.trim(), width / 6)));
  }
}

export type Verdict = "stable" | "marginal" | "unstable" | "undefined" | undefined;

/** What is known in a lane. Pictures keep no answer: they ask each time that they are drawn. */
export type Reads = (lane: string) => Known;

/** The document of the verdict, where it is about the values that are set, or a moment old. */
export function verdictIn(known: Reads): any {
  const { reply, late } = known("verdict");
  return late ? undefined : documentOf(reply);
}

// -------------------------------------------------------------------------------------------- locus

/** A plane that can be looked at closer. */
export class Zoom {
  private factor = 1;
  readonly buttons: HTMLElement[];

  constructor(private readonly changed: () => void) {
    const button = (text: string, words: string, by: (f: number) => number) =>
      h("button", { type: "button", class: "small", "aria-label": words, title: words, click: () => this.set(by(this.factor)) }, text);
    this.buttons = [button("−", "zoom out", (f) => f / 2), button("+", "zoom in", (f) => f * 2), button("reset", "reset zoom", () => 1)];
  }

  private set(factor: number): void {
    this.factor = Math.max(1 / 16, Math.min(1 << 16, factor));
    this.changed();
  }

  /** The window: around the whole, or around what matters once it is magnified. */
  window(centre: [number, number], half: number, focus: [number, number]): { centre: [number, number]; half: number } {
    return { centre: this.factor > 1 ? focus : centre, half: half / this.factor };
  }
}

export class LocusPlot {
  readonly figure: Figure;
  readonly zoom: Zoom;
  time: "discrete" | "continuous" = "discrete";
  private view: Axes | undefined;
  private window = { centre: [0, 0] as [number, number], half: 1 };
  private marks: SVGGElement = s("g", {});

  constructor(private readonly known: Reads) {
    this.figure = new Figure("locus", "Roots and root locus", "Roots", (svg, w, hgt) => this.paint(svg, w, hgt), () => this.shift());
    this.zoom = new Zoom(() => this.figure.draw());
    this.figure.controls.append(...this.zoom.buttons);
  }

  private get roots(): any {
    const { reply } = this.known("point");
    return no(reply) ? reply : reply.roots;
  }

  /** The rightmost roots, of a loop that has infinitely many. */
  private get rightmost(): any {
    return this.roots?.rightmost ? documentOf(this.known("roots").reply) : undefined;
  }

  private get at(): [number, number, number][] {
    if (!this.roots?.rightmost) return this.roots?.at ?? [];
    const both = ({ re, im, pair, multiplicity }: any) => (pair ? [1, -1] : [1]).map((side) => [Number(re), side * Number(im), multiplicity] as [number, number, number]);
    return (this.rightmost?.roots ?? []).flatMap(both);
  }

  /** Why there are no roots. */
  private get why(): any {
    if (!this.roots?.rightmost) return this.roots;
    const { reply } = this.known("roots");
    return documentOf(reply)?.roots ? {} : (no(reply) ? reply : { none: reply.notes?.join(" ") || "undecided" });
  }

  /** The lines that the roots move along. */
  private get data(): any {
    return documentOf(this.known("locus").reply);
  }

  /** What is looked at: all roots and crossings, or nearer. */
  private wanted(): { centre: [number, number]; half: number } {
    if (this.time === "discrete") return this.zoom.window([0, 0], 1.35, this.dominant());
    const near = [...this.at.map(([x, y]) => Math.hypot(x, y)), ...(this.data?.crossings ?? []).flatMap((c: any) => c.at.map(([x, y]: number[]) => Math.hypot(x!, y!)))];
    const half = Math.max(...near.filter(Number.isFinite), 1e-9) * 1.15;
    return this.zoom.window([-half * 0.35, 0], half, this.dominant());
  }

  /** The line that all roots which are not listed are left of. */
  private get others(): number | undefined {
    const line = this.rightmost?.others_left_of;
    return line == null ? undefined : float(line);
  }

  /** Around the rightmost roots, which reach much further up than across. */
  private tall(): [Scale, Scale] {
    const [re, im] = [this.at.map((r) => r[0]), this.at.map((r) => r[1])];
    const [right, left] = [Math.max(0, ...re), Math.min(this.others!, ...re)];
    const [reach, high] = [right - left || 1, Math.max(...im) * 1.15 || 1];
    const { centre, half } = this.zoom.window([(left + right) / 2 - reach * 0.1, 0], 1, this.dominant());
    const scale = (middle: number, far: number): Scale => ({ lower: middle - far * half, upper: middle + far * half, log: false });
    return [scale(centre[0], reach * 0.75), scale(centre[1], high)];
  }

  private paint(svg: SVGSVGElement, width: number, height: number): void {
    this.view = undefined;
    const branches: any[] = this.data?.branches ?? [];
    if (!this.at.length && !branches.length) return waiting(svg, width, height, no(this.why) ?? "");
    const box = whole(width, height);
    const discrete = this.time === "discrete";
    this.window = this.wanted();
    const { others } = this;
    const [xs, ys] = others === undefined ? equal(box, this.window.centre, this.window.half) : this.tall();
    const variable = discrete ? "z" : "s";
    const view = axes(svg, box, xs, ys, { x: `Re ${variable}`, y: `Im ${variable}` });
    this.view = view;
    const { inside, x, y } = view;
    if (discrete) {
      const radius = box.width / (xs.upper - xs.lower);
      inside.append(s("circle", { class: "boundary", cx: x(0), cy: y(0), r: radius }));
    } else {
      inside.append(s("rect", { class: "forbidden", x: x(0), y: box.top, width: Math.max(0, box.left + box.width - x(0)), height: box.height }));
      inside.append(s("line", { class: "boundary", x1: x(0), x2: x(0), y1: box.top, y2: box.top + box.height }));
    }
    if (others !== undefined) {
      inside.append(s("rect", { class: "unlisted", x: box.left, y: box.top, width: Math.max(0, x(others) - box.left), height: box.height }));
      inside.append(s("line", { class: "final", x1: x(others), x2: x(others), y1: box.top, y2: box.top + box.height }));
      inside.append(s("text", { class: "words", x: x(others) - 6, y: box.top + 16, "text-anchor": "end" }, "all others"));
    }
    for (const [k, branch] of branches.entries()) {
      const points = branch.roots.filter((p: (number | null)[]) => p[0] !== null && p[1] !== null);
      inside.append(s("path", { class: `branch c${k % 6}`, d: path(thin(points, view), view) }));
    }
    for (const crossing of this.data?.crossings ?? []) {
      for (const [re, im] of crossing.at) {
        for (const side of im === 0 ? [0] : [im, -im]) inside.append(s("circle", { class: "crossing", cx: x(re), cy: y(side), r: 5 }));
      }
    }
    this.marks = s("g", {});
    inside.append(this.marks);
    this.mark(view);
  }

  /** The roots alone, as long as the window is about the right one. */
  private shift(): boolean {
    if (!this.view || !this.at.length || this.rightmost) return false;
    const [{ centre, half }, wanted] = [this.window, this.wanted()];
    const off = Math.hypot(wanted.centre[0] - centre[0], wanted.centre[1] - centre[1]);
    if (off > half / 4 || wanted.half > half * 1.01 || wanted.half < half / 2) return false;
    this.mark(this.view);
    return true;
  }

  private mark({ x, y }: Axes): void {
    const once = this.at.every(([, , count]) => count === 1);
    const cross = (re: number, im: number) => `M${(x(re) - 5).toFixed(1)} ${(y(im) - 5).toFixed(1)}l10 10m0-10l-10 10`;
    const drawn = [...this.marks.children];
    if (once && drawn.length === this.at.length && drawn.every((e) => e.tagName === "path")) {
      for (const [k, [re, im]] of this.at.entries()) drawn[k]!.setAttribute("d", cross(re, im));
      return;
    }
    this.marks.replaceChildren();
    for (const [re, im, count] of this.at) {
      this.marks.append(s("path", { class: "root", d: cross(re, im) }));
      if (count > 1) this.marks.append(s("text", { class: "words", x: x(re) + 8, y: y(im) - 6 }, `×${count}`));
    }
  }

  /** The root that is nearest to the boundary from outside, or farthest out. */
  private dominant(): [number, number] {
    const rate = ([re, im]: [number, number, number]) => (this.time === "discrete" ? Math.hypot(re, im) : re);
    const best = [...this.at].sort((a, b) => rate(b) - rate(a) || b[1] - a[1])[0];
    return best ? [best[0], best[1]] : [0, 0];
  }

  /** Of infinitely many roots those that are known, and where all others are. */
  private sayRightmost(): void {
    const { roots, others_left_of: line, chain, degree } = this.rightmost;
    const [re, im] = this.dominant();
    const near = chain ? ` Infinitely many come near to the line Re s = ${label(String(float(chain[0])), 6)}.` : "";
    // Dead times that cancel leave finitely many.
    const all = `The loop has ${degree} roots: its dead times cancel.`;
    const some = `The ${roots.length} rightmost of infinitely many roots, a pair counted once: all others are left of Re s = ${label(String(float(line)), 6)}, proved.${near}`;
    this.figure.say(`${line == null ? all : some} The root farthest right is ${complex(re, im)}. A root locus is not drawn with dead time.`);
    const rows = () => roots.map((r: any) => [`${r.re.replace("-", "−")}${r.pair ? ` ± ${r.im}i` : ""}${r.multiplicity > 1 ? ` (${r.multiplicity} times)` : ""}`, r.damping == null ? "" : short(r.damping, 6), r.natural_frequency_hz == null ? "" : short(r.natural_frequency_hz, 6)]);
    this.figure.tabulate(() => [h("p", { class: "note" }, "All digits are certain."), table(line == null ? "Roots" : "The rightmost roots", ["root", "damping", "natural frequency (Hz)"], rows())]);
  }

  show(moves = false): void {
    const [point, lines, far] = [this.known("point"), this.known("locus"), this.known("roots")];
    this.figure.wait(((point.late || far.late) && this.at.length > 0) || (lines.late && this.data));
    if (moves) return this.figure.move();
    // How many roots are where: exact.
    const counts = verdictIn(this.known);
    const message = instead(this.why);
    const discrete = this.time === "discrete";
    if (message) this.figure.nothing(message, !(this.roots?.rightmost ? far : point).reply);
    else if (this.rightmost) this.sayRightmost();
    else if (this.at.length) {
      const where = discrete ? "inside the unit circle" : "left of the axis";
      const count = counts?.degree !== undefined ? `${counts.inside} of ${counts.degree} roots ${where}. ` : "";
      const [re, im] = this.dominant();
      const name = this.data?.parameter ? `Lines: as ${this.data.parameter} moves. ` : "";
      this.figure.say(`${count}${name}The root ${discrete ? "of greatest modulus" : "farthest right"} is ${complex(re, im)}.`);
      const size = discrete ? "modulus" : "damping";
      const rows = () => this.at.map(([a, b, k]) => [`${complex(a, b)}${k > 1 ? ` (${k} times)` : ""}`, short(discrete ? Math.hypot(a, b) : -a / Math.hypot(a, b), 6)]);
      this.figure.tabulate(() => [h("p", { class: "note" }, "Floating point; the counts above are exact."), table("Roots", ["root", size], rows())]);
    } else {
      this.figure.say("");
      this.figure.tabulate(() => []);
    }
    this.figure.draw();
  }
}

/** Points that a picture can tell apart. */
function thin(points: [number, number][], view: Axes): [number, number][] {
  const kept: [number, number][] = [];
  let [u, v] = [NaN, NaN];
  for (const [k, p] of points.entries()) {
    const [a, b] = [view.x(p[0]), view.y(p[1])];
    if (k > 0 && k < points.length - 1 && Math.abs(a - u) < 0.7 && Math.abs(b - v) < 0.7) continue;
    [u, v] = [a, b];
    kept.push(p);
  }
  return kept;
}

// ----------------------------------------------------------------------------------------- response

export class ResponsePlot {
  readonly figure: Figure;
  /** The answer that the points were taken from. */
  private taken: any;
  private made: any;
  private readonly select: HTMLSelectElement;
  private names = "";
  private view: Axes | undefined;
  private scales: { xs: Scale; ys: Scale } | undefined;
  private readonly line = s("path", { class: "line c0" });
  private readonly final = s("line", { class: "final" });

  constructor(private readonly known: Reads) {
    this.figure = new Figure("response", "Time response", "Values", (svg, w, hgt) => this.paint(svg, w, hgt), () => this.shift());
    this.select = h("select", { "aria-label": "signal shown", change: () => this.show() });
    this.figure.controls.append(this.select);
  }

  /** The answer, in which points were one list of numbers. */
  private get data(): any {
    const { reply } = this.known("point");
    if (reply !== this.taken) {
      this.taken = reply;
      const data = no(reply) ? reply : reply.response;
      const pairs = (flat: number[]) => Array.from({ length: flat.length / 2 }, (_, k) => [flat[2 * k], flat[2 * k + 1]]);
      this.made = data?.signals ? { ...data, signals: data.signals.map((x: any) => ({ ...x, points: pairs(x.points) })) } : data;
    }
    return this.made;
  }

  private get signal(): any {
    return this.data?.signals?.[this.select.selectedIndex] ?? this.data?.signals?.[0];
  }

  /** Axes around what there is to draw. */
  private wanted({ points, final }: { points: [number, number][]; final: number | null }): { xs: Scale; ys: Scale } {
    const ys = around([...points.map((p) => p[1]), ...(final === null ? [] : [final]), 0]);
    return { xs: { lower: 0, upper: points.at(-1)![0] || 1, log: false }, ys };
  }

  private paint(svg: SVGSVGElement, width: number, height: number): void {
    this.view = undefined;
    const signal = this.signal;
    if (!signal?.points.length) return waiting(svg, width, height, no(this.data) ?? "");
    this.scales = this.wanted(signal);
    const { xs, ys } = this.scales;
    this.view = axes(svg, whole(width, height), xs, ys, { x: `time (${this.data.unit})`, y: named(signal.name, signal.unit) });
    this.view.inside.append(this.final, this.line);
    this.curve(this.view, signal);
  }

  /** The curve alone, as long as it fits its axes. */
  private shift(): boolean {
    const signal = this.signal;
    if (!this.view || !this.scales || !signal?.points.length) return false;
    const [now, { xs, ys }] = [this.scales, this.wanted(signal)];
    const fits = xs.upper === now.xs.upper && ys.upper <= now.ys.upper && ys.lower >= now.ys.lower;
    if (!fits || 2 * (ys.upper - ys.lower) < now.ys.upper - now.ys.lower) return false;
    this.curve(this.view, signal);
    return true;
  }

  private curve(view: Axes, { points, final }: { points: [number, number][]; final: number | null }): void {
    const { box } = view;
    const at = final === null ? -99 : view.y(final);
    for (const [name, value] of Object.entries({ x1: box.left, x2: box.left + box.width, y1: at, y2: at })) this.final.setAttribute(name, value.toFixed(1));
    const few = this.data.held && points.length < 120;
    const drawn = few ? points.flatMap((p, k) => (k === 0 ? [p] : [[p[0], points[k - 1]![1]], p]) as [number, number][]) : thin(points, view);
    this.line.setAttribute("d", path(drawn, view));
  }

  show(moves = false): void {
    this.figure.wait(this.known("point").late && this.signal);
    if (moves) return this.figure.move();
    const message = instead(this.data);
    const names = JSON.stringify(this.data?.signals?.map((x: any) => x.name) ?? []);
    if (names !== this.names) {
      this.names = names;
      this.select.replaceChildren(...(this.data?.signals ?? []).map((x: any) => h("option", {}, x.name)));
    }
    this.select.hidden = (this.data?.signals?.length ?? 0) < 2;
    const signal = this.signal;
    if (message || !signal?.points.length) {
      this.figure.nothing(message ?? "", !this.known("point").reply);
    } else {
      const values: number[] = signal.points.map((p: number[]) => p[1]);
      const last = signal.points.at(-1);
      const unit = signal.unit ? ` ${signal.unit}` : "";
      const peak = values.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
      const goes = signal.final === null ? "" : `, equilibrium ${short(signal.final)}${unit}`;
      const note = this.data.note ? ` (${this.data.note})` : "";
      this.figure.say(`${signal.name}${note}: largest ${short(peak)}${unit}, ${short(last[1])}${unit} after ${short(last[0])} ${this.data.unit}${goes}. Floating point.`);
      const every = Math.max(1, Math.floor(signal.points.length / 20));
      const rows = () => signal.points.filter((_: unknown, k: number) => k % every === 0).map(([t, v]: number[]) => [short(t!), short(v!, 6)]);
      this.figure.tabulate(() => [table(signal.name, [`time (${this.data.unit})`, named(signal.name, signal.unit)], rows())]);
    }
    this.figure.draw();
  }
}
