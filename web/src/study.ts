// The document study.json, which the report of a study contains: what the page uses. `uplift schema study` states all keys with their units.
// Intensities are in the unit of the study, demands in that of their limit.
import { pretty_unit } from "./format";
import { significant } from "./quantity";

type Maybe = number | null;

export interface Interval {
  lower: Maybe;
  upper: Maybe;
}

/** A lognormal curve, or why there is none. */
export interface Fit {
  fitted: boolean;
  reason: string;
  theta?: number;
  beta?: number;
}

export interface FullFit extends Fit {
  theta_interval?: Interval;
  beta_interval?: Interval;
  curve?: { intensity: number[]; probability: number[]; lower: Maybe[]; upper: Maybe[] };
}

export interface CapacityEnd {
  known: "exact" | "at_least" | "at_most" | "nothing";
  intensity: Maybe;
}

export interface Capacity {
  motion: string;
  sample: number;
  found: boolean;
  capacity: CapacityEnd;
  resurrections: number[];
}

export interface Stripe {
  intensity: number;
  runs: number;
  exceeded: number;
  unknown: number;
}

/** Probabilities that a limit is exceeded at the design motion and at 1.5 times it. */
export interface Pair {
  at_design: Maybe;
  at_one_and_a_half: Maybe;
}

export interface Limit {
  name: string;
  quantity: string;
  label: string;
  of: string;
  unit: string;
  limit: number;
  at_least: boolean;
  source: string;
  survived: number;
  exceeded: number;
  unknown: number;
  capacities: Capacity[];
  stripes: Stripe[];
  regression?: { a: number; b: number; sigma: number; without_demand: number };
  confidence: number;
  fit: FullFit;
  unknown_survived: Fit;
  unknown_exceeded: Fit;
  capacity: { known: boolean; reason: string; median?: number; beta_r?: number; beta_u?: number; beta_c?: number; hclpf?: number; hclpf_composite?: number };
  bootstrap?: { known: boolean; reason: string; draws?: number; theta_interval?: Interval; beta_interval?: Interval };
  dispersion: { known: boolean; reason: string; median?: number; beta_r?: number; beta_u?: number; hclpf?: number };
  performance?: Pair & { at_design_interval: Interval; at_one_and_a_half_interval: Interval; met?: boolean; unknown_survived: Pair; unknown_exceeded: Pair; composite: Pair };
  risk?: { rate: Maybe; reason: string; share_below: Maybe; share_above: Maybe; composite: Maybe; unknown_survived: Maybe; unknown_exceeded: Maybe };
  fractiles?: { demands: number[]; p16: Maybe[]; p50: Maybe[]; p84: Maybe[] };
  tornado: { variable: string; low: number; high: number }[];
  tornado_basis: { samples: number; responses: number; reason: string };
}

export interface StudyRun {
  intensity: number;
  factor: number;
  outcome: string;
  states: string[];
  demands: Maybe[];
}

export interface StudyCurve {
  motion: string;
  sample: number;
  complete: boolean;
  runs: StudyRun[];
}

export interface Failure {
  id: string;
  motion: string;
  sample: number;
  intensity: number;
  outcome: string;
  reason: string;
  case: string;
  replay: string;
}

export interface StudyMotion {
  name: string;
  label: string;
  record: string;
  intensity: number;
  pga: number;
  pgv: number;
  arias: number;
  cav: number;
  significant_duration: number;
  step: number;
  duration: number;
}

export interface Variable {
  name: string;
  paths: string[];
  meaning: "factor" | "value";
  unit: string;
  distribution: "normal" | "lognormal" | "uniform";
  parameters: number[];
  values: number[];
}

export interface StudyFloor {
  floor: string;
  damping: number;
  level: number;
  runs: number;
  lost: number;
  missing: number;
  frequencies: number[];
  p16: number[];
  p50: number[];
  p84: number[];
}

