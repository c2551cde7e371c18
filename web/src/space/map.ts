// The map of one quantity over the plan of one interface, on a plain canvas: works without WebGL.
import { h } from "../dom";
import { pick_scale } from "../format";
import { linear_ticks, tick_labels } from "../ticks";
import { rgb, type Ink } from "./ink";
import { boundary, Colours, fill_triangles, type Plan, type Quantity, type Range } from "./raster";
import { rim_edges } from "./shape";
import type { SpaceInterface } from "../space_types";

const LEFT = 44;
const BAR_GAP = 14;
const BAR = 11;
const RIGHT = BAR_GAP + BAR + 44;
const TOP = 8;
const BOTTOM = 34;
const MIN_PLAN_HEIGHT = 74;
const FONT = '11px system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif';

const TITLES: Record<Quantity, { name: string; unit: string }> = {
  gap: { name: "Gap", unit: "m" },
  pressure: { name: "Pressure", unit: "Pa" },
  slip: { name: "Slip", unit: "m" },
};

export interface Values {
  openings: number[];
  values: number[];
  /** Point that the reader looks at. */
  marked: number | null;
}

export class PlanMap {
  readonly element: HTMLElement;
  readonly quantity: Quantity;
  readonly canvas = h("canvas", { class: "plan-map" });
  private readonly face_: SpaceInterface;
  private readonly range_: Range;
  private readonly rim_: number[];
  /** Of the plan: [smin, smax, tmin, tmax]. */
  private readonly reach_: [number, number, number, number];
  private width_ = 0;
  private highest_ = 0;
  private density_ = 1;

