// What is known about a model, with an engine that answers when the test says so: node --test web/app/test/questions.mjs

import assert from "node:assert/strict";
import { mock, test } from "node:test";
import { moduleOf } from "./instance.mjs";
import { random } from "./models.mjs";

const { MOMENT, Questions } = await moduleOf("questions.ts");
const { questionsAbout } = await moduleOf("requests.ts");

/** An engine whose answers wait; each says which request it answers. */
function slow() {
  const asked = [];
  const ask = (speed, lane, request) => new Promise((resolve) => asked.push({ lane, request, resolve }));
  /** Answers the request at this place, or ends it without an answer. */
  const answer = async (k, reply = {}) => {
    const [{ request, resolve }] = asked.splice(k, 1);
    resolve(reply && { request, ...reply });
    await new Promise((done) => process.nextTick(done));
  };
  return { asked, ask, answer };
}

const question = (model, value, lane = "map", speed = "long", subject = "K T") => ({ lane, speed, subject, request: { model, value, subject } });

function beginning() {
  const engine = slow();
  const told = [];
  const questions = new Questions(engine, (lane) => told.push(lane));
  const stand = (...all) => {
    questions.about(all[0].request.model);
    questions.stand(all[0].request.model, all);
    for (const { lane } of all) void questions.ask(all[0].request.model, lane);
  };
  return { engine, questions, stand, told };
}

test("another text has nothing of the one before, and late answers are nobody's", async () => {
  const { engine, questions, stand, told } = beginning();
  stand(question("first", 1));
  await engine.answer(0);
  assert.equal(questions.known("map").reply.request.model, "first");
  stand(question("first", 2));
  stand(question("second", 1));
  assert.deepEqual(questions.known("map"), { reply: undefined, now: false, late: false });
  for (const late of [{}, { stopped: "cancelled" }, { defect: "broken" }]) {
    stand(question("first", 3));
    stand(question("second", 4));
    told.length = 0;
    await engine.answer(engine.asked.findIndex((a) => a.request.model === "first" && a.request.value === 3), late);
    assert.deepEqual([questions.known("map").reply, told], [undefined, []], JSON.stringify(late));
  }
  await engine.answer(engine.asked.findLastIndex((a) => a.request.model === "second"));
  assert.deepEqual(questions.known("map").reply.request, question("second", 4).request);
});

test("axes that are others have no picture of the ones before, other values have one that says so", async () => {
  const { engine, questions, stand } = beginning();
  stand(question("text", 1));
  await engine.answer(0);
  stand(question("text", 2));
  const { reply, now } = questions.known("map");
  assert.deepEqual([reply.request.value, now], [1, false]);
  stand(question("text", 2, "map", "long", "K L"));
  assert.equal(questions.known("map").reply, undefined);
});

test("what is asked ahead about a text is known once that text is shown, and not before", async () => {
  const { engine, questions, stand } = beginning();
  stand(question("first", 1, "verdict", "quick"));
  await engine.answer(0, { verdict: "stable" });
  questions.stand("second", [question("second", 1, "verdict", "quick")]);
  void questions.ask("second", "verdict");
  await engine.answer(0, { verdict: "unstable" });
  assert.equal(questions.known("verdict").reply.verdict, "stable");
  questions.about("second");
  assert.equal(questions.known("verdict").reply.verdict, "unstable");
});

test("what was cancelled stays so until the text is opened once more", async () => {
  const { engine, questions, stand } = beginning();
  stand(question("text", 1));
  await engine.answer(0, { stopped: "cancelled" });
  assert.equal(questions.known("map").reply.stopped, "cancelled");
  await questions.ask("text", "map");
  assert.equal(engine.asked.length, 0);
  stand(question("text", 1));
  assert.deepEqual([questions.known("map").reply, engine.asked.length], [undefined, 1]);
});

