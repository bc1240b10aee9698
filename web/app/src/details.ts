// The drawer: every end with all its digits, certificates made and checked, the polynomial, tolerances, the best gains, what holds for all values.

import { gainsOf, objectivesOf, tuning } from "./best.js";
import { MARGINS, firstRange, forAll, rangesOf } from "./forall.js";
import { coefficients } from "./formula.js";
import { by, download, h, table } from "./dom.js";
import { label } from "./numbers.js";
import { equation, over } from "./over.js";
import { causes } from "./parameters.js";
import { no } from "./reply.js";

type Ask = (lane: string, request: unknown) => Promise<any>;

export interface Asked {
  text: string;
  values: [string, string][];
  names: string[];
  /** The parameters in the picture. */
  chosen: string[];
  time: string;
}

const DRAWERS = ["details", "polynomial", "tolerance", "best", "for-all"];

const program = (text: string, ...args: string[]) => ({ ask: "program", model: text, arguments: args });

function others(values: [string, string][], name: string): string[] {
  return values.filter(([n]) => n !== name).flatMap(([n, v]) => ["--set", `${n}=${v}`]);
}

const NOTHING: Asked = { text: "", values: [], names: [], chosen: [], time: "" };

export class Details {
  private asked: Asked = NOTHING;
  private digits = 30;
  private readonly open: Record<string, boolean> = {};
  /** What the content of each drawer is about, once it is whole. */
  private readonly filled: Record<string, Asked | undefined> = {};
  /** What is asked for. */
  private readonly filling: Record<string, Asked | undefined> = {};

  constructor(private readonly ask: Ask) {
    for (const id of DRAWERS) {
      by<HTMLDetailsElement>(id).addEventListener("toggle", (event) => {
        this.open[id] = (event.target as HTMLDetailsElement).open;
        void this.fill(id);
      });
    }
  }

  /** Another text: nothing stays of the one before. */
  clear(): void {
    this.asked = NOTHING;
    for (const id of DRAWERS) this.empty(id);
  }

  /** What the drawers will be about: what is about other values is grey. */
  stale(asked: Asked): void {
    const old = JSON.stringify(asked) !== JSON.stringify(this.asked);
    for (const id of DRAWERS) if (id !== "polynomial") this.body(id).setAttribute("aria-busy", String(old));
  }

  /** What the drawers are about; those that are open are filled anew. */
  async about(asked: Asked): Promise<void> {
    // What stands there is kept while it is about the same question.
    if (JSON.stringify(asked) !== JSON.stringify(this.asked)) this.asked = asked;
    for (const id of DRAWERS) await this.fill(id);
  }

  private body(id: string): HTMLElement {
    return by(`${id}-body`);
  }

  private empty(id: string): void {
    this.filled[id] = undefined;
    this.body(id).replaceChildren(h("p", {}, "computing …"));
  }

  /** Fills a drawer that is open; what was overtaken by another text or other values is left. */
  private async fill(id: string): Promise<void> {
    const { asked } = this;
    if (!this.open[id] || asked.text === "" || this.filled[id] === asked || this.filling[id] === asked) return;
    // The polynomial has the parameters in it: their values leave it as it is.
    if (id === "polynomial" && this.filled[id]?.text === asked.text) return;
    this.empty(id);
    this.filling[id] = asked;
    const parts = await this.content(id, asked);
    if (this.filling[id] === asked) this.filling[id] = undefined;
    const same = id === "polynomial" ? asked.text === this.asked.text : asked === this.asked;
    if (!parts || !same) return;
    this.filled[id] = asked;
    this.body(id).replaceChildren(...parts);
    this.body(id).setAttribute("aria-busy", "false");
  }

  private content(id: string, asked: Asked): Promise<Node[] | undefined> {
    switch (id) {
      case "details": return this.limits(asked);
      case "polynomial": return this.polynomial(asked);
      case "best": return this.best(asked);
      case "for-all": return this.forAll(asked);
      default: return this.tolerance(asked);
    }
  }

  private async limits(asked: Asked): Promise<Node[] | undefined> {
    const { text, values, names } = asked;
    const digits = h("select", { id: "digits", change: (event: Event) => {
      this.digits = Number((event.target as HTMLSelectElement).value);
      this.asked = { ...asked };
      void this.fill("details");
    } }, ...[12, 30, 100, 1000].map((n) => h("option", { value: n, selected: n === this.digits }, String(n))));
    const parts: Node[] = [h("p", {}, h("label", { for: "digits" }, "Significant digits "), digits)];
    parts.push(this.certificate(asked, undefined));
    for (const name of names) {
      const reply = await this.ask(`digits ${name}`, program(text, "intervals", "-", "--param", name, ...others(values, name), "--digits", String(this.digits), "--json"));
      if (!reply || asked !== this.asked) return undefined;
      parts.push(h("h3", {}, `Stable set of ${name}`));
      const message = no(reply);
      const document = message ? undefined : JSON.parse(reply.output);
      if (!document?.stable) {
        parts.push(h("p", {}, message ?? reply.notes.join(" ")));
        continue;
      }
      for (const [k, interval] of document.stable.entries()) {
        for (const side of ["lower", "upper"] as const) parts.push(this.end(interval[side], name, `${name}: ${side} end of interval ${k + 1}`));
      }
      if (document.stable.length === 0) parts.push(h("p", {}, "empty: stable for no value"));
      parts.push(this.certificate(asked, name));
    }
    return parts;
  }

