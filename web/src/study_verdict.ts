// The first page of a study: what an engineer asks first, in one sentence; what it rests on; and how far it can be trusted.
import { format_quantity, percent, significant } from "./quantity";
import { intensity_text, interval_text, rounded, run_count, searches, type Limit, type Study } from "./study";
import type { Choice, Fact, Verdict } from "./types";

const quoted = (name: string): string => `\u201c${name}\u201d`;
const plural = (count: number, word: string): string => `${count} ${word}${count === 1 ? "" : "s"}`;

/** "max_opening" and 0.03 as "largest gap at most 30 mm". */
export function limit_text(limit: Limit): string {
  if (limit.quantity === "") return limit.label;
  const of = limit.of ? ` of ${limit.of}` : "";
  return `${limit.label}${of} ${limit.at_least ? "at least" : "at most"} ${format_quantity(limit.limit, limit.unit)}`;
}

export const counted = (limit: Limit): number => limit.survived + limit.exceeded;

/** By how much the median moves when the runs of unknown outcome are counted as survived or as exceeded. */
export function unknown_change(limit: Limit): number | null {
  const [middle, survived, exceeded] = [limit.fit.theta, limit.unknown_survived.theta, limit.unknown_exceeded.theta];
  if (!limit.fit.fitted || middle === undefined || survived === undefined || exceeded === undefined) return null;
  return Math.max(Math.abs(survived / middle - 1), Math.abs(exceeded / middle - 1));
}

/** The limit of the headline: the first one of the plan that has a curve. */
export function main_limit(study: Study): Limit | undefined {
  return study.limits.find(({ fit }) => fit.fitted) ?? study.limits[0];
}

function headline(study: Study, limit: Limit): string {
  const { fit, unknown_survived: survived, unknown_exceeded: exceeded } = limit;
  if (fit.fitted && fit.theta !== undefined && fit.beta !== undefined)
    return `Median capacity for ${quoted(limit.name)}: ${intensity_text(study, fit.theta)} (${significant(100 * limit.confidence, 3)} % interval ${interval_text(study, fit.theta_interval)}), \u03b2 ${rounded(fit.beta)}`;
  if (survived.theta !== undefined && exceeded.theta !== undefined)
    return `Median capacity for ${quoted(limit.name)}: between ${rounded(Math.min(survived.theta, exceeded.theta))} and ${intensity_text(study, Math.max(survived.theta, exceeded.theta))}, depending on ${plural(limit.unknown, "run")} without outcome`;
  return `No fragility curve for ${quoted(limit.name)}: ${fit.reason}`;
}

/** Capacities that stand for a wide interval, whose upper end is what is fitted. */
function open_text({ capacities }: Limit): string {
  const open = capacities.filter(({ found }) => !found).length;
  return open === 0 ? "" : ` ${open} of ${capacities.length} capacities are not within the tolerance of the search: the median may be off.`;
}

/** How many runs count, what those without an outcome change, and whether the searches have come to their end. */
export function counts_text(limit: Limit): string {
  const all = counted(limit) + limit.unknown;
  if (limit.unknown === 0) return `All ${plural(all, "run")} count.${open_text(limit)}`;
  const change = unknown_change(limit);
  const those = limit.unknown === 1 ? "one without outcome changes" : `${limit.unknown} without outcome change`;
  const effect = change === null ? `${limit.unknown} have no outcome` : change < 5e-4 ? `${those} nothing` : `${those} the median by at most ${percent(change)}`;
  return `${counted(limit)} of ${plural(all, "run")} count; ${effect}.${open_text(limit)}`;
}

const probability_text = (probability: number): string => `${significant(100 * probability, 3)} %`;

function facts_of(study: Study, limit: Limit): Fact[] {
  const { fit, dispersion, capacity } = limit;
  const factors = study.factors.length > 0;
  const facts: Fact[] = [];
  if (fit.fitted && fit.theta !== undefined && fit.beta !== undefined) {
    facts.push({ label: "Median capacity", value: intensity_text(study, fit.theta), detail: `${significant(100 * limit.confidence, 3)} % interval ${interval_text(study, fit.theta_interval)}` });
    const apart = dispersion.known ? `between motions ${rounded(dispersion.beta_r ?? 0)}, between samples ${rounded(dispersion.beta_u ?? 0)}` : "of the logarithm of the capacity";
    facts.push({ label: "Dispersion \u03b2", value: rounded(fit.beta), detail: apart });
    facts.push(
      capacity.known && capacity.hclpf !== undefined
        ? { label: "HCLPF", value: intensity_text(study, capacity.hclpf), detail: `95 % confidence of less than 5 % probability${factors ? ", with the factors of safety" : ""}` }
        : { label: "1 % probability", value: intensity_text(study, fit.theta * Math.exp(-2.3263 * fit.beta)), detail: "of exceedance, by the fitted curve" });
  }
  const { performance, risk } = limit;
  const { at_design, at_one_and_a_half } = (factors ? performance?.composite : performance) ?? { at_design: null, at_one_and_a_half: null };
  if (at_design !== null && at_one_and_a_half !== null)
    facts.push({
      label: `At the design motion, ${intensity_text(study, study.design?.intensity)}`, value: probability_text(at_design),
      detail: `${probability_text(at_one_and_a_half)} at 1.5 times it${factors ? ", with the factors of safety" : ""}; aims of ASCE/SEI 43: 1 % and 10 %, ${at_design <= 0.01 && at_one_and_a_half <= 0.1 ? "met" : "not met"}`,
    });
  if (risk && risk.rate !== null) {
    const beyond = (risk.share_below ?? 0) + (risk.share_above ?? 0);
    const caution = beyond > 0.1 ? `; ${percent(beyond)} of it from beyond the points of that curve` : "";
    const composite = typeof risk.composite === "number" ? risk.composite : undefined;
    const beside = composite === undefined ? "" : factors ? `; ${risk.rate.toExponential(2)} by the fitted curve alone` : `; ${composite.toExponential(2)} with the composite \u03b2 of motions and samples`;
    facts.push({
      label: "Annual rate", value: (factors && composite !== undefined ? composite : risk.rate).toExponential(2),
      detail: `exceedances a year, by the hazard curve of the plan${!factors ? "" : composite !== undefined ? ", with the factors of safety" : ", without the factors of safety"}${caution}${beside}`,
    });
  }
  const without = study.failures.length;
  facts.push({
    label: "Runs", value: String(run_count(study)),
    detail: `${plural(study.motions.length, "motion")}${study.samples > 1 ? `, ${plural(study.samples, "sample")}` : ""}; ${without === 0 ? "none failed" : `${without} without outcome`}`,
  });
  return facts;
}

