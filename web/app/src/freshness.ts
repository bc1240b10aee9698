// Whether the answers are about the text that stands in the editor. Where they are not, they are grey, and a sentence says what they
// are about.

import { by } from "./dom.js";

/** Milliseconds until the sentence comes: most texts are read before. */
const MOMENT = 400;

export class Freshness {
  private shown: string | undefined;
  private text = "";
  /** The last text that was no model. */
  private none: string | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** What stands in the editor. */
  written(text: string): void {
    this.text = text;
    this.settle();
    if (text === this.none) this.refused(text);
    else if (text !== this.shown) this.timer = setTimeout(() => this.say("The text has changed and is not read yet."), MOMENT);
  }

  /** What the answers are about from now on. */
  about(text: string): void {
    this.shown = text;
    this.settle();
  }

  /** The text is no model. */
  refused(text: string): void {
    this.none = text;
    if (text !== this.text || text === this.shown) return;
    clearTimeout(this.timer);
    this.say("The text is no model at the moment.");
  }

  private settle(): void {
    clearTimeout(this.timer);
    const old = this.text !== this.shown;
    by("answers").classList.toggle("old", old);
    by("verdict-about").hidden = !old || this.shown === undefined;
    if (!old) by("stale").hidden = true;
  }

  private say(why: string): void {
    by("stale").textContent = `${why} ${this.shown === undefined ? "There is nothing to show yet." : "What is shown below is about the last text that was a model."}`;
    by("stale").hidden = false;
  }
}
