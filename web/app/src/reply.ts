// What the engine's answers say.

import type { Reply } from "./engine.js";

/** Why there is nothing to show, in the engine's words. */
export function no(reply: any): string | undefined {
  if (!reply) return "computing …";
  if (reply.refused) return reply.refused.diagnostics?.[0]?.message ?? reply.refused.text;
  if (reply.undefined) return `undefined here: ${reply.undefined}`;
  if (reply.stopped) return `undecided: ${reply.stopped}`;
  if (reply.defect) return `a defect of jurist: ${reply.defect}`;
  if (reply.none) return reply.none;
  return undefined;
}

/** Whether the counted work ended before there was anything to show. */
export function ended(reply: any): boolean {
  return reply?.stopped !== undefined && reply.stopped !== "cancelled";
}

/** The same, and what can be asked instead: sentences for a panel that has nothing else to say. */
export function instead(reply: any): string | undefined {
  const message = no(reply);
  const help: string | null | undefined = reply?.refused?.diagnostics?.[0]?.help;
  return message && help ? `${sentence(message)} ${sentence(help)}` : message;
}

function sentence(text: string): string {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}${/[.!?]$/.test(text) ? "" : "."}`;
}

const read = new WeakMap<object, any>();

/** The document that a command has written, read once. */
export function documentOf(reply: Reply): any {
  if (typeof reply?.output !== "string" || !reply.output.startsWith("{")) return undefined;
  if (!read.has(reply)) read.set(reply, JSON.parse(reply.output));
  return read.get(reply);
}
