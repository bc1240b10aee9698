// The page: one state, and what is asked when it changes.

import { sets } from "./copy.js";
import { Details } from "./details.js";
import { by, h, table } from "./dom.js";
import type { Engine, Reply, Speed } from "./engine.js";
import { type Shared, pack, unpack } from "./link.js";
import { script } from "./load.js";
import { float, isNumber, label, short } from "./numbers.js";
import { type Interval, Row } from "./parameters.js";
import type { Model } from "./model.js";
import { OpenLoopPlot } from "./openloop.js";
import { LocusPlot, MapPlot, ResponsePlot, type Verdict, no } from "./plots.js";
import type { Figure } from "./plot.js";
import { type TextBox, textArea } from "./textbox.js";

declare const DRIVE: string;
declare const EDITOR_SCRIPT: string;

export class Page {
  text = "";
  model: Model | undefined;
  private values = new Map<string, string>();
  private rows = new Map<string, Row>();
  private sets = new Map<string, Interval[]>();
  /** What is known already: the key of the last answer in each lane. */
  private readonly known = new Map<string, string>();
  focus = "";
  private cut = "";
  private mapAxes: [string, string] | undefined;
  private counts: any;
  private timer = 0;
  private quiet = 0;
  private said = 0;
  private readonly box: TextBox;
  private editor: TextBox;
  private readonly details: Details;
  readonly map: MapPlot;
  readonly locus = new LocusPlot();
  readonly response = new ResponsePlot();
  readonly loop: OpenLoopPlot;

  constructor(readonly engine: Engine) {
    this.box = textArea(by<HTMLTextAreaElement>("text"), (text) => this.typed(text));
    this.editor = this.box;
    this.map = new MapPlot((x, y, done) => this.moved(x, y, done), () => {});
    this.loop = new OpenLoopPlot(() => {
      this.cut = this.loop.cut.value;
      this.later();
      void this.remember(true);
    });
    this.details = new Details((lane, request) => engine.ask("slow", lane, request));
    const figures = this.figures();
    by("plots").append(...figures.map((f) => f.element));
    const words = ["Map", "Roots", "Response", "Open loop"];
    by("pager").append(...figures.map((f, k) => h("button", { type: "button", click: () => f.element.scrollIntoView({ inline: "start", block: "nearest" }) }, words[k]!)));
    engine.working = () => this.working();
    engine.progress = (_, text) => {
      if (!by("cancel").hidden) by("progress").textContent = text;
    };
    engine.idle = () => {
      if (!engine.busy) this.working();
    };
    by("cancel").addEventListener("click", () => engine.cancel(true));
  }

  figures(): Figure[] {
    return [this.map.figure, this.locus.figure, this.response.figure, this.loop.figure];
  }

  private working(): void {
    if (!this.engine.busy) {
      clearTimeout(this.quiet);
      this.quiet = 0;
      by("progress").textContent = "";
      by("cancel").hidden = true;
      return;
    }
    this.quiet ||= window.setTimeout(() => {
      if (!this.engine.busy) return;
      by("progress").textContent = `${this.engine.busy}…`;
      by("cancel").hidden = false;
    }, 400);
  }

  // ------------------------------------------------------------------------------------------ text

  /** A text from elsewhere. */
  async open(text: string, shared?: Shared): Promise<void> {
    this.editor.set(text);
    clearTimeout(this.timer);
    await this.read(text, shared);
  }

