// A chart without its drawing: curves, what is visible, the default range, shown units.
import { Curve, type Extent, type View } from "./curve";
import { pick_scale, with_unit, type Scale } from "./format";
import { DASHES, FAILED_DASH, SLOTS } from "./palette";
import type { Runs } from "./runs";
import type { Axis, Chart } from "./types";

// A failed curve that exceeds the sound range by no more than this part of it is shown whole.
const TOLERATED_EXCESS = 0.25;

function union(ranges: Extent[]): Extent | null {
  const min = Math.min(...ranges.map((r) => r.min));
  const max = Math.max(...ranges.map((r) => r.max));
  return Number.isFinite(min) && Number.isFinite(max) ? { min, max } : null;
}

function pad_linear(range: Extent, part: number): Extent {
  if (range.max === range.min) {
    const by = range.max === 0 ? 1 : Math.abs(range.max) * 0.1;
    return { min: range.min - by, max: range.max + by };
  }
  const by = (range.max - range.min) * part;
  // Zero is a natural border for quantities of one sign.
  const low = range.min >= 0 && range.min < 0.4 * range.max ? Math.min(0, range.min) : range.min - by;
  const high = range.max <= 0 && range.max > 0.4 * range.min ? Math.max(0, range.max) : range.max + by;
  return { min: range.min === 0 ? -by * 0.25 : low, max: range.max === 0 ? by * 0.25 : high };
}

function pad_log(range: Extent, part: number): Extent {
  const by = Math.pow(range.max / range.min, part) * (range.max === range.min ? 2 : 1.05);
  return { min: range.min / by, max: range.max * by };
}

/** A history that was thinned out begins and ends a little inside the run: the axis goes from 0 to the full second. */
function whole_time(range: Extent): Extent {
  const little = 0.01 * (range.max - range.min);
  const end = Math.ceil(range.max);
  return { min: range.min > 0 && range.min < little ? 0 : range.min, max: end - range.max < little ? end : range.max };
}

const pad = (range: Extent, log: boolean, part: number): Extent =>
  log ? pad_log(range, part) : pad_linear(range, part);

export class ChartModel {
  readonly chart: Chart;
  readonly curves: Curve[];
  readonly runs: Runs;
  readonly xscale: Scale;
  readonly yscale: Scale;
  /** The reader asked for the failed curves too. */
  full = false;

  constructor(chart: Chart, runs: Runs) {
    this.chart = chart;
    this.runs = runs;
    this.curves = chart.series.map((series) => new Curve(series, chart.x.log ?? false, chart.y.log ?? false));
    this.assign_styles();
    const sound = this.sound(this.curves);
    this.xscale = this.scale_of(sound.map((c) => c.xrange), chart.x);
    this.yscale = this.scale_of(sound.map((c) => c.yrange), chart.y);
  }

  get xlabel(): string {
    return with_unit(this.chart.x.label, this.xscale.unit);
  }

  get ylabel(): string {
    return with_unit(this.chart.y.label, this.yscale.unit);
  }

  visible(curve: Curve): boolean {
    return !curve.hidden && !this.runs.hidden(curve.run);
  }

  shown(): Curve[] {
    return this.curves.filter((curve) => this.visible(curve) && curve.length > 0);
  }

  /** All visible curves are histories over x. */
  monotone(): boolean {
    return this.shown().every((curve) => curve.monotone);
  }

  /** The range shown before any zoom: from the sound runs, so that a failed one does not flatten them. */
  default_view(): View {
    const shown = this.shown();
    const base = this.full ? shown : this.sound(shown);
    const x = this.x_range(base, shown);
    const y = this.grown(union(base.map((c) => c.yrange)), shown.map((c) => c.yrange), this.chart.y.log ?? false);
    const ypad = pad(y ?? { min: 0, max: 1 }, this.chart.y.log ?? false, 0.06);
    return { xmin: x.min, xmax: x.max, ymin: ypad.min, ymax: ypad.max };
  }

  /** Visible curves that leave the default view. */
  clipped(): Curve[] {
    const view = this.default_view();
    return this.shown().filter(
      (curve) =>
        curve.failed &&
        (curve.yrange.max > view.ymax || curve.yrange.min < view.ymin || curve.xrange.max > view.xmax * (1 + 1e-9)),
    );
  }

  private sound(curves: Curve[]): Curve[] {
    const sound = curves.filter((curve) => !curve.failed && Number.isFinite(curve.yrange.min));
    return sound.length > 0 ? sound : curves;
  }

  private x_range(base: Curve[], shown: Curve[]): Extent {
    const log = this.chart.x.log ?? false;
    const history = shown.every((curve) => curve.monotone);
    // The x of a history is given (time, ratio); the x of a loop is a result and can blow up as y does.
    const range = history ? union(shown.map((c) => c.xrange)) : union(base.map((c) => c.xrange));
    if (!range) return log ? { min: 0.1, max: 10 } : { min: 0, max: 1 };
    if (history && range.max > range.min && !shown.some((c) => c.length <= 40)) return this.chart.x.unit === "s" ? whole_time(range) : range;
    return pad(range, log, history ? 0.02 : 0.06);
  }

  private grown(range: Extent | null, others: Extent[], log: boolean): Extent | null {
    if (!range || log) return range;
    const excess = TOLERATED_EXCESS * (range.max - range.min);
    const small = others.filter((r) => r.min >= range.min - excess && r.max <= range.max + excess);
    return union([range, ...small]);
  }

  private scale_of(ranges: Extent[], axis: Axis): Scale {
    const range = union(ranges);
    return pick_scale(range ? Math.max(Math.abs(range.min), Math.abs(range.max)) : 0, axis.unit);
  }

  private group_of(i: number): string | undefined {
    return this.chart.series[i]?.group;
  }

  /** Colour by run; by curve where one run has all the curves (energies of one run, law curves). */
  private assign_styles(): void {
    const names = new Set(this.curves.map((curve) => curve.run ?? ""));
    const by_run = names.size > 1 || (this.curves.length === 1 && !names.has(""));
    const used = new Set<number>();
    const seen = new Map<string, number>();
    for (const curve of this.curves) {
      if (by_run && curve.run !== undefined) used.add(this.runs.slot(curve.run) % SLOTS);
    }
    let free = 0;
    const groups = new Map<string, number>();
    this.curves.forEach((curve, i) => {
      let repeat = 0;
      if (by_run && curve.run !== undefined) {
        const slot = this.runs.slot(curve.run);
        const before = seen.get(curve.run) ?? 0;
        seen.set(curve.run, before + 1);
        curve.slot = slot;
        repeat = before + Math.floor(slot / SLOTS);
      } else if (this.group_of(i) !== undefined && groups.has(this.group_of(i) as string)) {
        curve.slot = groups.get(this.group_of(i) as string) as number;
      } else {
        while (used.has(free % SLOTS) && free < SLOTS) free++;
        curve.slot = free % SLOTS;
        repeat = Math.floor(free / SLOTS);
        free++;
        const group = this.group_of(i);
        if (group !== undefined) groups.set(group, curve.slot);
      }
      if (curve.failed) curve.dash = FAILED_DASH;
      else if (this.chart.series[i]?.dash) curve.dash = DASHES[1] ?? [];
      else curve.dash = DASHES[repeat % DASHES.length] ?? [];
    });
  }
}
