// What the page shows. data.ts makes it from the document that the program writes into the page ("uplift-report-2", RawReport): the results
// documents summary.json (without its histories) and trust.json, and what only the report has (histories, frames, geometry, sentences of the terminal).
// All numbers are SI. Opening > 0, tension > 0, pressure > 0 in compression. `null` stands for a gap.

import type { Figures } from "./result_charts";
import type { Catalog } from "./result_verdict";
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

/** "motion": the report is one of ground motions, without a structure. */
export type VerdictLevel = "none" | "uplift" | "overturned" | "separated" | "failed" | "motion";

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
}

/** What becomes of a floor spectrum against the bonded run, band by band. */
export interface FloorChange {
  floor: string;
  damping: number;
  bands: { band: string; change_percent: number; change: string }[];
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
}

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

/** Surface of a group of solids. Its cells are triangles, counter-clockwise seen from outside. */
export interface SpacePart {
  name: string;
  /** Flat node indices, three per triangle. */
  triangles: number[];
  /** Flat node indices, two per edge: edges of elements on the surface. */
  edges: number[];
  /** Drawn translucent. Without it a part is ground when it lies below the first interface. */
  ground?: boolean;
}

/** A beam: a chain of node indices. */
export interface SpaceLine {
  name: string;
  nodes: number[];
}

/** A rigid raft or footing. It moves rigidly with its node (displacement and rotation). */
export interface SpaceBody {
  name: string;
  node: number;
  /** Flat x, y, z of the outline in the reference position, metres. */
  corners: number[];
}

export interface SpaceMass {
  node: number;
  mass: number;
}

export interface SpaceSupport {
  node: number;
  dofs: string[];
}

/** Faces of the mesh that are held, or through which waves leave. */
export interface SpaceBorder {
  name: string;
  kind: "held" | "absorbing";
  /** Flat node indices, three per triangle, counter-clockwise from outside. */
  triangles: number[];
}

export interface SpaceInterface {
  name: string;
  /** Flat x, y, z of its points, metres. */
  points: number[];
  /** Flat s, t of its points in the plane of the interface, metres. */
  plan: number[];
  /** Labels of s and t, such as "x" and "y". */
  axes: [string, string];
  /** Mean unit normal from the lower to the upper side. */
  normal: number[];
  area: number[];
  /** Flat indices of points, three per triangle. Empty: each point is drawn as a square of its area. */
  triangles: number[];
  /** Drawn upper node that each point moves with. Without it the points move with `body`. */
  node?: number[];
  /** Index in the bodies. */
  body?: number;
  /** One point that stands for a whole foundation: it has no map and no pressure. */
  foundation?: boolean;
}

export interface SpaceLoad {
  node: number;
  force: [number, number, number];
  label: string;
}

/** A model in three dimensions, z upwards. */
export interface SpaceModel {
  /** Flat x, y, z of the drawn nodes, metres. */
  nodes: number[];
  parts: SpacePart[];
  lines: SpaceLine[];
  bodies: SpaceBody[];
  masses: SpaceMass[];
  supports: SpaceSupport[];
  borders: SpaceBorder[];
  interfaces: SpaceInterface[];
  loads: SpaceLoad[];
}

/** Values of all frames in a compact form; data.ts turns them into plain numbers before the page uses them. */
export interface QuantisedFrames {
  /** SI value of one level. */
  unit: number;
  /** Distance of neighbours in a frame: 3 for the displacements of nodes. */
  stride: number;
  /** Per frame: change of the levels since the frame before, minus the change of the neighbour `stride` entries earlier. */
  differences: number[][];
}

/** The program writes `displacement`, `openings` and `pressures` as QuantisedFrames. */
export interface SpaceAnimation {
  run: string;
  time: number[];
  /** Per frame: flat x, y, z of each drawn node, metres. */
  displacement: number[][];
  /** Per body, per frame: [rx, ry, rz], radian. */
  rotation?: Record<string, number[][]>;
  /** Per interface, per frame, per point: metres, > 0 open. */
  openings: Record<string, number[][]>;
  /** Same shape, pascal, > 0 in compression. */
  pressures: Record<string, number[][]>;
  /** Same shape, metres, magnitude. */
  slips?: Record<string, number[][]>;
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
