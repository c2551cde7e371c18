// The model as a picture on a plain canvas, for browsers without WebGL: triangles projected, sorted by depth and painted.
import { cells_of, type Cell, type Edge } from "./cells";
import { fit_to, fitted, project, type Direction, type Frame } from "./frame";
import { rgb, type Rgb } from "./ink";
import { BORDERS, type Layer, type Look } from "./layers";
import type { FacePose } from "./pose";
import { plate_of, sharp_edges, structure_box } from "./shape";
import { add, cross, dot, point, sub, unit, type Box3, type Vec3 } from "./vector";
import type { View, ViewInput } from "./view";

const GROUND_OPACITY = 0.62;
const BORDER_OPACITY = 0.45;
const SHADE = 0.52;
const MASS_SIZE = 0.035;

// Every direction of the pictures looks down or level: the ground lies behind all that stands on it, the gap between.
const BEHIND = 1e6;

interface Piece {
  depth: number;
  paint: (c: CanvasRenderingContext2D) => void;
}

/** Normal of a polygon, which need not be plane. */
const normal_of = (corners: Vec3[]): Vec3 => {
  const first = corners[0] as Vec3;
  return unit(corners.reduce<Vec3>((sum, p, i) => add(sum, cross(sub(p, first), sub(corners[(i + 1) % corners.length] as Vec3, first))), [0, 0, 0]));
};

const shaded = (colour: Rgb, light: number, opacity: number): string => `rgba(${colour.map((v) => Math.round(v * light)).join()},${opacity})`;

export class FlatView implements View {
  readonly canvas: HTMLCanvasElement;
  readonly free = false;
  frame: Frame;
  private readonly input_: ViewInput;
  private readonly context_: CanvasRenderingContext2D;
  private readonly cells_: Cell[][];
  private readonly reference_: Vec3[][];
  private readonly size_: number;
  private pieces_: Piece[] = [];
  private density_ = 1;

  constructor(input: ViewInput, canvas: HTMLCanvasElement) {
    this.input_ = input;
    this.canvas = canvas;
    this.context_ = canvas.getContext("2d") as CanvasRenderingContext2D;
    this.cells_ = input.space.parts.map((part) => cells_of(input.space.nodes, part));
    this.reference_ = reference_lines(input);
    const box = structure_box(input.space);
    this.size_ = box.size;
    this.frame = fitted({ out: [0, -1, 0], up: [0, 0, 1] }, box, 1, 1);
  }

  resize(width: number, height: number, density: number): void {
    const grown = height / this.frame.height;
    this.density_ = density;
    this.canvas.width = Math.round(width * density);
    this.canvas.height = Math.round(height * density);
    this.frame = { ...this.frame, width, height, scale: this.frame.scale * grown };
  }

  aim(from: Direction | null, box: Box3): void {
    this.frame = from ? fitted(from, box, this.frame.width, this.frame.height) : fit_to(this.frame, box);
  }

  draw(look: Look): void {
    const { space, layers } = this.input_;
    this.pieces_ = [];
    for (const layer of layers) {
      const part = /^part (\d+)$/.exec(layer.key);
      if (part && look.shown(layer.key)) this.add_part(Number(part[1]), layer, look);
    }
    for (const border of BORDERS) if (look.shown(border.kind)) this.add_borders(border, look);
    if (look.shown("bodies")) space.bodies.forEach((_body, i) => this.add_plate(i, look));
    if (look.shown("gap") && layers.some((layer) => layer.key === "gap")) this.input_.pose.faces.forEach((face, i) => this.add_gap(face, i, look));
    if (look.shown("lines")) this.add_lines(look);
    if (look.shown("masses")) this.add_masses(look);
    if (look.shown("supports")) this.add_supports(look);
    this.pieces_.sort((a, b) => a.depth - b.depth);
    const c = this.context_;
    c.setTransform(this.density_, 0, 0, this.density_, 0, 0);
    c.clearRect(0, 0, this.frame.width, this.frame.height);
    c.lineJoin = "round";
    for (const piece of this.pieces_) piece.paint(c);
    if (look.shown("reference") && layers.some((layer) => layer.key === "reference")) this.draw_reference(look);
  }

  dispose(): void {
    this.pieces_ = [];
  }

  private depth(points: Vec3[]): number {
    return points.reduce((sum, p) => sum + dot(p, this.frame.out), 0) / points.length;
  }

