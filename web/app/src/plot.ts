// Axes in SVG. Everything here is floating point: pictures decide nothing.

import { h, s } from "./dom.js";
import { type Scale, place, short, ticks, value } from "./numbers.js";

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface Axes {
  box: Box;
  /** Where things are drawn; nothing of it shows outside of the box. */
  inside: SVGGElement;
  x(value: number): number;
  y(value: number): number;
}

let clips = 0;

/** Axes with their ticks; values of `always` that are in the window have a label, whatever else has. */
export function axes(svg: SVGSVGElement, box: Box, xs: Scale, ys: Scale, words: { x: string; y: string }, always: number[] = []): Axes {
  const id = `clip${++clips}`;
  const x = (v: number) => box.left + box.width * clamp(place(xs, v));
  const y = (v: number) => box.top + box.height * (1 - clamp(place(ys, v)));
  const right = box.left + box.width;
  const bottom = box.top + box.height;
  svg.append(s("clipPath", { id }, s("rect", { x: box.left, y: box.top, width: box.width, height: box.height })));
  svg.append(s("rect", { class: "ground", x: box.left, y: box.top, width: box.width, height: box.height }));
  let free = -Infinity;
  for (const t of ticks(xs, Math.max(5, box.width / 70))) {
    const at = x(t);
    svg.append(s("line", { class: "grid", x1: at, x2: at, y1: box.top, y2: bottom }));
    const text = short(t);
    const half = text.length * 3.6;
    if (at - half < free || at + half > right + 12) continue;
    free = at + half + 6;
    svg.append(s("text", { class: "tick", x: at, y: bottom + 15, "text-anchor": "middle" }, text));
  }
  const levels = always.filter((t) => t >= ys.lower && t <= ys.upper);
  const room = (t: number) => levels.every((level) => Math.abs(y(level) - y(t)) > 12);
  for (const t of [...levels, ...ticks(ys, Math.max(5, box.height / 45)).filter(room)]) {
    const at = y(t);
    svg.append(s("line", { class: "grid", x1: box.left, x2: right, y1: at, y2: at }));
    svg.append(s("text", { class: "tick", x: box.left - 6, y: at + 4, "text-anchor": "end" }, short(t)));
  }
  const inside = s("g", { "clip-path": `url(#${id})` });
  svg.append(inside);
  svg.append(s("rect", { class: "edge", x: box.left, y: box.top, width: box.width, height: box.height }));
  svg.append(s("text", { class: "name", x: right, y: bottom + 31, "text-anchor": "end" }, cut(words.x, box.width / 7)));
  svg.append(s("text", { class: "name", x: 4, y: box.top - 8 }, cut(words.y, (box.width + box.left) / 7)));
  return { box, inside, x, y };
}

function clamp(at: number): number {
  return Number.isFinite(at) ? Math.max(-30, Math.min(31, at)) : at > 0 ? 31 : -30;
}

/** Words that fit. */
export function cut(text: string, letters: number): string {
  const most = Math.max(4, Math.floor(letters));
  return text.length > most ? `${text.slice(0, most - 1)}…` : text;
}

export function path(points: Iterable<readonly [number, number]>, { x, y }: Pick<Axes, "x" | "y">): string {
  let text = "";
  for (const [u, v] of points) {
    const at = `${x(u).toFixed(1)} ${y(v).toFixed(1)}`;
    text += text ? `L${at}` : `M${at}`;
  }
  return text;
}

/** A scale around values with some room. */
export function around(values: number[], room = 0.06): Scale {
  const all = values.filter(Number.isFinite);
  let [lower, upper] = [Math.min(...all), Math.max(...all)];
  if (!(lower <= upper)) [lower, upper] = [0, 1];
  if (upper - lower <= 1e-9 * Math.max(Math.abs(upper), Math.abs(lower))) {
    const half = upper === 0 ? 1 : Math.abs(upper) * 0.1;
    [lower, upper] = [lower - half, upper + half];
  }
  const more = (upper - lower) * room;
  return { lower: lower - more, upper: upper + more, log: false };
}

/** Two scales with the same unit length around a window of the complex plane. */
export function equal(box: Box, centre: [number, number], half: number): [Scale, Scale] {
  const unit = half / Math.min(box.width, box.height) * 2;
  const scale = (c: number, pixels: number): Scale => ({ lower: c - (unit * pixels) / 2, upper: c + (unit * pixels) / 2, log: false });
  return [scale(centre[0], box.width), scale(centre[1], box.height)];
}

