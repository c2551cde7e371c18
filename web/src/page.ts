// The parts of the page that are words: head, choices, case, foot, and pages without data.
import { origin_chip } from "./chart";
import { h } from "./dom";
import type { ThemeSwitch } from "./theme";
import type { Choice, Report } from "./types";

/** "2025-03-01T10:20:30Z" as "2025-03-01 10:20 UTC": the same for every reader. */
function created_text(created: string): string {
  const match = /^(\d{4}-\d{2}-\d{2})T(\d{2}:\d{2})(?::\d{2}(?:\.\d+)?)?(Z|[+-]\d{2}:?\d{2})?$/.exec(created);
  if (!match) return created;
  return `${match[1]} ${match[2]}${match[3] === "Z" ? " UTC" : match[3] ? ` ${match[3]}` : ""}`;
}

function theme_button(themes: ThemeSwitch): HTMLElement {
  const button = h("button", { type: "button", class: "theme-toggle", onclick: () => themes.toggle() });
  const update = (): void => {
    button.textContent = themes.theme === "dark" ? "Light" : "Dark";
    button.setAttribute("aria-label", `Switch to ${themes.theme === "dark" ? "light" : "dark"} colours`);
  };
  themes.on_change(update);
  update();
  return button;
}

export function page_head(report: Report, themes: ThemeSwitch): HTMLElement {
  const meta = [report.case.file, created_text(report.created), report.version ? `uplift ${report.version}` : ""].filter(Boolean);
  return h(
    "header",
    { class: "page-head" },
    h("div", { class: "page-title" },
      h("h1", {}, report.title),
      report.subtitle ? h("p", { class: "subtitle" }, report.subtitle) : null,
      h("p", { class: "meta" }, ...meta.map((text) => h("span", {}, text)))),
    h("div", { class: "page-tools" },
      theme_button(themes),
      h("button", { type: "button", onclick: () => window.print() }, "Print")),
  );
}

/** What the paper gives, what this program chose, what the user typed. */
export function choices_card(choices: Choice[]): HTMLElement {
  const rows = choices.map((choice) =>
    h("tr", {}, h("th", { scope: "row" }, choice.what), h("td", { class: "value" }, choice.value), h("td", {}, origin_chip(choice.origin)), h("td", { class: "note" }, choice.note ?? "")),
  );
  const heads = ["What", "Value", "Origin", "Note"].map((text) => h("th", { scope: "col" }, text));
  return h(
    "figure",
    { class: "card table-card choices" },
    h("div", { class: "table-box", tabindex: 0, role: "region", "aria-label": "Choices" },
      h("table", {}, h("thead", {}, h("tr", {}, ...heads)), h("tbody", {}, ...rows))),
  );
}

// Pages opened from disk may not have the clipboard interface; selecting the text always works.
async function copy(text: string, button: HTMLElement, source: HTMLElement): Promise<void> {
  const label = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    getSelection()?.selectAllChildren(source);
    button.textContent = document.execCommand("copy") ? "Copied" : "Selected: press Ctrl-C";
  }
  setTimeout(() => (button.textContent = label), 1600);
}

export function case_card(report: Report): HTMLElement {
  const lines: [string, string][] = [
    ["Case file", report.case.file],
    ["SHA-256", report.case.sha256],
    ["Command", report.command],
    ["Program", report.version ? `uplift ${report.version}` : ""],
    ["Created", created_text(report.created)],
  ];
  const source = h("pre", { tabindex: 0 }, h("code", {}, report.case.resolved));
  const button = h("button", { type: "button", class: "copy" }, "Copy");
  button.addEventListener("click", () => void copy(report.case.resolved, button, source));
  return h(
    "div",
    { class: "card case-card" },
    h("dl", { class: "pairs" }, ...lines.filter(([, v]) => v !== "").flatMap(([k, v]) => [h("dt", {}, k), h("dd", {}, h("code", {}, v))])),
    report.case.resolved
      ? h("details", {}, h("summary", {}, "Resolved case: every default filled in"), h("div", { class: "source" }, button, source))
      : null,
  );
}

/** A page that has nothing to show says why. */
export function empty_page(message: string): HTMLElement {
  return h(
    "main",
    { class: "empty" },
    h("h1", {}, "uplift report"),
    h("p", {}, message),
  );
}
