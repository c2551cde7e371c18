// Numbers of the verdict as text, by the rules of the terminal (src/uplift/base/format.cpp and verdict_quantities.cpp): three significant
// digits, shares in per cent, and 0 for what is below the precision of a run.
import { scientific } from "./format";
import type { Quantity, ResultNumber } from "./summary";

/** A gap, force, ... below this is smaller than the precision of a run. */
function negligible(unit: string): number {
  if (["m", "rad", "N", "N m", "N s", "Pa"].includes(unit)) return 1e-9;
  return unit === "1" ? 1e-6 : 0;
}

/** Decimals that show so many significant digits of a size. */
function decimals_of(size: number, significant: number): number {
  return Math.min(6, Math.max(0, significant - 1 - Math.floor(Math.log10(size * 1.0005))));
}

/** Three significant digits; powers of ten outside 1e-6 to 1e5. */
function digits(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size < 1e-6 || size >= 1e5 ? scientific(value, 3) : value.toFixed(decimals_of(size, 3));
}

/** So many significant digits, without zeros at the end: "12.5", "0.1". */
export function significant(value: number, count: number): string {
  return String(Number(value.toPrecision(count)));
}

interface Prefix {
  factor: number;
  text: string;
}
const PREFIXES: Prefix[] = [{ factor: 1e9, text: "G" }, { factor: 1e6, text: "M" }, { factor: 1e3, text: "k" }, { factor: 1, text: "" }, { factor: 1e-3, text: "m" }];
const SMALL_ONLY = ["m", "rad", "s", "m/s", "rad/s"];
const SCALED = [...SMALL_ONLY, "N", "N m", "Pa", "J", "Pa/m", "N/m"];

/** The prefix in which a size reads well. Lengths and angles stay in m and rad down to a tenth: 0.5 m, but 35.9 mm. */
function prefix_of(magnitude: number, unit: string): Prefix {
  const size = magnitude * 1.0005; // what rounds to 1000 kN is 1 MN
  const small_only = SMALL_ONLY.includes(unit);
  if (!SCALED.includes(unit) || size === 0) return { factor: 1, text: "" };
  const fits = ({ factor }: Prefix): boolean => (!small_only || factor <= 1) && size >= factor * (small_only && factor === 1 ? 0.1 : 1);
  return PREFIXES.find(fits) ?? (PREFIXES[PREFIXES.length - 1] as Prefix);
}

const with_powers = (unit: string): string => unit.replace(/([A-Za-z])([234])/g, (_all, letter: string, power: string) => letter + "²³⁴"[Number(power) - 2]);

/** "35.9 mm", "1.37 MN m", "0.5 s". */
export function format_quantity(value: number | null, unit: string): string {
  if (value === null) return "not finite";
  if (unit === "1") return digits(value);
  const prefix = prefix_of(Math.abs(value), unit);
  return `${digits(value / prefix.factor)} ${prefix.text}${with_powers(unit)}`;
}

/** The same, with no more decimals than make sense for a value that still varies by `resolution`. */
export function format_quantity_within(value: number | null, resolution: number, unit: string): string {
  if (value === null || !(resolution > 0)) return format_quantity(value, unit);
  const prefix = prefix_of(Math.max(Math.abs(value), resolution), unit);
  const [shown, step] = [value / prefix.factor, resolution / prefix.factor];
  let decimals = decimals_of(step, 2);
  if (shown !== 0) decimals = Math.min(decimals, decimals_of(Math.max(Math.abs(shown), step), 3));
  const text = shown.toFixed(decimals);
  const positive = Number(text) === 0 ? text.replace("-", "") : text;
  return unit === "1" ? positive : `${positive} ${prefix.text}${with_powers(unit)}`;
}

/** "69 %", "1.2 %", and "46 times" from ten on. */
export function percent(fraction: number): string {
  if (Math.abs(fraction) >= 10) return `${significant(fraction, 3)} times`;
  const value = 100 * fraction;
  if (Math.abs(value) < 0.05 && value !== 0) return `${significant(value, 2)} %`;
  return `${value.toFixed(Math.abs(value) < 9.95 ? 1 : 0)} %`;
}

/** A relative change: "+40 %", "-52 %", "unchanged", and from ten times on "12.4 times as large". */
export function format_change(change: number): string {
  if (Math.abs(change) < 0.0005) return "unchanged";
  if (change >= 9) return `${digits(1 + change)} times as large`;
  return (change > 0 ? "+" : "") + percent(change);
}

/** A number of the verdict. */
export function format_value(quantity: Quantity, value: number | null): string {
  if (value === null) return "not finite";
  const held = Math.abs(value) < negligible(quantity.unit) ? 0 : value;
  if (!quantity.share) return format_quantity(held, quantity.unit);
  if (quantity.name.startsWith("change_of") && Math.abs(held) >= 10) return `${significant(100 * held, 3)} %`;
  if (Math.abs(held) >= 5e-4) return percent(held);
  return Math.abs(held) < 5e-5 ? "0 %" : `${(100 * held).toFixed(2)} %`;
}

/** The same; a value that still varies by `swing` has no more decimals than that justifies. */
export function format_within(quantity: Quantity, value: number | null, swing: number | undefined): string {
  const varies = !quantity.share && swing !== undefined && swing > 0 && swing >= negligible(quantity.unit);
  return varies ? format_quantity_within(value, swing, quantity.unit) : format_value(quantity, value);
}

/** Half of the range in which a residual value still varies; empty when it is at rest. */
export function format_swing(quantity: Quantity, swing: number | undefined): string {
  if (swing === undefined || !(swing > 0) || swing < negligible(quantity.unit)) return "";
  return quantity.share ? percent(swing) : format_quantity_within(swing, swing, quantity.unit);
}

/** By how much a number changes with twice the step: "±0.3 %", of instants "±0.02 s". */
export function format_step_change(quantity: Quantity, number: ResultNumber): string | undefined {
  const { value, at_twice_the_step: other, swing = 0 } = number;
  if (value === null || other === undefined || other === null) return undefined;
  const difference = Math.abs(other - value);
  if (quantity.share) return difference < 0.0005 ? "< 0.1 points" : `±${significant(100 * difference, 2)} points`;
  if (quantity.near_zero) {
    const nothing = difference <= negligible(quantity.unit) || difference < 0.01 * swing;
    return `±${nothing ? "0" : format_quantity_within(difference, difference, quantity.unit)}`;
  }
  const size = Math.max(Math.abs(value), Math.abs(other));
  const share = size > negligible(quantity.unit) ? difference / size : 0;
  return share < 0.0005 ? "< 0.1 %" : `±${percent(share)}`;
}
