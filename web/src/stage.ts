// The moving picture: the model drawn at one instant, displacements multiplied by one factor.
// Rotations are those of the small-displacement model: a body moves by u + rz × r, so that the drawn gap is the
// computed opening times the factor.
import { s, px } from "./dom";
import { NEGLIGIBLE } from "./format";
import { carrier, contact_line, Map2, model_box, node_map, ordered_indices, outline_of, type Box, type Point } from "./geometry";
import { arrow, hatched, path_of } from "./symbols";
import type { Animation, Interface, InterfacePoint, Model, ModelNode, Motion } from "./types";

const STAGE_WIDTH = 440;
const STAGE_HEIGHT = 340;
const PRESSURE_LENGTH = 38;
const STILL: Motion = [0, 0, 0];
const CONTACT = "M0 -3A3 3 0 1 0 0 3A3 3 0 1 0 0 -3Z";
const OPEN = "M0 -4.4L4.4 0L0 4.4L-4.4 0Z";

interface FaceParts {
  face: Interface;
  owner: string | null;
  order: number[];
  gap: SVGPathElement;
  pressure: SVGGElement;
  points: SVGPathElement[];
}

/** Largest displacement of any node over all frames: decides the default factor. */
export function largest_motion(animation: Animation): number {
  let largest = 0;
  for (const frames of Object.values(animation.nodes)) {
    for (const [ux, uy] of frames) largest = Math.max(largest, Math.hypot(ux, uy));
  }
  return largest;
}

function largest_pressure(animation: Animation): number {
  let largest = 0;
  for (const frames of Object.values(animation.pressures ?? {})) {
    for (const values of frames) for (const value of values) largest = Math.max(largest, Math.abs(value));
  }
  return largest;
}

export class Stage {
  readonly svg = s("svg", { viewBox: `0 0 ${STAGE_WIDTH} ${STAGE_HEIGHT}`, class: "model-svg stage", role: "img", "aria-label": "Deformed model at the chosen instant" });
  private readonly model_: Model;
  private readonly nodes_: Map<string, ModelNode>;
  private readonly map_: Map2;
  private readonly bodies_: { node: string; corners: Point[]; path: SVGPathElement }[] = [];
  private readonly outlines_: { lines: ModelNode[][]; path: SVGPathElement }[] = [];
  private readonly beams_: { nodes: string[]; path: SVGPathElement }[] = [];
  private readonly masses_: { node: string; circle: SVGCircleElement }[] = [];
  private readonly faces_: FaceParts[] = [];
  private animation_: Animation;
  private largest_pressure_ = 0;

  constructor(model: Model, animation: Animation) {
    this.model_ = model;
    this.animation_ = animation;
    this.nodes_ = node_map(model);
    this.map_ = new Map2(this.room(model_box(model)), STAGE_WIDTH, STAGE_HEIGHT, { left: 20, right: 20, top: 14, bottom: 48 });
    this.still_parts();
    this.moving_parts();
    this.set_animation(animation);
  }

  set_animation(animation: Animation): void {
    this.animation_ = animation;
    this.largest_pressure_ = largest_pressure(animation);
  }

  /** The size by which motions are judged, metres. */
  get size(): number {
    const box = model_box(this.model_);
    return Math.max(box.xmax - box.xmin, box.ymax - box.ymin);
  }

  draw(frame: number, factor: number): void {
    for (const part of this.outlines_) part.path.setAttribute("d", this.outline_path(part.lines, frame, factor));
    for (const body of this.bodies_) {
      body.path.setAttribute("d", path_of(body.corners.map(([x, y]) => this.carried(body.node, x, y, frame, factor)), true));
    }
    for (const beam of this.beams_) beam.path.setAttribute("d", this.beam_path(beam.nodes, frame, factor));
    for (const { node, circle } of this.masses_) {
      const n = this.nodes_.get(node);
      if (!n) continue;
      const [x, y] = this.carried(node, n.x, n.y, frame, factor);
      circle.setAttribute("cx", px(x));
      circle.setAttribute("cy", px(y));
    }
    for (const face of this.faces_) this.draw_face(face, frame, factor);
  }

