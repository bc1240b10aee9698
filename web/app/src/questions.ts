// What is asked about the model, and what is known of it. Panels keep no answers: each reads its lanes here. So no answer is shown
// beside another model, and whoever shows one knows whether it is the answer to the question that stands.

import type { Engine, Reply, Speed } from "./engine.js";

/** A question about a text; in a lane one question stands, and the last answer is kept. */
export interface Question {
  lane: string;
  speed: Speed;
  /** What is asked about, where another value is no older picture of the same: axes, a place to cut at. */
  subject?: string;
  request: { model: string };
}

/** What is known in a lane. */
export interface Known {
  /** The answer to the question that stands, or to the one before it about the same text. */
  reply: Reply | undefined;
  /** Whether it is the answer to the question that stands. */
  now: boolean;
  /** Whether the answer to the question that stands takes longer than a moment. */
  late: boolean;
}

/** Milliseconds for which the answer to the question before may stand as it is. */
export const MOMENT = 300;

interface Lane {
  question: Question;
  key: string;
  asked?: { key: string; done: Promise<void> } | undefined;
  answer?: { key: string; reply: Reply };
  late: boolean;
  timer?: ReturnType<typeof setTimeout> | undefined;
}

const UNKNOWN: Known = { reply: undefined, now: false, late: false };

export class Questions {
  /** The lanes of each text: of the one that is shown, and of one that may be next. */
  private readonly texts = new Map<string, Map<string, Lane>>();
  private text = "";

  /** `changed` is called where something else is known in a lane of the text that is shown. */
  constructor(
    private readonly engine: Pick<Engine, "ask">,
    private readonly changed: (lane: string) => void,
  ) {}

  /** From now on it is this text; nothing is known about another. */
  about(text: string): void {
    this.text = text;
    for (const other of [...this.texts.keys()]) if (other !== text) this.only(other, () => false);
    // Who opens a text once more asks once more for what was cancelled.
    this.only(text, (lane) => !lane.answer?.reply.stopped);
  }

  /** The questions that stand about a text; lanes without one are empty. */
  stand(text: string, questions: Question[]): void {
    this.only(text, (_, name) => questions.some((q) => q.lane === name));
    const lanes = this.texts.get(text) ?? new Map<string, Lane>();
    this.texts.set(text, lanes);
    for (const question of questions) {
      const key = JSON.stringify(question.request);
      const lane = lanes.get(question.lane);
      if (lane?.key === key) continue;
      if (lane && lane.question.subject === question.subject) Object.assign(lane, { question, key });
      else {
        if (lane) this.rest(lane);
        lanes.set(question.lane, { question, key, late: false });
      }
      this.wait(text, lanes.get(question.lane)!);
    }
  }

  /** Asks what stands in a lane, unless it is what was asked last. */
  ask(text: string, name: string): Promise<void> {
    const lane = this.texts.get(text)?.get(name);
    if (!lane) return Promise.resolve();
    const { key, question } = lane;
    if (lane.asked?.key === key) return lane.asked.done;
    const done = this.engine.ask(question.speed, name, question.request).then((reply) => this.answered(text, lane, { key, question }, reply));
    lane.asked = { key, done };
    return done;
  }

  known(name: string): Known {
    const lane = this.texts.get(this.text)?.get(name);
    if (!lane) return UNKNOWN;
    const { answer, key, late } = lane;
    return { reply: answer?.reply, now: answer?.key === key, late };
  }

  /** The lanes in which questions stand. */
  lanes(): Question[] {
    return [...(this.texts.get(this.text)?.values() ?? [])].map((lane) => lane.question);
  }

  private answered(text: string, lane: Lane, { key, question }: { key: string; question: Question }, reply: Reply | undefined): void {
    // The text is put aside, or the lane was forgotten.
    if (this.texts.get(text)?.get(question.lane) !== lane) return;
    if (reply === undefined) {
      if (lane.asked?.key === key) lane.asked = undefined;
      return;
    }
    // While a value moves an answer that is a frame old is better than one that is older; of other work only the last counts.
    if (key !== lane.key && (question.speed !== "quick" || reply.stopped || reply.defect)) return;
    lane.answer = { key, reply };
    this.rest(lane);
    this.wait(text, lane);
    if (text === this.text) this.changed(question.lane);
  }

  /** Says so once the answer to what stands does not come in a moment; more questions begin no new moment. */
  private wait(text: string, lane: Lane): void {
    if (lane.answer?.key === lane.key) return this.rest(lane);
    lane.timer ??= setTimeout(() => {
      lane.late = true;
      if (text === this.text) this.changed(lane.question.lane);
    }, MOMENT);
  }

  private rest(lane: Lane): void {
    clearTimeout(lane.timer);
    lane.timer = undefined;
    lane.late = false;
  }

  private only(text: string, stays: (lane: Lane, name: string) => boolean): void {
    const lanes = this.texts.get(text);
    if (!lanes) return;
    for (const [name, lane] of lanes) {
      if (stays(lane, name)) continue;
      this.rest(lane);
      lanes.delete(name);
    }
    if (lanes.size === 0) this.texts.delete(text);
  }
}
