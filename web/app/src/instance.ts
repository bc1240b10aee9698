// One instance of the engine: texts go in and come out through its memory. Also used by the tests, in Node.
//
// The engine comes in two parts (split.mjs). In the place of each function of the second one the first has an import, which takes the
// second part in when it is called for the first time; from then on that place of the table is the function itself.

interface Exports {
  memory: WebAssembly.Memory;
  table?: WebAssembly.Table;
  request(length: number): number;
  answer(): number;
  last_words(): number;
}

export interface Instance {
  /** The answer to a request; throws where the engine broke off. */
  ask(request: unknown): any;
  /** What it said before it broke off. */
  lastWords(): string;
  exports: Exports;
}

/** The second part is needed, and is not there yet. */
export class Incomplete extends Error {}

/** Half a pair of surrogates is no character: it goes as the one that says so. */
const wellFormed = (_: string, value: unknown) => (typeof value === "string" ? value.replace(/\p{Surrogate}/gu, "\ufffd") : value);

export async function instantiate(
  module: WebAssembly.Module,
  progress: (text: string) => void = () => {},
  rest: () => WebAssembly.Module | undefined = () => undefined,
): Promise<Instance> {
  const decoder = new TextDecoder();
  const told = (at: number, length: number) =>
    progress(decoder.decode(new Uint8Array(exports.memory.buffer, at, length)));
  let isWhole = false;
  const placeholder: Record<string, Function> = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    if (from !== "placeholder") continue;
    placeholder[name] = (...values: unknown[]) => {
      if (!isWhole) {
        const second = rest();
        if (!second) throw new Incomplete("the rest of the engine is not there");
        new WebAssembly.Instance(second, { primary: instance.exports });
        isWhole = true;
      }
      return exports.table!.get(Number(name))(...values);
    };
  }
  const instance = await WebAssembly.instantiate(module, { page: { progress: told }, placeholder });
  const exports = instance.exports as unknown as Exports;
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
    exports,
  };
}
