// Buttons, files, keys: what people do with the page as a whole.

import { commandLine, python, withNominals } from "./copy.js";
import { by, download, h, tabs } from "./dom.js";
import { examples } from "./examples.js";
import { pack } from "./link.js";
import type { Page } from "./page.js";
import { asModel } from "./paste.js";
import type { Figure } from "./plot.js";

export function wire(page: Page): void {
  const click = (id: string, does: () => void) => by(id).addEventListener("click", does);
  const toml = () => withNominals(page.text, page.differing());
  const link = location.protocol === "file:" ? "link, which opens on this machine alone, as the page is a file here," : "link";
  click("share", () => void pack(page.shared()).then((fragment) => copy(page, location.href.split("#")[0] + fragment, link)));
  click("copy-toml", () => void copy(page, toml(), "model file"));
  click("copy-python", () => void copy(page, python(page.text, page.focus || undefined, page.differing()), "Python"));
  click("copy-command", () => void copy(page, commandLine(page.focus || undefined, page.differing()), "command line"));
  click("save-toml", () => download("model.toml", "application/toml", toml()));
  click("save-svg", () => {
    for (const figure of page.figures()) download(`${figure.id}.svg`, "image/svg+xml", figure.standalone());
  });
  click("save-png", () => {
    for (const figure of page.figures()) void png(figure);
  });
  by<HTMLInputElement>("open").addEventListener("change", (event) => {
    const file = (event.target as HTMLInputElement).files?.[0];
    if (file) void take(page, file);
  });
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) void take(page, file);
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      by<HTMLDetailsElement>("copies").open = false;
      page.engine.cancel(true);
    }
  });
  const use = (pasted: string) => {
    by("paste-wrong").textContent = "";
    try {
      fresh(asModel(pasted));
    } catch (error) {
      by("paste-wrong").textContent = error instanceof Error ? error.message : String(error);
    }
  };
  const fresh = (text: string) => {
    void page.open(text, { m: "" }).then(() => page.remember(true));
    choose("tab-text");
    // Where the model stands below the answers, these are what is looked for now.
    if (by("paste-here").offsetParent) by("answers").scrollIntoView();
  };
  const templates = async () => {
    const reply = await page.engine.ask("quick", "templates", { ask: "program", model: null, arguments: ["new", "--list"] });
    const lines: string[] = reply?.output?.trimEnd().split("\n") ?? [];
    return lines.map((line) => line.split(/\s{2,}/, 2) as [string, string]);
  };
  const template = (name: string) =>
    void page.engine.ask("quick", "template", { ask: "program", model: null, arguments: ["new", name] }).then((reply) => reply?.output && fresh(reply.output));
  const choose = tabs(by("model-tabs"), (id) => id === "tab-examples" && void examples(templates, fresh, template));
  click("paste-here", () => {
    choose("tab-paste");
    by("model").scrollIntoView();
    by("pasted").focus({ preventScroll: true });
  });
  click("paste-use", () => use(by<HTMLTextAreaElement>("pasted").value));
  addEventListener("popstate", () => void page.follow());
  addEventListener("hashchange", () => void page.follow());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => page.figures().forEach((f) => f.draw()));
}

async function copy(page: Page, text: string, what: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Without the right to the clipboard the old way is left.
    const area = h("textarea", { class: "hidden" }, text);
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  page.say(`${what} copied`);
}

async function take(page: Page, file: File): Promise<void> {
  if (file.size > 4 << 20) return page.say("a model file is not that long");
  try {
    await page.open(asModel(await file.text()), { m: "" });
    await page.remember(true);
  } catch (error) {
    page.say(error instanceof Error ? error.message : String(error));
  }
}

async function png(figure: Figure): Promise<void> {
  const image = new Image();
  const url = URL.createObjectURL(new Blob([figure.standalone()], { type: "image/svg+xml" }));
  image.src = url;
  await image.decode();
  const canvas = h("canvas", { width: image.width * 2, height: image.height * 2 });
  const context = canvas.getContext("2d")!;
  context.fillStyle = getComputedStyle(document.body).backgroundColor;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(url);
  canvas.toBlob((blob) => blob && download(`${figure.id}.png`, "image/png", blob));
}