test("an answer of values before is late after a moment, however many questions come", async () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  try {
    const { engine, questions, stand, told } = beginning();
    stand(question("text", 0, "verdict", "quick"));
    await engine.answer(0);
    for (let value = 1; value < 10; value++) {
      stand(question("text", value, "verdict", "quick"));
      mock.timers.tick(MOMENT / 5);
    }
    assert.equal(questions.known("verdict").late, true);
    assert.deepEqual(told, ["verdict", "verdict"]);
    // Somebody drags, and answers follow a frame later: they stand.
    for (let value = 10; value < 30; value++) {
      stand(question("text", value, "verdict", "quick"));
      mock.timers.tick(MOMENT / 5);
      await engine.answer(engine.asked.findLastIndex((a) => a.request.value === value));
      stand(question("text", value + 1, "verdict", "quick"));
      assert.deepEqual([questions.known("verdict").late, questions.known("verdict").reply.request.value], [false, value]);
    }
  } finally {
    mock.timers.reset();
  }
});

test("whatever happens, what is known is about the text that is shown: 20 000 steps at random", async () => {
  const next = random(33);
  const pick = (list) => list[Math.floor(next() * list.length)];
  const { engine, questions } = beginning();
  let [text, shown, standing] = ["a", 0, new Map()];
  const all = () => {
    const subject = pick(["K T", "K L"]);
    return [question(text, pick([1, 2, 3]), "verdict", "quick", undefined), question(text, pick([1, 2, 3]), "map", "long", subject)].slice(Math.floor(next() * 2));
  };
  questions.about(text);
  for (let step = 0; step < 20_000; step++) {
    const what = next();
    if (what < 0.04) {
      text = pick(["a", "b", "c"]);
      questions.about(text);
      standing = new Map([...standing].filter(([, q]) => q.request.model === text));
    } else if (what < 0.4) {
      const questioned = all();
      questions.stand(text, questioned);
      standing = new Map(questioned.map((q) => [q.lane, q]));
      for (const { lane } of questioned) void questions.ask(text, lane);
    } else if (engine.asked.length > 0) {
      // Mostly what was asked last.
      const k = next() < 0.2 ? next() : 1 - next() / Math.max(1, engine.asked.length / 3);
      await engine.answer(Math.min(engine.asked.length - 1, Math.max(0, Math.floor(k * engine.asked.length))), pick([{}, {}, {}, { stopped: "cancelled" }, { defect: "broken" }, undefined]));
    }
    for (const lane of ["verdict", "map"]) {
      const { reply, now } = questions.known(lane);
      if (!reply) continue;
      shown++;
      assert.equal(reply.request.model, text);
      assert.ok(standing.has(lane), "no question stands, and something is known");
      if (now) assert.deepEqual(reply.request, standing.get(lane).request);
      if (reply.stopped || reply.defect) assert.ok(now || reply.request.value !== standing.get(lane).request.value);
    }
  }
  assert.ok(shown > 5000, `something was known ${shown} times`);
});

test("every question says which text it is about", () => {
  const also = { rightmost: false, finer: 0 };
  const chosen = { text: "text", values: [["K", "1"], ["T", "2"]], differing: [["K", "1"]], focus: "K", cut: "e", axes: ["K", "T"], method: "auto", also };
  const lanes = questionsAbout(chosen);
  const further = questionsAbout({ ...chosen, also: { rightmost: true, finer: 1 } });
  for (const { lane, request } of further) assert.equal(request.model, "text", lane);
  const names = ["verdict", "point", "intervals K", "intervals T", "locus", "frequency response", "margins", "map"];
  assert.deepEqual(lanes.map((q) => q.lane), names);
  assert.deepEqual(further.map((q) => q.lane).sort(), [...names, "roots", "finer map"].sort());
});

test("the work of a map is counted, but for an exact one that somebody waits for", () => {
  const chosen = { text: "text", values: [["K", "1"], ["T", "2"], ["L", "3"]], differing: [], focus: "", cut: "", axes: ["K", "T"], also: { rightmost: false, finer: 2 } };
  const maps = (method) => questionsAbout({ ...chosen, method }).filter((q) => q.request.ask === "map").map((q) => q.request);
  const [first, finer, small] = maps("auto");
  assert.deepEqual([first.method, finer.method, first.set], ["auto", "boxes", [["L", "3"]]]);
  assert.ok(first.work > 0 && finer.work > first.work && small.work > finer.work);
  assert.equal(maps("exact")[0].work, undefined);
});
