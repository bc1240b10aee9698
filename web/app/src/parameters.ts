// One row for each parameter: a box for the exact value and a slider whose track is the stable set.

import { h, s } from "./dom.js";
import { cut } from "./plot.js";
import { type Scale, beside, decimalAt, float, hint, isNumber, label, place, short, value } from "./numbers.js";

export interface Parameter {
  name: string;
  nominal: string | null;
  min: string | null;
  max: string | null;
  /** Whether these belong to the domain. */
  closed: boolean;
  unit: string | null;
  description: string | null;
  /** The nominal value as it is written, where that is a formula. */
  formula: string | null;
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

/** A cause of the documents in words. */
export function causes(text: string): string {
  const words: Record<string, string> = { "z=1": "root at z = 1", "z=-1": "root at z = −1", "s=0": "root at s = 0", domain: "end of the domain", infinity: "degree lost", neutral: "difference operator not stable", pole: "loop undefined", "square root": "loop undefined beyond", undecided: "undecided beyond" };
  return text.split("+").map((one) => words[one] ?? one).join(", ");
}

function cause(end: End): string {
  return end.frequency_hz === null ? causes(end.cause) : `${causes(end.cause)}, ${label(String(end.frequency_hz), 4)} Hz`;
}

/** The limit that is nearest to its value by ratio, in words. */
export function nearest(sets: Map<string, Interval[]>, values: Map<string, string>): string {
  let best: { far: number; words: string } | undefined;
  for (const [name, stable] of sets) {
    const now = float(values.get(name));
    const inside = stable.find((i) => !(i.lower && Number(i.lower.decimal) >= now) && !(i.upper && Number(i.upper.decimal) <= now));
    for (const end of inside ? [inside.lower, inside.upper] : []) {
      if (!end || end.cause === "domain") continue;
      const at = Number(end.decimal);
      const far = at === 0 || now === 0 ? Infinity : Math.abs(Math.log(Math.abs(at / now)));
      if (far < (best?.far ?? Infinity)) best = { far, words: `nearest limit: ${name} = ${label(end.decimal)},${at / now > 0 ? ` ×${short(at / now, 3)},` : ""} ${causes(end.cause)}` };
    }
  }
  return best?.words ?? "";
}

export class Row {
  readonly element: HTMLElement;
  readonly box: HTMLInputElement;
  private readonly slider: HTMLElement;
  private readonly region = s("path", { class: "stable" });
  private readonly bounds = s("path", { class: "end" });
  private readonly ends: HTMLElement;
  /** The ends that have a label, with the values just inside. */
  private labelled: { end: End; just: string }[] = [];
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
    const picture = s("svg", { preserveAspectRatio: "none", viewBox: "0 0 1000 20", "aria-hidden": "true" }, this.region, this.bounds);
    this.slider = h("div", {
      class: "slider",
      role: "slider",
      tabindex: 0,
      "aria-label": `${name}, slider over its stable set`,
      "aria-orientation": "horizontal",
      "aria-valuemin": 0,
      "aria-valuemax": 1000,
    }, picture, h("div", { class: "thumb" }));
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
      this.wrong.textContent = ok ? "" : hint(this.box.value);
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
      this.rest();
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
    const before = this.scale;
    if (!this.dragging) this.rescale();
    if (this.scale !== before) this.draw();
    else this.thumb();
  }

  /** The stable set, or why it is not known; while another value moves the track stays as long as it has room. */
  answer(stable: Interval[] | undefined, message = "", moves = false): void {
    this.stable = stable;
    this.message = message;
    const room = (end: End | null) => end === null || Math.abs(place(this.scale, Number(end.decimal)) - 0.5) <= 0.5;
    if (!this.dragging && !(moves && stable?.every((i) => room(i.lower) && room(i.upper)))) this.rescale();
    this.draw(moves);
  }

  /** Whether the stable set is of other values than those that are set. */
  wait(is: boolean): void {
    this.element.setAttribute("aria-busy", String(is));
  }