export interface Study {
  name: string;
  title: string;
  complete: boolean;
  provenance: { version: string; case_file: string; case_sha256: string; plan_sha256: string; inputs: { file: string; sha256: string }[]; seed: number };
  intensity: { measure: string; label: string; unit: string; period: number; damping: number };
  method: { type: "ida" | "truncated_ida" | "stripes" | "cloud"; levels: number[]; largest: number; tolerance: number };
  samples: number;
  pairing: "crossed" | "paired";
  motions: StudyMotion[];
  variables: Variable[];
  design?: { intensity: number; source: string };
  hazard?: { intensities: number[]; rates: number[]; source: string };
  factors: { name: string; median: number; beta_r: number; beta_u: number; source: string }[];
  outcomes: Record<string, number>;
  limits: Limit[];
  curves: StudyCurve[];
  failures: Failure[];
  floor_spectra: StudyFloor[];
}

/** "g_n" as people write it; a factor has no unit. */
export function intensity_unit(study: Study): string {
  return pretty_unit(study.intensity.unit).replace("g_n", "g");
}

/** "0.42 g"; no interval end is "unbounded". */
export function intensity_text(study: Study, value: Maybe | undefined): string {
  if (value === null || value === undefined) return "unbounded";
  const unit = intensity_unit(study);
  return rounded(value) + (unit ? `\u00a0${unit}` : "");
}

/** Three significant digits, zeros at the end included: "0.420". */
export function rounded(value: number): string {
  const text = value.toPrecision(3);
  return text.includes("e") ? significant(value, 3) : text;
}

/** "0.36 to 0.49 g". */
export function interval_text(study: Study, interval: Interval | undefined): string {
  const { lower, upper } = interval ?? { lower: null, upper: null };
  if (lower === null && upper === null) return "unbounded";
  if (lower === null) return `at most ${intensity_text(study, upper)}`;
  return upper === null ? `at least ${intensity_text(study, lower)}` : `${rounded(lower)} to ${intensity_text(study, upper)}`;
}

/** Standard normal distribution function, to 1e-7 (Abramowitz & Stegun, 7.1.26): for drawings. */
export function normal_cdf(z: number): number {
  const x = Math.abs(z) / Math.SQRT2;
  const t = 1 / (1 + 0.3275911 * x);
  const tail = 0.5 * t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) * Math.exp(-x * x);
  return z > 0 ? 1 - tail : tail;
}

/** Runs of all outcomes. */
export function run_count(study: Study): number {
  return Object.values(study.outcomes).reduce((sum, count) => sum + count, 0);
}

export const searches = (study: Study): boolean => study.method.type === "ida" || study.method.type === "truncated_ida";

/** What a curve is fitted to: of stripes the share of exceedances among the runs of known outcome; of searches the exact capacities in
    ascending order, the i-th of n at (i - 1/2)/n, where n counts those beyond the range as well. */
export function empirical(limit: Limit): { intensity: number[]; share: number[] } {
  const stripes = limit.stripes.filter((stripe) => stripe.runs > stripe.unknown);
  if (stripes.length > 0) return { intensity: stripes.map((each) => each.intensity), share: stripes.map((each) => each.exceeded / (each.runs - each.unknown)) };
  const known = limit.capacities.filter(({ capacity }) => capacity.known !== "nothing" && capacity.intensity !== null);
  const below = known.filter(({ capacity }) => capacity.known === "at_most").length;
  const exact = known.flatMap(({ capacity }) => (capacity.known === "exact" ? [capacity.intensity as number] : [])).sort((a, b) => a - b);
  return { intensity: exact, share: exact.map((_, i) => (below + i + 0.5) / known.length) };
}

/** The share of a sorted list, straight between its values. */
export function percentile(sorted: number[], share: number): number {
  const at = share * (sorted.length - 1);
  const [low, high] = [sorted[Math.floor(at)] ?? NaN, sorted[Math.ceil(at)] ?? NaN];
  return low + (at - Math.floor(at)) * (high - low);
}
