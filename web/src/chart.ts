// One figure: heading, live plot, legend, notes, caption, downloads. Drawn when scrolled near.
import { chart_csv, download } from "./export";
import { chart_svg, dash_of } from "./chart_svg";
import { BAND_OPACITY, type Curve, type View } from "./curve";
import { ChartModel } from "./chart_model";
import { h, s } from "./dom";
import { file_name, number } from "./format";
import { Readout } from "./hover";
import { colour_variable } from "./palette";
import { Plot } from "./plot";
import type { Runs } from "./runs";
import type { Chart, SeriesStyle } from "./types";

/** A dashed or plain line, a dot or a patch in the colour of a curve. */
export function swatch(slot: number, dash: number[], on_paper = dash, style?: SeriesStyle): SVGElement {
  const colour = colour_variable(slot);
  const box = { class: "swatch", width: 22, height: 8, viewBox: "0 0 22 8", "aria-hidden": "true" };
  if (style === "points") return s("svg", box, s("path", { d: "M8 4a3 3 0 1 0 6 0a3 3 0 1 0 -6 0", style: `fill:${colour}` }));
  if (style === "band") return s("svg", box, s("path", { d: "M0 0H22V8H0Z", style: `fill:${colour};fill-opacity:${2 * BAND_OPACITY}` }));
  return s(
    "svg",
    box,
    s("path", { d: "M0 4H22", style: `stroke:${colour};--print-dash:${on_paper.join(" ") || "none"}`, "stroke-width": 2.2, fill: "none", "stroke-dasharray": dash.join(" ") || null }),
  );
}

/** Small label that tells whose choice a figure or a value is. */
export function origin_chip(origin: string): HTMLElement {
  const kind = /^paper/i.test(origin) ? "paper" : /user/i.test(origin) ? "user" : "own";
  return h("span", { class: `origin origin-${kind}`, title: kind === "paper" ? "Taken from the paper" : "Origin" }, origin);
}

export class ChartCard {
  readonly element: HTMLElement;
  readonly model: ChartModel;
  private plot_: Plot | null = null;
  private readout_: Readout | null = null;
  private readonly number_: number;
  private readonly say_origin_: boolean;
  private readonly plot_box_ = h("div", { class: "plot-live", tabindex: 0, role: "group" });
  private readonly print_box_ = h("div", { class: "plot-print", "aria-hidden": "true" });
  private readonly legend_ = h("div", { class: "legend", role: "group", "aria-label": "Curves" });
  private readonly note_ = h("div", { class: "chart-note", hidden: true, "aria-live": "polite" });
  private readonly offer_ = h("div", { class: "chart-offer", hidden: true });
  private readonly reset_ = h("button", { type: "button", hidden: true, onclick: () => this.plot_?.reset() }, "Reset zoom");
  private readonly wide_ = h("button", { type: "button", class: "tool-wide", "aria-pressed": "false", title: "Use the whole width" }, "Widen");

  constructor(chart: Chart, runs: Runs, figure: number, say_origin: boolean) {
    this.model = new ChartModel(chart, runs);
    this.number_ = figure;
    this.say_origin_ = say_origin;
    this.plot_box_.setAttribute("aria-label", `Plot of ${chart.title}. Arrow keys move the cursor, plus and minus zoom, 0 resets.`);
    this.element = this.build();
    this.update_legend();
    this.update_notes();
    runs.on_change(() => this.changed());
    this.plot_box_.addEventListener("keydown", (event) => this.key(event));
    this.wide_.addEventListener("click", () => this.widen());
  }

  get id(): string {
    return this.model.chart.id;
  }

  get rendered(): boolean {
    return this.plot_ !== null;
  }

  get canvas(): HTMLCanvasElement | null {
    return this.plot_?.u.ctx.canvas ?? null;
  }

