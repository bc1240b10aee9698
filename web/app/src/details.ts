// The drawer: every end with all its digits, certificates made and checked, the polynomial, tolerances.

import { coefficients } from "./formula.js";
import { by, download, h, table } from "./dom.js";
import { label } from "./numbers.js";
import { causes } from "./parameters.js";
import { no } from "./plots.js";

type Ask = (lane: string, request: unknown) => Promise<any>;

export interface Asked {
  text: string;
  values: [string, string][];
  names: string[];
}

const program = (text: string, ...args: string[]) => ({ ask: "program", model: text, arguments: args });

function others(values: [string, string][], name: string): string[] {
  return values.filter(([n]) => n !== name).flatMap(([n, v]) => ["--set", `${n}=${v}`]);
}

export class Details {
  private asked: Asked = { text: "", values: [], names: [] };
  private digits = 30;
  private readonly open: Record<string, boolean> = {};

  constructor(private readonly ask: Ask) {
    for (const id of ["details", "polynomial", "tolerance"]) {
      by<HTMLDetailsElement>(id).addEventListener("toggle", (event) => {
        this.open[id] = (event.target as HTMLDetailsElement).open;
        void this.fill(id);
      });
    }
  }

  /** What the drawers are about; those that are open are filled anew. */
  async about(asked: Asked): Promise<void> {
    // What stands there is kept while it is about the same question.
    if (JSON.stringify(asked) === JSON.stringify(this.asked)) return;
    this.asked = asked;
    for (const id of ["details", "polynomial", "tolerance"]) if (this.open[id]) await this.fill(id);
  }

  private async fill(id: string): Promise<void> {
    if (!this.open[id]) return;
    if (id === "details") await this.limits();
    if (id === "polynomial") await this.polynomial();
    if (id === "tolerance") await this.tolerance();
  }

  private async limits(): Promise<void> {
    const { text, values, names } = this.asked;
    const body = by("details-body");
    const digits = h("select", { id: "digits", change: (event: Event) => {
      this.digits = Number((event.target as HTMLSelectElement).value);
      void this.limits();
    } }, ...[12, 30, 100, 1000].map((n) => h("option", { value: n, selected: n === this.digits }, String(n))));
    const parts: Node[] = [h("p", {}, h("label", { for: "digits" }, "Significant digits "), digits)];
    parts.push(this.certificate(undefined));
    for (const name of names) {
      const reply = await this.ask(`digits ${name}`, program(text, "intervals", "-", "--param", name, ...others(values, name), "--digits", String(this.digits), "--json"));
      if (!reply) return;
      parts.push(h("h3", {}, `Stable set of ${name}`));
      const message = no(reply);
      const document = message ? undefined : JSON.parse(reply.output);
      if (!document?.stable) {
        parts.push(h("p", {}, message ?? reply.notes.join(" ")));
        continue;
      }
      for (const [k, interval] of document.stable.entries()) {
        for (const side of ["lower", "upper"] as const) parts.push(this.end(interval[side], `${name}: ${side} end of interval ${k + 1}`));
      }
      if (document.stable.length === 0) parts.push(h("p", {}, "empty: stable for no value"));
      parts.push(this.certificate(name));
    }
    body.replaceChildren(...parts);
  }

  private end(end: any, title: string): Node {
    if (!end) return h("p", {}, `${title}: none, unbounded`);
    const code = (text: string) => h("span", { class: "digits" }, text);
    const rows: (Node | string)[][] = [["value", code(end.decimal)], ["cause", causes(end.cause)]];
    if (end.exact) rows.push(["exactly", code(end.exact)]);
    else if (end.enclosure) rows.push(["between", code(end.enclosure.join(" and "))]);
    if (end.frequency_hz != null) rows.push(["frequency", `${label(String(end.frequency_hz), 8)} Hz`]);
    else if (end.angle != null) rows.push(["angle", `${label(String(end.angle), 8)} rad per sample`]);
    if (end.polynomial) rows.push(["root of, from the constant term up", code(`[${end.polynomial.join(", ")}]`)]);
    if (end.over) rows.push(["zero of", code(JSON.stringify(end.over))]);
    return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": title }, table(title, ["what", "is"], rows));
  }

  /** A certificate of the verdict, or of the set of a parameter: made, checked in this page, saved. */
  private certificate(name: string | undefined): Node {
    const said = h("p", { role: "status" });
    const about = name ? `of the stable set of ${name}` : "of the verdict";
    const { text, values } = this.asked;
    const make = async () => {
      said.textContent = "making it…";
      const set = name ? values.filter(([n]) => n !== name) : values;
      const reply = await this.ask(`certificate ${name}`, { ask: "certificate", model: text, set, free: name ?? null });
      if (!reply) return;
      if (!reply.certificate) {
        said.textContent = no(reply) ?? "there is none";
        return;
      }
      said.textContent = "checking it with the independent checker…";
      const checked = await this.ask(`check ${name}`, { ask: "check", model: text, certificate: reply.certificate });
      if (!checked) return;
      const words = checked.proved ? `Proved by the checker, whose code shares nothing with the engine: ${checked.proved}` : `Rejected: ${checked.rejected ?? no(checked)}`;
      const file = `certificate-${name ?? "verdict"}.json`;
      said.replaceChildren(words, " ", h("button", { type: "button", class: "small", click: () => download(file, "application/json", reply.certificate) }, "Save the certificate"));
    };
    return h("div", {}, h("button", { type: "button", click: () => void make() }, `Certificate ${about}`), said);
  }

  private async polynomial(): Promise<void> {
    const { text } = this.asked;
    const reply = await this.ask("polynomial", program(text, "charpoly", "-", "--json"));
    if (!reply) return;
    const message = no(reply);
    const body = by("polynomial-body");
    if (message || !reply.output) return body.replaceChildren(h("p", {}, message ?? "undecided"));
    const latex = async () => {
      const tex = await this.ask("latex", program(text, "charpoly", "-", "--format", "latex"));
      if (tex?.output) await navigator.clipboard.writeText(tex.output);
    };
    const document = JSON.parse(reply.output);
    const long = reply.output.length > 200_000;
    body.replaceChildren(
      h("button", { type: "button", click: () => void latex() }, "Copy as LaTeX"),
      ...(long ? [h("pre", {}, "It is too long to be shown as a formula; the program writes it: jurist charpoly")] : coefficients(document)),
    );
  }

  private async tolerance(): Promise<void> {
    const { text, values } = this.asked;
    const body = by("tolerance-body");
    body.replaceChildren(h("p", {}, "…"));
    const reply = await this.ask("tolerance", program(text, "tolerance", "-", ...values.flatMap(([n, v]) => ["--set", `${n}=${v}`])));
    if (!reply) return;
    const message = no(reply) ?? [reply.output, ...reply.notes].join("\n");
    body.replaceChildren(h("pre", {}, message));
  }
}
