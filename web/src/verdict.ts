// The first page: headline, uplifted share over time, comparison with the bonded model, the criteria of the case, and the estimate from
// the tension ratio of a linear analysis.
import { h, s, type Child } from "./dom";
import { number, tied } from "./format";
import { share_chart } from "./share_chart";
import { spectrum_chart } from "./spectrum_chart";
import { study_block } from "./study_page";
import type { BaseVerdict, Chart, Criterion, CriterionState, FloorChange, Verdict, VerdictLevel, VerdictRow } from "./types";

const LEVEL_WORD: Record<VerdictLevel, string> = {
  none: "No uplift",
  uplift: "Uplift",
  overturned: "Overturned",
  separated: "Contact lost",
  failed: "Run failed",
  motion: "Ground motion",
  fragility: "Fragility",
};

// A tick, a lifted edge, a toppled block, a separated block, a cross, a seismogram, a fragility curve: the shape shows the level without colour.
const LEVEL_SIGN: Record<VerdictLevel, string> = {
  none: "M5 12.5L10 17.5L19 7",
  uplift: "M3 20H21M4 17L20 10M20 10V5M17.5 7.5L20 5L22.5 7.5",
  overturned: "M3 20H21M6 20L13 6L20 9.5L14.5 20",
  separated: "M3 20H21M5 13H19M12 10V3M9 6L12 3L15 6",
  failed: "M6 6L18 18M18 6L6 18",
  motion: "M2 12H6L8 6L11 18L14 4L17 15L19 12H22",
  fragility: "M3 3V20H21M4 19C12 19 11 6 20 5",
};

function level_sign(level: VerdictLevel): SVGElement {
  return s("svg", { class: "sign", viewBox: "0 0 24 24", width: 34, height: 34, "aria-hidden": "true" }, s("path", { d: LEVEL_SIGN[level] }));
}

