// Numbers and units as people read them. Data stay SI; only what is shown is scaled (m to mm, N to kN).

/** Gaps, displacements and rotations below this (m, rad) are smaller than the precision of a run and are shown as 0. */
export const NEGLIGIBLE = 1e-9;

const SUPERSCRIPT: Record<string, string> = {
  "-": "⁻", "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴", "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹",
};
const THIN = "\u2009";
const MINUS = "\u2212";

function minus(text: string): string {
  return text.replace("-", MINUS);
}

/** 10³ style: mantissa with the given significant digits. */
export function scientific(value: number, digits: number): string {
  const [mantissa, exponent] = value.toExponential(Math.max(0, digits - 1)).split("e");
  const power = String(Number(exponent)).replace(/[-\d]/g, (c) => SUPERSCRIPT[c] ?? c);
  if (mantissa === "1" && digits === 1) return `10${power}`;
  return `${minus(mantissa ?? "")}·10${power}`;
}

function group(text: string): string {
  const [whole = "", fraction] = text.split(".");
  const digits = whole.replace("-", "");
  if (digits.length < 5) return fraction === undefined ? whole : `${whole}.${fraction}`;
  const grouped = digits.replace(/\B(?=(\d{3})+$)/g, THIN);
  const sign = whole.startsWith("-") ? "-" : "";
  return sign + grouped + (fraction === undefined ? "" : `.${fraction}`);
}

/** Fixed number of decimals, typographic minus, thin space between thousands. */
export function fixed(value: number, decimals: number): string {
  const text = value.toFixed(Math.min(20, Math.max(0, decimals)));
  // "-0.00" is a rounded zero, not a negative number.
  return minus(group(Number(text) === 0 ? text.replace("-", "") : text));
}

/** A single number with significant digits; powers of ten outside 1e-3 … 1e5. */
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : `${MINUS}∞`;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return scientific(value, digits);
  return fixed(value, digits - 1 - Math.floor(Math.log10(size)));
}

/** "N m" to "N·m", "m/s2" to "m/s²". */
export function pretty_unit(unit: string | undefined): string {
  if (!unit || unit === "-" || unit === "1") return "";
  return unit
    .replace(/[ *]/g, "·")
    .replace(/([a-z])\^?([234])\b/gi, (_all, letter: string, digit: string) => letter + (SUPERSCRIPT[digit] ?? ""));
}

export interface Scale {
  /** SI value of one shown unit. */
  factor: number;
  unit: string;
}

const UP_AND_DOWN = new Set(["m", "N", "Pa", "J", "W", "N·m", "N/m", "N·s", "Pa/m", "J/m²", "N·m/rad", "N·s/m"]);
const DOWN_ONLY = new Set(["rad", "m/s", "s"]);

/** The prefix in which the largest value reads well. `largest` is the largest magnitude shown, SI. */
export function pick_scale(largest: number, unit: string | undefined): Scale {
  const base = pretty_unit(unit);
  const both = UP_AND_DOWN.has(base);
  if (!(largest > 0) || !Number.isFinite(largest) || !(both || DOWN_ONLY.has(base))) return { factor: 1, unit: base };
  const scaled = (factor: number, prefix: string): Scale => ({ factor, unit: prefix + base });
  if (both && largest >= 1e9) return scaled(1e9, "G");
  if (both && largest >= 1e6) return scaled(1e6, "M");
  if (both && largest >= 1e3) return scaled(1e3, "k");
  if (largest < 1e-4) return largest < 1e-7 ? scaled(1e-9, "n") : scaled(1e-6, "µ");
  if (largest < 0.1) return scaled(1e-3, "m");
  return { factor: 1, unit: base };
}

/** A value with its unit in the prefix that suits `largest`: "1.79 MN·m". Lengths and angles below the precision of a run read "0 mm". */
export function quantity_text(value: number, unit: string | undefined, largest = Math.abs(value), digits = 3): string {
  const base = pretty_unit(unit);
  if ((base === "m" || base === "rad") && Math.abs(value) < NEGLIGIBLE) return `0\u00a0m${base}`;
  const scale = pick_scale(largest, unit);
  return number(value / scale.factor, digits) + (scale.unit ? `\u00a0${scale.unit}` : "");
}

/** "Base moment" and "kN·m" to "Base moment (kN·m)". */
export function with_unit(label: string, unit: string): string {
  return unit ? `${label} (${unit})` : label;
}

/** A text that is safe as a file name. */
export function file_name(text: string): string {
  return text.toLowerCase().replace(/[^a-z0-9._-]+/g, "_").replace(/^_+|_+$/g, "") || "figure";
}

/** Typography of a sentence from the program: minus signs, units as everywhere on the page, a number and its unit on one line. */
export function tied(text: string): string {
  return text
    .replace(/(^|[ (])-(?=\d)/g, "$1\u2212")
    .replace(/(\d [kMG]?N) m(?![a-z])/g, "$1·m")
    .replace(/(\d k?m\/s)2\b/g, "$1²")
    .replace(/(\d) (?=(?:%|[µmkMG]?(?:m|s|g|N|Pa|J|Hz|rad|t)(?![a-z])))/g, "$1\u00a0");
}
