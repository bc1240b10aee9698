// Small models at random, the same for everyone who asks for as many.

/** Mulberry32: enough for tests, and the same everywhere. */
export function random(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export function randomModels(count) {
  const next = random(20261122);
  const pick = (list) => list[Math.floor(next() * list.length)];
  const number = () => pick(["1", "2", "1/2", "3/10", "0.25", "5", "1e-2", "7/3", "0.9", "1.5", "12.125"]);
  const sign = () => pick(["+", "-"]);
  const models = [];
  while (models.length < count) {
    const discrete = next() < 0.5;
    const v = discrete ? "z" : "s";
    const order = 1 + Math.floor(next() * 4);
    const coefficient = (k) => {
      const parts = [number()];
      if (k < order && next() < 0.6) parts.push(`${sign()} ${number()}*K`);
      if (k < order && next() < 0.15) parts.push(`${sign()} K^2/${1 + Math.floor(next() * 9)}`);
      if (next() < 0.25) parts.push(`${sign()} ${number()}*a`);
      return `(${parts.join(" ")})`;
    };
    const terms = Array.from({ length: order + 1 }, (_, k) => `${k === 0 ? "" : sign()} ${coefficient(k)}*${v}^${k}`);
    const domain = pick(["min = 0", "min = 0, max = 10", "min = -5, max = 5", "max = 3"]);
    models.push(
      `time = "${discrete ? "discrete" : "continuous"}"\n[parameters]\nK = { nominal = 1, ${domain} }\na = { nominal = "1/3", min = 0 }\n[loop]\ncharacteristic = "${terms.join(" ").trim()}"\n`,
    );
  }
  return models;
}
