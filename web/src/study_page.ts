// What the page draws of a study beside its figures: the fragility curves of the first page, the outcomes, and the tornado of the variables.
import { h, px, s } from "./dom";
import { format_quantity, percent } from "./quantity";
import { empirical, intensity_text, intensity_unit, rounded, run_count, searches, type Limit, type Study } from "./study";
import { influence_text } from "./study_tables";
import { counts_text, limit_text, main_limit } from "./study_verdict";
import { linear_ticks, tick_labels } from "./ticks";

const WIDTH = 460;
const HEIGHT = 230;
const LEFT = 40;
const RIGHT = 12;
const TOP = 10;
const BOTTOM = 38;

// So many limit states are drawn on the first page.
const DRAWN = 4;

/** What the curve was fitted to: shares of stripes, or the capacities in their order. */
function shares(limit: Limit): [number, number][] {
  const { intensity, share } = empirical(limit);
  return intensity.map((im, i) => [im, share[i] as number]);
}

function curve_paths(limit: Limit, k: number, x: (v: number) => number, y: (v: number) => number): SVGElement[] {
  const { curve } = limit.fit;
  if (!curve) return [];
  const path = (values: (number | null)[], otherwise: number): string[] => curve.intensity.map((im, i) => `${px(x(im))} ${px(y(values[i] ?? otherwise))}`);
  const colour = `--c:var(--c${k})`;
  return [
    s("path", { class: "fragility-band", style: colour, d: `M${path(curve.upper, 1).join("L")}L${path(curve.lower, 0).reverse().join("L")}Z` }),
    s("path", { class: "fragility-line", style: colour, d: `M${path(curve.probability, 0).join("L")}` }),
    ...shares(limit).map(([im, share]) => s("circle", { class: "fragility-point", style: colour, cx: px(x(im)), cy: px(y(share)), r: 2.4 })),
  ];
}

/** The fitted curves with their intervals: where the probability rises, and how wide the interval is. */
function fragility_drawing(study: Study): HTMLElement | null {
  const limits = study.limits.map((limit, k) => ({ limit, k })).filter(({ limit }) => limit.fit.fitted && limit.fit.curve).slice(0, DRAWN);
  if (limits.length === 0) return null;
  const most = Math.max(...limits.map(({ limit: { fit } }) => (fit.theta ?? 1) * Math.exp(2.2 * (fit.beta ?? 0))));
  const x = (v: number): number => LEFT + (Math.min(v, 1.02 * most) / most) * (WIDTH - LEFT - RIGHT);
  const y = (v: number): number => TOP + (1 - v) * (HEIGHT - TOP - BOTTOM);
  const ticks = linear_ticks(0, most, 6);
  const labels = tick_labels(ticks, false);
  const text = (tx: number, ty: number, anchor: string, words: string): SVGElement => s("text", { x: px(tx), y: px(ty), "text-anchor": anchor, class: "tick" }, words);
  const unit = intensity_unit(study);
  const clip = s("clipPath", { id: "fragility-clip" }, s("rect", { x: LEFT, y: 0, width: WIDTH - LEFT - RIGHT, height: HEIGHT }));
  const drawing = s("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "Probability that a limit is exceeded, against the intensity" },
    clip,
    ...[0, 0.25, 0.5, 0.75, 1].map((p) => s("path", { class: "rule", d: `M${LEFT} ${px(y(p))}H${WIDTH - RIGHT}` })),
    ...[0, 0.5, 1].map((p) => text(LEFT - 6, y(p) + 4, "end", `${100 * p} %`)),
    ...ticks.map((t, i) => text(x(t), HEIGHT - BOTTOM + 16, "middle", labels[i] ?? "")),
    text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 4, "middle", `${study.intensity.label}${unit ? ` (${unit})` : ""}`),
    s("g", { "clip-path": "url(#fragility-clip)" }, ...limits.flatMap(({ limit, k }) => curve_paths(limit, k, x, y))));
  const keys = limits.map(({ limit, k }) =>
    h("span", {}, s("svg", { viewBox: "0 0 22 8", width: 22, height: 8, "aria-hidden": "true" }, s("path", { class: "fragility-line", style: `--c:var(--c${k})`, d: "M0 4H22" })), `${limit.name}: ${intensity_text(study, limit.fit.theta)}`));
  return h("figure", { class: "share-chart" }, h("figcaption", {}, h("b", {}, "Probability of exceedance"), " \u00b7 fitted curves, their intervals, and the data"), drawing, h("div", { class: "spectrum-keys" }, ...keys));
}

const OUTCOME_NOTE: Record<string, string> = {
  completed: "survived or exceeded",
  overturned: "exceeds every limit",
  separated: "exceeds every limit",
};

