// One row for each parameter: a box for the exact value and a slider whose track is the stable set.

import { h, s } from "./dom.js";
import { cut } from "./plot.js";
import { type Scale, beside, decimalAt, float, isNumber, label, place, value } from "./numbers.js";

export interface Parameter {
  name: string;
  nominal: string | null;
  min: string | null;
  max: string | null;
  unit: string | null;
  description: string | null;
}

interface End {
  decimal: string;
  exact: string | null;
  cause: string;
  frequency_hz: number | null;
}

export interface Interval {
  lower: End | null;
  upper: End | null;
}

/** Positive values are on a logarithmic track from this ratio on. */
const WIDE = 100;

/** The track: around every end of the stable set, the nominal value and the value, inside the domain. */
export function track(parameter: Parameter, stable: Interval[], now: string): Scale {
  const ends = stable.flatMap((i) => [i.lower, i.upper]).filter((e): e is End => e !== null);
  const values = [...ends.map((e) => Number(e.decimal)), float(parameter.nominal), float(now)].filter(Number.isFinite);
  const [min, max] = [float(parameter.min), float(parameter.max)];
  const open = stable.some((i) => i.upper === null);
  const positive = values.filter((v) => v > 0);
  const [least, most] = [Math.min(...positive), Math.max(...positive)];
  if (positive.length > 0 && values.every((v) => v >= 0) && most / least >= WIDE && !(min < 0)) {
    const lower = Math.max(least / (values.includes(0) ? 20 : 4), min > 0 ? min : 0);
    return { lower, upper: Math.min(most * (open ? 30 : 4), Number.isFinite(max) ? max : Infinity), log: true };
  }
  let [lower, upper] = values.length > 0 ? [Math.min(...values), Math.max(...values)] : [0, 1];
  if (lower === upper) [lower, upper] = lower === 0 ? [-1, 1] : [Math.min(0, 2 * lower), Math.max(0, 2 * upper)];
  const room = (upper - lower) * (ends.length > 0 ? 0.15 : 0.5);
  lower = Math.max(lower - room, Number.isFinite(min) ? min : -Infinity);
  upper = Math.min(upper + room * (open ? 4 : 1), Number.isFinite(max) ? max : Infinity);
  return { lower, upper: upper > lower ? upper : lower + 1, log: false };
}

function cause(end: End): string {
  return end.frequency_hz === null ? end.cause : `${end.cause}, ${label(String(end.frequency_hz), 4)} Hz`;
}

export class Row {
  readonly element: HTMLElement;
  readonly box: HTMLInputElement;
  private readonly slider: HTMLElement;
  private readonly picture: SVGSVGElement;
  private readonly ends: HTMLElement;
  private readonly words: HTMLElement;
  private stable: Interval[] | undefined;
  private scale: Scale;
  private message = "";
  private dragging = false;
  private verdict = "";
  /** Only this much of a value is known to be wrong: that it is no number. */
  private wrong: HTMLElement;

  constructor(
    readonly parameter: Parameter,
    private now: string,
    private readonly changed: (text: string, done: boolean) => void,
    private readonly chosen: () => void,
  ) {
    const { name, unit, description, nominal } = parameter;
    this.scale = track(parameter, [], now);
    const id = `value-${Math.random().toString(36).slice(2, 8)}`;
    this.box = h("input", { id, value: now, autocomplete: "off", spellcheck: "false", "aria-describedby": `${id}-wrong` });
    this.wrong = h("span", { id: `${id}-wrong`, class: "wrong" });
    this.picture = s("svg", { preserveAspectRatio: "none", viewBox: "0 0 1000 20", "aria-hidden": "true" });
    this.slider = h("div", {
      class: "slider",
      role: "slider",
      tabindex: 0,
      "aria-label": `${name}, slider over its stable set`,
      "aria-orientation": "horizontal",
    }, this.picture, h("div", { class: "thumb" }));
    this.ends = h("div", { class: "ends" });
    this.words = h("p", { class: "sentence" });
    const reset = h("button", { type: "button", class: "small", title: `back to nominal, ${nominal ?? "none"}`, "aria-label": `${name} back to nominal`, click: () => nominal !== null && this.enter(nominal, true) }, "↺");
    const locus = h("button", { type: "button", class: "small", title: `root locus of ${name}`, "aria-label": `root locus of ${name}`, click: () => this.chosen() }, "locus");
    this.element = h(
      "div",
      { class: "parameter" },
      h("div", { class: "value" }, h("label", { for: id, title: description ?? "" }, cut(name, 60)), this.box, h("span", { class: "unit" }, cut(unit ?? "", 30)), reset, locus, this.wrong),
      h("div", { class: "track" }, this.slider, this.ends),
      this.words,
    );
    if (description) this.element.append(h("p", { class: "description" }, cut(description, 300)));
    this.listen();
    this.draw();
  }

