// What the page shows. data.ts makes it from the document that the program writes into the page ("uplift-report-2", RawReport): the results
// documents summary.json (without its histories) and trust.json, and what only the report has (histories, frames, geometry, sentences of the terminal).
// All numbers are SI. Opening > 0, tension > 0, pressure > 0 in compression. `null` stands for a gap.
import type { Figures } from "./result_charts";
import type { Catalog } from "./result_verdict";
import type { SpaceAnimation, SpaceModel } from "./space_types";
import type { Study } from "./study";
import type { Summary, Trust } from "./summary";

export const FORMAT = "uplift-report-2";

export type Maybe<T> = T | null | undefined;
export type Cell = string | number | boolean | null | undefined;
export type Row = Record<string, Cell>;

export interface CaseInfo {
  file: string;
  sha256: string;
  /** The case with every default filled in, as TOML text. */
  resolved: string;
  /** Other files that were read: meshes, records. */
  inputs?: { file: string; sha256: string }[];
}

/** "motion": the report is one of ground motions, without a structure; "fragility": of a study. */
export type VerdictLevel = "none" | "uplift" | "overturned" | "separated" | "failed" | "motion" | "fragility";

export interface Fact {
  label: string;
  value: string;
  detail?: string;
  /** By how much the value changes with twice the step. */
  stepChange?: string;
}

/** A number of the verdict, SI, with its texts. */
export interface VerdictRow {
  label: string;
  value: number;
  unit: string;
  text: string;
  /** Seconds. */
  time?: number;
  /** The same number of the bonded run. */
  bonded?: number;
  bondedText?: string;
  changeText?: string;
  /** Half of the range in which a residual still varies; absent when it is at rest. */
  swingText?: string;
  /** By how much the number changes with twice the step. */
  stepText?: string;
}

/** What is said of one interface. */
export interface BaseVerdict {
  name: string;
  /** A base, or a wall beside the structure; absent: a base. */
  role?: "base" | "wall";
  /** Uplifted share of the area over time. */
  time: number[];
  share: number[];
  /** Thresholds that the user gave, and for how many seconds the share is above. */
  above: { threshold: number; duration: number; text: string }[];
  /** Intervals without any contact, seconds. */
  lost: [number, number][];
  /** How often and how long there is no contact; may be empty. */
  lostText: string;
  beside: VerdictRow[];
  rest: VerdictRow[];
  /** Shares: what pulls in the bonded run, the uplift that stands for by equal energy (null: no answer), what was computed. */
  linear?: { tension: number; predicted: number | null; computed: number; tensionText: string; predictedText: string; computedText: string };
}

export type CriterionState = "met" | "not met" | "undetermined";

export interface Criterion {
  label: string;
  interface: string;
  state: CriterionState;
  valueText: string;
  limitText: string;
  atLeast: boolean;
  source: string;
  /** Doubling the step changes the value by at least its distance from the limit. */
  uncertain: boolean;
}

/** What becomes of a floor spectrum against the bonded run, band by band. */
export interface FloorChange {
  floor: string;
  damping: number;
  bands: { band: string; change_percent: number; change: string; arises?: boolean }[];
  /** Why there are no bands. */
  note?: string;
}

export interface Verdict {
  level: VerdictLevel;
  headline: string;
  /** And so what: beside the bonded run and the user's limits. */
  consequence?: string;
  facts: Fact[];
  paragraphs: string[];
  /** Run that the verdict is about. */
  run: string;
  interfaces: BaseVerdict[];
  criteria: Criterion[];
  floors: FloorChange[];
  /** How far the numbers depend on the time step; absent for static stages alone. */
  stepCheck?: StepCheck;
  /** What restricts all numbers: a study that is not complete. */
  warning?: string;
  /** Of a study. */
  study?: Study;
}

export interface StepCheck {
  result: "not made" | "converged" | "not converged";
  sentence: string;
}

export interface Choice {
  what: string;
  value: string;
  /** "paper", "our choice" or "user". */
  origin: string;
  note?: string;
}

export type ColumnKind = "number" | "text" | "status" | "percent";

export interface Column {
  key: string;
  label: string;
  unit?: string;
  /** Significant digits of the largest sound value. */
  digits?: number;
  /** "percent": the value is a fraction, 0.25 is shown as 25 %. */
  kind: ColumnKind;
}

export interface Table {
  id: string;
  title: string;
  caption: string;
  columns: Column[];
  rows: Row[];
  /** Rows with the same value of this key stand together under a heading. */
  rowGroup?: string;
}

export interface Section {
  id: string;
  title: string;
  text?: string;
}

export interface Axis {
  label: string;
  unit?: string;
  log?: boolean;
}

export interface Series {
  label: string;
  /** Name of the run: decides the colour, the same in every figure. */
  run?: string;
  x: (number | null)[];
  y: (number | null)[];
  dash?: boolean;
  hidden?: boolean;
  failed?: boolean;
  /** "line": without markers; "thin": one of many; "points": markers alone; "band": a closed outline, filled. Absent: by the number of points. */
  style?: SeriesStyle;
  /** Curves without a run that belong together have one colour. */
  group?: string;
}
export type SeriesStyle = "line" | "thin" | "points" | "band";

