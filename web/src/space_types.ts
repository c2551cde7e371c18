// What the page reads of a model in space: cells, edges, faces of interfaces and their frames.

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
