// Figures of a study: fragility with its interval and its data, incremental dynamic analysis, demands and regression, floor spectra.
import { percent, significant } from "./quantity";
import { empirical, intensity_text, intensity_unit, normal_cdf, percentile, searches, type Fit, type FullFit, type Limit, type Study, type StudyCurve, type StudyFloor } from "./study";
import type { Axis, Chart, Section, Series } from "./types";

const ORIGIN = "added by uplift";

// Demands are drawn up to this many limits: a run that overturns would flatten all others.
const DRAWN = 2.5;

const FRACTILES: [number, string][] = [[0.16, "16 %"], [0.5, "median"], [0.84, "84 %"]];

export const STUDY_SECTIONS: Section[] = [
  { id: "fragility", title: "Fragility", text: "Probability that a limit is exceeded, against the intensity of the motion: the fitted lognormal curve, its interval, and the data." },
  { id: "demands", title: "Demands", text: "Results of the single runs against the intensity of their motion." },
  { id: "floors", title: "Floor spectra", text: "Percentiles of the floor spectra over all runs of an intensity: pseudo-acceleration of equipment with a given frequency and damping." },
];

const id_of = (kind: string, k: number): string => `${kind}_${k + 1}`;

function intensity_axis(study: Study, log = false): Axis {
  return { label: study.intensity.label, unit: intensity_unit(study), ...(log ? { log } : {}) };
}

/** A closed outline: upper values from left to right, lower ones back. Ends that are unbounded lie at 0 and 1. */
function band_of({ intensity, lower, upper }: NonNullable<FullFit["curve"]>): { x: number[]; y: number[] } {
  const down = lower.map((value) => value ?? 0);
  return { x: [...intensity, ...[...intensity].reverse()], y: [...upper.map((value) => value ?? 1), ...down.reverse()] };
}

/** The same curve of another median and dispersion. */
function end_curve(label: string, fit: Fit): Series[] {
  const { theta, beta } = fit;
  if (!fit.fitted || theta === undefined || beta === undefined || beta <= 0) return [];
  const z = Array.from({ length: 41 }, (_, i) => -3 + (6 * i) / 40);
  return [{ label, x: z.map((each) => theta * Math.exp(beta * each)), y: z.map(normal_cdf), dash: true }];
}

function data_of(limit: Limit): Series[] {
  const { intensity, share } = empirical(limit);
  const label = limit.stripes.length > 0 ? "share of the runs" : intensity.length === 1 ? "1 capacity" : `${intensity.length} capacities`;
  return intensity.length > 0 ? [{ label, x: intensity, y: share, style: "points", group: "data" }] : [];
}

function fragility_chart(study: Study, limit: Limit, k: number): Chart[] {
  const { fit } = limit;
  const shown = `${significant(100 * limit.confidence, 3)} % interval`;
  const series: Series[] = [
    ...(fit.fitted && fit.curve ? [{ label: "fitted curve", x: fit.curve.intensity, y: fit.curve.probability, group: "fit" }, { label: shown, ...band_of(fit.curve), style: "band" as const, group: "fit" }] : []),
    ...data_of(limit),
    ...(limit.unknown > 0 ? [...end_curve("unknown as survived", limit.unknown_survived), ...end_curve("unknown as exceeded", limit.unknown_exceeded)] : []),
  ];
  if (series.length === 0) return [];
  const counts = limit.stripes.map((each) => `${each.exceeded}/${each.runs - each.unknown} at ${intensity_text(study, each.intensity)}`).join(", ");
  const data = limit.stripes.length > 0 ? `Exceeded: ${counts}.` : searches(study) ? "Points: capacities in ascending order, the i-th of n at (i \u2212 1/2)/n; curves beyond the range count in n." : "";
  return [{
    id: id_of("fragility", k), section: "fragility", title: limit.name, origin: ORIGIN,
    caption: `${fit.fitted ? "" : `No fit: ${fit.reason}. `}${limit.survived} runs survived, ${limit.exceeded} exceeded the limit, ${limit.unknown} are unknown. ${data}`.trim(),
    x: intensity_axis(study), y: { label: "Probability of exceedance" }, series,
  }];
}