  /** Numbers of ticks of the axes that are drawn. */
  get ticks(): number[] {
    return this.plot_?.u.axes.map((axis) => (axis as { _splits?: number[] | null })._splits?.length ?? 0) ?? [];
  }

  get view(): View {
    return this.plot_?.view ?? this.model.default_view();
  }

  /** Draws the live plot; nothing happens the second time. */
  render(): void {
    if (this.plot_) return;
    const width = this.plot_box_.clientWidth || 480;
    this.plot_ = new Plot(this.model, this.plot_box_, width, this.height(width), {
      cursor: (at) => this.show_readout(at),
      view: () => this.update_notes(),
    });
    this.readout_ = new Readout(this.model, this.plot_.u.over);
    this.plot_box_.classList.add("is-drawn");
    new ResizeObserver(() => this.fit()).observe(this.plot_box_);
    this.update_notes();
  }

  /** Colours changed. */
  repaint(): void {
    this.plot_?.u.redraw(false, true);
  }

  prepare_print(): void {
    const options = { width: 460, height: 268, standalone: false };
    this.print_box_.innerHTML = chart_svg(this.model, this.view, options);
  }

  end_print(): void {
    this.print_box_.replaceChildren();
  }

  set_visible(label: string, visible: boolean): void {
    for (const curve of this.model.curves) if (curve.label === label) curve.hidden = !visible;
    this.changed();
  }

  set_view(view: View): void {
    this.render();
    this.plot_?.set_view(view, true);
  }

  csv(): string {
    return chart_csv(this.model);
  }

  svg(): string {
    return chart_svg(this.model, this.view, { width: 720, height: 400, standalone: true });
  }

  private build(): HTMLElement {
    const { chart } = this.model;
    const name = file_name(chart.id);
    const tools = h(
      "div",
      { class: "tools" },
      this.reset_,
      this.wide_,
      h("button", { type: "button", class: "tool-csv", title: "Download the values of this figure in SI units", onclick: () => download(`${name}.csv`, "text/csv", this.csv()) }, "CSV"),
      h("button", { type: "button", class: "tool-svg", title: "Download this figure as a drawing", onclick: () => download(`${name}.svg`, "image/svg+xml", this.svg()) }, "SVG"),
    );
    return h(
      "figure",
      { class: "card chart", id: `chart-${chart.id}` },
      h("header", {}, h("h3", {}, h("span", { class: "fig" }, `Fig. ${this.number_}`), chart.title), this.say_origin_ ? origin_chip(chart.origin) : null, tools),
      h("div", { class: "ylabel" }, this.model.ylabel),
      this.plot_box_,
      this.print_box_,
      this.legend_,
      this.offer_,
      this.note_,
      chart.caption ? h("figcaption", {}, chart.caption) : null,
    );
  }

  private height(width: number): number {
    return Math.round(Math.min(380, Math.max(230, width * 0.52)));
  }

  private fit(): void {
    const width = this.plot_box_.clientWidth;
    if (width > 0) this.plot_?.resize(width, this.height(width));
  }

  private widen(): void {
    const wide = this.element.classList.toggle("is-wide");
    this.wide_.setAttribute("aria-pressed", String(wide));
  }

  private changed(): void {
    this.update_legend();
    this.plot_?.refresh();
    this.update_notes();
    this.readout_?.hide();
  }

  private update_legend(): void {
    const single = this.model.curves.length === 1 && this.model.curves[0]?.run === undefined;
    this.legend_.hidden = single;
    this.legend_.replaceChildren(
      ...this.model.curves.map((curve) =>
        h(
          "button",
          {
            type: "button",
            class: "key",
            "aria-pressed": String(this.model.visible(curve)),
            title: "Click to hide or show this curve. Shift-click to show only this curve.",
            onclick: (event) => this.toggle(curve, (event as MouseEvent).shiftKey),
          },
          swatch(curve.slot, curve.dash, dash_of(curve, true), curve.style),
          h("span", {}, curve.label),
          curve.failed ? h("em", {}, "failed") : null,
        ),
      ),
    );
  }

