// window.upliftReport: what the page shows, for tests and for curious readers in the browser's console.
import type { AnimationCard } from "./animation";
import type { ChartCard } from "./chart";
import type { View } from "./curve";
import type { SpaceCard } from "./space/card";
import type { TableCard } from "./table";
import type { Report } from "./types";

export interface Inspection {
  hasData: boolean;
  message: string;
  report: Report | null;
  charts: ChartProbe[];
  tables: { id: string; rows: number }[];
  animation: AnimationCard | null;
  space: SpaceCard | null;
  /** Draws every chart and the space view now, wherever the page stands. */
  renderAll(): void;
  chart(id: string): ChartProbe | undefined;
}

export interface ChartProbe {
  id: string;
  readonly rendered: boolean;
  readonly series: { label: string; run: string | undefined; length: number; visible: boolean; failed: boolean }[];
  readonly view: View;
  readonly canvas: HTMLCanvasElement | null;
  readonly ticks: number[];
  /** Number of canvas pixels with the given curve colours or any ink at all. */
  inkedPixels(): number;
  setVisible(label: string, visible: boolean): void;
  setView(view: View): void;
  csv(): string;
  svg(): string;
}

function inked_pixels(canvas: HTMLCanvasElement | null): number {
  const context = canvas?.getContext("2d");
  if (!canvas || !context || canvas.width === 0) return 0;
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  // Grid and axes are grey; curves are the only saturated ink, greys of the palette aside.
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b, a] = [data[i] as number, data[i + 1] as number, data[i + 2] as number, data[i + 3] as number];
    if (a > 60 && Math.max(r, g, b) - Math.min(r, g, b) > 40) count++;
  }
  return count;
}

function probe(card: ChartCard): ChartProbe {
  return {
    id: card.id,
    get rendered() {
      return card.rendered;
    },
    get series() {
      const { model } = card;
      return model.curves.map((c) => ({ label: c.label, run: c.run, length: c.length, visible: model.visible(c), failed: c.failed }));
    },
    get view() {
      return card.view;
    },
    get canvas() {
      return card.canvas;
    },
    get ticks() {
      return card.ticks;
    },
    inkedPixels: () => inked_pixels(card.canvas),
    setVisible: (label, visible) => card.set_visible(label, visible),
    setView: (view) => card.set_view(view),
    csv: () => card.csv(),
    svg: () => card.svg(),
  };
}

export function inspection(
  report: Report | null,
  message: string,
  charts: ChartCard[] = [],
  tables: TableCard[] = [],
  animation: AnimationCard | null = null,
  space: SpaceCard | null = null,
): Inspection {
  const probes = charts.map(probe);
  return {
    hasData: report !== null,
    message,
    report,
    charts: probes,
    get tables() {
      return tables.map((t) => ({ id: t.table.id, rows: t.row_count }));
    },
    animation,
    space,
    renderAll: () => [...(space ? [space] : []), ...charts].forEach((card) => card.render()),
    chart: (id) => probes.find((p) => p.id === id),
  };
}

declare global {
  interface Window {
    upliftReport: Inspection;
  }
}
