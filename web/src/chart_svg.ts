// A chart as a free-standing SVG: for the download and for print, where pixels of a canvas would look coarse.
// Always in the light colours.
import { BAND_OPACITY, below_first, has_markers, THIN_OPACITY, trace, type Curve, type Pen, type Projection, type View } from "./curve";
import type { ChartModel } from "./chart_model";
import { light_colour, print_dash } from "./palette";
import { linear_ticks, log_ticks, tick_labels } from "./ticks";

export interface SvgOptions {
  width: number;
  height: number;
  /** With title, origin and legend: a figure that stands alone. */
  standalone: boolean;
}

const INK = "#1c2329";
const SOFT = "#5b6670";
const GRID = "#e4e8ec";
const FONT = "system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif";

const escape_text = (text: string): string =>
  text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");

const round = (value: number): string => String(Math.round(value * 10) / 10);

class PathPen implements Pen {
  private readonly parts_: string[] = [];
  moveTo(x: number, y: number): void {
    this.parts_.push(`M${round(x)} ${round(y)}`);
  }
  lineTo(x: number, y: number): void {
    this.parts_.push(`L${round(x)} ${round(y)}`);
  }
  get d(): string {
    return this.parts_.join("");
  }
}

interface Frame extends Projection {
  top: number;
  height: number;
}

function projection(model: ChartModel, view: View, left: number, top: number, width: number, height: number): Frame {
  const fx = model.chart.x.log ? Math.log10 : (v: number): number => v;
  const fy = model.chart.y.log ? Math.log10 : (v: number): number => v;
  const [x0, x1, y0, y1] = [fx(view.xmin), fx(view.xmax), fy(view.ymin), fy(view.ymax)];
  return {
    left, top, width, height,
    x: (v) => left + ((fx(v) - x0) / (x1 - x0)) * width,
    y: (v) => top + height - ((fy(v) - y0) / (y1 - y0)) * height,
  };
}

function axis_ticks(min: number, max: number, factor: number, log: boolean, count: number): [number[], string[]] {
  const ticks = log ? log_ticks(min / factor, max / factor, count) : linear_ticks(min / factor, max / factor, count);
  return [ticks.map((t) => t * factor), tick_labels(ticks, log)];
}

const text = (x: number, y: number, anchor: string, fill: string, content: string, extra = ""): string =>
  `<text x="${round(x)}" y="${round(y)}" text-anchor="${anchor}" fill="${fill}"${extra}>${escape_text(content)}</text>`;

interface Ticks {
  x: [number[], string[]];
  y: [number[], string[]];
}

function axes_svg(model: ChartModel, frame: Frame, ticks: Ticks): string {
  const out: string[] = [];
  const bottom = frame.top + frame.height;
  const right = frame.left + frame.width;
  let grid = "";
  ticks.x[0].forEach((t, i) => {
    const x = frame.x(t);
    grid += `M${round(x)} ${round(frame.top)}V${round(bottom)}`;
    out.push(text(x, bottom + 15, "middle", SOFT, ticks.x[1][i] ?? ""));
  });
  ticks.y[0].forEach((t, i) => {
    const y = frame.y(t);
    grid += `M${round(frame.left)} ${round(y)}H${round(right)}`;
    out.push(text(frame.left - 6, y + 3.6, "end", SOFT, ticks.y[1][i] ?? ""));
  });
  out.unshift(`<path d="${grid}" stroke="${GRID}" fill="none"/>`);
  out.push(`<path d="M${round(frame.left)} ${round(frame.top)}V${round(bottom)}H${round(right)}" stroke="${SOFT}" fill="none"/>`);
  out.push(text(frame.left + frame.width / 2, bottom + 31, "middle", INK, model.xlabel));
  out.push(text(2, frame.top - 8, "start", INK, model.ylabel));
  return out.join("");
}

/** Shaken histories stay plain on paper: dashes between so many turns would only hide them. */
function is_shaken(curve: Curve): boolean {
  let turns = 0;
  for (let i = 2; i < curve.length; i++) {
    const [a, b, c] = [curve.y[i - 2] as number, curve.y[i - 1] as number, curve.y[i] as number];
    if ((b - a) * (c - b) < 0) turns++;
  }
  return turns > 80;
}

/** The dash of a curve, on paper that of its slot where it has none. */
export function dash_of(curve: Curve, on_paper: boolean): number[] {
  return on_paper && curve.style !== "thin" && curve.dash.length === 0 && !is_shaken(curve) ? print_dash(curve.slot) : curve.dash;
}

