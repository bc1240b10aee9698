// The editor that takes the place of the text area once it has arrived: a file of its own.

import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { type Diagnostic, lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { tags } from "@lezer/highlight";
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import type { Finding, TextBox } from "./textbox.js";

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--faint)" },
  { tag: tags.string, color: "var(--c2)" },
  { tag: [tags.number, tags.bool], color: "var(--c1)" },
  { tag: tags.heading, color: "var(--accent)" },
]);

/** A place in characters, from 1, as an offset in UTF-16. */
function offset(state: EditorState, line: number, column: number): number {
  if (line > state.doc.lines) return state.doc.length;
  const { from, text } = state.doc.line(Math.max(1, line));
  return from + [...text].slice(0, column - 1).join("").length;
}

globalThis.juristEditor = (parent: HTMLElement, text: string, changed: (text: string) => void): TextBox => {
  const extensions = [
    lineNumbers(),
    lintGutter(),
    history(),
    drawSelection(),
    highlightActiveLine(),
    StreamLanguage.define(toml),
    syntaxHighlighting(colours),
    keymap.of([...defaultKeymap, ...historyKeymap]),
    EditorView.contentAttributes.of({ "aria-label": "model file", tabindex: "0" }),
    EditorView.updateListener.of((update) => update.docChanged && changed(update.state.doc.toString())),
    EditorView.theme({
      "&": { color: "var(--ink)" },
      ".cm-gutters": { backgroundColor: "var(--raised)", color: "var(--faint)", border: "none" },
      ".cm-activeLine": { backgroundColor: "transparent" },
      ".cm-cursor": { borderLeftColor: "var(--ink)" },
      ".cm-content ::selection, .cm-selectionBackground": { backgroundColor: "var(--stable-ground) !important" },
      ".cm-scroller": { fontFamily: "ui-monospace, monospace" },
      ".cm-tooltip": { backgroundColor: "var(--ground)", color: "var(--ink)", border: "1px solid var(--faint)" },
    }),
  ];
  const view = new EditorView({ parent, state: EditorState.create({ doc: text, extensions }) });
  return {
    get: () => view.state.doc.toString(),
    set: (next) => view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: next } }),
    mark(findings: Finding[]) {
      const marks = findings.filter((f) => f.place !== null).map((f): Diagnostic => {
        const from = offset(view.state, f.place!.line, f.place!.column);
        const to = Math.max(from, offset(view.state, f.place!.end_line, f.place!.end_column));
        const message = [f.message, f.place!.text, f.help].filter((t) => t).join("; ");
        return { from, to, severity: f.severity, message: `[${f.code}] ${message}` };
      });
      view.dispatch(setDiagnostics(view.state, marks));
    },
    focus(line, column) {
      const at = offset(view.state, line, column);
      view.dispatch({ selection: { anchor: at }, scrollIntoView: true });
      view.focus();
    },
  };
};
