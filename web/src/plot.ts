// The live plot of a chart: uPlot gives canvas, axes, scales, drag zoom and cursor; curves are traced by curve.ts.
import uPlot from "uplot";
import { BAND_OPACITY, below_first, has_markers, THIN_OPACITY, trace, type Curve, type Projection, type View } from "./curve";
import type { ChartModel } from "./chart_model";
import { current_colour } from "./palette";
import { css_colour } from "./theme";
import { linear_ticks, log_ticks, tick_labels } from "./ticks";
import type { Scale } from "./format";

const FONT = '11px system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif';

export interface PlotEvents {
  /** The cursor moved to this place of the plot (CSS pixels), or left it (null). */
  cursor(at: { left: number; top: number } | null): void;
  /** The visible range changed. */
  view(): void;
}

function axis(model: ChartModel, which: "x" | "y"): uPlot.Axis {
  const scale: Scale = which === "x" ? model.xscale : model.yscale;
  const log = model.chart[which].log ?? false;
  const every = which === "x" ? 62 : 32;
  const ticks_of = (min: number, max: number, count: number): number[] =>
    (log ? log_ticks : linear_ticks)(min / scale.factor, max / scale.factor, count).map((t) => t * scale.factor);
  return {
    scale: which,
    font: FONT,
    labelFont: FONT,
    stroke: () => css_colour("--ink-soft"),
    grid: { stroke: () => css_colour("--grid"), width: 1 },
    ticks: { show: false },
    border: { show: true, stroke: () => css_colour("--axis"), width: 1 },
    gap: 5,
    splits: (u, _i, min, max) => ticks_of(min, max, (which === "x" ? u.width - 70 : u.height - 50) / every),
    // Every tick given here is labelled; uPlot would thin logarithmic ones by its own rule.
    filter: (_u, splits) => splits,
    values: (_u, splits) => tick_labels(splits.map((t) => t / scale.factor), log),
    size: (_u, values) => (which === "x" ? 24 : 12 + 6.3 * Math.max(2, ...(values ?? []).map((v) => v.length))),
    ...(which === "x" ? { label: model.xlabel, labelSize: 18, labelGap: 0 } : {}),
  };
}

export class Plot {
  readonly u: uPlot;
  private readonly model_: ChartModel;
  private readonly events_: PlotEvents;
  private zoomed_ = false;
  // Set while the program itself sets the scales: that is no zoom by the reader.
  private setting_ = false;

  constructor(model: ChartModel, host: HTMLElement, width: number, height: number, events: PlotEvents) {
    this.model_ = model;
    this.events_ = events;
    const view = model.default_view();
    // The data given to uPlot only span the range; the curves have an x of their own each.
    this.u = new uPlot(this.options(width, height), [[view.xmin, view.xmax], [null, null]], host);
    this.set_view(view, false);
  }

  get zoomed(): boolean {
    return this.zoomed_;
  }

  get view(): View {
    const { x, y } = this.u.scales;
    return { xmin: x?.min ?? 0, xmax: x?.max ?? 1, ymin: y?.min ?? 0, ymax: y?.max ?? 1 };
  }

  set_view(view: View, zoomed: boolean): void {
    this.setting_ = true;
    this.u.batch(() => {
      this.u.setScale("x", { min: view.xmin, max: view.xmax });
      this.u.setScale("y", { min: view.ymin, max: view.ymax });
    });
    this.setting_ = false;
    this.zoomed_ = zoomed;
    this.events_.view();
  }

  reset(): void {
    this.set_view(this.model_.default_view(), false);
  }

  /** Visibility changed: a view that was not chosen by the reader follows the curves. */
  refresh(): void {
    if (this.zoomed_) this.u.redraw(false, true);
    else this.reset();
    this.u.redraw(false, true);
  }

  resize(width: number, height: number): void {
    if (width !== this.u.width || height !== this.u.height) this.u.setSize({ width, height });
  }

  /** Zooms the x axis about a place given as part of the width. */
  zoom_x(factor: number, about: number): void {
    const view = this.view;
    const log = this.model_.chart.x.log ?? false;
    const f = log ? Math.log10 : (v: number): number => v;
    const g = log ? (v: number): number => Math.pow(10, v) : (v: number): number => v;
    const [a, b] = [f(view.xmin), f(view.xmax)];
    const centre = a + about * (b - a);
    this.set_view({ ...view, xmin: g(centre + (a - centre) * factor), xmax: g(centre + (b - centre) * factor) }, true);
  }