/** All limits in one figure. */
function together_chart(study: Study): Chart[] {
  const fitted = study.limits.filter(({ fit }) => fit.fitted && fit.curve);
  if (fitted.length < 2) return [];
  return [{
    id: "fragility_all", section: "fragility", title: "All limit states", origin: ORIGIN, caption: "Fitted curves with their intervals.",
    x: intensity_axis(study), y: { label: "Probability of exceedance" },
    series: fitted.flatMap(({ name, fit: { curve } }) => (curve ? [{ label: name, x: curve.intensity, y: curve.probability, group: name }, { label: `${name}, interval`, ...band_of(curve), style: "band" as const, group: name }] : [])),
  }];
}

// ---- incremental dynamic analysis ----

type Point = [number, number];

/** Demand and intensity of the runs of a curve that say something, ascending in intensity. */
function points_of(curve: StudyCurve, k: number): Point[] {
  return curve.runs.flatMap((run): Point[] => {
    const demand = run.demands[k];
    return demand === null || demand === undefined || run.states[k] === "unknown" ? [] : [[Math.abs(demand), run.intensity]];
  });
}

/** The curve from the origin to where it leaves the drawing. */
function drawn_part(points: Point[], most: number): Point[] {
  const drawn: Point[] = [[0, 0]];
  for (const [demand, intensity] of points) {
    const [before, below] = drawn[drawn.length - 1] as Point;
    if (demand > most) {
      if (before < most) drawn.push([most, below + ((intensity - below) * (most - before)) / (demand - before)]);
      break;
    }
    drawn.push([demand, intensity]);
  }
  return drawn;
}

/** From the origin up to the first demand that so many curves never reach. */
function fractiles_of({ demands, p16, p50, p84 }: NonNullable<Limit["fractiles"]>): Series[] {
  return [p16, p50, p84].map((values, k) => {
    const end = values.indexOf(null);
    const count = end < 0 ? demands.length : end;
    return { label: FRACTILES[k]?.[1] ?? "", x: [0, ...demands.slice(0, count)], y: [0, ...values.slice(0, count)], style: "line" as const, ...(k === 1 ? {} : { dash: true }), group: "percentiles" };
  });
}

/** Lines of many curves as one, with gaps between them. */
function joined(curves: Point[][], label: string): Series {
  const all = curves.flatMap((points) => [...points, null]);
  return { label, x: all.map((p) => p?.[0] ?? null), y: all.map((p) => p?.[1] ?? null), style: "thin", group: "records" };
}

function ida_chart(study: Study, limit: Limit, k: number): Chart[] {
  const curves = study.curves.map((curve) => points_of(curve, k)).filter((points) => points.length > 0);
  if (limit.quantity === "" || limit.at_least || curves.length === 0 || !(limit.limit > 0)) return [];
  const drawn = curves.map((points) => drawn_part(points, DRAWN * limit.limit));
  const top = Math.max(...drawn.flatMap((points) => points.map(([, intensity]) => intensity)));
  return [{
    id: id_of("ida", k), section: "demands", title: `${limit.name}: curves of all motions`, origin: ORIGIN,
    caption: `Demand of every run against its intensity, drawn up to ${DRAWN} times the limit; the table runs.csv (uplift study export) has all. Fractiles: of the intensities at which the curves first reach a demand.`,
    x: { label: limit.label.replace(/^./, (c) => c.toUpperCase()), unit: limit.unit }, y: intensity_axis(study),
    series: [
      joined(drawn, study.curves.length === 1 ? "1 curve" : `${curves.length} curves`),
      ...(limit.fractiles ? fractiles_of(limit.fractiles) : []),
      { label: "limit", x: [limit.limit, limit.limit], y: [0, top], style: "line", dash: true, group: "limit" },
    ],
  }];
}

// ---- stripes and clouds ----

/** A demand of zero has no logarithm. */
const without_demand = (count: number): string => (count === 0 ? "" : ` ${count === 1 ? "One run whose demand is zero counts" : `${count} runs whose demand is zero count`} as at most the limit.`);

const not_drawn = (count: number): string => (count === 0 ? "" : ` ${count === 1 ? "One run whose demand is zero is" : `${count} runs whose demand is zero are`} not drawn; percentiles count ${count === 1 ? "it" : "them"}.`);

