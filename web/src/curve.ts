// A curve as arrays, and how it is traced on any surface with moveTo/lineTo (canvas or SVG).
// uPlot's own paths want one shared, increasing x; moment-rotation loops have neither, so curves are traced here.
import type { Series, SeriesStyle } from "./types";

export interface Extent {
  min: number;
  max: number;
}

export interface View {
  xmin: number;
  xmax: number;
  ymin: number;
  ymax: number;
}

/** Where curves are traced: a canvas context, a Path2D or the SVG writer. */
export interface Pen {
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
}

/** Maps data to pixels. */
export interface Projection {
  x(value: number): number;
  y(value: number): number;
  /** Left edge and width of the plot in the same pixels. */
  left: number;
  width: number;
}

function to_array(values: (number | null)[], length: number): Float64Array {
  const out = new Float64Array(length);
  for (let i = 0; i < length; i++) out[i] = values[i] ?? NaN;
  return out;
}

function increasing(x: Float64Array): boolean {
  let last = -Infinity;
  for (const value of x) {
    if (Number.isNaN(value)) continue;
    if (value < last) return false;
    last = value;
  }
  return true;
}

/** Finite range of values; `positive` leaves out what a logarithmic axis cannot show. */
export function extent_of(values: Float64Array, positive: boolean): Extent {
  let min = Infinity;
  let max = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value) || (positive && value <= 0)) continue;
    if (value < min) min = value;
    if (value > max) max = value;
  }
  return { min, max };
}

export class Curve {
  readonly label: string;
  readonly run: string | undefined;
  readonly failed: boolean;
  readonly style: SeriesStyle | undefined;
  readonly x: Float64Array;
  readonly y: Float64Array;
  readonly length: number;
  /** x never decreases: a history, not a loop. */
  readonly monotone: boolean;
  readonly xrange: Extent;
  readonly yrange: Extent;
  slot = 0;
  dash: number[] = [];
  hidden: boolean;

  constructor(series: Series, xlog: boolean, ylog: boolean) {
    this.label = series.label;
    this.run = series.run;
    this.failed = series.failed ?? false;
    this.style = series.style;
    this.hidden = series.hidden ?? false;
    this.length = Math.min(series.x.length, series.y.length);
    this.x = to_array(series.x, this.length);
    this.y = to_array(series.y, this.length);
    this.monotone = increasing(this.x);
    this.xrange = extent_of(this.x, xlog);
    this.yrange = extent_of(this.y, ylog);
  }
}

/** Index of the first x that is not below `value` (x increasing). */
export function lower_bound(x: Float64Array, value: number): number {
  let low = 0;
  let high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((x[middle] as number) < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Far outside the picture the exact position does not matter, but surfaces lose precision there.
const FAR = 2e5;
const near = (value: number): number => (value > FAR ? FAR : value < -FAR ? -FAR : value);

/** Every point, leaving out those closer than a fraction of a pixel to the last one drawn. */
function trace_points(curve: Curve, map: Projection, pen: Pen, from: number, to: number): void {
  let down = false;
  let lastx = NaN;
  let lasty = NaN;
  let skipped = false;
  for (let i = from; i < to; i++) {
    const px = near(map.x(curve.x[i] as number));
    const py = near(map.y(curve.y[i] as number));
    if (Number.isNaN(px) || Number.isNaN(py)) {
      down = false;
      continue;
    }
    skipped = down && Math.abs(px - lastx) < 0.35 && Math.abs(py - lasty) < 0.35;
    if (skipped && i < to - 1) continue;
    if (down) pen.lineTo(px, py);
    else pen.moveTo(px, py);
    down = true;
    lastx = px;
    lasty = py;
  }
}

/** First, lowest, highest and last point of each pixel column: what a dense history looks like. */
function trace_columns(curve: Curve, map: Projection, pen: Pen, from: number, to: number): void {
  let down = false;
  let column = NaN;
  let low = 0;
  let high = 0;
  let last = 0;
  const flush = (): void => {
    if (Number.isNaN(column)) return;
    if (low !== last) pen.lineTo(column, low);
    if (high !== low) pen.lineTo(column, high);
    if (last !== high) pen.lineTo(column, last);
  };
  for (let i = from; i < to; i++) {
    const px = near(map.x(curve.x[i] as number));
    const py = near(map.y(curve.y[i] as number));
    if (Number.isNaN(px) || Number.isNaN(py)) {
      flush();
      column = NaN;
      down = false;
      continue;
    }
    const next = Math.round(px * 2) / 2;
    if (next !== column) {
      flush();
      if (down) pen.lineTo(next, py);
      else pen.moveTo(next, py);
      down = true;
      column = next;
      low = high = last = py;
    } else {
      low = Math.min(low, py);
      high = Math.max(high, py);
      last = py;
    }
  }
  flush();
}

/** Traces the part of the curve that the view shows. */
export function trace(curve: Curve, view: View, map: Projection, pen: Pen): void {
  let from = 0;
  let to = curve.length;
  if (curve.monotone) {
    from = Math.max(0, lower_bound(curve.x, view.xmin) - 1);
    to = Math.min(curve.length, lower_bound(curve.x, view.xmax) + 2);
    if (to - from > 4 * map.width) {
      trace_columns(curve, map, pen, from, to);
      return;
    }
  }
  trace_points(curve, map, pen, from, to);
}

/** Few points are a table of results rather than a history: they get markers. */
export function has_markers(curve: Curve): boolean {
  if (curve.style) return curve.style === "points";
  return curve.length > 0 && curve.length <= 40;
}

export const BAND_OPACITY = 0.17;
export const THIN_OPACITY = 0.5;

/** Order of drawing: bands and thin curves lie below the others, failed curves below the sound ones. */
export function below_first(curves: Curve[]): Curve[] {
  const height = ({ style, failed }: Curve): number => (style === "band" ? 0 : style === "thin" ? 1 : failed ? 2 : 3);
  return [...curves].sort((a, b) => height(a) - height(b));
}