  private toggle(curve: Curve, alone: boolean): void {
    const { runs, curves } = this.model;
    const focus = document.activeElement instanceof HTMLElement ? curves.indexOf(curve) : -1;
    this.offer_.hidden = true;
    if (alone) {
      for (const other of curves) other.hidden = other !== curve;
    } else if (this.model.visible(curve)) {
      curve.hidden = true;
      if (curve.run !== undefined) this.offer(curve.run);
    } else {
      curve.hidden = false;
      if (runs.hidden(curve.run) && curve.run !== undefined) runs.set_hidden([curve.run], false);
    }
    this.changed();
    // The legend was rebuilt: keep the keyboard where it was.
    (this.legend_.children[focus] as HTMLElement | undefined)?.focus({ preventScroll: true });
  }

  private offer(run: string): void {
    const everywhere = (): void => {
      this.offer_.hidden = true;
      this.model.runs.set_hidden([run], true);
    };
    this.offer_.replaceChildren(
      h("span", {}, `“${run}” is hidden in this figure.`),
      h("button", { type: "button", class: "everywhere", onclick: everywhere }, "Hide everywhere"),
    );
    this.offer_.hidden = false;
  }

  private update_notes(): void {
    this.reset_.hidden = !(this.plot_?.zoomed ?? false);
    const clipped = this.model.clipped();
    this.note_.hidden = clipped.length === 0 && !this.model.full;
    if (this.note_.hidden) return;
    const told = clipped.length > 2 ? `${clipped.length} curves of failed runs leave this range.` : clipped.map((c) => this.leaves(c)).join(" ");
    const text = this.model.full ? "Full range including failed runs." : told;
    const flip = (): void => {
      this.model.full = !this.model.full;
      this.plot_?.reset();
      this.update_notes();
    };
    this.note_.replaceChildren(
      h("span", {}, text),
      h("button", { type: "button", onclick: flip }, this.model.full ? "Range without failed runs" : "Show full range"),
    );
  }

  private leaves(curve: Curve): string {
    const { yscale } = this.model;
    const largest = Math.max(Math.abs(curve.yrange.min), Math.abs(curve.yrange.max));
    const beyond = number(largest / yscale.factor, 3) + (yscale.unit ? `\u00a0${yscale.unit}` : "");
    return `“${curve.label}” (failed) leaves this range: it reaches ${beyond}.`;
  }

  private show_readout(at: { left: number; top: number } | null): void {
    const u = this.plot_?.u;
    if (!u || !this.plot_ || !this.readout_) return;
    if (!at) {
      this.readout_.hide();
      return;
    }
    const map = this.plot_.projection(false);
    this.readout_.show(at.left, at.top, u.over.clientWidth, u.over.clientHeight, map, u.posToVal(at.left, "x"));
  }

  private key(event: KeyboardEvent): void {
    const u = this.plot_?.u;
    if (!u || event.ctrlKey || event.metaKey || event.altKey) return;
    const width = u.over.clientWidth;
    const left = Math.max(0, u.cursor.left ?? -1);
    const step = event.shiftKey ? width / 10 : width / 100;
    const move = (x: number): void => u.setCursor({ left: Math.min(width, Math.max(0, x)), top: u.over.clientHeight / 2 });
    if (event.key === "ArrowRight") move(left + step);
    else if (event.key === "ArrowLeft") move(left - step);
    else if (event.key === "Home") move(0);
    else if (event.key === "End") move(width);
    else if (event.key === "+" || event.key === "=") this.plot_?.zoom_x(0.6, left / width);
    else if (event.key === "-") this.plot_?.zoom_x(1 / 0.6, left / width);
    else if (event.key === "0" || event.key === "Escape") this.plot_?.reset();
    else return;
    event.preventDefault();
  }
}
