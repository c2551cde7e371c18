// Tick positions and their labels, shared by the screen (uPlot) and the SVG writer so that both agree.
import { fixed, scientific } from "./format";

/** Multiples of 1, 2 or 5 times a power of ten inside [min, max], about `count` of them; two at least, without which an axis has no scale. */
export function linear_ticks(min: number, max: number, count: number): number[] {
  const span = max - min;
  if (!(span > 0) || !Number.isFinite(span)) return [min];
  const raw = span / Math.max(1, count);
  const power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = ([1, 2, 5, 10].find((m) => m * power >= raw * 0.999) ?? 10) * power;
  const ticks: number[] = [];
  const first = Math.ceil(min / step - 1e-9);
  const last = Math.floor(max / step + 1e-9);
  for (let i = first; i <= last; i++) ticks.push(i * step);
  return ticks.length < 2 ? linear_ticks(min, max, 2 * Math.max(1, count)) : ticks;
}

/** Powers of ten inside [min, max], thinned to about `count`; with 2 and 5 when less than two decades show. */
export function log_ticks(min: number, max: number, count: number): number[] {
  if (!(min > 0) || !(max > min)) return [];
  const low = Math.floor(Math.log10(min) + 1e-9);
  const high = Math.ceil(Math.log10(max) - 1e-9);
  const decades = high - low;
  const stride = Math.max(1, Math.ceil(decades / Math.max(1, count)));
  const steps = decades <= 2 ? [1, 2, 5] : [1];
  const ticks: number[] = [];
  for (let e = low; e <= high; e += stride) {
    for (const m of steps) {
      const value = m * Math.pow(10, e);
      if (value >= min * (1 - 1e-9) && value <= max * (1 + 1e-9)) ticks.push(value);
    }
  }
  return ticks;
}

/** Plain numbers while all are short, else powers of ten throughout. */
function log_labels(ticks: number[]): string[] {
  if (ticks.every((t) => t > 0.9e-3 && t < 1.1e3)) return ticks.map((t) => String(Number(t.toPrecision(3))));
  return ticks.map((t) => (t > 0.99 && t < 1.01 ? "1" : scientific(t, 1)));
}

/** Labels of ticks given in shown units. */
export function tick_labels(ticks: number[], log: boolean): string[] {
  if (log) return log_labels(ticks);
  if (ticks.length === 0) return [];
  const step = ticks.length > 1 ? Math.abs((ticks[1] ?? 0) - (ticks[0] ?? 0)) : Math.abs(ticks[0] ?? 1) || 1;
  const largest = Math.max(...ticks.map(Math.abs));
  if (largest >= 1e5 || largest < 1e-3) {
    const digits = Math.max(1, Math.ceil(Math.log10(largest / step) - 1e-9) + 1);
    return ticks.map((t) => (t === 0 ? "0" : scientific(t, Math.min(digits, 4))));
  }
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return ticks.map((t) => fixed(t, decimals));
}
