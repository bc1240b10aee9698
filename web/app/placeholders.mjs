// What wasm-split leaves in the first part of a module in the place of each function of the second is an import: thousands, each of
// which an engine makes a function for when the page begins. Here they become functions that trap, which cost nothing; their
// places in the table are filled by the second part when that is there.

/** A module without the imports from `placeholder`; all other functions keep their numbers. */
export function withoutPlaceholders(module) {
  const reader = new Reader(module, 8);
  const sections = [];
  while (reader.at < module.length) {
    const id = reader.byte();
    const length = reader.number();
    sections.push({ id, content: reader.bytes(length) });
  }
  const of = (id) => sections.find((section) => section.id === id);
  const [imports, functions, code] = [of(2), of(3), of(10)];
  const types = [];
  const kept = [];
  for (const { from, kind, type, bytes } of importsOf(imports.content)) {
    if (kind === 0 && from === "placeholder") types.push(type);
    else if (kind === 0 && types.length > 0) throw new Error("a function is imported behind the placeholders");
    else kept.push(bytes);
  }
  const vector = (count, ...parts) => Buffer.concat([leb(count), ...parts]);
  const [declared, bodies] = [new Reader(functions.content), new Reader(code.content)];
  const counts = [declared.number(), bodies.number()];
  imports.content = vector(kept.length, ...kept);
  functions.content = vector(counts[0] + types.length, ...types.map(leb), declared.rest());
  // Three bytes: no locals, `unreachable`, `end`.
  code.content = vector(counts[1] + types.length, ...types.map(() => Buffer.from([3, 0, 0x00, 0x0b])), bodies.rest());
  const written = sections.map(({ id, content }) => Buffer.concat([Buffer.from([id]), leb(content.length), content]));
  return Buffer.concat([module.subarray(0, 8), ...written]);
}

function* importsOf(section) {
  const reader = new Reader(section);
  for (let left = reader.number(); left > 0; left--) {
    const begun = reader.at;
    const from = reader.text();
    reader.text();
    const kind = reader.byte();
    let type;
    if (kind === 0) type = reader.number();
    else if (kind === 3) reader.at += 2;
    else {
      if (kind === 1) reader.byte();
      const limits = reader.byte();
      reader.number();
      if (limits & 1) reader.number();
    }
    yield { from, kind, type, bytes: section.subarray(begun, reader.at) };
  }
}

/** Numbers of WebAssembly: seven bits in a byte, the lowest first. */
class Reader {
  constructor(content, at = 0) {
    this.content = content;
    this.at = at;
  }

  byte() {
    return this.content[this.at++];
  }

  number() {
    let [value, place] = [0, 1];
    for (;;) {
      const byte = this.byte();
      value += (byte & 127) * place;
      if (byte < 128) return value;
      place *= 128;
    }
  }

  bytes(length) {
    this.at += length;
    return this.content.subarray(this.at - length, this.at);
  }

  text() {
    return this.bytes(this.number()).toString("utf8");
  }

  rest() {
    return this.content.subarray(this.at);
  }
}

function leb(value) {
  const bytes = [];
  do {
    const low = value % 128;
    value = Math.floor(value / 128);
    bytes.push(value > 0 ? low + 128 : low);
  } while (value > 0);
  return Buffer.from(bytes);
}