  // Room on both sides for the magnified motion.
  private room(box: Box): Box {
    const size = Math.max(box.xmax - box.xmin, box.ymax - box.ymin);
    return { xmin: box.xmin - 0.17 * size, xmax: box.xmax + 0.17 * size, ymin: box.ymin - 0.02 * size, ymax: box.ymax + 0.06 * size };
  }

  private still_parts(): void {
    for (const face of this.model_.interfaces) {
      const line = contact_line(face);
      if (!line || face.opened) continue;
      const [a, b] = line.map(([x, y]) => this.map_.at(x, y)) as [Point, Point];
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      const by = 0.3 * length;
      const [ux, uy] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
      this.svg.append(hatched([a[0] - ux * by, a[1] - uy * by], [b[0] + ux * by, b[1] + uy * by], 10, "hatch ground"));
    }
    const ghost = s("g", { class: "ghost" });
    for (const part of this.model_.outlines) {
      const lines = part.lines.map((line) => line.map((n) => this.nodes_.get(n)).filter((n): n is ModelNode => n !== undefined));
      ghost.append(s("path", { d: lines.map((line) => path_of(line.map((n) => this.map_.at(n.x, n.y)), true)).join("") }));
    }
    for (const body of this.model_.bodies) {
      ghost.append(s("path", { d: path_of(outline_of(this.model_, body).map(([x, y]) => this.map_.at(x, y)), true) }));
    }
    for (const beam of this.model_.beams) {
      const points = beam.nodes.map((n) => this.nodes_.get(n)).filter((n): n is ModelNode => n !== undefined);
      ghost.append(s("path", { d: path_of(points.map((n) => this.map_.at(n.x, n.y))) }));
    }
    this.svg.append(ghost);
  }

  private moving_parts(): void {
    for (const part of this.model_.outlines) {
      const path = s("path", { class: "solid" });
      const lines = part.lines.map((line) => line.map((name) => this.nodes_.get(name)).filter((n): n is ModelNode => n !== undefined));
      this.outlines_.push({ lines, path });
      this.svg.append(path);
    }
    for (const face of this.model_.interfaces) {
      const parts: FaceParts = {
        face,
        owner: carrier(this.model_, face),
        order: ordered_indices(face),
        gap: s("path", { class: "gap" }),
        pressure: s("g", { class: "pressures" }),
        points: face.points.map(() => s("path", { d: CONTACT })),
      };
      this.faces_.push(parts);
      this.svg.append(parts.gap, parts.pressure);
    }
    for (const body of this.model_.bodies) {
      const path = s("path", { class: "body" });
      this.bodies_.push({ node: body.node, corners: outline_of(this.model_, body), path });
      this.svg.append(path);
    }
    for (const beam of this.model_.beams) {
      const path = s("path", { class: "beam" });
      this.beams_.push({ nodes: beam.nodes, path });
      this.svg.append(path);
    }
    const largest = Math.max(...this.model_.masses.map((m) => m.mass), 0);
    for (const { node, mass } of this.model_.masses) {
      const circle = s("circle", { class: "mass", r: px(Math.max(4, 12 * Math.cbrt(mass / (largest || 1)))) });
      this.masses_.push({ node, circle });
      this.svg.append(circle);
    }
    for (const face of this.faces_) this.svg.append(s("g", {}, ...face.points));
  }

  private motion(name: string, frame: number): Motion {
    return this.animation_.nodes[name]?.[frame] ?? STILL;
  }

  /** Picture place of a material point (x, y) that moves rigidly with a node. */
  private carried(name: string | null, x: number, y: number, frame: number, factor: number): Point {
    const node = name === null ? undefined : this.nodes_.get(name);
    if (!node || name === null) return this.map_.at(x, y);
    const [ux, uy, rz] = this.motion(name, frame);
    return this.map_.at(x + factor * (ux - rz * (y - node.y)), y + factor * (uy + rz * (x - node.x)));
  }

