// Values over a plan: colours interpolated over triangles, and the line where the opening passes zero.
import type { Ink, Ramp, Rgb } from "./ink";

/** What a colour stands for, SI. `high` and `low` end the bar; values beyond are drawn in the colour of the end. */
export interface Range {
  low: number;
  high: number;
  /** Some values lie beyond `high`. */
  over: boolean;
}

// So many values tell what most of them are.
const MANY = 1e5;

/** A single spike must not make all else pale: the bar ends at the 99.5 % of the non-zero values when the peak is far above. */
export function range_of(values: number[]): Range {
  const low = values.reduce((m, v) => Math.min(m, v), 0);
  const peak = values.reduce((m, v) => Math.max(m, v), 0);
  const stride = Math.ceil(values.length / MANY);
  const sizes = values.filter((v, i) => v > 0 && i % stride === 0).sort((a, b) => a - b);
  const most = sizes[Math.floor(0.995 * (sizes.length - 1))] ?? peak;
  return peak > 1.6 * most ? { low, high: most, over: true } : { low, high: peak, over: false };
}

export type Quantity = "gap" | "pressure" | "slip";

/** Colours of one quantity: a ramp above zero, for pressures another below, and one colour for closed points in the map of gaps. */
export class Colours {
  private readonly size_: number;
  private readonly above_: Ramp;
  private readonly below_: Ramp;
  private readonly closed_: Rgb | null;

  constructor(quantity: Quantity, range: Range, ink: Ink, closed: Rgb) {
    this.size_ = Math.max(range.high, -range.low) || 1;
    this.above_ = ink[quantity];
    this.below_ = ink.tension;
    this.closed_ = quantity === "gap" ? closed : null;
  }

  at(value: number): Rgb {
    if (this.closed_ && !(value > 0)) return this.closed_;
    return value >= 0 ? this.above_.at(value / this.size_) : this.below_.at(-value / this.size_);
  }
}

export interface Plan {
  /** Picture places of the points. */
  x: number[];
  y: number[];
  triangles: number[];
}

/** Fills the triangles into an image whose pixel (0, 0) lies at the picture's origin; `density` pixels per picture unit. */
export function fill_triangles(image: ImageData, plan: Plan, density: number, values: number[], colours: Colours): void {
  for (let t = 0; t < plan.triangles.length; t += 3) {
    const [i, j, k] = [plan.triangles[t] as number, plan.triangles[t + 1] as number, plan.triangles[t + 2] as number];
    const place = (n: number): [number, number] => [(plan.x[n] as number) * density - 0.5, (plan.y[n] as number) * density - 0.5];
    const [[ax, ay], [bx, by], [cx, cy]] = [place(i), place(j), place(k)];
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    if (area === 0) continue;
    const [va, vb, vc] = [values[i] ?? 0, values[j] ?? 0, values[k] ?? 0];
    const left = Math.max(0, Math.ceil(Math.min(ax, bx, cx)));
    const right = Math.min(image.width - 1, Math.floor(Math.max(ax, bx, cx)));
    const bottom = Math.min(image.height - 1, Math.floor(Math.max(ay, by, cy)));
    for (let y = Math.max(0, Math.ceil(Math.min(ay, by, cy))); y <= bottom; y++) {
      for (let x = left; x <= right; x++) {
        const b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
        const c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
        // A little beyond the sides, so that neighbours leave no seam.
        if (b < -1e-6 || c < -1e-6 || b + c > 1 + 1e-6) continue;
        const at = 4 * (y * image.width + x);
        const colour = colours.at(va + b * (vb - va) + c * (vc - va));
        image.data[at] = colour[0];
        image.data[at + 1] = colour[1];
        image.data[at + 2] = colour[2];
        image.data[at + 3] = 255;
      }
    }
  }
}

/** Pieces [x1, y1, x2, y2] of the line between open (opening > 0) and closed points. */
export function boundary(plan: Plan, openings: number[]): [number, number, number, number][] {
  const pieces: [number, number, number, number][] = [];
  for (let t = 0; t < plan.triangles.length; t += 3) {
    const corners = [0, 1, 2].map((k) => plan.triangles[t + k] as number);
    const crossings: [number, number][] = [];
    corners.forEach((i, k) => {
      const j = corners[(k + 1) % 3] as number;
      const [gi, gj] = [openings[i] ?? 0, openings[j] ?? 0];
      if (gi > 0 === gj > 0) return;
      const along = gi / (gi - gj);
      crossings.push([(plan.x[i] as number) + along * ((plan.x[j] as number) - (plan.x[i] as number)), (plan.y[i] as number) + along * ((plan.y[j] as number) - (plan.y[i] as number))]);
    });
    const [p, q] = crossings;
    if (p && q) pieces.push([...p, ...q]);
  }
  return pieces;
}
