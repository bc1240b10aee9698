// One instance of the engine: texts go in and come out through its memory. Also used by the tests, in Node.
//
// The engine comes in two parts (split.mjs). The first traps where it needs the second, which puts its functions into the places of the
// first one's table when it is there.

interface Exports {
  memory: WebAssembly.Memory;
  table?: WebAssembly.Table;
  request(length: number): number;
  answer(): number;
  last_words(): number;
}

export interface Instance {
  /** The answer to a request; throws where the engine broke off, or needs its second part. */
  ask(request: unknown): any;
  /** What it said before it broke off. */
  lastWords(): string;
  /** Takes the second part in. */
  complete(rest: WebAssembly.Module): void;
  isWhole(): boolean;
  exports: Exports;
}

/** Half a pair of surrogates is no character: it goes as the one that says so. */
const wellFormed = (_: string, value: unknown) => (typeof value === "string" ? value.replace(/\p{Surrogate}/gu, "\ufffd") : value);

export async function instantiate(module: WebAssembly.Module, progress: (text: string) => void = () => {}): Promise<Instance> {
  const decoder = new TextDecoder();
  const told = (at: number, length: number) =>
    progress(decoder.decode(new Uint8Array(exports.memory.buffer, at, length)));
  const instance = await WebAssembly.instantiate(module, { page: { progress: told } });
  const exports = instance.exports as unknown as Exports;
  // Only what was split lets its table be seen.
  let isWhole = exports.table === undefined;
  const text = (at: number) => {
    const length = new DataView(exports.memory.buffer).getUint32(at, true);
    return decoder.decode(new Uint8Array(exports.memory.buffer, at + 4, length));
  };
  return {
    ask(request) {
      const bytes = new TextEncoder().encode(JSON.stringify(request, wellFormed));
      const at = exports.request(bytes.length);
      new Uint8Array(exports.memory.buffer, at, bytes.length).set(bytes);
      return JSON.parse(text(exports.answer()));
    },
    lastWords: () => text(exports.last_words()),
    complete(rest) {
      if (!isWhole) new WebAssembly.Instance(rest, { primary: instance.exports });
      isWhole = true;
    },
    isWhole: () => isWhole,
    exports,
  };
}