export function study_verdict(study: Study): Verdict {
  const first = main_limit(study);
  const missing = study.curves.filter(({ complete }) => !complete).length;
  const warning = missing > 0 ? `The study is not complete: ${missing} of ${plural(study.curves.length, "curve")} lack runs. The numbers will change.` : undefined;
  return {
    level: first && (first.fit.fitted || first.unknown_survived.fitted) ? "fragility" : "failed",
    headline: first ? headline(study, first) : "The study has no limit state",
    ...(first ? { consequence: `${limit_text(first)}, ${study.intensity.label} as the intensity. ${counts_text(first)}`.replace(/^./, (c) => c.toUpperCase()) } : {}),
    facts: first ? facts_of(study, first) : [],
    paragraphs: [], run: "", interfaces: [], criteria: [], floors: [],
    study,
    ...(warning === undefined ? {} : { warning }),
  };
}

const METHOD: Record<Study["method"]["type"], string> = {
  ida: "incremental dynamic analysis: the capacity of every curve is searched",
  truncated_ida: "truncated incremental dynamic analysis: curves that survive the largest intensity are censored",
  stripes: "stripes: every curve at the same intensities",
  cloud: "cloud: the motions as they are, regression of the demand",
};

function distribution_text({ distribution, parameters, unit, meaning }: Study["variables"][number]): string {
  const [first = 0, second = 0] = parameters;
  const value = (v: number): string => (meaning === "factor" ? `${significant(v, 3)}` : format_quantity(v, unit));
  const what = meaning === "factor" ? "factor, " : "";
  if (distribution === "uniform") return `${what}uniform from ${value(first)} to ${value(second)}`;
  if (distribution === "normal") return `${what}normal, mean ${value(first)}, standard deviation ${value(second)}`;
  return `${what}lognormal, median ${value(first)}, \u03b2 ${significant(second, 3)}`;
}

/** What the plan decides. */
export function study_choices(study: Study): Choice[] {
  const { method } = study;
  const user = (what: string, value: string, note?: string): Choice => ({ what, value, origin: "user", ...(note ? { note } : {}) });
  const levels = method.levels.map((level) => significant(level, 4)).join(", ");
  const range = searches(study) ? `at most ${intensity_text(study, method.largest)}, to ${percent(method.tolerance)}` : method.type === "cloud" ? `factors ${levels}` : `${levels} ${intensity_text(study, 1).split("\u00a0")[1] ?? ""}`;
  return [
    user("Method", method.type.replace("_", " "), METHOD[method.type]),
    user("Intensity", study.intensity.label, study.intensity.measure === "factor" ? "factor on the motion" : "of the record that moves the ground"),
    user("Intensities", range.trim()),
    user("Motions", String(study.motions.length)),
    ...(study.variables.length > 0
      ? [user("Samples", String(study.samples), `Latin hypercube of seed ${study.provenance.seed}; ${study.pairing === "crossed" ? "every sample with every motion" : "one sample for each motion"}`)]
      : []),
    ...study.variables.map((variable) => user(variable.name, distribution_text(variable), variable.paths.join(", "))),
    ...study.limits.map((limit) => user(`Limit ${quoted(limit.name)}`, limit_text(limit), limit.source)),
    ...(study.design ? [user("Design motion", intensity_text(study, study.design.intensity), study.design.source)] : []),
    ...(study.hazard ? [user("Hazard curve", study.hazard.intensities.map((each, i) => `${significant(study.hazard?.rates[i] ?? 0, 3)} a year at ${intensity_text(study, each)}`).join(", "), study.hazard.source)] : []),
    ...study.factors.map((factor) => user(`Factor ${quoted(factor.name)}`, `median ${significant(factor.median, 3)}, \u03b2_R ${significant(factor.beta_r, 3)}, \u03b2_U ${significant(factor.beta_u, 3)}`, factor.source)),
    { what: "Confidence of intervals", value: `${significant(100 * (study.limits[0]?.confidence ?? 0.9), 3)} %`, origin: "added by uplift", note: "two-sided, by the profile of the likelihood" },
  ];
}
