// Examples and templates to begin with.

import { by, h } from "./dom.js";
import { script } from "./load.js";

declare global {
  /** File name and text. */
  var juristExamples: [string, string][] | undefined;
}

declare const EXAMPLES_SCRIPT: string;

const TITLE = /^\s*title\s*=\s*"((?:[^"\\]|\\.)*)"/m;

export async function examples(templates: () => Promise<[string, string][]>, take: (text: string) => void, template: (name: string) => void): Promise<void> {
  const panel = by("panel-examples");
  if (panel.childElementCount > 0) return;
  if (!globalThis.juristExamples) await script(EXAMPLES_SCRIPT);
  const button = (title: string, words: string, click: () => void) => h("button", { type: "button", click }, title, h("small", {}, words));
  const all = globalThis.juristExamples ?? [];
  panel.replaceChildren(
    h("h3", {}, "Templates"),
    h("div", { class: "examples" }, ...(await templates()).map(([name, about]) => button(name, about, () => template(name)))),
    h("h3", {}, "Examples"),
    h("div", { class: "examples" }, ...all.map(([name, text]) => button(TITLE.exec(text)?.[1] ?? name, name, () => take(text)))),
  );
}