/** A picture with its sentence and its table. It is drawn anew when its place changes its size; what moves can be drawn alone. */
export class Figure {
  readonly element: HTMLElement;
  readonly svg: SVGSVGElement;
  readonly sentence: HTMLElement;
  readonly extra: HTMLElement;
  readonly controls: HTMLElement;
  private readonly waits = h("span", { class: "waits", hidden: true }, "computing …; this is of the values before");
  private readonly table: HTMLDetailsElement;
  private readonly summary: HTMLElement;
  private size = { width: 0, height: 0 };
  private pending: "" | "some" | "all" = "";
  private seen = true;
  private rows: (() => (Node | string)[]) | undefined;

  /** `shift` draws what moves, where the rest of the picture can stay; else it says no. */
  constructor(
    readonly id: string,
    title: string,
    tableTitle: string,
    private readonly paint: (svg: SVGSVGElement, width: number, height: number) => void,
    private readonly shift: () => boolean = () => false,
  ) {
    this.svg = s("svg", { role: "img", "aria-labelledby": `${id}-title ${id}-sentence` });
    this.sentence = h("p", { id: `${id}-sentence`, class: "sentence" });
    this.extra = h("div", { class: "table", tabindex: 0, role: "region", "aria-label": `${tableTitle} (${title})` });
    this.controls = h("div", { class: "controls" });
    this.summary = h("summary", {}, tableTitle);
    this.table = h("details", { toggle: () => this.fill() }, this.summary, this.extra);
    this.element = h(
      "section",
      { class: "figure", id, "aria-labelledby": `${id}-title` },
      h("div", { class: "bar" }, h("h2", { id: `${id}-title` }, title), this.controls),
      h("div", { class: "canvas" }, this.svg, this.waits),
      this.sentence,
      this.table,
    );
    const canvas = this.svg.parentElement!;
    new ResizeObserver((entries) => {
      const { width, height } = entries.at(-1)!.contentRect;
      if (width === this.size.width && height === this.size.height) return;
      this.size = { width, height };
      this.draw();
    }).observe(canvas);
    new IntersectionObserver((entries) => (this.seen = entries.at(-1)!.isIntersecting)).observe(canvas);
  }

  /** Draws before the next frame, once. */
  draw(): void {
    this.soon("all");
  }

  /** The same for what moves, at once only where somebody sees it. */
  move(rests = false): void {
    if (rests || this.seen) this.soon("some");
  }

  private soon(what: "some" | "all"): void {
    if (this.pending === "") requestAnimationFrame(() => this.now());
    if (this.pending !== "all") this.pending = what;
  }

  private now(): void {
    const what = this.pending;
    this.pending = "";
    const { width, height } = this.size;
    if (width < 60 || height < 60 || (what === "some" && this.shift())) return;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const focus = document.activeElement === this.svg;
    this.svg.replaceChildren();
    this.paint(this.svg, width, height);
    if (focus) this.svg.focus();
  }

  /** Whether what is shown is of other values than those that are set. */
  wait(is: unknown): void {
    this.waits.hidden = !is;
    this.element.setAttribute("aria-busy", String(Boolean(is)));
  }

  /** Nothing of another model stays: neither drawn nor said. */
  clear(): void {
    this.svg.replaceChildren();
    this.extra.replaceChildren();
    this.rows = undefined;
    this.say("");
    this.draw();
  }

  say(text: string): void {
    if (this.sentence.textContent !== text) this.sentence.textContent = text;
    this.empty(false);
  }

  /** Why there is nothing: said once, with no empty picture above it. What is being computed keeps its place. */
  nothing(text: string, waits: boolean): void {
    this.say(text);
    this.empty(!waits && text !== "");
    this.tabulate(() => []);
  }

  private empty(is: boolean): void {
    this.svg.parentElement!.hidden = is;
    this.table.hidden = is;
  }

  /** What the table is about, where that depends on the answer. */
  head(title: string): void {
    if (this.summary.textContent !== title) this.summary.textContent = title;
  }

  /** What the table holds, made once somebody opens it. */
  tabulate(rows: () => (Node | string)[]): void {
    this.rows = rows;
    this.fill();
  }

  private fill(): void {
    if (this.table.open && this.rows) this.extra.replaceChildren(...this.rows());
  }

  /** The picture as a file of its own, with the colours of the page. */
  standalone(): string {
    const copy = this.svg.cloneNode(true) as SVGSVGElement;
    const style = getComputedStyle(document.documentElement);
    const css = PICTURE_STYLE.replace(/var\((--[\w-]+)\)/g, (_, name: string) => style.getPropertyValue(name).trim());
    copy.prepend(s("style", {}, css));
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copy.setAttribute("width", String(this.size.width));
    copy.setAttribute("height", String(this.size.height));
    copy.setAttribute("font-family", "sans-serif");
    copy.removeAttribute("aria-labelledby");
    copy.setAttribute("aria-label", `${this.sentence.textContent}`);
    return new XMLSerializer().serializeToString(copy);
  }
}

export { place, value };

declare const PICTURE_STYLE: string;
