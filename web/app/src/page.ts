// The page: one state, and what is asked when it changes.

import { Address } from "./address.js";
import { blocks, remarks } from "./about.js";
import { type Asked as Drawers, Details } from "./details.js";
import { by, h } from "./dom.js";
import type { Engine, Reply } from "./engine.js";
import { Freshness } from "./freshness.js";
import type { Shared } from "./link.js";
import { script } from "./load.js";
import { isNumber, same } from "./numbers.js";
import { type Interval, Row, nearest } from "./parameters.js";
import { type Model, asWritten, signals } from "./model.js";
import { OpenLoopPlot } from "./openloop.js";
import { MapPlot } from "./map.js";
import { LocusPlot, type Reads, ResponsePlot, verdictIn } from "./plots.js";
import type { Figure } from "./plot.js";
import { Questions } from "./questions.js";
import { documentOf, ended, instead } from "./reply.js";
import { type Also, MAPS, questionsAbout, verdictOf } from "./requests.js";
import { type TextBox, textArea } from "./textbox.js";
import { VerdictBar } from "./verdict.js";

declare const DRIVE: string;
declare const EDITOR_SCRIPT: string;

export class Page {
  /** What stands in the editor. */
  private written = "";
  /** What was read last. */
  private reading: string | undefined;
  /** The last of it that was a model, which is what is asked about. */
  text = "";
  model: Model | undefined;
  private values = new Map<string, string>();
  private rows = new Map<string, Row>();
  private readonly questions: Questions;
  private readonly known: Reads;
  private readonly bar: VerdictBar;
  private readonly freshness = new Freshness();
  focus = "";
  private cut = "";
  /** Where the loop is cut as long as nobody says it, and the program does not choose. */
  private natural = "";
  private method: "auto" | "exact" = "auto";
  /** What answers about the text have asked for beside the rest. */
  private also: Also = { rightmost: false, finer: 0 };
  private mapAxes: [string, string] | undefined;
  private timer = 0;
  private quiet = 0;
  private readonly box: TextBox;
  private editor: TextBox;
  private readonly details: Details;
  readonly map: MapPlot;
  readonly locus: LocusPlot;
  readonly response: ResponsePlot;
  readonly loop: OpenLoopPlot;

