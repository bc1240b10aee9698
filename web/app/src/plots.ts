// The pictures: map, root locus, time response.

import { h, s, table } from "./dom.js";
import { type Scale, decimalAt, float, short } from "./numbers.js";
import { type Axes, type Box, Figure, around, axes, cut, equal, path, place } from "./plot.js";

const LEFT = 58;
export const BELOW = 38;
export const ABOVE = 24;

export function whole(width: number, height: number, left = LEFT): Box {
  return { left, top: ABOVE, width: Math.max(20, width - left - 14), height: Math.max(20, height - ABOVE - BELOW) };
}

function named(name: string, unit: string | null | undefined): string {
  return unit ? `${name} (${unit})` : name;
}

export function waiting(svg: SVGSVGElement, width: number, height: number, text: string): void {
  const lines = text.match(new RegExp(`.{1,${Math.max(20, Math.floor(width / 7.5))}}(\\s|$)|\\S+`, "g")) ?? [text];
  for (const [k, line] of lines.slice(0, 6).entries()) {
    svg.append(s("text", { class: "name", x: width / 2, y: height / 2 + (k - lines.length / 2) * 18, "text-anchor": "middle" }, cut(line.trim(), width / 6)));
  }
}

/** Why there is nothing to draw, in the engine's words. */
export function no(reply: any): string | undefined {
  if (!reply) return "…";
  if (reply.refused) return reply.refused.diagnostics?.[0]?.message ?? reply.refused.text;
  if (reply.undefined) return `undefined here: ${reply.undefined}`;
  if (reply.stopped) return `undecided: ${reply.stopped}`;
  if (reply.defect) return `a defect of jurist: ${reply.defect}`;
  if (reply.none) return reply.none;
  return undefined;
}

export type Verdict = "stable" | "marginal" | "unstable" | "undefined" | undefined;

// ---------------------------------------------------------------------------------------------- map

export class MapPlot {
  readonly figure: Figure;
  data: any;
  /** The values at the point, as they are set. */
  point: [string, string] = ["", ""];
  verdict: Verdict;
  message = "";
  private view: Axes | undefined;
  private readonly cross = { x: s("line", { class: "cross" }), y: s("line", { class: "cross" }), point: s("circle", { r: 9 }) };

