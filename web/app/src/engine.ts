// The engine as the page sees it: three workers behind lanes. In a lane the last request counts; what was overtaken is dropped, or,
// once it runs, its worker is replaced by a new one made of the kept module. What needs the engine's second part before that is there
// waits for it. The first worker begins before its module has arrived.

export type Reply = any;

/** Answered while a parameter is dragged, when there is time, or after minutes: nobody waits behind the next kind. */
export type Speed = "quick" | "slow" | "long";

interface Asked {
  id: number;
  lane: string;
  request: unknown;
  resolve(reply: Reply | undefined): void;
}

/** What somebody waits for goes before the rest. */
const FIRST = new Set(["verdict", "describe"]);

/** What runs longer than this, in milliseconds, makes room for what somebody waits for. */
const PATIENCE = 400;

/** Requests that a worker holds, the one that it works at among them: the next begins while the page still draws the last answer. */
const HELD: Record<Speed, number> = { quick: 2, slow: 1, long: 1 };

let nextId = 1;

class Seat {
  private worker: Worker | undefined;
  private ready = false;
  /** What the worker holds; it works at the first. */
  private held: Asked[] = [];
  private since = 0;
  private waiting: Asked[] = [];
  private timer = 0;

  constructor(
    private readonly owner: Engine,
    private readonly speed: Speed,
  ) {
    // The others begin when they are first asked: what somebody waits for has the machine for itself until then.
    if (speed === "quick") this.begin();
  }

  /** Asks; `undefined` where a later request of the lane came first. */
  ask(lane: string, request: unknown): Promise<Reply | undefined> {
    return new Promise((resolve) => {
      const overtaken = this.waiting.filter((asked) => asked.lane === lane);
      this.waiting = this.waiting.filter((asked) => asked.lane !== lane);
      for (const asked of overtaken) asked.resolve(undefined);
      const asked = { id: nextId++, lane, request, resolve };
      const before = this.waiting.findIndex((other) => !FIRST.has(other.lane));
      this.waiting.splice(FIRST.has(lane) && before >= 0 ? before : this.waiting.length, 0, asked);
      const again = this.held.some((other) => other.lane === lane);
      if (again && this.speed !== "quick") this.giveUp();
      // Somebody moves something: what runs has to make room before long.
      else if (again || (this.running && FIRST.has(lane))) this.hurry();
      if (!this.worker) this.begin();
      this.next();
    });
  }

  /** Drops what waits and ends what runs; `reply` is what they get for an answer. */
  cancel(reply: Reply | undefined): void {
    const dropped = [...this.held, ...this.waiting];
    this.waiting = [];
    if (this.running) this.replace();
    for (const asked of dropped) asked.resolve(reply);
    this.next();
  }

  get running(): Asked | undefined {
    return this.held[0];
  }

  get busy(): string | undefined {
    return this.running?.lane;
  }

  private hurry(): void {
    clearTimeout(this.timer);
    const late = () => this.running && this.giveUp();
    this.timer = window.setTimeout(late, Math.max(0, PATIENCE - (performance.now() - this.since)));
  }

  private begin(): void {
    this.ready = false;
    const worker = this.owner.worker();
    this.worker = worker;
    worker.onmessage = ({ data }) => worker === this.worker && this.told(data);
    worker.onerror = (event) => worker === this.worker && this.broken(event.message || "the worker does not start");
  }

  /** The second part of the engine. */
  complete(rest: WebAssembly.Module): void {
    this.worker?.postMessage({ rest });
  }

  private told(data: any): void {
    if (data.ready) {
      this.ready = true;
      performance.mark("ready");
      this.next();
    } else if (data.incomplete) {
      this.worker?.terminate();
      clearTimeout(this.timer);
      this.waiting.unshift(...this.held);
      this.held = [];
      this.ready = false;
      void this.owner.whole().then(() => this.begin());
    } else if (data.failed) {
      this.owner.failed(data.failed);
    } else if (data.progress !== undefined) {
      if (data.id === this.running?.id) this.owner.progress(this.running!.lane, data.progress);
    } else if (data.id === this.running?.id) {
      const done = this.held.shift()!;
      this.since = performance.now();
      this.owner.took(done.lane, data.took);
      clearTimeout(this.timer);
      if (data.broken) this.anew();
      done.resolve(data.reply);
      this.next();
    }
  }

  private broken(message: string): void {
    const done = this.held.shift();
    if (!done) return this.owner.failed(message);
    this.anew();
    done.resolve({ defect: message });
    this.next();
  }

  /** Ends what runs: it is overtaken, or waits once more behind the others. */
  private giveUp(): void {
    const [given, ...others] = this.held;
    this.held = others;
    if (this.waiting.some((asked) => asked.lane === given!.lane)) given!.resolve(undefined);
    else this.waiting.push(given!);
    this.anew();
  }

  /** A new worker, for what the old one held. */
  private anew(): void {
    this.waiting.unshift(...this.held);
    this.replace();
  }

  private replace(): void {
    clearTimeout(this.timer);
    this.worker?.terminate();
    this.held = [];
    this.owner.replaced++;
    this.begin();
  }

  private next(): void {
    while (this.ready && this.held.length < HELD[this.speed]) {
      const asked = this.waiting.shift();
      if (!asked) break;
      if (this.held.length === 0) this.since = performance.now();
      this.held.push(asked);
      this.worker!.postMessage({ id: asked.id, request: asked.request });
      this.owner.working(this.busy!);
    }
    if (this.ready && !this.running) this.owner.idle();
  }
}

export class Engine {
  private readonly seats: Record<Speed, Seat>;
  private readonly source: string;
  private rest: WebAssembly.Module | undefined;
  private arriving: Promise<void> | undefined;
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
    private readonly module: Promise<WebAssembly.Module>,
    private readonly loadRest: () => Promise<WebAssembly.Module | undefined>,
  ) {
    this.source = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.seats = { quick: new Seat(this, "quick"), slow: new Seat(this, "slow"), long: new Seat(this, "long") };
  }

  /** A worker, which says so when it has the module and is ready. */
  worker(): Worker {
    const worker = new Worker(this.source);
    void this.module.then((module) => worker.postMessage({ module, rest: this.rest }));
    return worker;
  }

  /** Until the second part of the engine is there. */
  whole(): Promise<void> {
    const arrived = (rest: WebAssembly.Module | undefined) => {
      this.rest = rest;
      if (rest) for (const seat of Object.values(this.seats)) seat.complete(rest);
    };
    const lost = (why: unknown) => {
      this.arriving = undefined;
      this.failed(why instanceof Error ? why.message : String(why));
      throw why;
    };
    return (this.arriving ??= this.loadRest().then(arrived, lost));
  }

  ask(speed: Speed, lane: string, request: unknown): Promise<Reply | undefined> {
    return this.seats[speed].ask(lane, request);
  }

  /** Ends all work. What somebody ended is undecided, what nobody needs any more gets no answer. */
  cancel(wished = false): void {
    const reply = wished ? { stopped: "cancelled" } : undefined;
    for (const seat of Object.values(this.seats)) seat.cancel(reply);
  }

  get busy(): string | undefined {
    return this.seats.long.busy ?? this.seats.slow.busy ?? this.seats.quick.busy;
  }

  took(lane: string, milliseconds: number): void {
    this.times[lane] = milliseconds;
  }
}
