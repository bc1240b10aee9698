// The address of the page follows its state, and the state the address.

import { type Shared, pack, unpack } from "./link.js";

declare const DRIVE: string;

export class Address {
  private remembered = "";
  private turn = 0;

  constructor(private readonly shared: () => Shared) {}

  /** A new entry in the history when something is done, the same while it moves. */
  async remember(done: boolean): Promise<void> {
    const turn = ++this.turn;
    if (!done) await new Promise((resolve) => setTimeout(resolve, 200));
    if (turn !== this.turn || typeof CompressionStream === "undefined") return;
    const shared = this.shared();
    const plain = shared.m === DRIVE && Object.keys(shared).length === 1;
    const fragment = plain ? "" : await pack(shared);
    if (turn !== this.turn || fragment === this.remembered) return;
    this.remembered = fragment;
    const url = fragment || location.pathname + location.search;
    try {
      if (done) history.pushState(null, "", url);
      else history.replaceState(null, "", url);
    } catch {
      // Some hosts of files allow no history.
    }
  }

  /** Whether it was changed by somebody else since. */
  get isNew(): boolean {
    return location.hash !== this.remembered;
  }

  /** What it holds; fails where that is broken. */
  async held(): Promise<Shared> {
    this.remembered = location.hash;
    return (await unpack(location.hash)) ?? { m: DRIVE };
  }
}
