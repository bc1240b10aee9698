// The map of two parameters, and the point in it.

import { h, s } from "./dom.js";
import { type Scale, decimalAt, float } from "./numbers.js";
import { type Axes, type Box, Figure, axes, path, place } from "./plot.js";
import { type Reads, named, verdictIn, waiting, whole } from "./plots.js";
import type { Known } from "./questions.js";
import { instead, no } from "./reply.js";
import { MAPS } from "./requests.js";

export class MapPlot {
  readonly figure: Figure;
  /** The values at the point, as they are set. */
  point: [string, string] = ["", ""];
  /** How often more of the map was asked for. */
  finer = 0;
  /** Why no map is asked for. */
  message = "";
  private view: Axes | undefined;
  private readonly exact: HTMLButtonElement;
  private readonly smaller: HTMLButtonElement;
  private readonly cross = { x: s("line", { class: "cross" }), y: s("line", { class: "cross" }), point: s("circle", { r: 9 }) };

  constructor(
    private readonly known: Reads,
    private readonly moved: (x: string, y: string, done: boolean) => void,
    exactly: () => void,
    smaller: () => void,
  ) {
    this.smaller = h("button", { type: "button", class: "small", title: "boxes until 0.25 % is undecided, which may take a minute", hidden: true, click: smaller }, "smaller boxes");
    this.exact = h("button", { type: "button", class: "small", title: "the exact map, however long it takes", hidden: true, click: exactly }, "exact map");
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

  /** The map; a finer one once it is about the same values. */
  private get data(): any {
    const [map, ...finer] = MAPS.map(this.known);
    return (finer.reverse().find(({ reply, now }) => reply?.boxes && (now || !map!.now)) ?? map!).reply;
  }

  /** What is known of the last map that was asked for. */
  private get last(): Known {
    return this.known(MAPS[this.finer]!);
  }

  /** Whether there are boxes because the exact map takes long. */
  private get isLong(): boolean {
    return this.known("map").reply?.long === true;
  }

  /** Menus for the axes, where there is a choice. */
  choose(names: string[], axes: [string, string] | undefined, chosen: (axes: [string, string]) => void): void {
    const select = (k: 0 | 1) => {
      const change = (event: Event) => {
        const name = (event.target as HTMLSelectElement).value;
        const next: [string, string] = [...axes!];
        if (next[1 - k] === name) next[1 - k] = next[k];
        next[k] = name;
        chosen(next);
      };
      return h("select", { "aria-label": k === 0 ? "across" : "upwards", change }, ...names.map((n) => h("option", { selected: n === axes![k] }, n)));
    };
    this.figure.controls.replaceChildren(this.exact, this.smaller, ...(axes && names.length > 2 ? [select(0), select(1)] : []));
  }

  private paint(svg: SVGSVGElement, width: number, height: number): void {
    this.view = undefined;
    const data = this.data;
    this.drawn = data;
    if (!data?.x) return waiting(svg, width, height, this.message || no(data) || "");
    if (data.boxes) return this.paintBoxes(svg, whole(width, height, 64), data);
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

  /** Boxes by their verdicts, and that it is by boxes. */
  private paintBoxes(svg: SVGSVGElement, box: Box, data: any): void {
    // Not by its colour alone: what is undecided is hatched.
    const hatch = s("pattern", { id: "undecided", width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, s("rect", { class: "ground", width: 6, height: 6 }), s("line", { class: "hatch", x1: 0, x2: 0, y1: 0, y2: 6 }));
    svg.append(hatch);
    const view = axes(svg, box, data.x, data.y, { x: named(data.x.name, data.x.unit), y: named(data.y.name, data.y.unit) });
    this.view = view;
    const at = (n: number) => n.toFixed(1);
    const [x, y] = [(u: number) => at(box.left + u * box.width), (v: number) => at(box.top + (1 - v) * box.height)];
    const rectangle = ([left, low, right, high]: [number, number, number, number]) => `M${x(left)} ${y(low)}H${x(right)}V${y(high)}H${x(left)}z`;
    for (const [name, kind] of [["unstable", "outside"], ["stable", "region"], ["undecided", "open"]] as const) {
      const fill = kind === "open" ? "url(#undecided)" : undefined;
      view.inside.append(s("path", { class: kind, fill, d: data.boxes[name].map(rectangle).join("") }));
    }
    const words = `by boxes, ${data.shares.undecided} % undecided`;
    const [right, top] = [box.left + box.width - 8, box.top + 18];
    view.inside.append(s("rect", { class: "open sample", fill: "url(#undecided)", x: right - words.length * 6.6 - 20, y: top - 10, width: 12, height: 12 }));
    view.inside.append(s("text", { class: "words", x: right, y: top, "text-anchor": "end" }, words));
    view.inside.append(this.cross.x, this.cross.y, this.cross.point);
    this.shift();
  }

  /** What boxes say, how much is left, and why there are boxes. */
  private saidByBoxes({ x, y, shares, stopped }: any): string {
    const { last } = this;
    const ended = stopped && last.now ? "; the counted work ended before it was less" : "";
    const why = this.isLong ? "The exact map takes longer than that." : "There is no exact map of such a loop.";
    const smaller = !last.now ? " Smaller boxes are being computed." : last.reply?.x ? "" : ` Smaller boxes: ${no(last.reply)}.`;
    return `${x.name} and ${y.name} by boxes: ${shares.stable} % of the window is proved stable, ${shares.unstable} % unstable, ${shares.undecided} % is undecided (hatched)${ended}. ${why}${smaller}`;
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
    this.cross.point.setAttribute("class", `point ${verdictIn(this.known)?.verdict ?? ""}`);
    return true;
  }

  show(moves = false): void {
    this.figure.wait(this.known("map").late && this.data?.x);
    if (moves) return this.figure.move();
    const { data, point } = this;
    const { verdict } = verdictIn(this.known) ?? {};
    this.exact.hidden = !this.isLong;
    this.smaller.hidden = !(data?.boxes && this.finer === 1 && this.last.now);
    if (!data?.x) {
      this.figure.nothing(this.message || instead(data) || "", !this.message && !data);
    } else {
      const regions = data.never ? "stable at no point of the plane" : data.regions === 1 ? "one stable region, drawn green" : `${data.regions} stable regions, drawn green`;
      const at = verdict ? `, ${verdict}` : "";
      const map = data.boxes ? this.saidByBoxes(data) : `${data.x.name} and ${data.y.name}: ${regions}.`;
      this.figure.say(`${map} The point is at ${data.x.name} = ${point[0]}, ${data.y.name} = ${point[1]}${at}.`);
      this.figure.head(data.boxes ? "Boxes" : "What limits the region");
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
