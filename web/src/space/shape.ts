// What follows from the model once and for all: which parts are ground, edges of surfaces, plates, skins of interfaces.
import { add, Box3, cross, dot, length, point, sub, unit, type Vec3 } from "./vector";
import type { SpaceBody, SpaceInterface, SpaceModel, SpacePart } from "../space_types";

const SHARP = Math.cos((30 * Math.PI) / 180);

/** A part below the first interface is ground, unless the model says what it is. */
export function is_ground(space: SpaceModel, part: SpacePart): boolean {
  const face = space.interfaces[0];
  if (part.ground !== undefined) return part.ground;
  if (!face || part.triangles.length === 0 || face.points.length === 0) return false;
  const mean = (flat: ArrayLike<number>, indices: Iterable<number>): Vec3 => {
    let sum: Vec3 = [0, 0, 0];
    let count = 0;
    for (const i of indices) {
      sum = add(sum, point(flat, i));
      count++;
    }
    return [sum[0] / count, sum[1] / count, sum[2] / count];
  };
  const on_face = mean(face.points, face.area.keys());
  return dot(sub(mean(space.nodes, new Set(part.triangles)), on_face), face.normal as Vec3) < 0;
}

/** The box of the structure: all that is not ground. Without any, the box of everything. */
export function structure_box(space: SpaceModel): Box3 {
  const box = new Box3();
  for (const part of space.parts) if (!is_ground(space, part)) part.triangles.forEach((i) => box.include(point(space.nodes, i)));
  for (const line of space.lines) line.nodes.forEach((i) => box.include(point(space.nodes, i)));
  for (const body of space.bodies) for (let i = 0; 3 * i < body.corners.length; i++) box.include(point(body.corners, i));
  if (box.empty) for (let i = 0; 3 * i < space.nodes.length; i++) box.include(point(space.nodes, i));
  return box;
}

/** Visits each edge of a surface once with the triangles that it bounds. */
function edges_of(triangles: ArrayLike<number>, visit: (a: number, b: number, triangles: number[]) => void): void {
  const found = new Map<string, { a: number; b: number; triangles: number[] }>();
  for (let t = 0; 3 * t < triangles.length; t++) {
    for (let k = 0; k < 3; k++) {
      const a = triangles[3 * t + k] as number;
      const b = triangles[3 * t + ((k + 1) % 3)] as number;
      const key = a < b ? `${a} ${b}` : `${b} ${a}`;
      const edge = found.get(key);
      if (edge) edge.triangles.push(t);
      else found.set(key, { a, b, triangles: [t] });
    }
  }
  found.forEach((edge) => visit(edge.a, edge.b, edge.triangles));
}

export function triangle_normal(nodes: ArrayLike<number>, triangles: ArrayLike<number>, t: number): Vec3 {
  const [a, b, c] = [0, 1, 2].map((k) => point(nodes, triangles[3 * t + k] as number)) as [Vec3, Vec3, Vec3];
  return unit(cross(sub(b, a), sub(c, a)));
}

/** Flat node indices of the edges at which a surface bends by more than 30 degrees or ends. */
export function sharp_edges(nodes: ArrayLike<number>, triangles: ArrayLike<number>): number[] {
  const sharp: number[] = [];
  edges_of(triangles, (a, b, [first, second]) => {
    if (second === undefined || dot(triangle_normal(nodes, triangles, first as number), triangle_normal(nodes, triangles, second)) < SHARP) sharp.push(a, b);
  });
  return sharp;
}

/** Edges of one triangle only: the rim of a surface. */
export function rim_edges(triangles: ArrayLike<number>): number[] {
  const rim: number[] = [];
  edges_of(triangles, (a, b, bounded) => {
    if (bounded.length === 1) rim.push(a, b);
  });
  return rim;
}

/** A body as a plate: its outline, and the outline again at its upper side. It reaches its node when that lies not far above. */
export function plate_of(space: SpaceModel, body: SpaceBody): { bottom: Vec3[]; top: Vec3[] } {
  const bottom = Array.from({ length: Math.floor(body.corners.length / 3) }, (_, i) => point(body.corners, i));
  let area: Vec3 = [0, 0, 0];
  bottom.forEach((p, i) => (area = add(area, cross(p, bottom[(i + 1) % bottom.length] as Vec3), 0.5)));
  const normal = unit(area[2] < 0 ? [-area[0], -area[1], -area[2]] : area);
  const width = Math.sqrt(length(area));
  const rise = dot(sub(point(space.nodes, body.node), bottom[0] ?? [0, 0, 0]), normal);
  const thick = Math.min(0.25 * width, Math.max(0.06 * width, rise));
  return { bottom, top: bottom.map((p) => add(p, normal, thick)) };
}

/** Directions of s and t in space: least squares of the points over their plan; any two across the normal for a single point. */
export function plan_axes(face: SpaceInterface): [Vec3, Vec3] {
  const n = face.area.length;
  const mean = (at: (i: number) => number): number => Array.from({ length: n }, (_, i) => at(i)).reduce((a, b) => a + b, 0) / n;
  const s = (i: number): number => face.plan[2 * i] as number;
  const t = (i: number): number => face.plan[2 * i + 1] as number;
  const [ms, mt] = [mean(s), mean(t)];
  const [ss, st, tt] = [mean((i) => (s(i) - ms) ** 2), mean((i) => (s(i) - ms) * (t(i) - mt)), mean((i) => (t(i) - mt) ** 2)];
  const det = ss * tt - st * st;
  if (!(det > 1e-9 * (ss + tt) ** 2)) {
    const normal = unit(face.normal as Vec3);
    const first = unit(Math.abs(normal[2]) > 0.5 ? cross([0, 1, 0], normal) : cross([0, 0, 1], normal));
    return [first, cross(normal, first)];
  }
  const slopes = [0, 1, 2].map((k) => {
    const xs = mean((i) => (face.points[3 * i + k] as number) * (s(i) - ms));
    const xt = mean((i) => (face.points[3 * i + k] as number) * (t(i) - mt));
    return [(xs * tt - xt * st) / det, (xt * ss - xs * st) / det] as [number, number];
  });
  return [slopes.map((v) => v[0]) as Vec3, slopes.map((v) => v[1]) as Vec3];
}

/** The drawn surface of an interface: its triangles, or a square for every point. */
export interface Skin {
  /** Flat x, y, z in the reference position. */
  vertices: number[];
  /** Point of the interface that each vertex belongs to. */
  point: number[];
  triangles: number[];
  rim: number[];
}

export function skin_of(face: SpaceInterface): Skin {
  const n = face.area.length;
  if (face.triangles.length > 0) {
    return { vertices: face.points, point: Array.from({ length: n }, (_, i) => i), triangles: face.triangles, rim: rim_edges(face.triangles) };
  }
  const skin: Skin = { vertices: [], point: [], triangles: [], rim: [] };
  const [s, t] = plan_axes(face);
  for (let i = 0; i < n; i++) {
    const half = Math.sqrt(Math.max(0, face.area[i] as number)) / 2;
    const centre = point(face.points, i);
    const first = 4 * i;
    for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1]] as [number, number][]) {
      skin.vertices.push(...add(add(centre, s, a * half), t, b * half));
      skin.point.push(i);
    }
    skin.triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
    skin.rim.push(first, first + 1, first + 1, first + 2, first + 2, first + 3, first + 3, first);
  }
  return skin;
}
