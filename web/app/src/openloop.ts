// The open loop: Bode and Nyquist plots with the exact margins.

import { h, s, table } from "./dom.js";
import { type Scale, label, short } from "./numbers.js";
import { type Box, Figure, around, axes, equal, path } from "./plot.js";
import { ABOVE, BELOW, type Reads, Zoom, waiting, whole } from "./plots.js";
import { documentOf, instead, no } from "./reply.js";

/** What is below so many decibels, as at a zero on the boundary, needs no room in the picture. */
const DEEP = -120;

export class OpenLoopPlot {
  readonly figure: Figure;
  readonly zoom: Zoom;
  readonly cut: HTMLSelectElement;
  private nyquist = false;
  private readonly toggles: HTMLButtonElement[];

  constructor(
    private readonly known: Reads,
    chosen: () => void,
  ) {
    this.figure = new Figure("open-loop", "Open loop and margins", "Margins", (svg, w, hgt) => this.paint(svg, w, hgt));
    this.zoom = new Zoom(() => this.figure.draw());
    this.cut = h("select", { "aria-label": "where the loop is cut", title: "where the loop is cut", change: chosen });
    this.toggles = [false, true].map((nyquist) =>
      h("button", { type: "button", class: "small", "aria-pressed": String(!nyquist), click: () => this.choose(nyquist) }, nyquist ? "Nyquist" : "Bode"),
    );
    this.figure.controls.append(this.cut, ...this.toggles, ...this.zoom.buttons);
    this.choose(false);
  }

  /** Where the loop may be cut. */
  offer(signals: string[], cut: string, automatic: boolean): void {
    const option = (value: string, text: string) => h("option", { value, selected: value === cut }, text);
    this.cut.replaceChildren(...(automatic ? [option("", "cut: automatic")] : []), ...signals.map((n) => option(n, `cut at ${n}`)));
  }

  /** The curve, or why there is none. */
  private get data(): any {
    const { reply } = this.known("frequency response");
    return documentOf(reply) ?? reply;
  }

  private get margins(): any {
    const { reply } = this.known("margins");
    return documentOf(reply) ?? reply;
  }

  private choose(nyquist: boolean): void {
    this.nyquist = nyquist;
    for (const [k, button] of this.toggles.entries()) button.setAttribute("aria-pressed", String((k === 1) === nyquist));
    for (const button of this.zoom.buttons) button.hidden = !nyquist;
    this.figure.draw();
  }

  private paint(svg: SVGSVGElement, width: number, height: number): void {
    const data = this.data;
    if (!data?.frequency) return waiting(svg, width, height, this.why(data) ?? "");
    if (this.nyquist) this.paintNyquist(svg, width, height, data);
    else this.paintBode(svg, width, height, data);
  }

  /** Why there is nothing; where the menu has an answer to that, so is this one. */
  private why(reply: any): string | undefined {
    const open = reply?.refused?.diagnostics?.some((d: any) => d.code === "E-cut");
    return open && this.cut.options.length > 1 ? `${no(reply)}: choose it above` : instead(reply);
  }

  private paintBode(svg: SVGSVGElement, width: number, height: number, data: any): void {
    const finite = (k: number) => data.response[k][0] !== null && data.response[k][1] !== null;
    const kept: number[] = data.frequency.map((_: number, k: number) => k).filter(finite);
    const positive: number[] = data.frequency.filter((f: number) => f > 0);
    const xs: Scale = { lower: positive[0]!, upper: positive.at(-1)!, log: true };
    // Of a loop with complex coefficients negative frequencies have a curve of their own.
    const curves = (value: (k: number) => number): [number, number][][] =>
      [1, -1].map((sign) => kept.filter((k) => sign * data.frequency[k] > 0).map((k) => [Math.abs(data.frequency[k]), value(k)] as [number, number]).filter((p) => Number.isFinite(p[1])));
    const decibels = curves((k) => 20 * Math.log10(Math.hypot(data.response[k][0], data.response[k][1])));
    const phase = curves((k) => data.phase_degrees[k]);
    const room = Math.max(20, (height - ABOVE * 2 - BELOW) / 2);
    const top: Box = { ...whole(width, height), height: room };
    const bottom: Box = { ...top, top: top.top + room + ABOVE + 4 };
    const words = data.hertz ? "frequency (Hz)" : "frequency (rad/sample)";
    const panels: [Box, [number, number][][], string, string, number[]][] = [
      [top, decibels, "gain (dB)", "", [0]],
      [bottom, phase, "phase (degrees)", words, [-180, 180]],
    ];
    for (const [box, points, name, below, levels] of panels) {
      const degrees = levels.length > 1;
      const seen = points.flat().map((p) => p[1]);
      const least = degrees ? -Infinity : Math.min(DEEP, Math.max(...seen) + DEEP / 2);
      const ys: Scale = { ...around([...seen.map((v) => Math.max(v, least)), levels[0]!]), degrees, decibels: !degrees };
      const view = axes(svg, box, xs, ys, { x: below, y: name }, levels);
      if (box === top) for (const t of svg.querySelectorAll(".tick[text-anchor=middle]")) t.remove();
      for (const level of levels) {
        view.inside.append(s("line", { class: "boundary", x1: box.left, x2: box.left + box.width, y1: view.y(level), y2: view.y(level) }));
      }
      for (const frequency of this.crossings()) {
        view.inside.append(s("line", { class: "cross", x1: view.x(frequency), x2: view.x(frequency), y1: box.top, y2: box.top + box.height }));
      }
      for (const [k, half] of points.entries()) {
        if (half.length > 0) view.inside.append(s("path", { class: k === 0 ? "line c0" : "line c0 mirrored", d: path(half, view) }));
      }
    }
  }

