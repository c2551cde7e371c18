// A small drawing of one floor spectrum for the first page: the run, the bonded run and what is broadened, with its largest values named.
import { h, px, s } from "./dom";
import { number, pretty_unit } from "./format";
import { linear_ticks, log_ticks, tick_labels } from "./ticks";
import type { Chart, Series } from "./types";

const WIDTH = 400;
const HEIGHT = 210;
const LEFT = 34;
const RIGHT = 10;
const TOP = 8;
const BOTTOM = 34;

/** What kind of line a series is: the drawing tells them apart without colour. */
function kind_of(series: Series): "bonded" | "broadened" | "raw" {
  if (series.dash) return "bonded";
  return series.run ? "raw" : "broadened";
}

export function spectrum_chart(chart: Chart): HTMLElement | null {
  const wanted = ["broadened", "bonded", "raw"] as const;
  const lines = wanted.flatMap((kind) => {
    const found = chart.series.find((series) => kind_of(series) === kind && !series.failed);
    return found ? [{ kind, series: found }] : [];
  });
  const points = lines.flatMap(({ series }) => series.x.map((x, i) => [x ?? NaN, series.y[i] ?? NaN] as const)).filter(([x, y]) => x > 0 && Number.isFinite(y));
  if (points.length < 2) return null;
  const [from, to] = [Math.min(...points.map(([x]) => x)), Math.max(...points.map(([x]) => x))];
  const top = 1.05 * Math.max(...points.map(([, y]) => y));
  if (!(to > from) || !(top > 0)) return null;
  const x = (f: number): number => LEFT + (Math.log(f / from) / Math.log(to / from)) * (WIDTH - LEFT - RIGHT);
  const y = (a: number): number => TOP + (1 - a / top) * (HEIGHT - TOP - BOTTOM);
  const path = ({ x: xs, y: ys }: Series): string => {
    const parts: string[] = [];
    xs.forEach((f, i) => {
      const a = ys[i];
      if (f && f > 0 && a !== null && a !== undefined) parts.push(`${parts.length === 0 ? "M" : "L"}${px(x(f))} ${px(y(a))}`);
    });
    return parts.join("");
  };
  const text = (tx: number, ty: number, anchor: string, words: string): SVGElement => s("text", { x: px(tx), y: px(ty), "text-anchor": anchor, class: "tick" }, words);
  const rows = linear_ticks(0, top, 4);
  const columns = log_ticks(from, to, 6);
  const [row_words, column_words] = [tick_labels(rows, false), tick_labels(columns, true)];
  const drawing = s("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": chart.title },
    ...rows.map((a) => s("path", { class: "rule", d: `M${LEFT} ${px(y(a))}H${WIDTH - RIGHT}` })),
    ...rows.map((a, i) => text(LEFT - 5, y(a) + 4, "end", row_words[i] ?? "")),
    ...columns.map((f, i) => text(x(f), HEIGHT - BOTTOM + 16, "middle", column_words[i] ?? "")),
    text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 4, "middle", "Hz"),
    ...lines.map(({ kind, series }) => s("path", { class: `spectrum is-${kind}`, d: path(series) })));
  const key = (kind: string, words: string): HTMLElement =>
    h("span", {}, s("svg", { viewBox: "0 0 22 8", width: 22, height: 8, "aria-hidden": "true" }, s("path", { class: `spectrum is-${kind}`, d: "M0 4H22" })), words);
  const peak = (series: Series): string => number(Math.max(...series.y.map((a) => a ?? 0)), 3);
  const words = { raw: "with uplift", bonded: "bonded", broadened: "broadened" };
  const named = (kind: keyof typeof words, series: Series): string => (kind === "broadened" && /envelope/.test(series.label) ? series.label.replace(/ by .*/, "") : words[kind]);
  return h("figure", { class: "share-chart spectrum-chart" },
    h("figcaption", {}, h("b", {}, chart.title.replace(": floor spectrum", "")), ` · ${chart.y.label.toLowerCase()} (${pretty_unit(chart.y.unit)})`),
    drawing,
    h("div", { class: "spectrum-keys" }, ...[...lines].reverse().map(({ kind, series }) => key(kind, `${named(kind, series)}, peak ${peak(series)}`))));
}
