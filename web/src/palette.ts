// Colours of runs. One slot per run name, in order of first appearance, the same in every figure.
// The hues follow Okabe-Ito and Tol (safe for the common colour-vision deficiencies), darkened or
// lightened for contrast with the page; beyond ten runs the slots repeat with another dash pattern.
import type { Report } from "./types";

const LIGHT = ["#0067a5", "#d1570b", "#0a8f6c", "#a8418f", "#b08800", "#3a9fd6", "#4b3b9e", "#8c1c4a", "#5f6b1a", "#5a6470"];
const DARK = ["#5cb3f0", "#ff9455", "#43cfa3", "#dc8bc9", "#e5c44f", "#8fd3ff", "#a99cff", "#f07ea6", "#b9c75e", "#aab4bf"];

export const SLOTS = LIGHT.length;

/** Dash patterns (CSS pixels) by repetition of the palette or by curve of the same run. */
export const DASHES: number[][] = [[], [7, 3], [2, 2.5], [9, 3, 2, 3], [4, 2]];
export const FAILED_DASH = [3, 3];

/** Dash of a plain curve on paper, where colours may be greys: by its slot. */
export function print_dash(slot: number): number[] {
  return DASHES[slot % DASHES.length] ?? [];
}

export function light_colour(slot: number): string {
  return LIGHT[slot % SLOTS] ?? "#000";
}

export function colour_variable(slot: number): string {
  return `var(--c${slot % SLOTS})`;
}

/** Colour of a slot under the theme that now holds. */
export function current_colour(slot: number): string {
  return document.documentElement.dataset["theme"] === "dark" ? (DARK[slot % SLOTS] ?? "#fff") : light_colour(slot);
}

/** Declares the slots as CSS variables. Print always uses the light set. */
export function install_palette(): void {
  const block = (colours: string[]): string => colours.map((c, i) => `--c${i}:${c}`).join(";");
  const style = document.createElement("style");
  style.textContent = `:root{${block(LIGHT)}}@media screen{:root[data-theme=dark]{${block(DARK)}}}`;
  document.head.append(style);
}

/** Run names in order of first appearance: tables, then charts, then animations. */
export function run_names(report: Report): string[] {
  const in_data = new Set<string>();
  for (const chart of report.charts) for (const series of chart.series) if (series.run) in_data.add(series.run);
  for (const animation of report.animations) in_data.add(animation.run);
  for (const animation of report.spaceAnimations ?? []) in_data.add(animation.run);
  const ordered = new Set<string>();
  for (const table of report.tables) {
    for (const row of table.rows) {
      for (const column of table.columns) {
        const value = row[column.key];
        if (typeof value === "string" && in_data.has(value)) ordered.add(value);
      }
    }
  }
  for (const name of in_data) ordered.add(name);
  return [...ordered];
}
