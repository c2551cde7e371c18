// The readout at the cursor: all visible curves at one x for histories, the nearest point for loops.
import { h, s, px } from "./dom";
import { lower_bound, type Curve, type Projection } from "./curve";
import type { ChartModel } from "./chart_model";
import { number } from "./format";
import { colour_variable } from "./palette";

// Pixels beyond its ends within which a history still answers.
const END_REACH = 6;

// More rows than this would cover the plot.
const LONG_LIST = 8;
const AXIS_HEIGHT = 46;

interface Hit {
  curve: Curve;
  index: number;
}

/** The sample of a history nearest to x, or nothing where the curve has a gap. */
function nearest_in_x(curve: Curve, x: number): number | null {
  const after = lower_bound(curve.x, x);
  let best: number | null = null;
  for (const i of [after - 1, after]) {
    if (i < 0 || i >= curve.length || Number.isNaN(curve.y[i])) continue;
    if (best === null || Math.abs((curve.x[i] as number) - x) < Math.abs((curve.x[best] as number) - x)) best = i;
  }
  return best;
}

/** The point of any curve nearest to a place in pixels. */
function nearest_point(curves: Curve[], map: Projection, left: number, top: number): Hit | null {
  let best: Hit | null = null;
  let distance = 48 * 48;
  for (const curve of curves) {
    for (let i = 0; i < curve.length; i++) {
      const dx = map.x(curve.x[i] as number) - left;
      const dy = map.y(curve.y[i] as number) - top;
      const d = dx * dx + dy * dy;
      if (d < distance) {
        distance = d;
        best = { curve, index: i };
      }
    }
  }
  return best;
}

export class Readout {
  private readonly model_: ChartModel;
  private readonly box_ = h("div", { class: "readout", hidden: true });
  private readonly marks_ = s("svg", { class: "marks", "aria-hidden": "true" });

  constructor(model: ChartModel, over: HTMLElement) {
    this.model_ = model;
    over.append(this.marks_, this.box_);
  }

  hide(): void {
    this.box_.hidden = true;
    this.marks_.replaceChildren();
  }

  /** Shows what stands at a place; `width` and `height` are those of the plotting area. */
  show(left: number, top: number, width: number, height: number, map: Projection, xvalue: number): void {
    const curves = this.model_.shown();
    const history = this.model_.monotone();
    const hits = history ? this.history_hits(curves, xvalue, map, left) : this.loop_hits(curves, map, left, top);
    if (hits.length === 0) {
      this.hide();
      return;
    }
    this.box_.replaceChildren(...this.lines(hits, history, xvalue));
    this.box_.hidden = false;
    this.place(left, top, width, height, hits.length > LONG_LIST);
    this.marks_.replaceChildren(
      ...hits.map(({ curve, index }) =>
        s("circle", {
          cx: px(map.x(curve.x[index] as number)),
          cy: px(map.y(curve.y[index] as number)),
          r: 3.5,
          style: `stroke:${colour_variable(curve.slot)}`,
        }),
      ),
    );
  }

  private history_hits(curves: Curve[], x: number, map: Projection, left: number): Hit[] {
    const hits: Hit[] = [];
    for (const curve of curves) {
      const inside = left >= map.x(curve.xrange.min) - END_REACH && left <= map.x(curve.xrange.max) + END_REACH;
      const index = inside ? nearest_in_x(curve, x) : null;
      if (index !== null) hits.push({ curve, index });
    }
    return hits;
  }

  private loop_hits(curves: Curve[], map: Projection, left: number, top: number): Hit[] {
    const hit = nearest_point(curves, map, left, top);
    return hit ? [hit] : [];
  }

  private lines(hits: Hit[], history: boolean, x: number): HTMLElement[] {
    const { xscale, yscale, chart } = this.model_;
    const first = hits[0];
    const at = history || !first ? x : (first.curve.x[first.index] as number);
    const head = h("div", { class: "readout-head" }, `${chart.x.label} `, h("b", {}, number(at / xscale.factor, 4)), ` ${xscale.unit}`);
    const rows = hits.map(({ curve, index }) =>
      h(
        "div",
        { class: "readout-row" },
        h("i", { style: `background:${colour_variable(curve.slot)}` }),
        h("span", {}, curve.label),
        h("b", {}, number((curve.y[index] as number) / yscale.factor, 4)),
      ),
    );
    const body = h("div", { class: rows.length > LONG_LIST ? "readout-rows two" : "readout-rows" }, ...rows);
    return [head, body, h("div", { class: "readout-unit" }, yscale.unit)];
  }

  // Beside the cursor, on the side that has room; a long list goes below the axis, where it hides no curve.
  private place(left: number, top: number, width: number, height: number, long: boolean): void {
    if (long) {
      this.box_.style.transform = `translate(0,${Math.round(height + AXIS_HEIGHT)}px)`;
      return;
    }
    const w = this.box_.offsetWidth;
    const t = this.box_.offsetHeight;
    const x = left + 14 + w > width ? Math.max(0, left - 14 - w) : left + 14;
    const y = Math.min(Math.max(0, top - t / 2), Math.max(0, height - t));
    this.box_.style.transform = `translate(${Math.round(x)}px,${Math.round(y)}px)`;
  }
}
