// What is said in words and tables: the program's remarks on a model, its blocks and constants, how its roots are counted.

import { by, h, table } from "./dom.js";
import type { Reply } from "./engine.js";
import type { Model } from "./model.js";
import type { TextBox } from "./textbox.js";

/** The remarks as the program draws them, with buttons that go to their places. */
export function remarks(reply: Reply, editor: TextBox): void {
  const place = by("remarks");
  if (!reply.text) return place.replaceChildren();
  const wrong = reply.check.diagnostics.some((d: any) => d.severity === "error");
  const goto = reply.check.diagnostics
    .filter((d: any) => d.place)
    .slice(0, 8)
    .map((d: any) => h("button", { type: "button", class: "small", click: () => editor.focus(d.place.line, d.place.column) }, `line ${d.place.line}`));
  place.replaceChildren(h("pre", { class: wrong ? "error" : "", tabindex: 0, role: "region", "aria-label": wrong ? "errors" : "warnings" }, reply.text), ...goto);
}

/** Blocks and constants as tables. */
export function blocks(model: Model): void {
  by("panel-blocks").replaceChildren(
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "blocks" }, table(model.rules || "Blocks", ["name", "input", "output", "does"], model.blocks)),
    h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "constants" }, table("Constants", ["name", "value"], model.constants.map((c) => [c.name, c.value]))),
  );
}

/** Where the roots are, in words. */
export function counted(document: any): string | undefined {
  if (document?.degree === undefined || document.inside === undefined) return undefined;
  if (document.inside === null) return uncounted(document);
  const { degree, inside, on, outside, infinite } = document;
  const where = document.time === "continuous" ? "in the left half plane" : "inside the unit circle";
  const rest = [on ? `${on} on the boundary` : "", outside ? `${outside} outside` : "", infinite ? `${infinite} at infinity` : ""].filter((t) => t);
  return `${inside} of ${degree} ${degree === 1 ? "root" : "roots"} ${where}${rest.length > 0 ? `, ${rest.join(", ")}` : ""}`;
}
declare const EDITOR_SCRIPT: string;

/** The same of a loop with dead time, which as a rule has infinitely many roots: those that are not left of the axis are counted. */
function uncounted({ on, outside }: any): string | undefined {
  if (outside === null || outside === undefined) return undefined;
  const many = (count: number) => `${count === 0 ? "no" : count} ${count === 1 ? "root" : "roots"}`;
  return `${many(outside)} in the right half plane${on ? `, ${on} on the axis` : ""}`;
}