  private typed(text: string): void {
    if (text === this.text) return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.read(text).then(() => this.remember(true)), 250);
  }

  private async read(text: string, shared?: Shared): Promise<void> {
    this.text = text;
    const reply = await this.engine.ask("quick", "describe", { ask: "describe", model: text });
    if (!reply || text !== this.text) return;
    if (reply.defect) return this.defect(reply.defect);
    this.editor.mark(reply.check.diagnostics);
    this.remarks(reply);
    by("stale").hidden = reply.model !== null;
    if (!reply.model) return;
    this.engine.cancel();
    this.take(reply.model, shared);
  }

  private remarks(reply: Reply): void {
    const place = by("remarks");
    if (!reply.text) return place.replaceChildren();
    const wrong = reply.check.diagnostics.some((d: any) => d.severity === "error");
    const goto = reply.check.diagnostics
      .filter((d: any) => d.place)
      .slice(0, 8)
      .map((d: any) => h("button", { type: "button", class: "small", click: () => this.editor.focus(d.place.line, d.place.column) }, `line ${d.place.line}`));
    place.replaceChildren(h("pre", { class: wrong ? "error" : "", tabindex: 0, role: "region", "aria-label": wrong ? "errors" : "warnings" }, reply.text), ...goto);
  }

  /** A model that is one. */
  private take(model: Model, shared?: Shared): void {
    const before = this.model;
    this.model = model;
    this.known.clear();
    this.sets.clear();
    const values = new Map<string, string>();
    for (const { name, nominal } of model.parameters) {
      // What was dragged stays where it is while the text is edited; a new nominal value wins.
      const old = before?.parameters.find((p) => p.name === name);
      const kept = !shared && old && old.nominal === nominal ? this.values.get(name) : undefined;
      const given = shared?.v?.[name];
      values.set(name, (given !== undefined && isNumber(given) ? given : kept) ?? nominal ?? "1");
    }
    this.values = values;
    const names = model.parameters.map((p) => p.name);
    this.focus = [shared?.p, this.focus, names[0]].find((n) => n !== undefined && names.includes(n)) ?? "";
    const axes = shared?.a ?? this.mapAxes;
    this.mapAxes = axes?.every((n) => names.includes(n)) && axes[0] !== axes[1] ? axes : names.length >= 2 ? [names[0]!, names[1]!] : undefined;
    this.cut = shared?.c ?? this.cut;
    document.title = `${model.title ?? "jurist"}: exact stability limits`;
    this.build(model, names);
    this.ask();
  }

  private build(model: Model, names: string[]): void {
    this.rows = new Map();
    const list = by("parameters");
    list.replaceChildren();
    for (const parameter of model.parameters) {
      const { name } = parameter;
      const row = new Row(parameter, this.values.get(name)!, (text, done) => this.entered(name, text, done), () => {
        this.focus = name;
        this.later();
        void this.remember(true);
      });
      this.rows.set(name, row);
      list.append(row.element);
    }
    if (names.length === 0) list.append(h("p", { class: "sentence" }, "The model has no parameters: only its verdict can be asked for."));
    const blocks = by("panel-blocks");
    blocks.replaceChildren(
      h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "blocks" }, table(model.rules || "Blocks", ["name", "input", "output", "does"], model.blocks)),
      h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "constants" }, table("Constants", ["name", "value"], model.constants.map((c) => [c.name, c.value]))),
    );
    const option = (value: string, text: string) => h("option", { value, selected: value === this.cut }, text);
    const signals = [...new Set([...model.blocks.flatMap((b) => b[2].split(", ")), ...names])].filter((n) => n !== "" && n !== "u" && n !== "y" || names.includes(n));
    if (!signals.includes(this.cut)) this.cut = "";
    this.loop.cut.replaceChildren(option("", "cut: automatic"), ...signals.map((n) => option(n, `cut at ${n}`)));
    this.mapControls(names);
    by("tolerance").hidden = !model.tolerances;
    this.locus.time = model.time;
  }

  private mapControls(names: string[]): void {
    const { controls } = this.map.figure;
    controls.replaceChildren();
    if (!this.mapAxes || names.length < 3) return;
    const select = (k: 0 | 1) => {
      const choose = (event: Event) => {
        const name = (event.target as HTMLSelectElement).value;
        const axes = this.mapAxes!;
        if (axes[1 - k] === name) axes[1 - k] = axes[k];
        axes[k] = name;
        this.known.delete("map");
        this.mapControls(names);
        this.later();
        void this.remember(true);
      };
      return h("select", { "aria-label": k === 0 ? "across" : "upwards", change: choose }, ...names.map((n) => h("option", { selected: n === this.mapAxes![k] }, n)));
    };
    controls.append(select(0), select(1));
  }

  // ---------------------------------------------------------------------------------------- values

  private entered(name: string, text: string, done: boolean): void {
    this.values.set(name, text);
    this.ask();
    void this.remember(done);
  }

  private moved(x: string, y: string, done: boolean): void {
    if (!this.mapAxes) return;
    for (const [name, text] of [[this.mapAxes[0], x], [this.mapAxes[1], y]] as const) {
      this.values.set(name, text);
      this.rows.get(name)?.set(text);
    }
    this.ask();
    void this.remember(done);
  }

  /** Names and values as they are set. */
  given(without: string[] = []): [string, string][] {
    return [...this.values].filter(([name]) => !without.includes(name));
  }

  private program(...args: string[]): unknown {
    return { ask: "program", model: this.text, arguments: args };
  }

  /** Asks once for each key; what is overtaken leaves no trace. */
  private async once(speed: Speed, lane: string, request: unknown, use: (reply: Reply) => void): Promise<void> {
    const key = JSON.stringify(request);
    if (this.known.get(lane) === key) return;
    this.known.set(lane, key);
    const reply = await this.engine.ask(speed, lane, request);
    if (this.known.get(lane) !== key) return;
    if (reply === undefined) {
      this.known.delete(lane);
      return;
    }
    if (reply.defect) this.defect(reply.defect);
    use(reply);
  }

  /** Everything that a point needs: the verdict and the pictures that move at once, the rest when there is time. */
  private ask(): void {
    const given = sets(this.given());
    this.told = this.once("quick", "verdict", this.program("verdict", "-", "--json", ...given), (reply) => this.verdict(reply));
    const point = { ask: "point", model: this.text, set: this.given(), response: true };
    void this.once("quick", "point", point, (reply) => {
      this.locus.roots = no(reply) ? reply : reply.roots;
      this.response.data = no(reply) ? reply : reply.response;
      this.locus.say(this.counts);
      this.response.say();
    });
    for (const [name, row] of this.rows) {
      const request = this.program("intervals", "-", "--param", name, "--json", ...sets(this.given([name])));
      void this.once("quick", `intervals ${name}`, request, (reply) => this.interval(name, row, reply));
    }
    if (this.mapAxes) {
      this.map.point = [this.values.get(this.mapAxes[0])!, this.values.get(this.mapAxes[1])!];
      this.map.say();
    }
    this.later();
  }

  private laterTimer = 0;
  /** Until the verdict is there. */
  private told = Promise.resolve();

  private later(): void {
    clearTimeout(this.laterTimer);
    this.laterTimer = window.setTimeout(() => void this.told.then(() => this.slow()), 60);
  }

  private slow(): void {
    if (!this.model) return;
    const names = this.model.parameters.map((p) => p.name);
    if (this.focus) {
      const request = this.program("locus", "-", "--param", this.focus, "--json", "--quiet", ...sets(this.given([this.focus])));
      void this.once("slow", "locus", request, (reply) => {
        this.locus.data = this.document(reply);
        this.locus.message = "";
        this.locus.say(this.counts);
      });
    } else {
      this.locus.data = undefined;
      this.locus.say(this.counts);
    }
    const at = this.cut ? ["--at", this.cut] : [];
    const given = sets(this.given());
    void this.once("slow", "margins", this.program("margins", "-", "--json", ...at, ...given), (reply) => {
      this.loop.margins = this.document(reply) ?? reply;
      this.loop.say();
    });
    void this.once("slow", "frequency response", this.program("bode", "-", "--json", ...at, ...given), (reply) => {
      this.loop.data = this.document(reply) ?? reply;
      this.loop.say();
    });
    if (this.mapAxes) {
      const [x, y] = this.mapAxes;
      const request = { ask: "map", model: this.text, set: this.given(this.mapAxes), x, y };
      if (this.known.get("map") !== JSON.stringify(request)) {
        void this.once("long", "map", request, (reply) => {
          this.map.data = reply;
          this.map.message = "";
          this.map.tabulate();
          this.map.say();
        });
      }
    } else {
      this.map.data = undefined;
      this.map.message = names.length < 2 ? "A map needs two parameters." : "";
      this.map.say();
    }
    void this.details.about({ text: this.text, values: this.given(), names });
  }

  private document(reply: Reply): any {
    return typeof reply.output === "string" && reply.output.startsWith("{") ? JSON.parse(reply.output) : undefined;
  }

  private interval(name: string, row: Row, reply: Reply): void {
    const document = this.document(reply);
    if (!document?.stable) {
      this.sets.delete(name);
      row.answer(undefined, no(reply) ?? (reply.notes?.join(" ") || "undecided"));
    } else {
      this.sets.set(name, document.stable);
      row.answer(document.stable);
    }
    this.limit();
  }

  private verdict(reply: Reply): void {
    performance.mark("verdict");
    const document = this.document(reply);
    const message = no(reply);
    const verdict: Verdict = document?.verdict ?? undefined;
    this.counts = document?.degree !== undefined ? document : undefined;
    by("verdict").className = `verdict ${verdict ?? ""}`;
    by("verdict-word").textContent = verdict ?? (message ? "no answer" : "undecided");
    let roots = message ?? reply.notes?.join(" ") ?? "";
    if (document?.degree !== undefined && document.inside !== undefined && document.inside !== null) {
      const { degree, inside, on, outside, infinite } = document;
      const where = this.model?.time === "continuous" ? "in the left half plane" : "inside the unit circle";
      const rest = [on ? `${on} on the boundary` : "", outside ? `${outside} outside` : "", infinite ? `${infinite} at infinity` : ""].filter((t) => t);
      roots = `${inside} of ${degree} roots ${where}${rest.length > 0 ? `, ${rest.join(", ")}` : ""}`;
    }
    by("verdict-roots").textContent = roots;
    for (const row of this.rows.values()) row.say(verdict ?? "");
    this.map.verdict = verdict;
    this.map.say();
    this.locus.say(this.counts);
    this.limit();
    // A reader is told once the value rests.
    clearTimeout(this.said);
    this.said = window.setTimeout(() => {
      const words = `${verdict ?? "no answer"}: ${roots}`;
      if (by("announce").textContent !== words) by("announce").textContent = words;
    }, 700);
  }

  /** The limit that is nearest by ratio, in words. */
  private limit(): void {
    let best: { far: number; words: string } | undefined;
    for (const [name, stable] of this.sets) {
      const now = float(this.values.get(name));
      const inside = stable.find((i) => !(i.lower && Number(i.lower.decimal) >= now) && !(i.upper && Number(i.upper.decimal) <= now));
      for (const end of inside ? [inside.lower, inside.upper] : []) {
        if (!end || end.cause === "domain") continue;
        const at = Number(end.decimal);
        const far = at === 0 || now === 0 ? Infinity : Math.abs(Math.log(Math.abs(at / now)));
        if (far < (best?.far ?? Infinity)) best = { far, words: `nearest limit: ${name} = ${label(end.decimal)}, ×${short(at / now, 3)}, ${end.cause}` };
      }
    }
    by("verdict-limit").textContent = best?.words ?? "";
  }

  private defect(text: string): void {
    const place = by("failure");
    place.hidden = false;
    place.textContent = `This is a defect of jurist, please report it with the link of this page: ${text}`;
  }

  // ------------------------------------------------------------------------------- links and files

  /** What a link holds. */
  shared(): Shared {
    const shared: Shared = { m: this.text };
    const changed = this.model?.parameters.filter((p) => this.values.get(p.name) !== p.nominal) ?? [];
    if (changed.length > 0) shared.v = Object.fromEntries(changed.map((p) => [p.name, this.values.get(p.name)!]));
    if (this.focus && this.focus !== this.model?.parameters[0]?.name) shared.p = this.focus;
    if (this.mapAxes && (this.model?.parameters.length ?? 0) > 2) shared.a = this.mapAxes;
    if (this.cut) shared.c = this.cut;
    return shared;
  }

  private remembered = "";
  private remembering = 0;

  /** The address follows the state: a new entry in the history when something is done, the same while it moves. */
  async remember(done: boolean): Promise<void> {
    const turn = ++this.remembering;
    if (!done) await new Promise((resolve) => setTimeout(resolve, 200));
    if (turn !== this.remembering || typeof CompressionStream === "undefined") return;
    const shared = this.shared();
    const plain = shared.m === DRIVE && Object.keys(shared).length === 1;
    const fragment = plain ? "" : await pack(shared);
    if (turn !== this.remembering || fragment === this.remembered) return;
    this.remembered = fragment;
    const url = fragment || location.pathname + location.search;
    try {
      if (done) history.pushState(null, "", url);
      else history.replaceState(null, "", url);
    } catch {
      // Some hosts of files allow no history.
    }
  }

  async follow(): Promise<void> {
    if (location.hash === this.remembered) return;
    this.remembered = location.hash;
    try {
      const shared = await unpack(location.hash);
      await this.open(shared?.m ?? DRIVE, shared ?? { m: DRIVE });
    } catch (error) {
      this.say(error instanceof Error ? error.message : "this link is broken");
      if (!this.model) await this.open(DRIVE);
    }
  }

  /** A remark for a few seconds. */
  say(text: string): void {
    const place = by("update");
    place.hidden = false;
    place.textContent = text;
    setTimeout(() => (place.hidden = true), 6000);
  }

  /** The editor takes the place of the text area. */
  async improve(): Promise<void> {
    await script(EDITOR_SCRIPT);
    const area = by<HTMLTextAreaElement>("text");
    const had = document.activeElement === area;
    const editor = globalThis.juristEditor!(by("editor"), area.value, (text) => this.typed(text));
    area.remove();
    this.editor = editor;
    const reply = await this.engine.ask("quick", "remarks", { ask: "describe", model: editor.get() });
    if (reply?.check) editor.mark(reply.check.diagnostics);
    if (had) editor.focus(1, 1);
  }
}