  private listen(): void {
    const commit = (done: boolean) => {
      const ok = isNumber(this.box.value);
      this.box.setAttribute("aria-invalid", String(!ok));
      this.wrong.textContent = ok ? "" : "a number such as 110, 1e-4 or 1/3";
      if (ok) this.enter(this.box.value.trim(), done, true);
    };
    this.box.addEventListener("input", () => commit(false));
    this.box.addEventListener("change", () => commit(true));
    const at = (event: PointerEvent) => {
      const { left, width } = this.slider.getBoundingClientRect();
      return Math.max(0, Math.min(1, (event.clientX - left) / width));
    };
    const drag = (event: PointerEvent, done: boolean) => {
      const u = at(event);
      this.enter(event.shiftKey ? this.snapped(u) : this.inside(decimalAt(this.scale, u)), done);
    };
    this.slider.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.slider.setPointerCapture(event.pointerId);
      this.dragging = true;
      this.slider.focus();
      drag(event, false);
    });
    this.slider.addEventListener("pointermove", (event) => this.dragging && drag(event, false));
    const end = (event: PointerEvent) => {
      if (!this.dragging) return;
      this.dragging = false;
      drag(event, true);
      this.rescale();
    };
    this.slider.addEventListener("pointerup", end);
    this.slider.addEventListener("pointercancel", () => (this.dragging = false));
    this.slider.addEventListener("keydown", (event) => {
      const u = place(this.scale, float(this.now));
      const steps: Record<string, number> = { ArrowRight: 0.01, ArrowUp: 0.01, ArrowLeft: -0.01, ArrowDown: -0.01, PageUp: 0.1, PageDown: -0.1 };
      const step = steps[event.key];
      if (step !== undefined && event.shiftKey) this.enter(this.neighbour(u, step > 0), true);
      else if (step !== undefined) this.enter(this.inside(decimalAt(this.scale, Math.max(0, Math.min(1, u + step)))), true);
      else if (event.key === "Home") this.enter(this.inside(decimalAt(this.scale, 0)), true);
      else if (event.key === "End") this.enter(this.inside(decimalAt(this.scale, 1)), true);
      else return;
      event.preventDefault();
    });
  }

  /** A bound of the domain is not in it: one thousandth of the track away from it is. */
  private inside(text: string): string {
    const { min, max } = this.parameter;
    if (min !== null && float(text) <= float(min)) return decimalAt(this.scale, 0.001);
    if (max !== null && float(text) >= float(max)) return decimalAt(this.scale, 0.999);
    return text;
  }

  /** Just inside the ends of the stable set, as texts with their places. */
  private stops(): { at: number; text: string }[] {
    const stops = (this.stable ?? []).flatMap(({ lower, upper }) => [
      ...(lower ? [{ at: place(this.scale, Number(lower.decimal)), text: beside(lower.decimal, true) }] : []),
      ...(upper ? [{ at: place(this.scale, Number(upper.decimal)), text: beside(upper.decimal, false) }] : []),
    ]);
    return stops.filter((stop) => float(stop.text) !== 0);
  }

  private snapped(u: number): string {
    const near = this.stops().sort((a, b) => Math.abs(a.at - u) - Math.abs(b.at - u))[0];
    return near?.text ?? decimalAt(this.scale, u);
  }

  private neighbour(u: number, up: boolean): string {
    const further = this.stops().filter((stop) => (up ? stop.at > u + 1e-6 : stop.at < u - 1e-6));
    return further.sort((a, b) => (up ? a.at - b.at : b.at - a.at))[0]?.text ?? this.now;
  }

  private enter(text: string, done: boolean, typed = false): void {
    this.set(text, typed);
    this.changed(text, done);
  }

  /** Shows a value that was set elsewhere. */
  set(text: string, typed = false): void {
    this.now = text;
    if (!typed && this.box.value !== text) {
      this.box.value = text;
      this.box.setAttribute("aria-invalid", "false");
      this.wrong.textContent = "";
    }
    if (!this.dragging) this.rescale();
    this.thumb();
  }

  /** The stable set, or why it is not known. */
  answer(stable: Interval[] | undefined, message = ""): void {
    this.stable = stable;
    this.message = message;
    if (!this.dragging) this.rescale();
    this.draw();
  }

  say(verdict: string): void {
    this.verdict = verdict;
    this.thumb();
  }

  private rescale(): void {
    const wanted = track(this.parameter, this.stable ?? [], this.now);
    const at = place(this.scale, float(this.now));
    // The track stays under the thumb while the value is on it and what it shows has not changed.
    const same = wanted.lower === this.scale.lower && wanted.upper === this.scale.upper;
    if (same || (at >= 0 && at <= 1 && this.drawn === this.key())) return;
    this.scale = wanted;
    this.draw();
  }

  private drawn = "";

  private key(): string {
    return (this.stable ?? []).map((i) => `${i.lower?.decimal}..${i.upper?.decimal}`).join();
  }

  private draw(): void {
    this.drawn = this.key();
    this.picture.replaceChildren();
    this.ends.replaceChildren();
    const labels: { at: number; end: End; up: boolean }[] = [];
    for (const { lower, upper } of this.stable ?? []) {
      const from = lower ? place(this.scale, Number(lower.decimal)) : 0;
      const to = upper ? place(this.scale, Number(upper.decimal)) : 1;
      const [a, b] = [Math.max(0, Math.min(1, from)), Math.max(0, Math.min(1, to))];
      if (b > a) this.picture.append(s("rect", { class: "stable", x: a * 1000, y: 0, width: Math.max(1.5, (b - a) * 1000), height: 20 }));
      if (lower) labels.push({ at: from, end: lower, up: true });
      if (upper) labels.push({ at: to, end: upper, up: false });
    }
    const room: number[] = [];
    for (const { at, end, up } of labels) {
      if (at < -0.001 || at > 1.001) continue;
      this.picture.append(s("line", { class: "end", x1: at * 1000, x2: at * 1000, y1: 0, y2: 20 }));
      if (room.some((other) => Math.abs(other - at) < 0.12)) continue;
      room.push(at);
      const text = label(end.decimal);
      const just = beside(end.decimal, up);
      const button = h("button", {
          type: "button",
          class: at < 0.12 ? "first" : at > 0.88 ? "last" : "",
          title: `${end.decimal}: ${cause(end)}. Takes ${just}, just inside.`,
          "aria-label": `${this.parameter.name} to ${just}, just inside its limit ${text}: ${cause(end)}`,
          click: () => float(just) !== 0 && this.enter(just, true),
        }, text);
      button.style.left = `${(at * 100).toFixed(2)}%`;
      this.ends.append(button);
    }
    const words = this.message || this.sentence();
    if (this.words.textContent !== words) this.words.textContent = words;
    this.element.classList.toggle("unknown", this.stable === undefined);
    this.thumb();
  }

  private sentence(): string {
    if (!this.stable) return "…";
    if (this.stable.length === 0) return "stable for no value";
    const bound = (end: End | null, none: string) => (end ? `${label(end.decimal)} (${cause(end)})` : none);
    const one = (i: Interval) => `from ${bound(i.lower, "−∞")} to ${bound(i.upper, "∞")}`;
    const shown = this.stable.slice(0, 4).map(one).join(" and ");
    return `stable ${shown}${this.stable.length > 4 ? ` and ${this.stable.length - 4} more` : ""}`;
  }

  private thumb(): void {
    const at = Math.max(0, Math.min(1, place(this.scale, float(this.now))));
    const thumb = this.slider.lastElementChild as HTMLElement;
    thumb.style.left = `${(at * 100).toFixed(3)}%`;
    thumb.className = `thumb ${this.verdict}`;
    this.slider.setAttribute("aria-valuemin", "0");
    this.slider.setAttribute("aria-valuemax", "1000");
    this.slider.setAttribute("aria-valuenow", String(Math.round(at * 1000)));
    this.slider.setAttribute("aria-valuetext", `${this.now}${this.parameter.unit ? ` ${this.parameter.unit}` : ""}${this.verdict ? `, ${this.verdict}` : ""}`);
  }

  /** For tests: what the track reaches over. */
  get range(): [number, number] {
    return [value(this.scale, 0), value(this.scale, 1)];
  }
}
