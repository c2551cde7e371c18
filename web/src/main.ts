// Puts the page together: head, verdict, tables, model and motion, figures by section, choices, case.
import { AnimationCard } from "./animation";
import { ChartCard } from "./chart";
import { read_report } from "./data";
import { h } from "./dom";
import { inspection } from "./inspect";
import { model_card } from "./model";
import { choices_card, empty_page, page_head, repeat_card } from "./page";
import { install_palette, run_names } from "./palette";
import { run_bar } from "./runbar";
import { Runs } from "./runs";
import { SpaceCard } from "./space/card";
import { tornado_cards } from "./study_page";
import { RestMaps } from "./space/rest_maps";
import { TableCard } from "./table";
import { ThemeSwitch } from "./theme";
import { rest_table, verdict_card } from "./verdict";
import type { Chart, Report, Section } from "./types";

// Charts are drawn when they come this near to the screen.
const NEAR = "500px";

// The section of the residual state follows the verdict.
const REST = "rest";

/** Figures that are drawn late, and differently in print. */
interface Drawn {
  readonly element: HTMLElement;
  render(): void;
  prepare_print(): void;
  end_print(): void;
}

interface Part {
  id: string;
  title: string;
  element: HTMLElement;
}

function failed_runs(report: Report): Set<string> {
  const failed = new Set<string>();
  for (const chart of report.charts) {
    for (const series of chart.series) if (series.failed && series.run) failed.add(series.run);
  }
  return failed;
}

function part(id: string, title: string, ...children: (Node | null)[]): Part {
  return { id, title, element: h("section", { class: "part", id }, h("h2", {}, title), ...children) };
}

/** Charts in the order in which the page shows them, so that figures are numbered from top to bottom. */
function in_page_order(report: Report): Chart[] {
  const rank = new Map(report.sections.map((section, i) => [section.id, i]));
  const of = (chart: Chart): number => rank.get(chart.section) ?? report.sections.length;
  return [...report.charts].sort((a, b) => of(a) - of(b));
}

/** Charts by section; those of no known section come last so that none is lost. */
function chart_parts(report: Report, cards: ChartCard[]): Part[] {
  const known = new Set(report.sections.map((section) => section.id));
  const rest: Section = { id: "", title: "Further figures" };
  return [...report.sections, rest].flatMap((section) => {
    if (section.id === REST) return [];
    const mine = cards.filter(({ model }) => (section.id === "" ? !known.has(model.chart.section) : model.chart.section === section.id));
    if (mine.length === 0) return [];
    const text = section.text ? h("p", { class: "section-text" }, section.text) : null;
    return [part(`section-${section.id || "rest"}`, section.title, text, h("div", { class: "grid" }, ...mine.map((c) => c.element)))];
  });
}

/** The residual state: table, profiles or maps of the interfaces. */
function after_shock(report: Report, cards: ChartCard[], maps: RestMaps | null): Part[] {
  const table = rest_table(report.verdict);
  const mine = cards.filter(({ model }) => model.chart.section === REST);
  if (!table && mine.length === 0 && !maps) return [];
  const section = report.sections.find(({ id }) => id === REST);
  const text = section?.text ? h("p", { class: "section-text" }, section.text) : null;
  return [part("after-shock", section?.title ?? "Residual state", text, table, h("div", { class: "grid" }, ...mine.map((c) => c.element), maps?.element ?? null))];
}

function contents(parts: Part[]): HTMLElement {
  const links = parts.map((p) => h("li", {}, h("a", { href: `#${p.id}` }, p.title)));
  // Open beside the page on wide screens, a closed box on narrow ones.
  return h("nav", { class: "toc", "aria-label": "Contents" }, h("details", { open: matchMedia("(min-width: 1180px)").matches }, h("summary", {}, "Contents"), h("ol", {}, ...links)));
}

function draw_when_near(cards: Drawn[]): void {
  const observer = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        cards.find((card) => card.element === entry.target)?.render();
        observer.unobserve(entry.target);
      }
    },
    { rootMargin: NEAR },
  );
  cards.forEach((card) => observer.observe(card.element));
}

/** Print shows drawings instead of canvases: sharp at any resolution, always in light colours. */
function follow_print(cards: Drawn[]): void {
  let printing = false;
  const set = (on: boolean): void => {
    if (on === printing) return;
    printing = on;
    cards.forEach((card) => (on ? card.prepare_print() : card.end_print()));
    document.querySelectorAll<HTMLDetailsElement>("details.in-print").forEach((box) => {
      if (on) box.dataset["was"] = box.open ? "open" : "";
      box.open = on || box.dataset["was"] === "open";
    });
  };
  addEventListener("beforeprint", () => set(true));
  addEventListener("afterprint", () => set(false));
  matchMedia("print").addEventListener("change", (event) => set(event.matches));
}

