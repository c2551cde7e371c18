// Downloads: CSV in SI with units in the head, and files offered by the browser.
import type { Curve } from "./curve";
import type { ChartModel } from "./chart_model";
import { pretty_unit } from "./format";
import type { Axis, Table } from "./types";

/** Quotes a field when the separator, a quote or a line break stands in it. */
function field(text: string): string {
  return /[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

function head(label: string, axis: Axis): string {
  const unit = pretty_unit(axis.unit);
  return unit ? `${label} [${unit}]` : label;
}

function same_x(curves: Curve[]): boolean {
  const first = curves[0];
  if (!first) return true;
  return curves.every((c) => c.length === first.length && c.x.every((v, i) => Object.is(v, first.x[i])));
}

const cell = (array: Float64Array, i: number): string => {
  const value = i < array.length ? (array[i] as number) : NaN;
  return Number.isNaN(value) ? "" : String(value);
};

/** All curves of a chart, hidden ones too. One x column where all share it, else one x beside each curve. */
export function chart_csv(model: ChartModel): string {
  const { chart, curves } = model;
  const rows = Math.max(0, ...curves.map((c) => c.length));
  const shared = same_x(curves);
  const heads: string[] = shared ? [head(chart.x.label, chart.x)] : [];
  for (const curve of curves) {
    if (!shared) heads.push(`${curve.label}: ${head(chart.x.label, chart.x)}`);
    heads.push(`${curve.label}: ${head(chart.y.label, chart.y)}`);
  }
  const lines = [heads.map(field).join(",")];
  const first = curves[0];
  for (let i = 0; i < rows; i++) {
    const cells: string[] = shared && first ? [cell(first.x, i)] : [];
    for (const curve of curves) {
      if (!shared) cells.push(cell(curve.x, i));
      cells.push(cell(curve.y, i));
    }
    lines.push(cells.join(","));
  }
  return lines.join("\n") + "\n";
}

export function table_csv(table: Table): string {
  const columns = table.columns;
  const extra = table.rowGroup && !columns.some((c) => c.key === table.rowGroup) ? [table.rowGroup] : [];
  const heads = [...extra, ...columns.map((c) => head(c.label, c))];
  const keys = [...extra, ...columns.map((c) => c.key)];
  const lines = table.rows.map((row) => keys.map((key) => field(String(row[key] ?? ""))).join(","));
  return [heads.map(field).join(","), ...lines].join("\n") + "\n";
}

/** Hands a text to the browser as a file. */
export function download(name: string, type: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: `${type};charset=utf-8` }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  // The browser has to start reading before the address goes.
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
