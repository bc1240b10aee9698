// The page: one state, and what is asked when it changes.

import { Address } from "./address.js";
import { sets } from "./copy.js";
import { blocks, counted, remarks } from "./about.js";
import { Details } from "./details.js";
import { by, h } from "./dom.js";
import type { Engine, Reply } from "./engine.js";
import type { Shared } from "./link.js";
import { script } from "./load.js";
import { isNumber } from "./numbers.js";
import { type Interval, Row, nearest } from "./parameters.js";
import type { Model } from "./model.js";
import { OpenLoopPlot } from "./openloop.js";
import { LocusPlot, MapPlot, ResponsePlot, type Verdict, no } from "./plots.js";
import type { Figure } from "./plot.js";
import { Questions } from "./questions.js";
import { type TextBox, textArea } from "./textbox.js";

declare const DRIVE: string;
declare const EDITOR_SCRIPT: string;

export class Page {
  /** What stands in the editor. */
  private written = "";
  /** The last of it that was a model, which is what is asked about. */
  text = "";
  model: Model | undefined;
  private values = new Map<string, string>();
  private rows = new Map<string, Row>();
  private sets = new Map<string, Interval[]>();
  private readonly questions: Questions;
  focus = "";
  private cut = "";
  private mapAxes: [string, string] | undefined;
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
    this.questions = new Questions(engine, (text) => this.defect(text));
    this.box = textArea(by<HTMLTextAreaElement>("text"), (text) => this.typed(text));
    this.editor = this.box;
    this.map = new MapPlot((x, y, done) => this.moved(x, y, done));
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
    if (text === this.written) return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.read(text).then(() => this.remember(true)), 250);
  }

  private async read(text: string, shared?: Shared): Promise<void> {
    this.written = text;
    // Nobody needs the answers about what is put aside; while somebody types, only when there is a new model.
    if (shared) this.engine.cancel();
    // The drive is a model: before anything else there is its verdict.
    const known = shared && !this.model && text === DRIVE;
    if (known) {
      this.text = text;
      this.guess(text, shared);
    }
    const described = this.engine.ask("quick", "describe", { ask: "describe", model: text });
    if (shared && !known) this.guess(text, shared);
    const reply = await described;
    if (!this.model) performance.mark("described");
    if (!reply || text !== this.written) return;
    if (reply.defect) return this.defect(reply.defect);
    this.editor.mark(reply.check.diagnostics);
    remarks(reply, this.editor);
    by("stale").hidden = reply.model !== null;
    if (!reply.model) return;
    if (!shared) this.engine.cancel();
    this.text = text;
    this.take(reply.model, shared);
  }

  /** Asks for the verdict before the model is known: what differs from nominal is. */
  private guess(text: string, { v = {} }: Shared): void {
    this.questions.renew();
    const given = sets(Object.entries(v).filter(([, value]) => isNumber(value)));
    void this.questions.once("quick", "verdict", this.program(text, "verdict", "-", "--json", ...given), (reply) => {
      if (text === this.text) this.verdict(reply);
    });
  }

  /** A model that is one. */
  private take(model: Model, shared?: Shared): void {
    const before = this.model;
    this.model = model;
    this.sets.clear();
    if (!shared) {
      this.questions.renew();
    }
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
      row.say(this.map.verdict ?? "");
      this.rows.set(name, row);
      list.append(row.element);
    }
    if (names.length === 0) list.append(h("p", { class: "sentence" }, "The model has no parameters: only its verdict can be asked for."));
    blocks(model);
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
        this.questions.forget("map");
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
    this.ask(!done);
    void this.remember(done);
  }

  private moved(x: string, y: string, done: boolean): void {
    if (!this.mapAxes) return;
    for (const [name, text] of [[this.mapAxes[0], x], [this.mapAxes[1], y]] as const) {
      this.values.set(name, text);
      this.rows.get(name)?.set(text);
    }
    this.ask(!done);
    void this.remember(done);
  }

  /** Names and values as they are set. */
  given(without: string[] = []): [string, string][] {
    return [...this.values].filter(([name]) => !without.includes(name));
  }

  /** Those of them that differ from nominal. */
  differing(): [string, string][] {
    return this.given().filter(([name, value]) => this.model?.parameters.find((p) => p.name === name)?.nominal !== value);
  }

  private program(model: string, ...args: string[]): unknown {
    return { ask: "program", model, arguments: args };
  }

  /** Everything that a point needs: the verdict and the pictures that move at once, the rest when there is time. */
  private ask(moves = false): void {
    this.moves = moves;
    const verdict = this.program(this.text, "verdict", "-", "--json", ...sets(this.differing()));
    this.told = this.questions.once("quick", "verdict", verdict, (reply) => this.verdict(reply));
    const point = { ask: "point", model: this.text, set: this.given(), response: true };
    void this.questions.once("quick", "point", point, (reply) => {
      this.locus.roots = no(reply) ? reply : reply.roots;
      this.response.take(no(reply) ? reply : reply.response);
      this.locus.show(this.moves);
      this.response.show(this.moves);
    });
    for (const [name, row] of this.rows) {
      const request = this.program(this.text, "intervals", "-", "--param", name, "--json", ...sets(this.given([name])));
      void this.questions.once("quick", `intervals ${name}`, request, (reply) => this.interval(name, row, reply));
    }
    if (this.mapAxes) {
      this.map.point = [this.values.get(this.mapAxes[0])!, this.values.get(this.mapAxes[1])!];
      this.map.show(moves);
    }
    this.later();
  }

  /** Whether a value moves: then pictures follow it, and sentences and tables wait until it rests. */
  private moves = false;
  private laterTimer = 0;
  /** Until the verdict is there. */
  private told = Promise.resolve();

  /** Until there is a verdict. */
  answered(): Promise<void> {
    return this.told;
  }

  private later(): void {
    clearTimeout(this.laterTimer);
    this.laterTimer = window.setTimeout(() => void this.told.then(() => this.slow()), 60);
  }

  private slow(): void {
    if (!this.model) return;
    if (this.moves) {
      this.moves = false;
      for (const row of this.rows.values()) row.rest();
      for (const plot of [this.map, this.locus, this.response]) plot.show();
    }
    const names = this.model.parameters.map((p) => p.name);
    if (this.focus) {
      const request = this.program(this.text, "locus", "-", "--param", this.focus, "--json", "--quiet", ...sets(this.given([this.focus])));
      void this.questions.once("slow", "locus", request, (reply) => {
        this.locus.data = this.document(reply);
        this.locus.show();
      });
    } else {
      this.locus.data = undefined;
      this.locus.show();
    }
    const at = this.cut ? ["--at", this.cut] : [];
    const given = sets(this.given());
    void this.questions.once("slow", "margins", this.program(this.text, "margins", "-", "--json", ...at, ...given), (reply) => {
      this.loop.margins = this.document(reply) ?? reply;
      this.loop.show();
    });
    void this.questions.once("slow", "frequency response", this.program(this.text, "bode", "-", "--json", ...at, ...given), (reply) => {
      this.loop.data = this.document(reply) ?? reply;
      this.loop.show();
    });
    if (this.mapAxes) {
      const [x, y] = this.mapAxes;
      const request = { ask: "map", model: this.text, set: this.given(this.mapAxes), x, y };
      void this.questions.once("long", "map", request, (reply) => {
        this.map.data = reply;
        this.map.message = "";
        this.map.show();
      });
    } else {
      this.map.data = undefined;
      this.map.message = names.length < 2 ? "A map needs two parameters." : "";
      this.map.show();
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
      row.answer(undefined, no(reply) ?? (reply.notes?.join(" ") || "undecided"), this.moves);
    } else {
      this.sets.set(name, document.stable);
      row.answer(document.stable, "", this.moves);
    }
    this.limit();
  }

  private verdict(reply: Reply): void {
    const document = this.document(reply);
    const message = no(reply);
    const verdict: Verdict = document?.verdict ?? undefined;
    this.locus.counts = document?.degree !== undefined ? document : undefined;
    by("verdict").className = `verdict ${verdict ?? ""}`;
    const word = verdict ?? (message ? "no answer" : "undecided");
    if (by("verdict-word").textContent !== word) by("verdict-word").textContent = word;
    const roots = counted(document) ?? message ?? reply.notes?.join(" ") ?? "";
    if (by("verdict-roots").textContent !== roots) by("verdict-roots").textContent = roots;
    for (const row of this.rows.values()) row.say(verdict ?? "");
    this.map.verdict = verdict;
    this.map.show(this.moves);
    this.locus.show(this.moves);
    this.limit();
    this.mark();
    // A reader is told once the value rests.
    clearTimeout(this.said);
    this.said = window.setTimeout(() => {
      const words = `${verdict ?? "no answer"}: ${roots}`;
      if (by("announce").textContent !== words) by("announce").textContent = words;
    }, 700);
  }

  private marked = false;

  /** When the first verdict was there, and drawn: for those who measure. */
  private mark(): void {
    if (this.marked) return;
    this.marked = true;
    performance.mark("verdict");
    requestAnimationFrame(() => setTimeout(() => performance.mark("drawn")));
  }

  private limit(): void {
    by("verdict-limit").textContent = nearest(this.sets, this.values);
  }

  private defect(text: string): void {
    const place = by("failure");
    place.hidden = false;
    place.textContent = `This is a defect of jurist, please report it with the link of this page: ${text}`;
  }

  // ------------------------------------------------------------------------------- links and files

  /** What a link holds. */
  shared(): Shared {
    const shared: Shared = { m: this.written };
    const differing = this.differing();
    if (differing.length > 0) shared.v = Object.fromEntries(differing);
    if (this.focus && this.focus !== this.model?.parameters[0]?.name) shared.p = this.focus;
    if (this.mapAxes && (this.model?.parameters.length ?? 0) > 2) shared.a = this.mapAxes;
    if (this.cut) shared.c = this.cut;
    return shared;
  }

  private readonly address = new Address(() => this.shared());

  remember(done: boolean): Promise<void> {
    return this.address.remember(done);
  }

  /** Opens what the address holds, where that is new. */
  async follow(): Promise<void> {
    if (!this.address.isNew) return;
    try {
      const shared = await this.address.held();
      await this.open(shared.m, shared);
    } catch (error) {
      this.say(error instanceof Error ? error.message : "this link is broken");
      if (!this.model) await this.open(DRIVE, { m: DRIVE });
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