  /** Data to CSS pixels of the plotting area. */
  projection(device: boolean): Projection {
    const { bbox } = this.u;
    const ratio = device ? 1 : 1 / devicePixelRatio;
    const [left, top] = device ? [bbox.left, bbox.top] : [0, 0];
    const width = bbox.width * ratio;
    const height = bbox.height * ratio;
    const fx = this.model_.chart.x.log ? Math.log10 : (v: number): number => v;
    const fy = this.model_.chart.y.log ? Math.log10 : (v: number): number => v;
    const view = this.view;
    const x0 = fx(view.xmin);
    const y0 = fy(view.ymin);
    const sx = width / (fx(view.xmax) - x0);
    const sy = height / (fy(view.ymax) - y0);
    return { left, width, x: (v) => left + (fx(v) - x0) * sx, y: (v) => top + height - (fy(v) - y0) * sy };
  }

  private options(width: number, height: number): uPlot.Options {
    const own_range = (_u: uPlot, min: number, max: number): [number, number] => [min ?? 0, max ?? 1];
    const distr = (log: boolean | undefined): uPlot.Scale.Distr => (log ? 3 : 1);
    const { x, y } = this.model_.chart;
    return {
      width,
      height,
      padding: [8, 12, 0, 0],
      legend: { show: false },
      scales: {
        x: { time: false, distr: distr(x.log), range: own_range },
        y: { auto: false, distr: distr(y.log), range: y.log ? () => [1, 10] : own_range },
      },
      axes: [axis(this.model_, "x"), axis(this.model_, "y")],
      series: [{}, { scale: "y", show: true, points: { show: false } }],
      cursor: {
        points: { show: false },
        drag: { x: true, y: true, uni: 24, dist: 4 },
        focus: { prox: -1 },
        bind: { dblclick: () => () => (this.reset(), null) },
      },
      hooks: {
        draw: [() => this.draw_curves()],
        setCursor: [(u) => this.tell_cursor(u)],
        setScale: [() => this.tell_scale()],
      },
    };
  }

  private tell_cursor(u: uPlot): void {
    const { left, top } = u.cursor;
    const outside = left === undefined || top === undefined || left < 0 || top < 0;
    this.events_.cursor(outside ? null : { left, top });
  }

  private tell_scale(): void {
    // The first scales are set while the constructor still runs.
    if (this.setting_ || this.u === undefined) return;
    this.zoomed_ = true;
    this.events_.view();
  }

  private draw_curves(): void {
    if (this.u === undefined) return;
    const { ctx, bbox } = this.u;
    const view = this.view;
    const map = this.projection(true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineJoin = "round";
    const order = below_first(this.model_.shown());
    for (const curve of order) this.draw_curve(ctx, curve, view, map);
    ctx.restore();
  }

  private draw_line(ctx: CanvasRenderingContext2D, curve: Curve, view: View, map: Projection): void {
    const ratio = devicePixelRatio;
    ctx.beginPath();
    ctx.lineWidth = (curve.style === "thin" ? 0.8 : curve.failed ? 1.1 : 1.5) * ratio;
    ctx.globalAlpha = curve.style === "thin" ? THIN_OPACITY : curve.style === "band" ? BAND_OPACITY : 1;
    ctx.setLineDash(curve.dash.map((d) => d * ratio));
    trace(curve, view, map, ctx);
    if (curve.style === "band") ctx.fill();
    else ctx.stroke();
    ctx.globalAlpha = 1;
  }

  private draw_curve(ctx: CanvasRenderingContext2D, curve: Curve, view: View, map: Projection): void {
    const ratio = devicePixelRatio;
    ctx.strokeStyle = ctx.fillStyle = current_colour(curve.slot);
    if (curve.style !== "points") this.draw_line(ctx, curve, view, map);
    if (!has_markers(curve)) return;
    ctx.beginPath();
    for (let i = 0; i < curve.length; i++) {
      const x = map.x(curve.x[i] as number);
      const y = map.y(curve.y[i] as number);
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      ctx.moveTo(x, y);
      ctx.arc(x, y, 2.6 * ratio, 0, 2 * Math.PI);
    }
    ctx.fill();
  }
}
