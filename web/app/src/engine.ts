// The engine as the page sees it: two workers behind lanes. In a lane the last request counts; what was overtaken is dropped, or,
// once it runs, its worker is replaced by a new one made of the kept module.

export type Reply = any;

/** Answered while a parameter is dragged, or in its own time. */
export type Speed = "quick" | "slow";

interface Asked {
  id: number;
  lane: string;
  request: unknown;
  resolve(reply: Reply | undefined): void;
}

/** A quick request that runs longer than this is given up for the next one. */
const PATIENCE = 400;

let nextId = 1;

class Seat {
  private worker: Worker | undefined;
  private ready = false;
  private running: Asked | undefined;
  private since = 0;
  private waiting: Asked[] = [];
  private timer = 0;

  constructor(
    private readonly owner: Engine,
    private readonly speed: Speed,
  ) {
    this.begin();
  }

  /** Asks; `undefined` where a later request of the lane came first. */
  ask(lane: string, request: unknown): Promise<Reply | undefined> {
    return new Promise((resolve) => {
      const overtaken = this.waiting.filter((asked) => asked.lane === lane);
      this.waiting = this.waiting.filter((asked) => asked.lane !== lane);
      for (const asked of overtaken) asked.resolve(undefined);
      this.waiting.push({ id: nextId++, lane, request, resolve });
      if (this.running?.lane === lane && this.speed === "slow") this.replace(false);
      else if (this.running && this.speed === "quick") this.hurry();
      this.next();
    });
  }

  /** Drops what waits and ends what runs. */
  cancel(lane?: string): void {
    const dropped = this.waiting.filter((asked) => !lane || asked.lane === lane);
    this.waiting = this.waiting.filter((asked) => !dropped.includes(asked));
    for (const asked of dropped) asked.resolve(undefined);
    if (this.running && (!lane || this.running.lane === lane)) this.replace(false);
    this.next();
  }

  get busy(): string | undefined {
    return this.running?.lane;
  }

  private hurry(): void {
    clearTimeout(this.timer);
    const late = () => this.waiting.length > 0 && this.running && this.replace(false);
    this.timer = window.setTimeout(late, Math.max(0, PATIENCE - (performance.now() - this.since)));
  }

  private begin(): void {
    this.ready = false;
    const worker = this.owner.worker();
    this.worker = worker;
    worker.onmessage = ({ data }) => worker === this.worker && this.told(data);
    worker.onerror = (event) => worker === this.worker && this.broken(event.message || "the worker does not start");
  }

  private told(data: any): void {
    if (data.ready) {
      this.ready = true;
      this.next();
    } else if (data.failed) {
      this.owner.failed(data.failed);
    } else if (data.progress !== undefined) {
      if (data.id === this.running?.id) this.owner.progress(this.running!.lane, data.progress);
    } else if (data.id === this.running?.id) {
      const done = this.running!;
      this.running = undefined;
      this.owner.took(done.lane, data.took);
      if (data.broken) this.replace(true);
      done.resolve(data.reply);
      this.next();
    }
  }

  private broken(message: string): void {
    const done = this.running;
    this.running = undefined;
    if (!done) return this.owner.failed(message);
    this.replace(true);
    done.resolve({ defect: message });
    this.next();
  }

  private replace(broken: boolean): void {
    clearTimeout(this.timer);
    this.worker?.terminate();
    const given = this.running;
    this.running = undefined;
    if (!broken) given?.resolve(undefined);
    this.owner.replaced++;
    this.begin();
  }

  private next(): void {
    if (!this.ready || this.running) return;
    const asked = this.waiting.shift();
    if (!asked) return this.owner.idle();
    this.running = asked;
    this.since = performance.now();
    this.owner.working(asked.lane);
    this.worker!.postMessage({ id: asked.id, request: asked.request });
    if (this.speed === "quick" && this.waiting.length > 0) this.hurry();
  }
}

export class Engine {
  private readonly seats: Record<Speed, Seat>;
  private readonly source: string;
  /** How often a worker was replaced. */
  replaced = 0;
  /** Milliseconds of the last answer in each lane. */
  readonly times: Record<string, number> = {};
  progress: (lane: string, text: string) => void = () => {};
  working: (lane: string) => void = () => {};
  idle: () => void = () => {};
  failed: (why: string) => void = () => {};

  constructor(
    script: string,
    private readonly module: WebAssembly.Module,
  ) {
    this.source = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.seats = { quick: new Seat(this, "quick"), slow: new Seat(this, "slow") };
  }

  worker(): Worker {
    const worker = new Worker(this.source);
    worker.postMessage({ module: this.module });
    return worker;
  }

  ask(speed: Speed, lane: string, request: unknown): Promise<Reply | undefined> {
    return this.seats[speed].ask(lane, request);
  }

  /** Ends long work; with a lane only that. */
  cancel(lane?: string): void {
    this.seats.slow.cancel(lane);
  }

  get busy(): string | undefined {
    return this.seats.slow.busy;
  }

  took(lane: string, milliseconds: number): void {
    this.times[lane] = milliseconds;
  }
}
