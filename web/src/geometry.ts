// Geometry of the model drawing and of the animation: outlines of bodies, interface lines, the map to the picture.
import type { Body, Interface, InterfacePoint, Model, ModelNode } from "./types";

export type Point = [number, number];

export interface Box {
  xmin: number;
  xmax: number;
  ymin: number;
  ymax: number;
}

/** Direction along an interface point: the normal turned clockwise, so that n = (0, 1) gives (1, 0). */
export const tangent = (p: InterfacePoint): Point => [p.ny, -p.nx];

export function node_map(model: Model): Map<string, ModelNode> {
  return new Map(model.nodes.map((node) => [node.name, node]));
}

/** The node that carries the upper side of an interface; `body` may name a node or a body. */
export function carrier(model: Model, face: Interface): string | null {
  if (face.body === undefined) return null;
  if (model.nodes.some((node) => node.name === face.body)) return face.body;
  return model.bodies.find((body) => body.name === face.body)?.node ?? null;
}

/** Points in order along the interface. */
export function ordered_indices(face: Interface): number[] {
  const first = face.points[0];
  if (!first) return [];
  const [tx, ty] = tangent(first);
  const along = (p: InterfacePoint): number => p.x * tx + p.y * ty;
  return face.points.map((_p, i) => i).sort((a, b) => along(face.points[a] as InterfacePoint) - along(face.points[b] as InterfacePoint));
}

/**
 * Overhang of the contact line beyond its first and last point. Points that stand for equal parts of the width
 * (all areas alike) lie half a spacing inside; end points of half the area lie on the edge.
 */
function overhang(face: Interface, order: number[]): number {
  const at = (i: number): InterfacePoint => face.points[order[i] as number] as InterfacePoint;
  if (order.length < 3) return 0;
  const on_edge = at(0).area < 0.75 * at(1).area;
  return on_edge ? 0 : Math.hypot(at(1).x - at(0).x, at(1).y - at(0).y) / 2;
}

/** The ends of the contact line. */
export function contact_line(face: Interface): [Point, Point] | null {
  const order = ordered_indices(face);
  const first = face.points[order[0] ?? -1];
  const last = face.points[order[order.length - 1] ?? -1];
  if (!first || !last) return null;
  const by = overhang(face, order);
  const [t0, t1] = [tangent(first), tangent(last)];
  return [
    [first.x - t0[0] * by, first.y - t0[1] * by],
    [last.x + t1[0] * by, last.y + t1[1] * by],
  ];
}

/** Corners of a body: as given, else a flat block on its interface, else nothing. */
export function outline_of(model: Model, body: Body): Point[] {
  if (body.outline && body.outline.length > 2) return body.outline;
  const face = model.interfaces.find((candidate) => carrier(model, candidate) === body.node);
  const line = face ? contact_line(face) : null;
  const first = face?.points[0];
  const node = model.nodes.find((n) => n.name === body.node);
  if (!line || !first || !node) return [];
  const [a, b] = line;
  const width = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const rise = (node.x - first.x) * first.nx + (node.y - first.y) * first.ny;
  const thick = Math.max(0.09 * width, rise);
  return [a, b, [b[0] + first.nx * thick, b[1] + first.ny * thick], [a[0] + first.nx * thick, a[1] + first.ny * thick]];
}

/** Everything that is drawn, in metres. */
export function model_box(model: Model): Box {
  const xs: number[] = [];
  const ys: number[] = [];
  const add = (x: number, y: number): void => void (xs.push(x), ys.push(y));
  model.nodes.forEach((n) => add(n.x, n.y));
  model.interfaces.forEach((face) => face.points.forEach((p) => add(p.x, p.y)));
  model.bodies.forEach((body) => outline_of(model, body).forEach(([x, y]) => add(x, y)));
  const box = { xmin: Math.min(...xs), xmax: Math.max(...xs), ymin: Math.min(...ys), ymax: Math.max(...ys) };
  const size = Math.max(box.xmax - box.xmin, box.ymax - box.ymin) || 1;
  // A column without width still needs a picture that is not a line.
  const grow = Math.max(0, 0.3 * size - (box.xmax - box.xmin)) / 2;
  return { ...box, xmin: box.xmin - grow, xmax: box.xmax + grow };
}

/** Metres to picture units, y upwards. */
export class Map2 {
  readonly scale: number;
  /** Of the picture's box. */
  readonly middle: Point;
  private readonly x0_: number;
  private readonly y0_: number;

  constructor(box: Box, width: number, height: number, margin: { left: number; right: number; top: number; bottom: number }) {
    const w = width - margin.left - margin.right;
    const t = height - margin.top - margin.bottom;
    this.scale = Math.min(w / (box.xmax - box.xmin || 1), t / (box.ymax - box.ymin || 1));
    this.x0_ = margin.left + w / 2 - (this.scale * (box.xmin + box.xmax)) / 2;
    this.y0_ = margin.top + t / 2 + (this.scale * (box.ymin + box.ymax)) / 2;
    this.middle = [margin.left + w / 2, margin.top + t / 2];
  }

  at(x: number, y: number): Point {
    return [this.x0_ + this.scale * x, this.y0_ - this.scale * y];
  }
}

/** 1, 2 or 5 times a power of ten, not above `value`. */
export function round_down(value: number): number {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  const digit = value / power;
  return (digit >= 5 ? 5 : digit >= 2 ? 2 : 1) * power;
}