  private outline(c: CanvasRenderingContext2D, points: Vec3[]): void {
    c.beginPath();
    for (const p of points) c.lineTo(...project(this.frame, p));
    c.closePath();
  }

  /** From 0.4 in the shade to 1: the light comes over the viewer's left shoulder. */
  private light(normal: Vec3): number {
    const { right, up, out } = this.frame;
    const sun = unit(add(add([-0.55 * right[0], -0.55 * right[1], -0.55 * right[2]], up, 0.8), out, 0.6));
    return 1 - SHADE + SHADE * Math.max(0, dot(normal, sun));
  }

  private add_part(index: number, layer: Layer, look: Look): void {
    const { pose } = this.input_;
    const base = rgb(layer.colour?.(look.ink) ?? "#888888");
    const opacity = layer.ground && look.translucent ? GROUND_OPACITY : 1;
    for (const cell of this.cells_[index] as Cell[]) {
      const corners = cell.nodes.map((i) => pose.at(i));
      const normal = normal_of(corners);
      if (dot(normal, this.frame.out) <= 0) continue;
      const moved = cell.nodes.reduce((sum, i) => sum + (pose.moved[i] as number), 0) / corners.length;
      const colour = look.displacement === null ? base : look.ink.displacement.at(moved / (look.displacement || 1));
      const fill = shaded(colour, this.light(normal), opacity);
      const depth = this.depth(corners) - (layer.ground ? BEHIND : 0);
      this.pieces_.push({ depth, paint: (c) => this.paint_cell(c, corners, cell.edges, fill, opacity === 1, look) });
    }
  }

  private paint_cell(c: CanvasRenderingContext2D, corners: Vec3[], edges: Edge[], fill: string, opaque: boolean, look: Look): void {
    this.outline(c, corners);
    c.fillStyle = fill;
    c.fill();
    if (opaque) this.stroke(c, fill, 0.8);
    edges.forEach((kind, k) => {
      if (kind === "none" || (kind === "cell" && !look.shown("edges"))) return;
      c.beginPath();
      c.moveTo(...project(this.frame, corners[k] as Vec3));
      c.lineTo(...project(this.frame, corners[(k + 1) % corners.length] as Vec3));
      c.globalAlpha = kind === "sharp" ? 0.75 : opaque ? 0.4 : 0.2;
      this.stroke(c, look.ink.edge, kind === "sharp" ? 1 : 0.7);
      c.globalAlpha = 1;
    });
  }

  private stroke(c: CanvasRenderingContext2D, colour: string, width: number): void {
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.stroke();
  }

  private add_polygon(points: Vec3[], fill: string, stroke: string, behind = 0): void {
    this.pieces_.push({
      depth: this.depth(points) - behind,
      paint: (c) => {
        this.outline(c, points);
        c.fillStyle = fill;
        c.fill();
        this.stroke(c, stroke, 0.8);
      },
    });
  }

  private add_borders({ kind, colour }: (typeof BORDERS)[number], look: Look): void {
    const { space, pose } = this.input_;
    const fill = shaded(rgb(colour(look.ink)), 1, BORDER_OPACITY);
    for (const border of space.borders) {
      if (border.kind !== kind) continue;
      for (let t = 0; t < border.triangles.length; t += 3) {
        const corners = border.triangles.slice(t, t + 3).map((i) => pose.at(i));
        if (dot(normal_of(corners), this.frame.out) <= 0) continue;
        // Just before the ground that it covers.
        this.pieces_.push({
          depth: this.depth(corners) - BEHIND + 1e-3 * this.size_,
          paint: (c) => {
            this.outline(c, corners);
            c.fillStyle = fill;
            c.fill();
          },
        });
      }
    }
  }

  private add_plate(index: number, look: Look): void {
    const flat = this.input_.pose.plates[index] as Float32Array;
    const n = flat.length / 6;
    const bottom = Array.from({ length: n }, (_, i) => point(flat, i));
    const top = Array.from({ length: n }, (_, i) => point(flat, n + i));
    const sides = bottom.map((p, i) => [p, bottom[(i + 1) % n] as Vec3, top[(i + 1) % n] as Vec3, top[i] as Vec3]);
    for (const face of [[...bottom].reverse(), top, ...sides]) {
      const normal = normal_of(face);
      if (dot(normal, this.frame.out) > 0) this.add_polygon(face, shaded(rgb(look.ink.body), this.light(normal), 1), look.ink.edge);
    }
  }