function curve_svg(curve: Curve, view: View, frame: Frame, on_paper: boolean): string {
  const pen = new PathPen();
  trace(curve, view, frame, pen);
  const colour = light_colour(curve.slot);
  const dashes = dash_of(curve, on_paper);
  const dash = dashes.length > 0 ? ` stroke-dasharray="${dashes.join(" ")}"` : "";
  const line = curve.style === "thin" ? ` stroke-width="0.7" stroke-opacity="${THIN_OPACITY}"` : ` stroke-width="1.3"`;
  let out = curve.style === "points" ? "" : curve.style === "band"
    ? `<path d="${pen.d}Z" fill="${colour}" fill-opacity="${BAND_OPACITY}"/>`
    : `<path d="${pen.d}" fill="none" stroke="${colour}"${line} stroke-linejoin="round"${dash}/>`;
  if (has_markers(curve)) {
    for (let i = 0; i < curve.length; i++) {
      const x = frame.x(curve.x[i] as number);
      const y = frame.y(curve.y[i] as number);
      if (Number.isFinite(x) && Number.isFinite(y)) out += `<circle cx="${round(x)}" cy="${round(y)}" r="2.2" fill="${colour}"/>`;
    }
  }
  return out;
}

/** A line, a dot or a patch. */
function legend_key(curve: Curve, x: number, y: number): string {
  const colour = light_colour(curve.slot);
  if (curve.style === "points") return `<circle cx="${round(x + 10)}" cy="${round(y)}" r="3" fill="${colour}"/>`;
  if (curve.style === "band") return `<rect x="${round(x)}" y="${round(y - 4)}" width="20" height="8" fill="${colour}" fill-opacity="${2 * BAND_OPACITY}"/>`;
  const dash = curve.dash.length > 0 ? ` stroke-dasharray="${curve.dash.join(" ")}"` : "";
  return `<path d="M${round(x)} ${round(y)}h20" stroke="${colour}" stroke-width="${curve.style === "thin" ? 1 : 2}"${dash}/>`;
}

/** Legend lines, filled from the left; widths are estimated because text cannot be measured in a string. */
function legend_svg(curves: Curve[], left: number, top: number, width: number): [string, number] {
  let x = left;
  let y = top;
  let out = "";
  for (const curve of curves) {
    const label = curve.failed && !/fail/i.test(curve.label) ? `${curve.label} (failed)` : curve.label;
    const wide = 34 + label.length * 6;
    if (x > left && x + wide > left + width) {
      x = left;
      y += 17;
    }
    out += legend_key(curve, x, y - 4);
    out += text(x + 25, y, "start", INK, label);
    x += wide + 12;
  }
  return [out, y - top + (curves.length > 0 ? 17 : 0)];
}

/** The chart as SVG text. `view` is what the reader now sees. */
export function chart_svg(model: ChartModel, view: View, options: SvgOptions): string {
  const { width, standalone } = options;
  const curves = model.shown();
  const head = standalone ? 46 : 0;
  const [legend, legend_height] = standalone ? legend_svg(curves, 10, head + 2, width - 20) : ["", 0];
  const top = head + legend_height + 22;
  const height = options.height + head + legend_height;
  const bottom = height - 38;
  const y = axis_ticks(view.ymin, view.ymax, model.yscale.factor, model.chart.y.log ?? false, (bottom - top) / 34);
  const left = 14 + 6.3 * Math.max(2, ...y[1].map((label) => label.length));
  const right = width - 14;
  const x = axis_ticks(view.xmin, view.xmax, model.xscale.factor, model.chart.x.log ?? false, (right - left) / 62);
  const frame = projection(model, view, left, top, right - left, bottom - top);
  const clip = `clip-${model.chart.id.replace(/[^\w-]/g, "_")}-${standalone ? "f" : "p"}`;
  const title = standalone
    ? text(10, 20, "start", INK, model.chart.title, ' font-size="14" font-weight="600"') +
      text(10, 36, "start", SOFT, model.chart.origin)
    : "";
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" ` +
    `font-family="${FONT}" font-size="11"><title>${escape_text(model.chart.title)}</title>` +
    (standalone ? `<rect width="${width}" height="${height}" fill="#fff"/>` : "") +
    title + legend + axes_svg(model, frame, { x, y }) +
    `<clipPath id="${clip}"><rect x="${round(left)}" y="${round(top)}" width="${round(right - left)}" height="${round(bottom - top)}"/></clipPath>` +
    `<g clip-path="url(#${clip})">${below_first(curves).map((curve) => curve_svg(curve, view, frame, !standalone)).join("")}</g></svg>\n`
  );
}