  constructor(private readonly moved: (x: string, y: string, done: boolean) => void) {
    this.figure = new Figure("map", "Map of two parameters", "What limits the region", (svg, w, hgt) => this.paint(svg, w, hgt), () => this.shift());
    const svg = this.figure.svg;
    svg.setAttribute("tabindex", "0");
    svg.setAttribute("role", "application");
    svg.setAttribute("aria-roledescription", "map; the arrow keys move the point");
    const at = (event: PointerEvent, done: boolean) => {
      if (!this.view || !this.data?.x) return;
      const { left, top } = svg.getBoundingClientRect();
      const box = this.view.box;
      const u = Math.max(0, Math.min(1, (event.clientX - left - box.left) / box.width));
      const v = Math.max(0, Math.min(1, 1 - (event.clientY - top - box.top) / box.height));
      this.moved(decimalAt(this.data.x, u), decimalAt(this.data.y, v), done);
    };
    svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !this.data?.x) return;
      svg.setPointerCapture(event.pointerId);
      at(event, false);
    });
    svg.addEventListener("pointermove", (event) => svg.hasPointerCapture(event.pointerId) && at(event, false));
    svg.addEventListener("pointerup", (event) => svg.hasPointerCapture(event.pointerId) && at(event, true));
    svg.addEventListener("keydown", (event) => {
      const step = event.shiftKey ? 0.1 : 0.01;
      const by: Record<string, [number, number]> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
      const delta = by[event.key];
      if (!delta || !this.data?.x) return;
      event.preventDefault();
      const moved = (scale: Scale, text: string, d: number) =>
        d === 0 ? text : decimalAt(scale, Math.max(0, Math.min(1, place(scale, float(text)) + d)));
      this.moved(moved(this.data.x, this.point[0], delta[0]), moved(this.data.y, this.point[1], delta[1]), true);
    });
  }

  private paint(svg: SVGSVGElement, width: number, height: number): void {
    this.view = undefined;
    const data = this.data;
    this.drawn = data;
    if (!data?.x) return waiting(svg, width, height, this.message || no(data) || "…");
    const box = whole(width, height, 64);
    const view = axes(svg, box, data.x, data.y, { x: named(data.x.name, data.x.unit), y: named(data.y.name, data.y.unit) });
    this.view = view;
    const unit = { x: (u: number) => box.left + u * box.width, y: (v: number) => box.top + (1 - v) * box.height };
    const { inside } = view;
    // As one shape: neighbours with an edge of their own each show a seam.
    if (data.areas.length > 0) inside.append(s("path", { class: "region", d: data.areas.map((outline: [number, number][]) => `${path(outline, unit)}Z`).join("") }));
    for (const wall of data.walls) {
      const kind = wall.causes.includes("pair") && !wall.causes.includes("z=") && !wall.causes.includes("s=0") ? "pair" : wall.causes.includes("=-1") ? "minus" : wall.causes.includes("=") ? "real" : "other";
      inside.append(s("path", { class: `wall ${wall.limits ? "limits" : ""} ${kind}`, d: path(wall.points, unit) }));
    }
    // The words of each mechanism once, beside its longest line, where they cover least.
    const said = new Set<string>();
    const drawn = data.walls.flatMap((wall: any) => wall.points).map(([u, v]: number[]) => [unit.x(u!), unit.y(v!)] as [number, number]);
    for (const wall of [...data.walls].filter((w: any) => w.limits).sort((a: any, b: any) => b.points.length - a.points.length)) {
      if (said.has(wall.words)) continue;
      const at = placed(wall, box, unit, drawn);
      if (!at) continue;
      said.add(wall.words);
      const [x, y] = at;
      // What comes later keeps away from it.
      for (let k = -4; k <= 4; k++) drawn.push([x + (k / 4) * wall.words.length * 3.2, y - 4]);
      inside.append(s("text", { class: "words", x, y, "text-anchor": "middle" }, wall.words));
    }
    inside.append(this.cross.x, this.cross.y, this.cross.point);
    this.shift();
  }

  /** The point alone. */
  private shift(): boolean {
    if (!this.view) return false;
    const { box } = this.view;
    const [x, y] = [this.view.x(float(this.point[0])), this.view.y(float(this.point[1]))];
    const put = (element: Element, places: Record<string, number>) => {
      for (const [name, at] of Object.entries(places)) element.setAttribute(name, Number.isFinite(at) ? at.toFixed(1) : "-99");
    };
    put(this.cross.x, { x1: x, x2: x, y1: box.top, y2: box.top + box.height });
    put(this.cross.y, { x1: box.left, x2: box.left + box.width, y1: y, y2: y });
    put(this.cross.point, { cx: x, cy: y });
    this.cross.point.setAttribute("class", `point ${this.verdict ?? ""}`);
    return true;
  }

  show(moves = false): void {
    if (moves) return this.figure.move();
    const { data, point } = this;
    if (!data?.x) {
      this.figure.say(this.message || no(data) || "");
      this.figure.tabulate(() => []);
    } else {
      const regions = data.never ? "stable at no point of the plane" : data.regions === 1 ? "one stable region, drawn green" : `${data.regions} stable regions, drawn green`;
      const at = this.verdict ? `, ${this.verdict}` : "";
      this.figure.say(`${data.x.name} and ${data.y.name}: ${regions}. The point is at ${data.x.name} = ${point[0]}, ${data.y.name} = ${point[1]}${at}.`);
    }
    this.figure.svg.setAttribute("aria-label", this.figure.sentence.textContent ?? "");
    if (data?.x && data === this.drawn) return this.figure.move(true);
    this.figure.draw();
    if (data?.x) this.figure.tabulate(() => [h("pre", {}, String(data.text ?? ""))]);
  }

  /** What was drawn last. */
  private drawn: any;
}

type Unit = { x(u: number): number; y(v: number): number };

