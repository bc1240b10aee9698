// What a link holds, packed into its fragment: it never reaches a server. The number before `=` is the version; a page reads all of
// them for ever.

export interface Shared {
  /** The model's text. */
  m: string;
  /** Values that differ from nominal. */
  v?: Record<string, string>;
  /** The parameter of the locus. */
  p?: string;
  /** The axes of the map. */
  a?: [string, string];
  /** Where the loop is cut. */
  c?: string;
}

/** Longer texts are not unpacked: a link is no place for a bomb. */
const MOST = 1 << 20;

export async function pack(shared: Shared): Promise<string> {
  const stream = new Blob([JSON.stringify(shared)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return `#1=${btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

/** What a fragment says; `undefined` for one that is not ours, an error for one that is broken. */
export async function unpack(fragment: string): Promise<Shared | undefined> {
  const [, version, body] = /^#(\d+)=([\w-]*)$/.exec(fragment) ?? [];
  if (version === undefined) return undefined;
  if (version !== "1") throw new Error(`this link is of version ${version}, which this page does not know`);
  const bytes = Uint8Array.from(atob(body!.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const parts: Uint8Array[] = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    length += value.length;
    if (length > MOST) throw new Error("this link holds more than a megabyte");
    parts.push(value);
  }
  return checked(JSON.parse(await new Blob(parts as BlobPart[]).text()));
}

function checked(shared: any): Shared {
  if (typeof shared?.m !== "string") throw new Error("this link holds no model");
  const out: Shared = { m: shared.m };
  if (shared.v && typeof shared.v === "object") {
    out.v = Object.create(null) as Record<string, string>;
    for (const [name, text] of Object.entries(shared.v)) if (typeof text === "string") out.v[name] = text;
  }
  if (typeof shared.p === "string") out.p = shared.p;
  if (typeof shared.c === "string") out.c = shared.c;
  if (Array.isArray(shared.a) && shared.a.length === 2 && shared.a.every((n: unknown) => typeof n === "string")) out.a = shared.a;
  return out;
}