  /** Nothing moves any more. */
  rest(): void {
    if (!this.dragging) this.rescale();
    this.draw();
  }

  say(verdict: string): void {
    this.verdict = verdict;
    this.thumb();
  }

  private rescale(): void {
    const at = place(this.scale, float(this.now));
    // The track stays under the thumb while the value is on it and what it shows has not changed.
    if (at >= 0 && at <= 1 && this.scaled === this.key()) return;
    this.scale = track(this.parameter, this.stable ?? [], this.now);
    this.scaled = this.key();
  }

  /** The ends that the track was made for. */
  private scaled = "";

  private key(): string {
    return (this.stable ?? []).map((i) => `${i.lower?.decimal}..${i.upper?.decimal}`).join();
  }

  private draw(moves = false): void {
    const labels: { at: number; end: End; up: boolean }[] = [];
    let [inside, bounds] = ["", ""];
    for (const { lower, upper } of this.stable ?? []) {
      const from = lower ? place(this.scale, Number(lower.decimal)) : 0;
      const to = upper ? place(this.scale, Number(upper.decimal)) : 1;
      const [a, b] = [Math.max(0, Math.min(1, from)) * 1000, Math.max(0, Math.min(1, to)) * 1000];
      if (b > a) inside += `M${a.toFixed(2)} 0h${Math.max(1.5, b - a).toFixed(2)}v20H${a.toFixed(2)}z`;
      if (lower) labels.push({ at: from, end: lower, up: true });
      if (upper) labels.push({ at: to, end: upper, up: false });
    }
    const room: number[] = [];
    this.labelled = [];
    for (const { at, end, up } of labels) {
      if (at < -0.001 || at > 1.001) continue;
      bounds += `M${(at * 1000).toFixed(2)} 0v20`;
      if (room.some((other) => Math.abs(other - at) < 0.12)) continue;
      const k = room.push(at) - 1;
      const just = beside(end.decimal, up);
      this.labelled.push({ end, just });
      const button = (this.ends.children[k] ?? this.ends.appendChild(this.label(k))) as HTMLElement;
      const text = label(end.decimal);
      button.className = at < 0.12 ? "first" : at > 0.88 ? "last" : "";
      button.style.left = `${(at * 100).toFixed(2)}%`;
      if (button.textContent !== text) button.textContent = text;
      if (moves) continue;
      button.title = `${end.decimal}: ${cause(end)}. Takes ${just}, just inside.`;
      button.setAttribute("aria-label", `${this.parameter.name} to ${just}, just inside its limit ${text}: ${cause(end)}`);
    }
    while (this.ends.children.length > room.length) this.ends.lastElementChild!.remove();
    this.region.setAttribute("d", inside);
    this.bounds.setAttribute("d", bounds);
    this.element.classList.toggle("unknown", this.stable === undefined);
    this.thumb();
    if (moves) return;
    const waits = this.stable && this.element.ariaBusy === "true" ? "computing …; for the values before: " : "";
    const words = waits + (this.message || this.sentence());
    if (this.words.textContent !== words) this.words.textContent = words;
  }

  private label(k: number): HTMLElement {
    const take = () => {
      const just = this.labelled[k]?.just;
      if (just !== undefined && float(just) !== 0) this.enter(just, true);
    };
    return h("button", { type: "button", click: take });
  }

  private sentence(): string {
    if (!this.stable) return "computing …";
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
    this.slider.setAttribute("aria-valuenow", String(Math.round(at * 1000)));
    this.slider.setAttribute("aria-valuetext", `${this.now}${this.parameter.unit ? ` ${this.parameter.unit}` : ""}${this.verdict ? `, ${this.verdict}` : ""}`);
  }

  /** For tests: what the track reaches over. */
  get range(): [number, number] {
    return [value(this.scale, 0), value(this.scale, 1)];
  }
}