function beside_table(base: BaseVerdict): HTMLElement | null {
  if (base.beside.length === 0) return null;
  const wall = base.role === "wall";
  const bonded = base.beside.some((row) => row.bonded !== undefined);
  const checked = base.beside.some((row) => row.stepText !== undefined);
  const row = ({ label, time, text, bondedText, changeText, stepText }: VerdictRow): HTMLElement =>
    h("tr", {},
      h("th", { scope: "row" }, label),
      h("td", { title: time === undefined ? null : `at ${number(time, 4)} s` }, tied(text)),
      checked ? h("td", { class: "step-change" }, tied(stepText ?? "–")) : null,
      bonded ? h("td", {}, tied(bondedText ?? "–")) : null,
      bonded ? h("td", { class: "change" }, tied(changeText ?? "–")) : null);
  const heads = [bonded || !wall ? "" : "Wall", bonded ? "With uplift" : "Largest", ...(checked ? ["Twice the step"] : []), ...(bonded ? ["Bonded", "Change"] : [])];
  return h("table", { class: "beside" },
    h("thead", {}, h("tr", {}, ...heads.map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, ...base.beside.map(row)));
}

/** Three bars: tension ratio of the linear analysis, uplift estimated from it, uplift computed. */
function tension_bars(base: BaseVerdict): HTMLElement | null {
  const { linear } = base;
  if (!linear || (linear.tension <= 0 && linear.computed <= 0)) return null;
  const bar = (kind: string, label: string, share: number | null, text: string): HTMLElement =>
    h("div", { class: `bar bar-${kind}` },
      h("span", { class: "bar-label" }, label),
      h("span", { class: "bar-track" }, share === null ? null : h("i", { style: `width:${Math.min(100, 100 * share).toFixed(1)}%` })),
      h("b", {}, share === null ? "not applicable" : tied(text)));
  return h("div", { class: "tension" },
    h("h3", {}, "Tension ratio of the linear analysis and uplift"),
    bar("linear", "tension, bonded model", linear.tension, linear.tensionText),
    bar("predicted", "uplift estimated", linear.predicted, linear.predictedText),
    bar("computed", "uplift computed", linear.computed, linear.computedText));
}

const STATE_SIGN: Record<CriterionState, string> = { met: "✓", "not met": "✕", undetermined: "?" };

function criterion_row(criterion: Criterion): HTMLElement {
  const { state, label, atLeast, source, valueText, limitText, uncertain } = criterion;
  return h("li", { class: `criterion is-${state.replace(" ", "-")}` },
    h("span", { class: "state" }, h("i", { "aria-hidden": "true" }, STATE_SIGN[state]), ` ${state}`),
    h("span", { class: "what" }, label + (criterion.interface ? ` (${criterion.interface})` : "")),
    h("span", { class: "value" }, tied(valueText), `, limit ${atLeast ? "≥" : "≤"} ${tied(limitText)}`, uncertain ? "; not certain: doubling the step changes the value by at least its distance from the limit" : ""),
    h("span", { class: "by" }, source));
}

function criteria_list(criteria: Criterion[]): HTMLElement {
  if (criteria.length === 0) return h("p", { class: "no-criteria" }, "The case sets no criteria. A table ", h("code", {}, "[[verdict.criterion]]"), " in the case file sets a limit for a result.");
  const met = criteria.filter((c) => c.state === "met").length;
  return h("div", { class: "criteria" },
    h("h3", {}, `Criteria of the case: ${met} of ${criteria.length} met`),
    h("ul", {}, ...criteria.map(criterion_row)));
}

/** The floor and damping whose spectrum changes most in a band. Where the bonded floor is not excited there is no change to compare. */
function most_changed(floors: FloorChange[]): FloorChange | undefined {
  const size = (floor: FloorChange): number => Math.max(0, ...floor.bands.map((each) => (each.arises ? 0 : Math.abs(each.change_percent))));
  return floors.reduce<FloorChange | undefined>((best, each) => (best && size(best) >= size(each) ? best : each), undefined);
}

/** Floors in rows, frequency bands in columns; next to the table the spectrum that changes most. */
function floor_block(floors: FloorChange[], charts: Chart[]): HTMLElement | null {
  if (floors.length === 0) return null;
  const bands = [...new Set(floors.flatMap((floor) => floor.bands.map(({ band }) => band)))];
  const short = (band: string): string => band.replace(/ Hz$/, "").replace("below ", "< ").replace("above ", "> ").replace(" to ", "–");
  const cell = (floor: FloorChange, band: string): HTMLElement => {
    const found = floor.bands.find((each) => each.band === band);
    return h("td", {}, found ? tied(found.change) : "–");
  };
  const most = most_changed(floors);
  const chart = most ? charts.find((each) => each.id === `floor_${most.floor}_${number(100 * most.damping, 4).replace(/\.?0+$/, "")}`) : undefined;
  return h("div", { class: "floors" },
    h("h3", {}, "Floor spectra compared with the bonded model: change of the peak in each frequency band (Hz)"),
    h("div", { class: "floors-columns" },
      h("div", { class: "floors-box", tabindex: 0, role: "region", "aria-label": "Change of the floor spectra" },
        h("table", { class: "beside" },
          h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Floor, damping"), ...bands.map((band) => h("th", { scope: "col", title: band }, short(band))))),
          h("tbody", {}, ...floors.map((floor) =>
            h("tr", { class: floor === most && chart ? "is-drawn" : null },
              h("th", { scope: "row" }, `${floor.floor}, ${number(100 * floor.damping, 2)}\u00a0%`),
              ...(floor.note ? [h("td", { colspan: Math.max(1, bands.length) }, floor.note)] : bands.map((band) => cell(floor, band)))))))),
      chart ? spectrum_chart(chart) : null));
}

function base_block(base: BaseVerdict, many: boolean): HTMLElement {
  const [chart, bars] = [share_chart(base), tension_bars(base)];
  return h("div", { class: "base-verdict" },
    many ? h("h3", { class: "base-name" }, base.role === "wall" ? `${base.name} (wall)` : base.name) : null,
    h("div", { class: "base-columns" },
      chart || bars ? h("div", {}, chart, bars) : null, // walls and the whole structure have none
      beside_table(base)));
}

/** How far the numbers depend on the time step: a warning where they do, or where nobody looked. */
function step_check({ stepCheck }: Verdict): HTMLElement | null {
  return stepCheck ? h("p", { class: `step-check is-${stepCheck.result.replace(" ", "-")}` }, tied(stepCheck.sentence)) : null;
}

export function verdict_card(verdict: Verdict, charts: Chart[]): HTMLElement {
  const facts = verdict.facts.map((fact) =>
    h("div", { class: "fact" }, h("dt", {}, fact.label), h("dd", {}, h("b", {}, tied(fact.value)), fact.stepChange ? h("small", { class: "step-change" }, tied(`twice the step: ${fact.stepChange}`)) : null, fact.detail ? h("small", {}, tied(fact.detail)) : null)),
  );
  const many = verdict.interfaces.length > 1;
  const blocks: Child[] = verdict.interfaces.map((base) => base_block(base, many));
  return h(
    "section",
    { class: `verdict verdict-${verdict.level}`, id: "verdict", "aria-label": "Verdict" },
    h("div", { class: "verdict-head" },
      level_sign(verdict.level),
      h("div", {}, h("p", { class: "verdict-level" }, verdict.study && verdict.level === "failed" ? "No fit" : (LEVEL_WORD[verdict.level] ?? verdict.level)), h("h2", {}, tied(verdict.headline)), verdict.consequence ? h("p", { class: "so-what" }, tied(verdict.consequence)) : null, step_check(verdict), verdict.warning ? h("p", { class: "step-check is-not-converged" }, verdict.warning) : null)),
    facts.length > 0 ? h("dl", { class: "facts" }, ...facts) : null,
    verdict.study ? study_block(verdict.study) : null,
    ...blocks,
    floor_block(verdict.floors ?? [], charts),
    verdict.interfaces.length > 0 ? criteria_list(verdict.criteria) : null,
    verdict.paragraphs.length > 0 ? h("div", { class: "prose" }, ...verdict.paragraphs.map((text) => h("p", {}, tied(text)))) : null,
  );
}

/** Residual values of all interfaces in one table. Null when the run has none. */
export function rest_table(verdict: Verdict): HTMLElement | null {
  const bases = verdict.interfaces.filter((base) => base.rest.length > 0);
  if (bases.length === 0) return null;
  const checked = bases.some((base) => base.rest.some((row) => row.stepText !== undefined));
  const rows = bases.flatMap((base) =>
    base.rest.map((row) =>
      h("tr", {},
        h("th", { scope: "row" }, bases.length > 1 ? `${row.label} (${base.name})` : row.label),
        h("td", {}, tied(row.text)),
        checked ? h("td", { class: "step-change" }, tied(row.stepText ?? "–")) : null,
        h("td", {}, row.swingText === undefined ? "–" : `± ${tied(row.swingText)}`))));
  return h("figure", { class: "card rest-card" },
    h("table", { class: "beside" },
      h("thead", {}, h("tr", {}, ...["Residual value", "Mean of the last tenth of the run", ...(checked ? ["Twice the step"] : []), "Remaining variation"].map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...rows)),
    h("figcaption", {}, "Rotation (in the plane positive counter-clockwise), settlement (positive downwards) and slip are relative to the state before the shaking."));
}
