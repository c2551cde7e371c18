// Tables of a study: limit states, counts of stripes, motions with their capacities, variables, runs without an outcome.
import { percent, significant } from "./quantity";
import { intensity_text, intensity_unit, interval_text, percentile, rounded, searches, type Fit, type Interval, type Limit, type Study } from "./study";
import type { Column, ColumnKind, Row, Table } from "./types";

// More rows of failures than this are in runs.csv.
const MOST_FAILURES = 100;

function column(key: string, label: string, kind: ColumnKind, unit = "", digits = 3): Column {
  return { key, label, kind, unit, digits };
}

const fit_text = (study: Study, fit: Fit): string => (fit.theta === undefined || fit.beta === undefined ? "no fit" : `${intensity_text(study, fit.theta)}, \u03b2 ${rounded(fit.beta)}`);

function limits_table(study: Study): Table[] {
  if (study.limits.length === 0) return [];
  const unknown = study.limits.some((limit) => limit.unknown > 0);
  const apart = study.limits.some(({ dispersion }) => dispersion.known);
  const bootstrap = study.limits.some((limit) => limit.bootstrap !== undefined);
  const site = study.limits.some(({ performance }) => performance !== undefined);
  const hazard = study.limits.some(({ risk }) => risk !== undefined);
  const shared = study.samples > 1 && study.pairing === "crossed";
  return [{
    id: "limits",
    title: "Limit states",
    caption:
      `Median and dispersion of the fitted lognormal curve, with the interval of ${significant(100 * (study.limits[0]?.confidence ?? 0.9), 3)} % confidence. ` +
      (shared && apart ? "The interval of the median follows from the scatter between motions and between samples, which the curves share. " : "") +
      (shared && !apart && searches(study) ? "The interval takes all curves as independent; where the motions scatter more than the samples (\u03b2_R), it is too narrow. " : "") +
      (searches(study) ? "" : "The interval knows that runs share motions and samples. ") +
      (bootstrap ? "Bootstrap: percentiles of fits to data drawn from the curve; runs count as independent. " : "") +
      (site ? `Design: probability at the design motion of ${intensity_text(study, study.design?.intensity)} and at 1.5 times it; ASCE/SEI 43 aims at 1 % and 10 %. ` : "") +
      (hazard ? "Annual rate: with which the limit is exceeded, by the fitted curve and the hazard curve. " : "") +
      (unknown ? "Runs of unknown outcome are left out of the fit; the last two columns count them as survived and as exceeded." : ""),
    columns: [
      column("name", "Limit", "text"), column("theta", "Median", "number", intensity_unit(study)), column("interval", "Interval", "text"), column("beta", "\u03b2", "number"), column("beta_interval", "Interval of \u03b2", "text"),
      ...(bootstrap ? [column("bootstrap", "Bootstrap", "text"), column("beta_bootstrap", "Bootstrap of \u03b2", "text")] : []),
      ...(site ? [column("at_design", "Design", "percent"), column("at_one_and_a_half", "1.5 \u00d7 design", "percent")] : []),
      ...(hazard ? [column("rate", "Annual rate", "number")] : []),
      column("survived", "Survived", "number", "", 6), column("exceeded", "Exceeded", "number", "", 6), column("unknown", "Unknown", "number", "", 6),
      ...(unknown ? [column("as_survived", "Unknown as survived", "text"), column("as_exceeded", "Unknown as exceeded", "text")] : []),
    ],
    rows: study.limits.map((limit): Row => {
      const { fit, performance } = limit;
      const beta_text = ({ lower, upper }: Interval): string => `${lower === null ? "0" : rounded(lower)} to ${upper === null ? "unbounded" : rounded(upper)}`;
      const drawn = limit.bootstrap?.known ? limit.bootstrap : undefined;
      return {
        name: limit.name, theta: fit.theta, beta: fit.beta, interval: fit.fitted ? interval_text(study, fit.theta_interval) : `no fit: ${fit.reason}`,
        beta_interval: fit.beta_interval ? beta_text(fit.beta_interval) : "",
        bootstrap: drawn ? interval_text(study, drawn.theta_interval) : (limit.bootstrap?.reason ?? ""), beta_bootstrap: drawn?.beta_interval ? beta_text(drawn.beta_interval) : "",
        at_design: performance?.at_design, at_one_and_a_half: performance?.at_one_and_a_half, rate: limit.risk?.rate,
        survived: limit.survived, exceeded: limit.exceeded, unknown: limit.unknown,
        as_survived: fit_text(study, limit.unknown_survived), as_exceeded: fit_text(study, limit.unknown_exceeded),
      };
    }),
  }];
}