  private end(end: any, name: string, title: string): Node {
    if (!end) return h("p", {}, `${title}: none, unbounded`);
    const code = (text: string) => h("span", { class: "digits" }, text);
    const rows: (Node | string)[][] = [["value", code(end.decimal)], ["cause", causes(end.cause)]];
    if (end.exact) rows.push(["exactly", code(end.exact)]);
    else if (end.enclosure) rows.push(["between", code(end.enclosure.join(" and "))]);
    if (end.frequency_hz != null) rows.push(["frequency", `${label(String(end.frequency_hz), 8)} Hz`]);
    else if (end.angle != null) rows.push(["angle", `${label(String(end.angle), 8)} rad per sample`]);
    if (end.polynomial) rows.push(["root of", code(equation(end.polynomial, name))]);
    if (end.over) rows.push(...over(end.over, name).map(([what, is]) => [what, code(is)]));
    return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": title }, table(title, ["what", "is"], rows));
  }

  /** A certificate of the verdict, or of the set of a parameter: made, checked in this page, saved. */
  private certificate({ text, values }: Asked, name: string | undefined): Node {
    const said = h("p", { role: "status" });
    const about = name ? `of the stable set of ${name}` : "of the verdict";
    const over = () => {
      said.textContent = "undecided: cancelled";
    };
    const make = async () => {
      said.textContent = "making it…";
      const set = name ? values.filter(([n]) => n !== name) : values;
      const reply = await this.ask(`certificate ${about}`, { ask: "certificate", model: text, set, free: name ?? null });
      if (!reply) return over();
      if (!reply.certificate) {
        said.textContent = no(reply) ?? "there is none";
        return;
      }
      said.textContent = "checking it with the independent checker…";
      const checked = await this.ask(`check ${about}`, { ask: "check", model: text, certificate: reply.certificate });
      if (!checked) return over();
      const words = checked.proved ? `Proved by the checker, whose code shares nothing with the engine: ${checked.proved}` : `Rejected: ${checked.rejected ?? no(checked)}`;
      const file = `certificate-${name ?? "verdict"}.json`;
      said.replaceChildren(words, " ", h("button", { type: "button", class: "small", click: () => download(file, "application/json", reply.certificate) }, "Save the certificate"));
    };
    return h("div", {}, h("button", { type: "button", click: () => void make() }, `Certificate ${about}`), said);
  }

  private async polynomial({ text }: Asked): Promise<Node[] | undefined> {
    const reply = await this.ask("polynomial", program(text, "charpoly", "-", "--json"));
    if (!reply) return undefined;
    const message = no(reply);
    if (message || !reply.output) return [h("p", {}, message ?? "undecided")];
    const latex = async () => {
      const tex = await this.ask("latex", program(text, "charpoly", "-", "--format", "latex"));
      if (tex?.output) await navigator.clipboard.writeText(tex.output);
    };
    const document = JSON.parse(reply.output);
    const long = reply.output.length > 200_000;
    return [
      h("button", { type: "button", click: () => void latex() }, "Copy as LaTeX"),
      ...(long ? [h("pre", {}, "It is too long to be shown as a formula; the program writes it: jurist charpoly")] : coefficients(document)),
    ];
  }

  /** A button that asks for the best gains. */
  private async best({ text, values, names, chosen, time }: Asked): Promise<Node[]> {
    const gains = gainsOf(text, chosen.length > 0 ? chosen : names);
    if (gains.length === 0) return [h("p", {}, "The model has no parameters that could be tuned.")];
    const objective = h("select", { id: "objective" }, ...objectivesOf(text, gains, time).map((o) => h("option", { value: o }, o)));
    const said = h("pre", { role: "status" });
    const find = async () => {
      said.textContent = "searching …";
      const reply = await this.ask("best", program(text, ...tuning(gains, (objective as HTMLSelectElement).value, values)));
      said.textContent = reply ? (no(reply) ?? [reply.output, ...reply.notes].join("\n")) : "undecided: cancelled";
    };
    return [
      h("p", {}, h("label", { for: "objective" }, `Best of ${gains.join(", ")}: `), objective, " ", h("button", { type: "button", id: "find-best", click: () => void find() }, "Best within the region")),
      said,
    ];
  }

  /** A button that asks what holds for all values of other names. */
  private async forAll({ text, values, names, chosen }: Asked): Promise<Node[]> {
    const what = h("select", { id: "for-all-what" }, ...[MARGINS, ...names].map((o) => h("option", { value: o }, o === MARGINS ? o : `the good values of ${o}`)));
    const line = h("input", { id: "for-all-ranges", type: "text", value: firstRange(values, chosen), spellcheck: false, autocomplete: "off" }) as HTMLInputElement;
    const said = h("pre", { role: "status" });
    const find = async () => {
      const found = rangesOf(line.value);
      if ("wrong" in found || found.ranges.length === 0) {
        said.textContent = `${"wrong" in found ? `'${found.wrong}' is no range` : "there is no range"}: NAME=LO..HI, such as L=0..5e-3`;
        return;
      }
      said.textContent = "computing …";
      const reply = await this.ask("for all", program(text, ...forAll((what as HTMLSelectElement).value, found.ranges, values)));
      said.textContent = reply ? (no(reply) ?? [reply.output, ...reply.notes].join("\n")) : "undecided: cancelled";
    };
    return [
      h("p", {}, h("label", { for: "for-all-ranges" }, "For all "), line, " ", h("label", { for: "for-all-what" }, "what is "), what, " ", h("button", { type: "button", id: "find-for-all", click: () => void find() }, "Prove")),
      said,
    ];
  }

  private async tolerance({ text, values }: Asked): Promise<Node[] | undefined> {
    const reply = await this.ask("tolerance", program(text, "tolerance", "-", ...values.flatMap(([n, v]) => ["--set", `${n}=${v}`])));
    return reply && [h("pre", {}, no(reply) ?? [reply.output, ...reply.notes].join("\n"))];
  }
}