export interface Chart {
  id: string;
  section: string;
  title: string;
  caption: string;
  origin: string;
  x: Axis;
  y: Axis;
  series: Series[];
}

export interface ModelNode {
  name: string;
  x: number;
  y: number;
  /** A node of a mesh's outline: it moves, but is not marked. */
  hidden?: boolean;
}

/** Boundary of a group of a mesh: closed lines of nodes. */
export interface Outline {
  name: string;
  lines: string[][];
}

export interface Beam {
  name: string;
  nodes: string[];
}

export interface Body {
  name: string;
  node: string;
  /** Corners in the reference position, metres. Without it a flat block is drawn. */
  outline?: [number, number][];
}

export interface Mass {
  node: string;
  mass: number;
}

export interface Support {
  node: string;
  dofs: string[];
  /** Holds in static stages alone. */
  staticsOnly?: boolean;
}

/** Faces of the mesh through which waves leave. */
export interface Absorbing {
  group: string;
  /** Follows a column of level ground. */
  freeField: boolean;
  /** A wave comes in here. */
  incident: boolean;
  /** [x1, y1, x2, y2] of every edge, metres. */
  edges: [number, number, number, number][];
}

export interface Spring {
  nodes: [string, string | null];
  kind: "spring" | "dashpot";
}

export interface InterfacePoint {
  x: number;
  y: number;
  /** Unit normal from the lower to the upper side. */
  nx: number;
  ny: number;
  area: number;
  /** Node that the point is drawn moving with. */
  node?: string;
}

export interface Interface {
  name: string;
  /** Node (or name of the body) that carries the upper side. */
  body?: string;
  /** Opened inside a mesh: the ground below it is drawn as a mesh. */
  opened?: boolean;
  points: InterfacePoint[];
}

export interface Load {
  node: string;
  fx: number;
  fy: number;
  label: string;
}

export interface Model {
  nodes: ModelNode[];
  beams: Beam[];
  bodies: Body[];
  masses: Mass[];
  supports: Support[];
  absorbing: Absorbing[];
  springs: Spring[];
  interfaces: Interface[];
  loads: Load[];
  /** Of a mesh. */
  outlines: Outline[];
  /** Edges of its elements, when they are not too many: [x1, y1, x2, y2]. */
  grid: [number, number, number, number][];
}

/** Per frame: [ux, uy, rz]. */
export type Motion = [number, number, number];

export interface Animation {
  run: string;
  time: number[];
  nodes: Record<string, Motion[]>;
  /** Per interface, per frame, per point: metres, > 0 open. */
  openings: Record<string, number[][]>;
  /** Same shape, pascal, > 0 in compression. */
  pressures?: Record<string, number[][]>;
  /** Per interface, per frame: uplifted share of the area as the run counts it. Without it the page counts the open points. */
  uplifted?: Record<string, number[]>;
}

export interface Report {
  format: string;
  title: string;
  subtitle?: string;
  version: string;
  created: string;
  command: string;
  /** Compiler of the program. */
  builtWith?: string;
  case: CaseInfo;
  verdict: Verdict;
  choices: Choice[];
  tables: Table[];
  sections: Section[];
  charts: Chart[];
  model: Model | null;
  animations: Animation[];
  /** The model in three dimensions; `model` is then null and `animations` is empty. */
  space?: SpaceModel | null;
  spaceAnimations?: SpaceAnimation[];
}

export type RawChart = Omit<Chart, "origin"> & { origin?: string };

/** The document as the program writes it. A report of ground motions has no summary: it has its head, verdict and sections itself. */
export interface RawReport {
  format: string;
  subtitle?: string;
  /** The case with every default filled in, as TOML text. */
  resolved?: string;
  summary?: Summary;
  trust?: Trust;
  /** study.json, of a study; `resolved` is then its plan, and `case` the file of it. */
  study?: Study;
  /** Quantities of the verdict by name. */
  quantities?: Catalog;
  /** Static stages alone: nothing happens over time. */
  statics?: boolean;
  /** What is to be known of the floor spectra of these runs; may be empty. */
  floorsWarning?: string;
  /** Uplifted share over time, by interface. */
  uplifted?: { time: number[]; share: number[] }[];
  /** What the case states for single figures. */
  figures?: Figures;
  title?: string;
  version?: string;
  created?: string;
  command?: string;
  builtWith?: string;
  case?: CaseInfo;
  /** With a summary: facts and paragraphs alone. */
  verdict?: Partial<Verdict>;
  choices?: Choice[];
  tables?: Table[];
  sections?: Section[];
  /** Without origin: that which the case states, or the program. */
  charts?: RawChart[];
  model?: Partial<Model> | null;
  animations?: Animation[];
  space?: Partial<SpaceModel> | null;
  spaceAnimations?: SpaceAnimation[];
}
