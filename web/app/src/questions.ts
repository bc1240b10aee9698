// Questions about one model after the other: each is asked once, and answered to the model that it was asked about.

import type { Engine, Reply, Speed } from "./engine.js";

export class Questions {
  /** The last question of each lane, and when it is answered. */
  private readonly known = new Map<string, { key: string; done: Promise<void> }>();
  private model = 0;

  constructor(
    private readonly engine: Engine,
    private readonly defect: (text: string) => void,
  ) {}

  /** From now on it is another model: an answer about the one before is nobody's. */
  renew(): void {
    this.model++;
    this.known.clear();
  }

  /** Asks once more where the same is asked. */
  forget(lane: string): void {
    this.known.delete(lane);
  }

  /** Asks, unless it is what was asked last; what is overtaken leaves no trace. */
  once(speed: Speed, lane: string, request: unknown, use: (reply: Reply) => void): Promise<void> {
    const key = JSON.stringify(request);
    const known = this.known.get(lane);
    if (known?.key === key) return known.done;
    const { model } = this;
    const answered = (reply: Reply | undefined) => {
      if (model !== this.model) return;
      const last = this.known.get(lane)?.key === key;
      if (reply === undefined) {
        if (last) this.forget(lane);
        return;
      }
      // While a value moves an answer that is a frame old is better than one that is older; of other work only the last counts.
      if (!last && speed !== "quick") return;
      if (reply.defect) this.defect(reply.defect);
      use(reply);
    };
    const done = this.engine.ask(speed, lane, request).then(answered);
    this.known.set(lane, { key, done });
    return done;
  }
}