/** The link of the part in view is marked. */
function follow_scroll(toc: HTMLElement, parts: Part[]): void {
  const links = new Map(parts.map((p) => [p.element, toc.querySelector(`a[href="#${CSS.escape(p.id)}"]`)]));
  const observer = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        links.forEach((link, element) => link?.classList.toggle("is-here", element === entry.target));
      }
    },
    { rootMargin: "-15% 0px -75% 0px" },
  );
  parts.forEach((p) => observer.observe(p.element));
}

function show_report(host: HTMLElement, report: Report): void {
  document.title = `${report.title} – uplift`;
  const themes = new ThemeSwitch();
  const runs = new Runs(run_names(report), failed_runs(report));
  // The origin of a figure is shown only where figures have different origins.
  const say_origin = new Set(report.charts.map((chart) => chart.origin)).size > 1;
  const charts = in_page_order(report).map((chart, i) => new ChartCard(chart, runs, i + 1, say_origin));
  const tables = report.tables.map((table) => new TableCard(table, runs));
  // The motions of a study can be many: they follow the figures.
  const late = report.verdict.study ? tables.filter(({ table }) => table.id === "motions") : [];
  const early = tables.filter((table) => !late.includes(table));
  const { model, animations, choices, space } = report;
  const animation = model && animations.length > 0 ? new AnimationCard(model, animations, runs) : null;
  const space_card = space ? new SpaceCard(space, report.spaceAnimations ?? [], runs, themes) : null;
  const last = report.spaceAnimations?.find((a) => a.run === report.verdict.run) ?? report.spaceAnimations?.[0];
  const rest_maps = space && last && last.time.length > 0 ? new RestMaps(space, last, themes) : null;
  const drawn_late: Drawn[] = [...(rest_maps ? [rest_maps] : []), ...(space_card ? [space_card] : []), ...charts];

  const tornados = report.verdict.study ? tornado_cards(report.verdict.study) : [];
  const figures = chart_parts(report, charts);
  const parts: Part[] = [
    { id: "verdict", title: "Verdict", element: verdict_card(report.verdict, report.charts) },
    ...after_shock(report, charts, rest_maps),
    ...(early.length > 0 ? [part("tables", report.verdict.study ? "Limit states" : early.length > 1 ? "Tables" : "Comparison", ...early.map((t) => t.element))] : []),
    ...(model ? [part("model", animation ? "Model and motion" : "Model", h("div", { class: "grid" }, model_card(model), animation?.element ?? null))] : []),
    ...(space_card ? [part("space-model", space_card.frames > 0 ? "Model and motion" : "Model", space_card.element)] : []),
    ...figures,
    ...(tornados.length > 0 ? [part("tornado", "Influence of the uncertain numbers", h("div", { class: "grid" }, ...tornados))] : []),
    ...(late.length > 0 ? [part("motions", "Motions", ...late.map((t) => t.element))] : []),
    ...(choices.length > 0 ? [part("choices", "Choices", choices_card(choices))] : []),
    part("case", "How to reproduce the results", repeat_card(report)),
  ];
  const toc = contents(parts);
  // The bar of runs sticks to the top while the figures pass, so both share one box.
  const bar = runs.names.length > 1 && figures.length > 0 ? run_bar(runs) : null;
  const drawn = figures.map((p) => p.element);
  const before = parts.slice(0, parts.indexOf(figures[0] ?? (parts[parts.length - 1] as Part))).map((p) => p.element);
  const after = parts.map((p) => p.element).filter((e) => !before.includes(e) && !drawn.includes(e));
  host.append(
    h("div", { class: "page" }, toc, h("main", {}, page_head(report, themes), ...before, h("div", { class: "figures" }, bar, ...drawn), ...after)),
  );

  themes.on_change(() => charts.forEach((card) => card.repaint()));
  draw_when_near(drawn_late);
  follow_print(drawn_late);
  follow_scroll(toc, parts);
  window.upliftReport = inspection(report, "", charts, tables, animation, space_card);
}

async function start(): Promise<void> {
  install_palette();
  const host = document.getElementById("report") as HTMLElement;
  const result = await read_report();
  if (result.kind === "report") {
    show_report(host, result.report);
    return;
  }
  new ThemeSwitch();
  const message = result.kind === "empty" ? "This page contains no data. The program fills it when it runs a case: uplift compare CASE." : result.message;
  host.append(empty_page(message));
  window.upliftReport = inspection(null, message);
}

void start();