  constructor(face: SpaceInterface, quantity: Quantity, range: Range) {
    this.face_ = face;
    this.quantity = quantity;
    this.range_ = range;
    this.rim_ = rim_edges(face.triangles);
    this.reach_ = this.find_reach();
    const { name, unit } = TITLES[quantity];
    const scale = pick_scale(Math.max(range.high, -range.low), unit);
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${name} of ${face.name} in plan`);
    this.element = h("div", { class: `plan plan-${quantity}` }, h("h4", {}, `${name} (${scale.unit})`), this.canvas);
  }

  /** Width in CSS pixels; the height follows from the plan, which is not drawn higher than `highest`. */
  resize(width: number, highest: number, density: number): void {
    this.width_ = width;
    this.highest_ = highest;
    this.density_ = density;
    const height = Math.ceil(this.height());
    this.canvas.width = Math.round(width * density);
    this.canvas.height = Math.round(height * density);
    this.canvas.style.aspectRatio = `${width} / ${height}`;
  }

  draw({ openings, values, marked }: Values, ink: Ink): void {
    const context = this.canvas.getContext("2d");
    if (!context || this.width_ === 0) return;
    const colours = new Colours(this.quantity, this.range_, ink, rgb(ink.closed));
    context.setTransform(this.density_, 0, 0, this.density_, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.font = FONT;
    if (this.face_.triangles.length > 0) this.draw_triangles(context, openings, values, colours, ink);
    else this.draw_squares(context, openings, values, colours, ink);
    this.draw_axes(context, ink);
    this.draw_bar(context, colours, ink);
    if (marked !== null) this.draw_mark(context, marked, ink);
  }

  /** The point nearest to a place of the canvas (CSS pixels), or null when none is near. */
  point_at(x: number, y: number): number | null {
    const grown = this.width_ / (this.canvas.clientWidth || 1);
    let best: number | null = null;
    let distance = 24 * grown;
    this.face_.area.forEach((_a, i) => {
      const [px, py] = this.at(this.s(i), this.t(i));
      const d = Math.hypot(px - x * grown, py - y * grown);
      if (d < distance) [best, distance] = [i, d];
    });
    return best;
  }

  private s(i: number): number {
    return this.face_.plan[2 * i] ?? 0;
  }

  private t(i: number): number {
    return this.face_.plan[2 * i + 1] ?? 0;
  }

  private half(i: number): number {
    return this.face_.triangles.length > 0 ? 0 : Math.sqrt(Math.max(0, this.face_.area[i] ?? 0)) / 2;
  }

  private find_reach(): [number, number, number, number] {
    const box: [number, number, number, number] = [Infinity, -Infinity, Infinity, -Infinity];
    this.face_.area.forEach((_a, i) => {
      const [s, t, half] = [this.s(i), this.t(i), this.half(i)];
      box[0] = Math.min(box[0], s - half);
      box[1] = Math.max(box[1], s + half);
      box[2] = Math.min(box[2], t - half);
      box[3] = Math.max(box[3], t + half);
    });
    return box;
  }

  private scale(): number {
    const [s0, s1, t0, t1] = this.reach_;
    return Math.min((this.width_ - LEFT - RIGHT) / (s1 - s0 || 1), this.highest_ / (t1 - t0 || 1));
  }

  private height(): number {
    const [, , t0, t1] = this.reach_;
    return TOP + BOTTOM + Math.max(MIN_PLAN_HEIGHT, this.scale() * (t1 - t0));
  }

  /** Canvas place of a point of the plan. */
  private at(s: number, t: number): [number, number] {
    const [s0, , t0, t1] = this.reach_;
    const spare = this.height() - TOP - BOTTOM - this.scale() * (t1 - t0);
    return [LEFT + this.scale() * (s - s0), TOP + spare / 2 + this.scale() * (t1 - t)];
  }

  private draw_triangles(c: CanvasRenderingContext2D, openings: number[], values: number[], colours: Colours, ink: Ink): void {
    const places = this.face_.area.map((_a, i) => this.at(this.s(i), this.t(i)));
    const plan: Plan = { x: places.map((p) => p[0]), y: places.map((p) => p[1]), triangles: this.face_.triangles };
    const image = c.createImageData(this.canvas.width, this.canvas.height);
    fill_triangles(image, plan, this.density_, values, colours);
    c.putImageData(image, 0, 0);
    c.beginPath();
    for (let i = 0; i < this.rim_.length; i += 2) {
      c.moveTo(...(places[this.rim_[i] as number] as [number, number]));
      c.lineTo(...(places[this.rim_[i + 1] as number] as [number, number]));
    }
    this.stroke(c, ink.soft, 1);
    c.beginPath();
    for (const [x1, y1, x2, y2] of boundary(plan, openings)) {
      c.moveTo(x1, y1);
      c.lineTo(x2, y2);
    }
    this.stroke(c, ink.card, 4);
    this.stroke(c, ink.boundary, 1.7);
  }

  // Closed squares, then the open ones over the line around each: of the lines only those around open areas remain.
  private draw_squares(c: CanvasRenderingContext2D, openings: number[], values: number[], colours: Colours, ink: Ink): void {
    const square = (i: number): [number, number, number, number] => {
      const half = this.half(i) * this.scale();
      const [x, y] = this.at(this.s(i), this.t(i));
      // On whole pixels neighbours leave no seam.
      const snap = (v: number): number => Math.round(v * this.density_) / this.density_;
      const [left, top] = [snap(x - half), snap(y - half)];
      return [left, top, snap(x + half) - left, snap(y + half) - top];
    };
    const points = this.face_.area.map((_a, i) => i);
    const open = points.filter((i) => (openings[i] ?? 0) > 0);
    const fill = (list: number[]): void =>
      list.forEach((i) => {
        c.fillStyle = `rgb(${colours.at(values[i] ?? 0).join()})`;
        c.fillRect(...square(i));
      });
    fill(points);
    for (const [colour, width] of [[ink.card, 5], [ink.boundary, 2.6]] as [string, number][]) {
      c.beginPath();
      open.forEach((i) => c.rect(...square(i)));
      if (open.length > 0) this.stroke(c, colour, width);
    }
    fill(open);
  }

  private stroke(c: CanvasRenderingContext2D, colour: string, width: number): void {
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.lineCap = "round";
    c.lineJoin = "round";
    c.stroke();
  }

  private draw_axes(c: CanvasRenderingContext2D, ink: Ink): void {
    const [s0, s1, t0, t1] = this.reach_;
    const [left, low] = this.at(s0, t0);
    const [right, high] = this.at(s1, t1);
    c.fillStyle = ink.soft;
    const ticks = (from: number, to: number, size: number): { at: number; label: string }[] => {
      const list = linear_ticks(from, to, size < 40 ? 1 : Math.max(3, size / 45));
      const labels = tick_labels(list, false);
      return list.map((at, i) => ({ at, label: labels[i] as string }));
    };
    c.beginPath();
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const { at, label } of ticks(s0, s1, right - left)) {
      const [x] = this.at(at, t0);
      c.moveTo(x, low + 3);
      c.lineTo(x, low + 7);
      c.fillText(label, x, low + 9);
    }
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const { at, label } of ticks(t0, t1, low - high)) {
      const [, y] = this.at(s0, at);
      c.moveTo(left - 3, y);
      c.lineTo(left - 7, y);
      c.fillText(label, left - 10, y);
    }
    this.stroke(c, ink.line, 1);
    c.textAlign = "center";
    c.textBaseline = "alphabetic";
    c.fillText(`${this.face_.axes[0]} (m)`, (left + right) / 2, low + 31);
    c.save();
    c.translate(10, (low + high) / 2);
    c.rotate(-Math.PI / 2);
    c.fillText(`${this.face_.axes[1]} (m)`, 0, 0);
    c.restore();
  }

  private draw_bar(c: CanvasRenderingContext2D, colours: Colours, ink: Ink): void {
    const { low, high, over } = this.range_;
    const x = this.at(this.reach_[1], 0)[0] + BAR_GAP;
    const [top, bottom] = [TOP + (over ? 9 : 0), this.height() - BOTTOM];
    const span = high - low || 1;
    const y = (value: number): number => bottom - ((value - low) / span) * (bottom - top);
    for (let row = Math.round(top); row < bottom; row++) {
      const value = low + ((bottom - row - 0.5) / (bottom - top)) * span;
      c.fillStyle = `rgb(${colours.at(value).join()})`;
      c.fillRect(x, row, BAR, 1);
    }
    if (over) {
      c.beginPath();
      c.moveTo(x, top);
      c.lineTo(x + BAR / 2, top - 9);
      c.lineTo(x + BAR, top);
      c.fillStyle = `rgb(${colours.at(high).join()})`;
      c.fill();
    }
    c.beginPath();
    c.rect(x + 0.5, Math.round(top) + 0.5, BAR - 1, bottom - Math.round(top) - 1);
    this.stroke(c, ink.line, 1);
    const scale = pick_scale(Math.max(high, -low), TITLES[this.quantity].unit);
    const ticks = linear_ticks(low / scale.factor, high / scale.factor, (bottom - top) / 34);
    c.fillStyle = ink.soft;
    c.textAlign = "left";
    c.textBaseline = "middle";
    if (high > low) tick_labels(ticks, false).forEach((label, i) => c.fillText(label, x + BAR + 5, y((ticks[i] as number) * scale.factor)));
    else c.fillText("0", x + BAR + 5, bottom - 4);
  }

  private draw_mark(c: CanvasRenderingContext2D, point: number, ink: Ink): void {
    c.beginPath();
    c.arc(...this.at(this.s(point), this.t(point)), 5, 0, 2 * Math.PI);
    this.stroke(c, ink.card, 4);
    this.stroke(c, ink.text, 1.6);
  }
}
