// Symbols of mechanics for the model drawing: arrows, springs, dashpots, supports, hatched ground, labels.
import { s, px } from "./dom";
import type { Point } from "./geometry";

export const path_of = (points: Point[], close = false): string =>
  points.map(([x, y], i) => `${i === 0 ? "M" : "L"}${px(x)} ${px(y)}`).join("") + (close ? "Z" : "");

/** Arrow between two points; the head lies at `to`. */
export function arrow(from: Point, to: Point, head: number, cls: string): SVGElement {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]) || 1;
  const [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  const back: Point = [to[0] - ux * head, to[1] - uy * head];
  const half = head * 0.42;
  const tip = path_of([to, [back[0] - uy * half, back[1] + ux * half], [back[0] + uy * half, back[1] - ux * half]], true);
  return s("g", { class: cls }, s("path", { class: "shaft", d: path_of([from, back]) }), s("path", { class: "head", d: tip }));
}

/** Zigzag of a spring, or cylinder and piston of a dashpot, between two points. */
export function spring(a: Point, b: Point, kind: "spring" | "dashpot"): SVGElement {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  const [ux, uy] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
  const at = (along: number, across: number): Point => [
    a[0] + ux * along * length - uy * across,
    a[1] + uy * along * length + ux * across,
  ];
  if (kind === "spring") {
    const turns = [0.2, 0.26, 0.38, 0.5, 0.62, 0.74, 0.8];
    const zig = turns.map((t, i) => at(t, i === 0 || i === turns.length - 1 ? 0 : i % 2 === 0 ? -5 : 5));
    return s("path", { class: "spring", d: path_of([a, ...zig, b]) });
  }
  const cup = path_of([at(0.62, -6), at(0.38, -6), at(0.38, 6), at(0.62, 6)]);
  return s("path", { class: "spring", d: path_of([a, at(0.38, 0)]) + cup + path_of([at(0.54, -4), at(0.54, 4)]) + path_of([at(0.54, 0), b]) });
}

/** Hatched strip below a line (picture coordinates; "below" is to the right of a→b turned clockwise). */
export function hatched(a: Point, b: Point, depth: number, cls = "hatch"): SVGElement {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  const [ux, uy] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
  let d = "";
  for (let along = depth * 0.5; along <= length; along += 8) {
    const foot: Point = [a[0] + ux * along, a[1] + uy * along];
    const end: Point = [foot[0] - ux * depth * 0.8 - uy * depth, foot[1] - uy * depth * 0.8 + ux * depth];
    d += path_of([foot, end]);
  }
  return s("g", { class: cls }, s("path", { class: "hatch-lines", d }), s("path", { class: "hatch-edge", d: path_of([a, b]) }));
}

/** Symbol of the blocked motions at a node. */
export function support([x, y]: Point, dofs: string[]): SVGElement {
  const [ux, uy, rz] = ["ux", "uy", "rz"].map((dof) => dofs.includes(dof));
  const g = s("g", { class: "support" });
  if (ux && uy && rz) {
    g.append(hatched([x - 16, y], [x + 16, y], 8));
  } else if (uy) {
    g.append(s("path", { d: path_of([[x, y], [x - 8, y + 13], [x + 8, y + 13]], true) }));
    if (ux) g.append(hatched([x - 13, y + 13], [x + 13, y + 13], 6));
    else g.append(s("circle", { cx: px(x - 4), cy: px(y + 16), r: 2.6 }), s("circle", { cx: px(x + 4), cy: px(y + 16), r: 2.6 }), hatched([x - 13, y + 19], [x + 13, y + 19], 6));
  } else if (ux) {
    g.append(
      s("path", { d: path_of([[x, y], [x - 13, y - 8], [x - 13, y + 8]], true) }),
      s("circle", { cx: px(x - 16), cy: px(y - 4), r: 2.6 }),
      s("circle", { cx: px(x - 16), cy: px(y + 4), r: 2.6 }),
      hatched([x - 19, y - 13], [x - 19, y + 13], 6),
    );
  } else if (rz) {
    g.append(s("rect", { x: px(x - 6), y: px(y - 6), width: 12, height: 12 }));
  }
  return g;
}

