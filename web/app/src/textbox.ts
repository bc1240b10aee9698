// Where the model's text is written: a text area that works at once, an editor after it.

export interface Place {
  line: number;
  column: number;
  end_line: number;
  end_column: number;
  text: string;
}

export interface Finding {
  severity: "error" | "warning";
  code: string;
  message: string;
  help: string | null;
  place: Place | null;
}

export interface TextBox {
  get(): string;
  set(text: string): void;
  mark(findings: Finding[]): void;
  focus(line: number, column: number): void;
}

declare global {
  var juristEditor: ((parent: HTMLElement, text: string, changed: (text: string) => void) => TextBox) | undefined;
}

export function textArea(area: HTMLTextAreaElement, changed: (text: string) => void): TextBox {
  area.addEventListener("input", () => changed(area.value));
  return {
    get: () => area.value,
    set(text) {
      area.value = text;
      changed(text);
    },
    mark(findings) {
      area.setAttribute("aria-invalid", String(findings.some((f) => f.severity === "error")));
    },
    focus(line, column) {
      const before = area.value.split("\n").slice(0, line - 1).join("\n");
      const at = before.length + (line > 1 ? 1 : 0) + column - 1;
      area.focus();
      area.setSelectionRange(at, at);
    },
  };
}
