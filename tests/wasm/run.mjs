// Asks the library, compiled to WebAssembly, and compares: node run.mjs MODULE
import { readFileSync } from 'node:fs';

const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), {});
const { memory, answer } = instance.exports;
const at = answer();
const length = new DataView(memory.buffer).getUint32(at, true);
const text = new TextDecoder().decode(new Uint8Array(memory.buffer, at + 4, length));
const expected = `${'K below 2 by a complex pair\n'.repeat(3)}map decided\nthree units of work: stopped\n`;
if (text !== expected) {
    console.error(`expected:\n${expected}\nanswered:\n${text}`);
    process.exit(1);
}
console.log(`WebAssembly: ${text.trimEnd().split('\n').length} answers as expected`);
