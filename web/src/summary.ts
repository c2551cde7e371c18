// The results documents summary.json and trust.json, which the report contains (the summary without its histories): what the page uses.
// `uplift schema results` and `uplift schema trust` state all keys with their units.

type Maybe = number | null;

/** A quantity of the verdict, from the catalog of the program. */
export interface Quantity {
  name: string;
  unit: string;
  meaning: string;
  /** A share or a change: shown in per cent. */
  share?: boolean;
  /** Can be near zero: a share, a change, an instant, a residual. */
  near_zero?: boolean;
}

export interface ResultNumber {
  value: Maybe;
  unit: string;
  time?: number;
  at_twice_the_step?: Maybe;
  swing?: number;
  bonded?: Maybe;
  change_percent?: Maybe;
  change_note?: string;
}
export type ResultNumbers = Record<string, ResultNumber>;

export interface Peak {
  value: Maybe;
  time: Maybe;
  unit: string;
}

interface Band {
  band: string;
  from: number;
  change: Maybe;
  arises?: boolean; // the bonded floor is not excited in the band
}
export interface FloorSummary {
  name: string;
  zero_period_acceleration: Peak;
  spectra: { damping: number; peak: { value: Maybe; frequency: Maybe }; beside_bonded?: Band[] }[];
}

interface Range {
  max: Maybe[];
  min: Maybe[];
}
export interface BeamEnvelope {
  beam: string;
  along: { value: number[] };
  elevation: { value: number[] };
  axial: Range;
  shear: Range;
  moment: Range;
  /** In three dimensions only. */
  torsion?: Range;
}

export interface RunSummary {
  name: string;
  label: string;
  group: string;
  status: string;
  expected: string;
  bonded?: boolean;
  steps: number;
  retries: number;
  wall_seconds: Maybe;
  max_top_motion?: Peak;
  max_uplifted_ratio: Peak;
  max_opening: Peak;
  max_base_moment: Peak;
  /** Absent where all interfaces are whole foundations, which have no pressure. */
  max_pressure?: Peak;
  energy_created_share: Maybe;
  floor_spectra?: FloorSummary[];
  beam_envelopes?: BeamEnvelope[];
  agreement?: { result: string; deviation: Maybe };
}

export interface InterfaceSummary {
  name: string;
  role: "base" | "wall";
  numbers: ResultNumbers;
  above?: { uplifted_ratio: number; duration: number }[];
  full_loss?: { from: number; to: number }[];
}

export interface CriterionSummary {
  quantity: string;
  unit: string;
  interface?: string;
  beam?: string;
  result: "met" | "not met" | "undetermined";
  value: Maybe;
  limit: number;
  kind: "at_least" | "at_most";
  source: string;
  within_step_change?: boolean;
}

export interface VerdictSummary {
  level: "none" | "uplift" | "overturned" | "separated" | "failed";
  headline: string;
  consequence: string;
  step_check: { result: "not made" | "converged" | "not converged"; sentence: string };
  per_metre: boolean;
  numbers: ResultNumbers;
  interfaces: InterfaceSummary[];
  beams?: { name: string; numbers: ResultNumbers }[];
  /** In space: storeys of which both axes are recorded. */
  storeys?: { name: string; numbers: ResultNumbers }[];
  criteria: CriterionSummary[];
  floors: { floor: string; damping: number; bands: { band: string; change_percent: number; change: string; arises?: boolean }[]; note?: string }[];
}

/** Ground under a footing, from published formulas. */
export interface SoilSummary {
  source: string;
  embedment: number;
  frequency: number;
  radiation: boolean;
  motions: {
    motion: string; shear_modulus: Maybe; depth: Maybe; at_surface: Maybe; embedment_factor: Maybe; dynamic_factor: Maybe; stiffness: Maybe; damping: Maybe;
  }[];
}

export interface Summary {
  version: string;
  built_with: string;
  title: string;
  command: string;
  created: string;
  case: { file: string; sha256: string };
  inputs: { file: string; sha256: string }[];
  interfaces: { name: string; soil?: SoilSummary }[];
  motions: unknown[];
  runs: RunSummary[];
  floor_envelopes?: { damping_case: string; runs: number; floors: FloorSummary[] }[];
  verdict: VerdictSummary;
  band?: number;
  compared_columns?: string[];
  stiffness_sweep?: { k_F: number; created_share_path: Maybe; status_path: string; created_share_end: Maybe; status_end: string }[];
}

export interface Trust {
  spectrum_band: number;
  runs: { choice: string; label: string; status: string; reason: string }[];
  not_changed: { choice: string; reason: string }[];
  bands: { quantity: string; interface: string; unit: string; value: Maybe; least: Maybe; most: Maybe; band?: number; swing?: number; dominant: string }[];
  spectra: TrustSpectrum[];
}

export interface TrustSpectrum {
  floor: string;
  damping: number;
  speaks_to: number;
  limited_by: string;
  reaches: { choice: string; to: number }[];
  above_broadened?: number;
  above_at?: number;
  frequencies: number[];
  value: Maybe[];
  least: Maybe[];
  most: Maybe[];
}
