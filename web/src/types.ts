// The JSON document that the program writes into the page ("uplift-report-1").
// All numbers are SI. Opening > 0, tension > 0, pressure > 0 in compression. `null` stands for a gap.

export const FORMAT = "uplift-report-1";

export type Maybe<T> = T | null | undefined;
export type Cell = string | number | boolean | null | undefined;
export type Row = Record<string, Cell>;

export interface CaseInfo {
  file: string;
  sha256: string;
  /** The case with every default filled in, as TOML text. */
  resolved: string;
}

export type VerdictLevel = "none" | "uplift" | "overturned" | "failed";

export interface Fact {
  label: string;
  value: string;
  detail?: string;
}

export interface Verdict {
  level: VerdictLevel;
  headline: string;
  facts: Fact[];
  paragraphs: string[];
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
}

export interface Report {
  format: string;
  title: string;
  subtitle?: string;
  version: string;
  created: string;
  command: string;
  case: CaseInfo;
  verdict: Verdict;
  choices: Choice[];
  tables: Table[];
  sections: Section[];
  charts: Chart[];
  model: Model | null;
  animations: Animation[];
}