// Of a label in the units of the drawing: height of its line, width of a character (an upper bound for the sans-serif fonts of browsers).
const LINE = 13;
const CHARACTER = 6.6;
// How much farther from its anchor a label may stand, and from where on a line leads to it.
const DISTANCES = [0, 8, 18, 30, 44, 60];
const LEADER = 8;

interface Rect {
  x: number;
  y: number;
  w: number;
  t: number;
}

/** Puts labels where they hide neither symbols nor each other. */
export class Labels {
  private readonly taken_: Rect[] = [];
  private readonly width_: number;
  private readonly height_: number;

  constructor(width: number, height: number) {
    this.width_ = width;
    this.height_ = height;
  }

  /** Keeps a square of half-width `half` about a point free. */
  block([x, y]: Point, half: number): void {
    this.taken_.push({ x: x - half, y: y - half, w: 2 * half, t: 2 * half });
  }

  block_line(a: Point, b: Point): void {
    const steps = Math.max(1, Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1]) / 8));
    for (let i = 0; i <= steps; i++) {
      this.block([a[0] + ((b[0] - a[0]) * i) / steps, a[1] + ((b[1] - a[1]) * i) / steps], 3);
    }
  }

  /**
   * A label near an anchor, at least `away` units from it. Farther away a thin line leads to it. Nothing where no position is free: the
   * symbol's tooltip holds the same text.
   */
  place(anchor: Point, away: number, content: string, cls: string): SVGElement | null {
    const w = content.length * CHARACTER + 2;
    for (const farther of DISTANCES) {
      const box = this.candidates(anchor, away + 3 + farther, w).find((r) => this.free(r));
      if (!box) continue;
      this.taken_.push(box);
      const text = s("text", { class: cls, x: px(box.x + 1), y: px(box.y + 10.5) }, content);
      if (farther < LEADER) return text;
      const end: Point = [Math.max(box.x, Math.min(anchor[0], box.x + w)), Math.max(box.y, Math.min(anchor[1], box.y + LINE))];
      return s("g", {}, s("path", { class: "leader", d: path_of([anchor, end]) }), text);
    }
    return null;
  }

  /** A label inside of a rectangle from `low` to `high`: at its left, middle or right, as near to half of its height as is free. */
  place_inside(low: Point, high: Point, content: string, cls: string): SVGElement | null {
    const w = content.length * CHARACTER + 2;
    const spare = high[0] - low[0] - w;
    const middle = (low[1] + high[1]) / 2;
    const reach = (high[1] - low[1] - LINE) / 2;
    for (let farther = 0; spare >= 0 && farther <= Math.max(0, reach); farther += 6) {
      for (const y of farther > 0 ? [middle + farther, middle - farther] : [middle]) {
        const box = [0.03, 0.5, 0.97, 0.27, 0.73].map((share) => ({ x: low[0] + share * spare, y: y - LINE / 2, w, t: LINE })).find((r) => this.free(r));
        if (!box) continue;
        this.taken_.push(box);
        return s("text", { class: cls, x: px(box.x + 1), y: px(box.y + 10.5) }, content);
      }
    }
    return null;
  }

  private candidates([x, y]: Point, d: number, w: number): Rect[] {
    const corners: Point[] = [
      [x + d, y - LINE / 2],
      [x - d - w, y - LINE / 2],
      [x + d * 0.8, y - d * 0.8 - LINE],
      [x - d * 0.8 - w, y - d * 0.8 - LINE],
      [x + d * 0.8, y + d * 0.8],
      [x - d * 0.8 - w, y + d * 0.8],
      [x - w / 2, y - d - LINE],
      [x - w / 2, y + d],
    ];
    return corners.map(([left, top]) => ({ x: left, y: top, w, t: LINE }));
  }

  private free(r: Rect): boolean {
    if (r.x < 2 || r.y < 2 || r.x + r.w > this.width_ - 2 || r.y + r.t > this.height_ - 2) return false;
    return this.taken_.every((q) => r.x + r.w < q.x || q.x + q.w < r.x || r.y + r.t < q.y || q.y + q.t < r.y);
  }
}