/** How the runs ended, the frequent outcomes first. */
function outcome_bars(study: Study): HTMLElement {
  const all = Math.max(1, run_count(study));
  const bars = Object.entries(study.outcomes).filter(([name, count]) => count > 0 || name === "completed" || name === "failed").map(([name, count]) =>
    h("div", { class: `bar bar-outcome is-${name}` },
      h("span", { class: "bar-label" }, name, h("small", {}, ` ${OUTCOME_NOTE[name] ?? "unknown"}`)),
      h("span", { class: "bar-track" }, h("i", { style: `width:${((100 * count) / all).toFixed(1)}%` })),
      h("b", {}, count === 0 || count === all ? String(count) : `${count} (${percent(count / all)})`)));
  return h("div", { class: "outcomes" }, h("h3", {}, `Outcomes of ${all} runs`), ...bars);
}

/** One line for each limit that the headline is not about. */
function other_limits(study: Study): HTMLElement | null {
  const lines = study.limits.filter((limit) => limit !== main_limit(study)).map((limit) => {
    const { fit } = limit;
    const median = fit.fitted && fit.theta !== undefined && fit.beta !== undefined ? `median ${intensity_text(study, fit.theta)}, \u03b2 ${rounded(fit.beta)}` : `no fit: ${fit.reason}`;
    return h("li", {}, h("b", {}, limit.name), ` (${limit_text(limit)}): ${median}. ${counts_text(limit)}`);
  });
  if (lines.length === 0) return null;
  return h("div", { class: "other-limits" }, h("h3", {}, "Other limit states"), h("ul", {}, ...lines));
}

export function study_block(study: Study): HTMLElement {
  return h("div", { class: "study-block base-columns" }, fragility_drawing(study), h("div", {}, outcome_bars(study), other_limits(study)));
}

// ---- tornado ----

const ROW = 42;
const BAR = 15;
const NAMES = 150;
const VALUES = 70;
const BARS = 260;

/** Two bars for each variable, its smallest values above its largest, from the median or the mean of all. */
function tornado_card(study: Study, limit: Limit): HTMLElement | null {
  const all = limit.tornado.filter(({ low, high }) => low > 0 && high > 0);
  const found = searches(study);
  const { samples, responses, reason } = limit.tornado_basis;
  if (all.length === 0) return reason === "" ? null : h("figure", { class: "card tornado" }, h("header", {}, h("h3", {}, limit.name)), h("figcaption", {}, `Not given: ${reason}.`));
  const text = (value: number): string => (found ? intensity_text(study, value) : format_quantity(value, limit.unit));
  const centre = Math.exp(all.reduce((sum, { low, high }) => sum + Math.log(low * high) / 2, 0) / all.length);
  const reach = Math.max(...all.flatMap(({ low, high }) => [low, high]).map((v) => Math.abs(v - centre)), 0.02 * centre);
  const middle = NAMES + VALUES + BARS / 2;
  const x = (v: number): number => middle + ((v - centre) / reach) * (BARS / 2);
  const [width, bottom] = [NAMES + 2 * VALUES + BARS, all.length * ROW + 4];
  const bar = (kind: string, value: number, top: number): SVGElement[] => {
    const right = value >= centre;
    return [
      s("rect", { class: `tornado-${kind}`, x: px(Math.min(x(value), middle)), y: top, width: px(Math.max(1, Math.abs(x(value) - middle))), height: BAR }),
      s("text", { x: px(x(value) + (right ? 6 : -6)), y: top + 12, "text-anchor": right ? "start" : "end" }, text(value)),
    ];
  };
  const rows = all.flatMap(({ variable, low, high }, i) => {
    const top = 6 + i * ROW;
    return [s("text", { x: NAMES - 8, y: top + BAR + 4, "text-anchor": "end", class: "tornado-name" }, variable), ...bar("low", low, top), ...bar("high", high, top + BAR + 1)];
  });
  const what = found ? "capacity" : limit.label;
  const changes = all.map(({ variable, low, high }) => `${variable} ${influence_text(low / centre)} and ${influence_text(high / centre)}`).join("; ");
  return h("figure", { class: "card tornado" },
    h("header", {}, h("h3", {}, `${limit.name}: ${what}`)),
    s("svg", { viewBox: `0 0 ${width} ${bottom + 22}`, role: "img", "aria-label": `Influence of the variables on the ${what}` },
      ...rows, s("path", { class: "tornado-axis", d: `M${middle} 2V${bottom}` }), s("text", { x: middle, y: bottom + 16, "text-anchor": "middle" }, text(centre))),
    h("div", { class: "spectrum-keys" },
      h("span", {}, h("i", { class: "dot tornado-low" }), "smallest third of the values"), h("span", {}, h("i", { class: "dot tornado-high" }), "largest third")),
    h("figcaption", {}, `Geometric means of the ${what} over the samples with the smallest and with the largest third of the values of each variable${study.pairing === "crossed" ? `, compared under the same ${found ? "motions" : "motions and intensities"} by the effects of both (least squares)` : ""}, and changes from the middle of these means: ${changes}. They rest on ${responses} ${found ? "capacities" : "completed runs"} of ${samples === study.samples ? "all" : `${samples} of`} ${study.samples} samples.`));
}

/** One drawing for each limit; none without variables. */
export function tornado_cards(study: Study): HTMLElement[] {
  return study.limits.flatMap((limit) => tornado_card(study, limit) ?? []);
}