  constructor(readonly engine: Engine) {
    this.questions = new Questions(engine, (lane) => this.changed(lane));
    this.known = (lane: string) => this.questions.known(lane);
    this.bar = new VerdictBar(this.known);
    this.box = textArea(by<HTMLTextAreaElement>("text"), (text) => this.typed(text));
    this.editor = this.box;
    const exactly = () => {
      this.method = "exact";
      this.further({ finer: 0 });
      this.chosen();
    };
    this.map = new MapPlot(this.known, (x, y, done) => this.moved(x, y, done), exactly, () => this.further({ finer: 2 }));
    this.locus = new LocusPlot(this.known);
    this.response = new ResponsePlot(this.known);
    this.loop = new OpenLoopPlot(this.known, () => {
      this.cut = this.loop.cut.value;
      this.chosen();
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
    this.written = text;
    this.freshness.written(text);
    await this.read(text, shared);
  }

  private typed(text: string): void {
    // Who writes the old text again wants no other read.
    clearTimeout(this.timer);
    if (text === this.written) return;
    this.written = text;
    this.freshness.written(text);
    if (text === this.reading) return;
    this.timer = window.setTimeout(() => void this.read(text).then(() => this.remember(true)), 250);
  }

  private async read(text: string, shared?: Shared): Promise<void> {
    this.reading = text;
    // Nobody needs the answers about what is put aside; while somebody types, only when there is a new model.
    if (shared) this.engine.cancel();
    // The drive is a model: before anything else there is its verdict.
    const known = shared && !this.model && text === DRIVE;
    if (known) {
      this.about(text);
      this.guess(text, shared);
    }
    const described = this.engine.ask("quick", "describe", { ask: "describe", model: text });
    if (shared && !known) this.guess(text, shared);
    const reply = await described;
    if (!this.model) performance.mark("described");
    if (!reply || text !== this.reading) return;
    // Who ends long work wants the text read all the same.
    if (reply.stopped) return this.read(text, shared);
    if (reply.defect) return this.defect(reply.defect);
    this.editor.mark(reply.check.diagnostics);
    remarks(reply, this.editor);
    if (!reply.model) {
      if (text !== this.text) this.questions.stand(text, []);
      this.freshness.refused(text);
      // What was ended for this text is asked for again.
      if (this.model) this.ask();
      return;
    }
    if (!shared) this.engine.cancel();
    this.about(text);
    this.take(asWritten(reply.model, text), shared);
  }

  /** From now on all panels are about this text, and hold nothing of another. */
  private about(text: string): void {
    const other = text !== this.text;
    this.text = text;
    this.questions.about(text);
    this.freshness.about(text);
    if (!other) return;
    clearTimeout(this.laterTimer);
    this.laterTimer = 0;
    [this.natural, this.method, this.also] = ["", "auto", { rightmost: false, finer: 0 }];
    by("failure").hidden = true;
    this.details.clear();
    for (const figure of this.figures()) figure.clear();
    this.bar.show();
  }

  /** Asks for the verdict before the model is known: what differs from nominal is. */
  private guess(text: string, { v = {} }: Shared): void {
    this.questions.stand(text, [verdictOf(text, Object.entries(v).filter(([, value]) => isNumber(value)))]);
    void this.questions.ask(text, "verdict");
  }

  /** A model that is one. */
  private take(model: Model, shared?: Shared): void {
    const before = this.model;
    this.model = model;
    const values = new Map<string, string>();
    for (const { name, nominal } of model.parameters) {
      // What was dragged stays where it is while the text is edited; a new nominal value wins.
      const old = before?.parameters.find((p) => p.name === name);
      const now = this.values.get(name);
      const kept = !shared && old && same(old.nominal, nominal) && !same(now, nominal) ? now : undefined;
      const given = shared?.v?.[name];
      values.set(name, (given !== undefined && isNumber(given) ? given : kept) ?? nominal ?? "1");
    }
    this.values = values;
    const names = model.parameters.map((p) => p.name);
    // A text from elsewhere brings what is chosen about it.
    this.focus = [shared ? shared.p : this.focus, names[0]].find((n) => n !== undefined && names.includes(n)) ?? "";
    const axes = shared ? shared.a : this.mapAxes;
    this.mapAxes = axes?.every((n) => names.includes(n)) && axes[0] !== axes[1] ? axes : names.length >= 2 ? [names[0]!, names[1]!] : undefined;
    this.cut = shared ? (shared.c ?? "") : this.cut;
    this.map.message = this.mapAxes ? "" : `A map needs two parameters, and this model has ${names.length === 0 ? "none" : "one"}.`;
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
        this.chosen();
      });
      this.rows.set(name, row);
      list.append(row.element);
    }
    if (names.length === 0) list.append(h("p", { class: "sentence" }, "The model has no parameters: only its verdict can be asked for."));
    blocks(model);
    const cuts = signals(model);
    if (!cuts.includes(this.cut)) this.cut = "";
    this.loop.offer(cuts, this.cut || this.natural, !this.natural);
    this.mapControls(names);
    by("tolerance").hidden = !model.tolerances;
    this.locus.time = model.time;
  }

  /** Something about the pictures was chosen. */
  private chosen(): void {
    this.ask();
    void this.remember(true);
  }

  private mapControls(names: string[]): void {
    this.map.choose(names, this.mapAxes, (axes) => {
      this.mapAxes = axes;
      this.method = "auto";
      this.also = { ...this.also, finer: 0 };
      this.mapControls(names);
      this.chosen();
    });
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
  given(): [string, string][] {
    return [...this.values];
  }

  /** Those of them that differ from nominal, and those that would follow others. */
  differing(): [string, string][] {
    const known = (name: string) => this.model?.parameters.find((p) => p.name === name);
    return this.given().filter(([name, value]) => !same(known(name)?.nominal, value) || known(name)?.formula != null);
  }

  /** Everything that a point needs: the verdict and the pictures that move at once, the rest when there is time. */
  private ask(moves = false): void {
    this.moves = moves;
    const { text, mapAxes: axes } = this;
    this.stand();
    const quick = this.questions.lanes().filter((q) => q.speed === "quick");
    this.details.stale(this.drawers());
    this.told = this.questions.ask(text, "verdict");
    for (const { lane } of quick) void this.questions.ask(text, lane);
    if (axes) this.map.point = [this.values.get(axes[0])!, this.values.get(axes[1])!];
    if (!moves) this.show();
    else if (axes) this.map.show(true);
    this.later();
  }

  private stand(): void {
    const { text, focus, mapAxes: axes, method, also } = this;
    const cut = this.cut || this.natural;
    this.map.finer = also.finer;
    this.questions.stand(text, questionsAbout({ text, values: this.given(), differing: this.differing(), focus, cut, axes, method, also }));
  }

  /** An answer says that there is more to ask, or no more. */
  private further(also: Partial<Also>): void {
    const next = { ...this.also, ...also };
    if (next.rightmost === this.also.rightmost && next.finer === this.also.finer) return;
    this.also = next;
    this.stand();
    this.later();
  }

  /** The program wants to be told where the loop is cut. */
  private cutAt(reply: Reply): void {
    const asks = reply?.refused?.diagnostics?.some((d: any) => d.code === "E-cut");
    if (!asks || this.cut || this.natural || !this.model?.cut) return;
    this.natural = this.model.cut;
    this.loop.offer(signals(this.model), this.natural, false);
    this.stand();
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
    const { text } = this;
    this.laterTimer = window.setTimeout(() => {
      this.laterTimer = 0;
      void this.told.then(() => text === this.text && this.slow());
    }, 60);
  }

  private slow(): void {
    if (!this.model) return;
    if (this.moves) {
      this.moves = false;
      for (const row of this.rows.values()) row.rest();
      for (const plot of [this.map, this.locus, this.response]) plot.show();
    }
    for (const { lane, speed } of this.questions.lanes()) if (speed !== "quick") void this.questions.ask(this.text, lane);
    void this.details.about(this.drawers());
  }

  private drawers(): Drawers {
    const chosen = this.mapAxes ?? (this.focus ? [this.focus] : []);
    return { text: this.text, values: this.given(), names: [...this.rows.keys()], chosen, time: this.model?.time ?? "" };
  }

  // --------------------------------------------------------------------------------------- answers

  /** Everything that panels show, anew. */
  private show(): void {
    this.bar.show();
    for (const plot of [this.map, this.locus, this.response, this.loop]) plot.show();
    for (const name of this.rows.keys()) this.interval(name);
    this.limit();
  }

  /** Something else is known in a lane. */
  private changed(lane: string): void {
    const { reply } = this.known(lane);
    if (reply?.defect) this.defect(reply.defect);
    const { moves } = this;
    if (lane === "verdict") {
      this.bar.show();
      for (const row of this.rows.values()) row.say(verdictIn(this.known)?.verdict ?? "");
      this.map.show(moves);
      this.locus.show(moves);
      this.limit();
    } else if (lane === "point") {
      if (reply?.roots) this.further({ rightmost: reply.roots.rightmost === true });
      this.locus.show(moves);
      this.response.show(moves);
    } else if (lane === "locus" || lane === "roots") this.locus.show();
    else if ((MAPS as readonly string[]).includes(lane)) {
      if (lane === "map" && (reply?.x || ended(reply))) this.further({ finer: reply.boxes !== undefined || ended(reply) ? 1 : 0 });
      this.map.show();
    } else if (lane === "margins" || lane === "frequency response") {
      this.cutAt(reply);
      this.loop.show();
    }
    else {
      this.interval(lane.replace("intervals ", ""));
      this.limit();
    }
  }

  private interval(name: string): void {
    const { reply, late } = this.known(`intervals ${name}`);
    const document = documentOf(reply);
    const row = this.rows.get(name);
    row?.wait(late);
    if (document?.stable) row?.answer(document.stable, "", this.moves);
    else row?.answer(undefined, instead(late ? undefined : reply) ?? (reply.notes?.join(" ") || "undecided"), this.moves);
  }

  /** The stable sets that are known. */
  get sets(): Map<string, Interval[]> {
    const of = (name: string) => [name, documentOf(this.known(`intervals ${name}`).reply)?.stable] as const;
    return new Map([...this.rows.keys()].map(of).filter(([, stable]) => stable));
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
    const text = editor.get();
    const reply = await this.engine.ask("quick", "remarks", { ask: "describe", model: text });
    if (reply?.check && text === editor.get()) editor.mark(reply.check.diagnostics);
    if (had) editor.focus(1, 1);
  }
}

