// A small drawing of the uplifted share over time, with the user's thresholds.
import { h, px, s } from "./dom";
import { fixed, number } from "./format";
import { linear_ticks, tick_labels } from "./ticks";
import type { BaseVerdict } from "./types";

const WIDTH = 460;
const HEIGHT = 150;
const LEFT = 40;
const RIGHT = 12;
const TOP = 10;
const BOTTOM = 24;

// So many intervals without contact are named.
const SHOWN = 3;

/** The next round share above the largest one. */
function top_of(largest: number): number {
  return [0.05, 0.1, 0.2, 0.4, 0.6, 0.8].find((top) => largest <= 0.95 * top) ?? 1;
}

export function share_chart(base: BaseVerdict): HTMLElement | null {
  const { time, share, above } = base;
  const largest = share.reduce((m, v) => Math.max(m, v), 0);
  if (time.length < 2 || largest <= 0) return null;
  const peak = share.indexOf(largest);
  const top = top_of(Math.max(largest, ...above.map((each) => each.threshold)));
  const [from, to] = [time[0] as number, time[time.length - 1] as number];
  const x = (t: number): number => LEFT + ((t - from) / (to - from)) * (WIDTH - LEFT - RIGHT);
  const y = (v: number): number => TOP + (1 - v / top) * (HEIGHT - TOP - BOTTOM);
  const line = time.map((t, i) => `${i === 0 ? "M" : "L"}${px(x(t))} ${px(y(share[i] as number))}`).join("");
  const ticks = linear_ticks(from, to, 6);
  const labels = tick_labels(ticks, false);
  const text = (tx: number, ty: number, anchor: string, words: string, kind = "tick"): SVGElement =>
    s("text", { x: px(tx), y: px(ty), "text-anchor": anchor, class: kind }, words);
  const drawing = s("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `Uplifted share over time, at most ${fixed(100 * largest, 0)} %` },
    ...[0, 0.5, 1].map((part) => s("path", { class: "rule", d: `M${LEFT} ${px(y(part * top))}H${WIDTH - RIGHT}` })),
    ...[0, 0.5, 1].map((part) => text(LEFT - 6, y(part * top) + 4, "end", `${number(100 * part * top, 2)} %`)),
    ...ticks.map((t, i) => text(x(t), HEIGHT - 8, "middle", `${labels[i] ?? ""}${i === ticks.length - 1 ? " s" : ""}`)),
    s("path", { class: "area", d: `${line}L${px(x(to))} ${px(y(0))}L${px(x(from))} ${px(y(0))}Z` }),
    s("path", { class: "line", d: line }),
    ...base.lost.map(([a, b]) => s("path", { class: "lost", d: `M${px(x(a))} ${TOP}V${HEIGHT - BOTTOM}H${px(Math.max(x(b), x(a) + 1))}V${TOP}Z` })),
    ...above.map((each) => s("path", { class: "threshold", d: `M${LEFT} ${px(y(each.threshold))}H${WIDTH - RIGHT}` })),
    s("circle", { class: "peak", cx: px(x(time[peak] as number)), cy: px(y(largest)), r: 3.5 }));
  const words = above.map((each) => each.text);
  if (base.lost.length > 0) {
    const shown = base.lost.slice(0, SHOWN).map(([a, b]) => `${number(a, 4)} to ${number(b, 4)} s`).join(", ");
    const more = base.lost.length > SHOWN ? " and later" : "";
    words.push(`${base.lostText} (${shown}${more})`);
  }
  return h("figure", { class: "share-chart" },
    h("figcaption", {}, h("b", {}, "Uplifted area over time"), words.length > 0 ? ` · ${words.join(" · ")}` : ""), drawing);
}