  private outline_path(lines: ModelNode[][], frame: number, factor: number): string {
    return lines.map((line) => path_of(line.map((node) => this.carried(node.name, node.x, node.y, frame, factor)), true)).join("");
  }

  /** Cubic through the displacements and rotations of the end nodes, straight along the axis. */
  private beam_path(names: string[], frame: number, factor: number): string {
    const points: Point[] = [];
    for (let i = 1; i < names.length; i++) {
      const a = this.nodes_.get(names[i - 1] as string);
      const b = this.nodes_.get(names[i] as string);
      if (a && b) points.push(...this.segment(a, b, frame, factor));
    }
    return path_of(points);
  }

  private segment(a: ModelNode, b: ModelNode, frame: number, factor: number): Point[] {
    const [ua, va, ra] = this.motion(a.name, frame);
    const [ub, vb, rb] = this.motion(b.name, frame);
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    const [cx, cy] = [(b.x - a.x) / length, (b.y - a.y) / length];
    const along = (u: number, v: number): number => u * cx + v * cy;
    const across = (u: number, v: number): number => -u * cy + v * cx;
    const points: Point[] = [];
    for (let k = 0; k <= 16; k++) {
      const t = k / 16;
      const axial = along(ua, va) * (1 - t) + along(ub, vb) * t;
      const cubic =
        across(ua, va) * (1 - 3 * t * t + 2 * t ** 3) +
        ra * length * (t - 2 * t * t + t ** 3) +
        across(ub, vb) * (3 * t * t - 2 * t ** 3) +
        rb * length * (t ** 3 - t * t);
      const x = a.x + (b.x - a.x) * t + factor * (axial * cx - cubic * cy);
      const y = a.y + (b.y - a.y) * t + factor * (axial * cy + cubic * cx);
      points.push(this.map_.at(x, y));
    }
    return points;
  }

  private draw_face(parts: FaceParts, frame: number, factor: number): void {
    const { face, order } = parts;
    const openings = this.animation_.openings[face.name]?.[frame] ?? [];
    const pressures = this.animation_.pressures?.[face.name]?.[frame] ?? [];
    const upper: Point[] = [];
    const lower: Point[] = [];
    parts.pressure.replaceChildren();
    for (const i of order) {
      const p = face.points[i] as InterfacePoint;
      const opening = openings[i] ?? 0;
      const [x, y] = this.carried(p.node ?? parts.owner, p.x, p.y, frame, factor);
      const by = factor * Math.max(0, opening) * this.map_.scale;
      upper.push([x, y]);
      lower.push([x - p.nx * by, y + p.ny * by]);
      const mark = parts.points[i];
      mark?.setAttribute("transform", `translate(${px(x)} ${px(y)})`);
      mark?.setAttribute("d", opening > NEGLIGIBLE ? OPEN : CONTACT);
      mark?.setAttribute("class", opening > NEGLIGIBLE ? "pt-open" : "pt-contact");
      this.add_pressure(parts.pressure, p, [x, y], pressures[i] ?? 0);
    }
    parts.gap.setAttribute("d", path_of([...upper, ...lower.reverse()], true));
  }

  // Compression pushes the upper side along n, tension pulls it back; both are drawn on the ground side.
  private add_pressure(group: SVGGElement, p: InterfacePoint, [x, y]: Point, value: number): void {
    const length = this.largest_pressure_ > 0 ? (PRESSURE_LENGTH * Math.abs(value)) / this.largest_pressure_ : 0;
    if (length < 1) return;
    const near: Point = [x - p.nx * 4, y + p.ny * 4];
    const far: Point = [near[0] - p.nx * length, near[1] + p.ny * length];
    const head = Math.min(5, length);
    group.append(value > 0 ? arrow(far, near, head, "push") : arrow(near, far, head, "pull"));
  }
}