/** Where the words of a line go: the middle of their foot. */
function placed(wall: any, box: Box, unit: Unit, drawn: [number, number][]): [number, number] | undefined {
  const half = wall.words.length * 3.2;
  const inner = wall.points.filter(([u, v]: number[]) => u! > 0.02 && u! < 0.98 && v! > 0.02 && v! < 0.98);
  let best: { at: [number, number]; covers: number } | undefined;
  for (const share of [0.5, 0.35, 0.65, 0.2, 0.8]) {
    const point = inner[Math.floor(inner.length * share)];
    if (!point) continue;
    const [x, y] = [unit.x(point[0]), unit.y(point[1])];
    for (const at of [[x, y - 8], [x + half + 8, y + 4], [x - half - 8, y + 4], [x, y + 18]] as [number, number][]) {
      if (at[0] - half < box.left + 4 || at[0] + half > box.left + box.width - 4 || at[1] < box.top + 14 || at[1] > box.top + box.height - 4) continue;
      const covers = drawn.filter(([a, b]) => Math.abs(a - at[0]) < half + 2 && b > at[1] - 13 && b < at[1] + 5).length;
      if (covers < (best?.covers ?? Infinity)) best = { at, covers };
    }
  }
  return best?.at;
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
  data: any;
  roots: any;
  /** How many roots are where: exact. */
  counts: { inside: number; degree: number; infinite: number } | undefined;
  time: "discrete" | "continuous" = "discrete";
  private view: Axes | undefined;
  private window = { centre: [0, 0] as [number, number], half: 1 };
  private marks: SVGGElement = s("g", {});

  constructor() {
    this.figure = new Figure("locus", "Roots and root locus", "Roots", (svg, w, hgt) => this.paint(svg, w, hgt), () => this.shift());
    this.zoom = new Zoom(() => this.figure.draw());
    this.figure.controls.append(...this.zoom.buttons);
  }

  private get at(): [number, number, number][] {
    return this.roots?.at ?? [];
  }

  /** What is looked at: all roots and crossings, or nearer. */
  private wanted(): { centre: [number, number]; half: number } {
    if (this.time === "discrete") return this.zoom.window([0, 0], 1.35, this.dominant());
    const near = [...this.at.map(([x, y]) => Math.hypot(x, y)), ...(this.data?.crossings ?? []).flatMap((c: any) => c.at.map(([x, y]: number[]) => Math.hypot(x!, y!)))];
    const half = Math.max(...near.filter(Number.isFinite), 1e-9) * 1.15;
    return this.zoom.window([-half * 0.35, 0], half, this.dominant());
  }

  private paint(svg: SVGSVGElement, width: number, height: number): void {
    this.view = undefined;
    const branches: any[] = this.data?.branches ?? [];
    const message = no(this.roots);
    if (!this.at.length && !branches.length) return waiting(svg, width, height, message || "…");
    const box = whole(width, height);
    const discrete = this.time === "discrete";
    this.window = this.wanted();
    const [xs, ys] = equal(box, this.window.centre, this.window.half);
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
    if (!this.view || !this.at.length) return false;
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

  show(moves = false): void {
    if (moves) return this.figure.move();
    const { counts } = this;
    const message = no(this.roots);
    const discrete = this.time === "discrete";
    if (message) {
      this.figure.say(message);
      this.figure.tabulate(() => []);
    } else if (this.at.length) {
      const where = discrete ? "inside the unit circle" : "left of the axis";
      const count = counts ? `${counts.inside} of ${counts.degree} roots ${where}. ` : "";
      const [re, im] = this.dominant();
      const name = this.data?.parameter ? `Lines: as ${this.data.parameter} moves. ` : "";
      this.figure.say(`${count}${name}The root ${discrete ? "of greatest modulus" : "farthest right"} is ${complex(re, im)}.`);
      const size = discrete ? "modulus" : "damping";
      const rows = () => this.at.map(([a, b, k]) => [`${complex(a, b)}${k > 1 ? ` (${k} times)` : ""}`, short(discrete ? Math.hypot(a, b) : -a / Math.hypot(a, b), 6)]);
      this.figure.tabulate(() => [h("p", { class: "note" }, "Floating point; the counts above are exact."), table("Roots", ["root", size], rows())]);
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

function complex(re: number, im: number): string {
  return im === 0 ? short(re, 6) : `${short(re, 6)} ${im < 0 ? "−" : "+"} ${short(Math.abs(im), 6)}i`;
}

// ----------------------------------------------------------------------------------------- response

export class ResponsePlot {
  readonly figure: Figure;
  private data: any;
  private readonly select: HTMLSelectElement;
  private names = "";
  private view: Axes | undefined;
  private scales: { xs: Scale; ys: Scale } | undefined;
  private readonly line = s("path", { class: "line c0" });
  private readonly final = s("line", { class: "final" });

  constructor() {
    this.figure = new Figure("response", "Time response", "Values", (svg, w, hgt) => this.paint(svg, w, hgt), () => this.shift());
    this.select = h("select", { "aria-label": "signal shown", change: () => this.show() });
    this.figure.controls.append(this.select);
  }

  /** An answer, in which points are one list of numbers. */
  take(data: any): void {
    const pairs = (flat: number[]) => Array.from({ length: flat.length / 2 }, (_, k) => [flat[2 * k], flat[2 * k + 1]]);
    this.data = data?.signals ? { ...data, signals: data.signals.map((x: any) => ({ ...x, points: pairs(x.points) })) } : data;
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
    if (!signal?.points.length) return waiting(svg, width, height, no(this.data) || "…");
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
    if (moves) return this.figure.move();
    const message = no(this.data);
    const names = JSON.stringify(this.data?.signals?.map((x: any) => x.name) ?? []);
    if (names !== this.names) {
      this.names = names;
      this.select.replaceChildren(...(this.data?.signals ?? []).map((x: any) => h("option", {}, x.name)));
    }
    this.select.hidden = (this.data?.signals?.length ?? 0) < 2;
    const signal = this.signal;
    if (message || !signal?.points.length) {
      this.figure.say(message ?? "");
      this.figure.tabulate(() => []);
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