/** Capacities as nuclear practice states them, with the factors of safety of the plan. */
function capacity_table(study: Study): Table[] {
  const known = study.limits.some(({ capacity }) => capacity.known);
  if (!known && study.factors.length === 0) return [];
  const factors = study.factors.length > 0 ? " and of the factors of safety" : "";
  const site = study.limits.some(({ performance }) => performance !== undefined);
  const hazard = study.limits.some(({ risk }) => risk !== undefined);
  return [{
    id: "capacity",
    title: "Capacities",
    caption:
      `A_m: median${factors ? ", times the medians of the factors of safety" : ""}. \u03b2_R: randomness, from motion to motion; \u03b2_U: uncertainty of knowledge; both of the runs${factors}. ` +
      "HCLPF: A_m \u00b7 exp(\u22121.65 (\u03b2_R + \u03b2_U)), 95 % confidence of less than 5 % probability. By the composite curve, with \u03b2_C = \u221a(\u03b2_R\u00b2 + \u03b2_U\u00b2): " +
      ["the intensity of 1 % probability", ...(site ? ["the probabilities at the design motion and at 1.5 times it"] : []), ...(hazard ? ["the annual rate"] : [])].join(", ") + ".",
    columns: [
      column("name", "Limit", "text"), column("median", "A_m", "number", intensity_unit(study)), column("beta_r", "\u03b2_R", "number"), column("beta_u", "\u03b2_U", "number"), column("beta_c", "\u03b2_C", "number"),
      column("hclpf", "HCLPF", "number", intensity_unit(study)), column("hclpf_composite", "1 % probability", "number", intensity_unit(study)),
      ...(site ? [column("at_design", "Design", "percent"), column("at_one_and_a_half", "1.5 \u00d7 design", "percent")] : []),
      ...(hazard ? [column("rate", "Annual rate", "number")] : []),
      ...(study.limits.every(({ capacity }) => capacity.known) ? [] : [column("reason", "Not known", "text")]),
    ],
    rows: study.limits.map(({ name, capacity, performance, risk }): Row => ({ ...capacity, name, ...performance?.composite, rate: risk?.composite })),
  }];
}

function stripes_table(study: Study): Table[] {
  const limits = study.limits.filter(({ stripes }) => stripes.length > 0);
  if (limits.length === 0) return [];
  return [{
    id: "stripes",
    title: "Counts at every intensity",
    caption: "Share: exceeded among the runs with a known outcome.",
    columns: [
      column("intensity", study.intensity.label, "number", intensity_unit(study)), column("runs", "Runs", "number", "", 6), column("exceeded", "Exceeded", "number", "", 6),
      column("unknown", "Unknown", "number", "", 6), column("share", "Share", "percent"),
    ],
    rows: limits.flatMap(({ name, stripes }) =>
      stripes.map(({ intensity, runs, exceeded, unknown }): Row => ({ limit: name, intensity, runs, exceeded, unknown, share: runs > unknown ? exceeded / (runs - unknown) : null }))),
    rowGroup: "limit",
  }];
}

/** The capacity of a motion: "0.52", with several samples "0.52 (0.41 to 0.60)"; ends of the range are said. */
function capacity_text(limit: Limit, motion: string): string {
  const mine = limit.capacities.filter((each) => each.motion === motion && each.capacity.intensity !== null);
  if (mine.length === 0) return "";
  const text = ({ capacity }: Limit["capacities"][number]): string =>
    `${capacity.known === "at_least" ? "> " : capacity.known === "at_most" ? "< " : ""}${rounded(capacity.intensity as number)}`;
  const sorted = [...mine].sort((a, b) => (a.capacity.intensity as number) - (b.capacity.intensity as number));
  const [least, most] = [sorted[0] as (typeof sorted)[number], sorted[sorted.length - 1] as (typeof sorted)[number]];
  if (text(least) === text(most)) return text(least);
  return `${rounded(percentile(sorted.map(({ capacity }) => capacity.intensity as number), 0.5))} (${text(least)} to ${text(most)})`;
}