  private add_gap({ skin, upper, lower, opening }: FacePose, index: number, look: Look): void {
    const range = this.input_.largest_opening(index) || 1;
    for (let t = 0; 3 * t < skin.triangles.length; t++) {
      const vertices = skin.triangles.slice(3 * t, 3 * t + 3);
      const corners = vertices.map((v) => point(upper, v)) as [Vec3, Vec3, Vec3];
      const mean = vertices.reduce((sum, v) => sum + (opening[v] as number), 0) / 3;
      // Seen from below only: from above the structure covers it.
      if (dot(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])), this.frame.out) > 0) continue;
      const fill = mean > 0 ? look.ink.gap.css(mean / range) : look.ink.closed;
      this.add_polygon(corners, fill, fill, BEHIND / 2);
    }
    for (let i = 0; i < skin.rim.length; i += 2) {
      const [a, b] = [skin.rim[i] as number, skin.rim[i + 1] as number];
      if ((opening[a] as number) <= 0 && (opening[b] as number) <= 0) continue;
      const fill = shaded(rgb(look.ink.open), 1, 0.6);
      this.add_polygon([point(upper, a), point(upper, b), point(lower, b), point(lower, a)], fill, fill, BEHIND / 2);
    }
  }

  private add_lines(look: Look): void {
    for (const line of this.input_.space.lines) {
      for (let i = 1; i < line.nodes.length; i++) {
        const ends = [this.input_.pose.at(line.nodes[i - 1] as number), this.input_.pose.at(line.nodes[i] as number)];
        this.pieces_.push({
          depth: this.depth(ends),
          paint: (c) => {
            c.beginPath();
            for (const p of ends) c.lineTo(...project(this.frame, p));
            c.lineCap = "round";
            this.stroke(c, look.ink.steel, 3.5);
          },
        });
      }
    }
  }

  private add_dot(at: Vec3, radius: number, fill: string, stroke: string): void {
    this.pieces_.push({
      depth: this.depth([at]) + radius / this.frame.scale,
      paint: (c) => {
        c.beginPath();
        c.arc(...project(this.frame, at), radius, 0, 2 * Math.PI);
        c.fillStyle = fill;
        c.fill();
        this.stroke(c, stroke, 1);
      },
    });
  }

  private add_masses(look: Look): void {
    const { space, pose } = this.input_;
    const largest = Math.max(...space.masses.map((m) => m.mass), 0) || 1;
    const size = MASS_SIZE * this.size_ * this.frame.scale;
    for (const { node, mass } of space.masses) this.add_dot(pose.at(node), size * Math.max(0.3, Math.cbrt(Math.max(0, mass) / largest)), look.ink.mass, look.ink.card);
  }

  private add_supports(look: Look): void {
    for (const { node } of this.input_.space.supports) this.add_dot(this.input_.pose.at(node), 2, look.ink.soft, look.ink.soft);
  }

  private draw_reference(look: Look): void {
    const c = this.context_;
    c.setLineDash([3, 3]);
    c.beginPath();
    for (const line of this.reference_) line.forEach((p, i) => (i === 0 ? c.moveTo(...project(this.frame, p)) : c.lineTo(...project(this.frame, p))));
    this.stroke(c, look.ink.soft, 0.8);
    c.setLineDash([]);
  }
}

/** Lines of the structure before loading: sharp edges, beams, plates. */
function reference_lines({ space, layers }: ViewInput): Vec3[][] {
  const lines: Vec3[][] = [];
  space.parts.forEach((part, index) => {
    if (layers.find((layer) => layer.key === `part ${index}`)?.ground) return;
    const sharp = sharp_edges(space.nodes, part.triangles);
    for (let i = 0; i < sharp.length; i += 2) lines.push([point(space.nodes, sharp[i] as number), point(space.nodes, sharp[i + 1] as number)]);
  });
  for (const line of space.lines) lines.push(line.nodes.map((i) => point(space.nodes, i)));
  for (const body of space.bodies) {
    const { bottom, top } = plate_of(space, body);
    for (const ring of [bottom, top]) lines.push([...ring, ring[0] as Vec3]);
  }
  return lines;
}