  private crossings(): number[] {
    // Else they might be of other values than the curve.
    if (!this.known("margins").now || !this.known("frequency response").now) return [];
    const { gain = [], phase = [] } = this.margins?.crossings ?? {};
    const of = (c: any) => (this.data.hertz ? c.frequency_hz : c.angle);
    return [...gain, ...phase].map(of).filter((f: unknown): f is number => typeof f === "number").map(Math.abs);
  }

  private paintNyquist(svg: SVGSVGElement, width: number, height: number, data: any): void {
    const box = whole(width, height);
    const { centre, half } = this.zoom.window([-0.5, 0], 2, [-1, 0]);
    const [xs, ys] = equal(box, centre, half);
    const view = axes(svg, box, xs, ys, { x: "Re L", y: "Im L" });
    const { inside, x, y } = view;
    inside.append(s("circle", { class: "boundary", cx: x(0), cy: y(0), r: box.width / (xs.upper - xs.lower) }));
    const branch = (sign: number): [number, number][] =>
      data.response.filter((p: (number | null)[], k: number) => sign * data.frequency[k] > 0 && p[0] !== null && p[1] !== null);
    const [upper, lower] = [branch(1), branch(-1)];
    inside.append(s("path", { class: "line c0", d: path(upper, view) }));
    const mirrored = lower.length > 0 ? lower : upper.map(([a, b]): [number, number] => [a, -b]);
    inside.append(s("path", { class: "line c0 mirrored", d: path(mirrored, view) }));
    inside.append(s("path", { class: "root", d: `M${x(-1) - 6} ${y(0)}h12m-6-6v12` }));
    inside.append(s("text", { class: "words", x: x(-1) + 6, y: y(0) - 6 }, "−1"));
  }

  show(): void {
    const [curve, margins] = [this.known("frequency response"), this.known("margins")];
    this.figure.wait((curve.late && this.data?.frequency) || (margins.late && this.margins?.at));
    const message = this.why(this.data) ?? this.why(this.margins);
    const found = this.margins;
    const waits = !(curve.reply && margins.reply);
    if (message && !waits && this.data?.frequency) this.figure.say(message);
    else if (message || !found?.at) this.figure.nothing(message ?? "", waits);
    else if (!found.stable) {
      this.figure.say(`Cut at ${found.at}. The loop is ${found.verdict}: it has no margins.`);
      this.figure.tabulate(() => [this.table()]);
    } else {
      const db = (value: number | null) => (value === null ? "unlimited" : `${short(value, 4)} dB`);
      const upper = found.gain?.upper ? `gain margin ${db(found.gain.upper_db)}` : "any larger gain";
      const lower = !found.gain?.lower ? "" : found.gain.lower_db === null ? ", any smaller gain" : `, lower ${db(found.gain.lower_db)}`;
      const phase = found.phase ? `, phase margin ${label(found.phase.degrees, 4)}°` : "";
      this.figure.say(`Cut at ${found.at}: ${upper}${lower}${phase}. The margins are exact, the curve is drawn in floating point.`);
      this.figure.tabulate(() => [this.table()]);
    }
    this.figure.draw();
  }

  private table(): HTMLTableElement {
    const found = this.margins;
    const hz = (of: any) => (of?.frequency_hz != null ? `${short(of.frequency_hz, 6)} Hz` : of?.angle != null ? `${short(of.angle, 6)} rad` : "");
    const rows: string[][] = [];
    const add = (name: string, value: string | undefined | null, at: any) => value != null && rows.push([name, value, hz(at)]);
    add("gain margin, upper", found.gain?.upper && `${found.gain.upper.decimal} (${found.gain.upper_db} dB)`, found.gain?.upper);
    add("gain margin, lower", found.gain?.lower && `${found.gain.lower.decimal} (${found.gain.lower_db} dB)`, found.gain?.lower);
    add("phase margin", found.phase && `${found.phase.degrees}°`, found.phase);
    add("phase margin, lag", found.phase?.lag && `${found.phase.lag}°`, null);
    add("phase margin, lead", found.phase?.lead && `${found.phase.lead}°`, null);
    const delay = found.delay;
    add("delay margin", delay && (delay.unbounded ? "unlimited" : delay.seconds != null ? `${delay.seconds} s` : delay.samples != null ? `${delay.at_least ? "at least " : ""}${delay.samples} samples` : null), delay);
    add("modulus margin, min |1 + L|", found.modulus?.value?.decimal, found.modulus);
    add("peak of the sensitivity", found.modulus?.peak_sensitivity?.decimal, found.modulus);
    add("peak of the complementary sensitivity", found.complementary?.peak?.decimal, found.complementary);
    add("disk margin", found.disk?.alpha?.decimal, found.disk);
    for (const c of found.crossings?.gain ?? []) add("crossing |L| = 1", `phase margin ${c.phase_margin_degrees}°`, c);
    for (const c of found.crossings?.phase ?? []) add("crossing L < 0", `factor ${c.factor}`, c);
    return table(`Margins of the loop cut at ${found.at}`, ["margin", "value", "frequency"], rows);
  }
}
