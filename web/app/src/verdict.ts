// The bar above all answers: the verdict, how many roots are where, and the same for those who listen.

import { counted } from "./about.js";
import { by } from "./dom.js";
import { type Reads, type Verdict, verdictIn } from "./plots.js";
import { no } from "./reply.js";

function put(id: string, text: string): void {
  if (by(id).textContent !== text) by(id).textContent = text;
}

export class VerdictBar {
  private said: ReturnType<typeof setTimeout> | undefined;
  private marked = false;

  constructor(private readonly known: Reads) {}

  show(): void {
    clearTimeout(this.said);
    const { reply, now, late } = this.known("verdict");
    const document = verdictIn(this.known);
    if (!reply || late) {
      by("verdict").className = "verdict";
      put("verdict-word", "…");
      put("announce", "");
      return put("verdict-roots", "computing …");
    }
    const verdict: Verdict = document?.verdict ?? undefined;
    const message = no(reply);
    by("verdict").className = `verdict ${verdict ?? ""}`;
    put("verdict-word", verdict ?? (message ? "no answer" : "undecided"));
    const roots = counted(document) ?? message ?? reply.notes?.join(" ") ?? "";
    put("verdict-roots", roots);
    this.mark();
    // A reader is told once the value rests.
    if (now) this.said = setTimeout(() => put("announce", [verdict ?? "no answer", roots].filter((t) => t).join(": ")), 700);
  }

  /** When the first verdict was there, and drawn: for those who measure. */
  private mark(): void {
    if (this.marked) return;
    this.marked = true;
    performance.mark("verdict");
    requestAnimationFrame(() => setTimeout(() => performance.mark("drawn")));
  }
}