function points_chart(study: Study, limit: Limit, k: number): Chart[] {
  const every = study.curves.flatMap((curve) => points_of(curve, k)).filter(([, intensity]) => intensity > 0);
  const all = every.filter(([demand]) => demand > 0);
  if (limit.quantity === "" || all.length === 0) return [];
  const intensities = all.map(([, intensity]) => intensity);
  const [least, most] = [Math.min(...intensities), Math.max(...intensities)];
  const { regression } = limit;
  const grid = Array.from({ length: 42 }, (_, i) => least * Math.pow(most / least, i / 41));
  const line = (shift: number): number[] => grid.map((x) => Math.exp((regression?.a ?? 0) + (regression?.b ?? 0) * Math.log(x) + shift * (regression?.sigma ?? 0)));
  const levels = [...new Set(intensities)].sort((a, b) => a - b);
  const at = (level: number): number[] => every.filter(([, intensity]) => intensity === level).map(([demand]) => demand).sort((a, b) => a - b);
  return [{
    id: id_of("demand", k), section: "demands", title: limit.name, origin: ORIGIN,
    caption: regression
      ? `Regression ln demand = a + b ln intensity with a = ${significant(regression.a, 3)}, b = ${significant(regression.b, 3)}, standard deviation ${significant(regression.sigma, 3)}; dashed: one standard deviation.${without_demand(regression.without_demand)}`
      : `Every run with a result, and the percentiles of each intensity.${not_drawn(every.length - all.length)}`,
    x: intensity_axis(study, true), y: { label: limit.label.replace(/^./, (c) => c.toUpperCase()), unit: limit.unit, log: true },
    series: [
      { label: `${all.length} runs`, x: all.map(([, x]) => x), y: all.map(([y]) => y), style: "points", group: "runs" },
      ...(regression
        ? [{ label: "regression", x: grid, y: line(0), group: "fit" }, { label: "84 %", x: grid, y: line(1), dash: true, group: "fit" }, { label: "16 %", x: grid, y: line(-1), dash: true, group: "fit" }]
        : FRACTILES.map(([share, label]): Series => ({ label, x: levels, y: levels.map((level) => percentile(at(level), share) || null), ...(share === 0.5 ? {} : { dash: true }), style: "line", group: "percentiles" }))),
      ...(limit.limit > 0 ? [{ label: "limit", x: [least, most], y: [limit.limit, limit.limit], dash: true, style: "line" as const, group: "limit" }] : []),
    ],
  }];
}

// ---- floor spectra ----

/** What the percentiles of an intensity are made of: "8 at 0.20 g, of which 2 lost the structure, and 1 without an outcome left out". */
function floor_runs({ runs, lost, missing }: StudyFloor, at: string): string {
  if (runs === 0) return `none at ${at}, all ${missing} without an outcome`;
  return `${runs} at ${at}${lost > 0 ? `, of which ${lost} lost the structure` : ""}${missing > 0 ? `, and ${missing} without an outcome left out` : ""}`;
}

function floor_charts(study: Study): Chart[] {
  const kinds = new Map<string, StudyFloor[]>();
  for (const each of study.floor_spectra) {
    const key = `${each.floor}, ${percent(each.damping)} damping`;
    kinds.set(key, [...(kinds.get(key) ?? []), each]);
  }
  const named = ({ level }: StudyFloor): string => (study.method.type === "cloud" ? `factor ${significant(level, 3)}` : intensity_text(study, level));
  return [...kinds].map(([title, levels], k) => ({
    id: id_of("floor", k), section: "floors", title, origin: ORIGIN,
    caption: `Median and range from 16 % to 84 % over the runs of each intensity (${levels.map((each) => floor_runs(each, named(each))).join("; ")}).${levels.some(({ lost }) => lost > 0) ? " Spectra of runs that lost the structure are those up to there, lower bounds of what comes." : ""}`,
    x: { label: "Frequency", unit: "Hz", log: true }, y: { label: "Pseudo-acceleration", unit: "m/s2", log: true },
    series: levels.filter(({ runs }) => runs > 0).flatMap((each): Series[] => [
      { label: `${named(each)}, median`, x: each.frequencies, y: each.p50, style: "line", group: named(each) },
      { label: "16 to 84 %", x: [...each.frequencies, ...[...each.frequencies].reverse()], y: [...each.p84, ...[...each.p16].reverse()], style: "band", group: named(each) },
    ]),
  }));
}

export function study_charts(study: Study): Chart[] {
  const demands = searches(study) ? ida_chart : points_chart;
  return [
    ...together_chart(study),
    ...study.limits.flatMap((limit, k) => fragility_chart(study, limit, k)),
    ...study.limits.flatMap((limit, k) => demands(study, limit, k)),
    ...floor_charts(study),
  ];
}