function motions_table(study: Study): Table[] {
  const found = searches(study);
  const unit = intensity_unit(study);
  const risen = found && study.limits.some(({ capacities }) => capacities.some(({ resurrections }) => resurrections.length > 0));
  const measured = study.motions.some(({ record }) => record !== "");
  const several = study.samples > 1 && study.pairing === "crossed";
  return [{
    id: "motions",
    title: "Motions",
    caption:
      "Intensities of the motions as they are, at the factor 1." +
      (found ? ` Capacity: the smallest intensity that exceeds the limit${several ? ", median (smallest to largest) over the samples" : ""}.` : " Exceeded: runs that exceed the limit, among those with a known outcome.") +
      (risen ? " Resurrections: runs that survive above the capacity." : ""),
    columns: [
      column("name", "Motion", "text"), ...(study.intensity.measure === "factor" ? [] : [column("intensity", study.intensity.label, "number", unit)]),
      ...(measured ? [...(study.intensity.measure === "pga" ? [] : [column("pga", "PGA", "number", "m/s2")]), column("pgv", "PGV", "number", "m/s"), column("arias", "Arias", "number", "m/s"), column("d", "D5\u201395", "number", "s")] : []),
      ...study.limits.map(({ name }, k) => (found ? column(`limit_${k}`, `${name}${unit ? ` (${unit})` : ""}`, "text") : column(`limit_${k}`, name, "text"))),
      ...(risen ? [column("resurrections", "Resurrections", "number", "", 6)] : []),
    ],
    rows: study.motions.map((motion): Row => {
      const mine = study.curves.filter((curve) => curve.motion === motion.name);
      const share = (k: number): string => {
        const states = mine.flatMap(({ runs }) => runs.map((run) => run.states[k])).filter((state) => state !== "unknown");
        return states.length === 0 ? "" : `${states.filter((state) => state === "exceeded").length} of ${states.length}`;
      };
      const row: Row = { name: motion.label || motion.name, intensity: motion.intensity };
      if (motion.record !== "") Object.assign(row, { pga: motion.pga, pgv: motion.pgv, arias: motion.arias, d: motion.significant_duration });
      study.limits.forEach((limit, k) => (row[`limit_${k}`] = found ? capacity_text(limit, motion.name) : share(k)));
      row["resurrections"] = study.limits.reduce((sum, { capacities }) => sum + capacities.filter((each) => each.motion === motion.name).reduce((n, each) => n + each.resurrections.length, 0), 0);
      return row;
    }),
  }];
}

function failures_table(study: Study): Table[] {
  const { failures } = study;
  if (failures.length === 0) return [];
  const shown = failures.slice(0, MOST_FAILURES);
  return [{
    id: "failures",
    title: "Runs without an outcome",
    caption:
      "Neither survivals nor collapses. The commands are for the folder of the study: the first repeats the run alone, the second the step that failed." +
      (shown.length < failures.length ? ` The first ${shown.length} of ${failures.length}; runs.csv (uplift study export) has all.` : ""),
    columns: [
      column("motion", "Motion", "text"), ...(study.samples > 1 ? [column("sample", "Sample", "number", "", 6)] : []), column("intensity", study.intensity.label, "number", intensity_unit(study)),
      column("outcome", "Outcome", "status"), column("reason", "Reason", "text"), column("run", "Repeat", "text"), column("replay", "Replay", "text"),
    ],
    rows: shown.map((each): Row => ({
      motion: each.motion, sample: each.sample, intensity: each.intensity, outcome: each.outcome, reason: each.reason,
      run: each.case ? `uplift run ${each.case}` : "", replay: each.replay ? `uplift replay ${each.replay}` : "",
    })),
  }];
}

export function study_tables(study: Study): Table[] {
  return [...limits_table(study), ...capacity_table(study), ...stripes_table(study), ...failures_table(study), ...motions_table(study)];
}

/** A variable's influence in words: "-12 %" and "+9 %". */
export const influence_text = (ratio: number): string => (Math.abs(ratio - 1) < 5e-4 ? "0 %" : `${ratio > 1 ? "+" : "\u2212"}${percent(Math.abs(ratio - 1))}`);
