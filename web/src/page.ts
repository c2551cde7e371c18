// The parts of the page that are text: head, choices, case, and pages without data.
import { origin_chip } from "./chart";
import { h } from "./dom";
import { cut_note } from "./table";
import type { ThemeSwitch } from "./theme";
import type { Choice, Report } from "./types";

/** "2025-03-01T10:20:30Z" as "2025-03-01 10:20 UTC": the same for every reader. */
function created_text(created: string): string {
  const match = /^(\d{4}-\d{2}-\d{2})T(\d{2}:\d{2})(?::\d{2}(?:\.\d+)?)?(Z|[+-]\d{2}:?\d{2})?$/.exec(created);
  if (!match) return created;
  return `${match[1]} ${match[2]}${match[3] === "Z" ? " UTC" : match[3] ? ` ${match[3]}` : ""}`;
}

// So many rows are shown without a click.
const FEW = 12;

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

function choice_table(choices: Choice[]): HTMLElement {
  const rows = choices.map((choice) =>
    h("tr", {}, h("th", { scope: "row" }, choice.what), h("td", { class: "value" }, choice.value), h("td", {}, origin_chip(choice.origin)), h("td", { class: "note" }, choice.note ?? "")),
  );
  const heads = ["What", "Value", "Origin", "Note"].map((text) => h("th", { scope: "col" }, text));
  const box = h("div", { class: "table-box", tabindex: 0, role: "region", "aria-label": "Choices" },
    h("table", {}, h("thead", {}, h("tr", {}, ...heads)), h("tbody", {}, ...rows)));
  return h("div", {}, box, cut_note(box));
}

/** Values with a stated origin; those that the user typed follow in a closed box when there are many. */
export function choices_card(choices: Choice[]): HTMLElement {
  const typed = choices.filter((choice) => choice.origin === "user" && !choice.note);
  const others = choices.filter((choice) => !typed.includes(choice));
  const apart = typed.length > FEW;
  const shown = apart ? others : choices;
  return h(
    "figure",
    { class: "card table-card choices" },
    shown.length > 0 ? choice_table(shown) : null,
    apart ? h("details", {}, h("summary", {}, `${typed.length} values from the case file`), choice_table(typed)) : null,
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

function step(...words: (Node | string)[]): HTMLElement {
  return h("li", {}, ...words);
}

const code = (text: string): HTMLElement => h("code", {}, text);

function case_steps({ case: from, command }: Report): HTMLElement[] {
  const subcommand = /^uplift (\w+)/.exec(command)?.[1] ?? "run";
  return [
    step("Run ", code(command), "."),
    step("Without the files, save the resolved case below as ", code("case.toml"), " and run ", code(`uplift ${subcommand} case.toml`),
      ". It contains all default values of this version, so that a later version uses the same ones", (from.inputs ?? []).length > 0 ? ". The input files are still needed." : "."),
  ];
}

function study_steps(): HTMLElement[] {
  return [
    step("Run ", code("uplift study run FOLDER"), " on a new folder with the plan below as ", code("plan.toml"),
      ". The number of processes, the order of the runs and interruptions have no influence on ", code("study.json"), "."),
    step("For a single run, ", code("uplift study export FOLDER --run ID"), " writes its case, and ", code("uplift run"), " repeats it bit for bit. ", code("runs.csv"), " lists the identities."),
  ];
}

/** Program, files with their hashes, command, and the case with all default values: what is needed to reproduce the results. */
export function repeat_card(report: Report): HTMLElement {
  const { case: from, command } = report;
  const { study } = report.verdict;
  const lines: [string, string][] = [
    ["Program", report.version ? `uplift ${report.version}${report.builtWith ? `, ${report.builtWith}` : ""}` : ""],
    ["Created", created_text(report.created)],
    [study ? "Plan" : report.verdict.level === "motion" ? "Record" : "Case file", from.file],
    ["SHA-256", from.sha256],
    ...(from.inputs ?? []).flatMap(({ file, sha256 }): [string, string][] => [["Input file", file], ["SHA-256", sha256]]),
    ...(study ? [["Seed of the samples", String(study.provenance.seed)] as [string, string]] : []),
    ["Command", command],
  ];
  const source = h("pre", { tabindex: 0 }, h("code", {}, from.resolved));
  const button = h("button", { type: "button", class: "copy" }, "Copy");
  button.addEventListener("click", () => void copy(from.resolved, button, source));
  // The files of a study are named relative to its plan.
  const folder = study && from.file.includes("/") ? from.file.slice(0, from.file.lastIndexOf("/") + 1) : "";
  const files = [from.file, ...(from.inputs ?? []).map(({ file }) => (file.startsWith("/") ? file : folder + file))].filter(Boolean);
  return h(
    "div",
    { class: "card case-card" },
    h("dl", { class: "pairs" }, ...lines.filter(([, v]) => v !== "").flatMap(([k, v]) => [h("dt", {}, k), h("dd", {}, h("code", {}, v))])),
    from.resolved
      ? h("ol", { class: "repeat" },
          step("Use the same program: ", code("uplift --version"), ` prints ${report.version}.`),
          step("Check the files: ", code(`sha256sum ${files.join(" ")}`), " must print the hashes above."),
          ...(study ? study_steps() : case_steps(report)))
      : null,
    from.resolved
      ? h("details", { class: "in-print" }, h("summary", {}, study ? "Plan of the study" : "Resolved case with all default values"), h("div", { class: "source" }, button, source))
      : null,
  );
}

/** A page without data states the reason. */
export function empty_page(message: string): HTMLElement {
  return h(
    "main",
    { class: "empty" },
    h("h1", {}, "uplift report"),
    h("p", {}, message),
  );
}
