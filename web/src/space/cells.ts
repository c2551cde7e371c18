// Surfaces as polygons for the painter: two triangles that share an inner edge of a cell become one quadrilateral, so
// that no seam shows along the diagonal.
import { sharp_edges } from "./shape";
import type { SpacePart } from "../space_types";

/** A side may be an edge of an element, a sharp edge of the surface, or neither. */
export type Edge = "none" | "cell" | "sharp";

export interface Cell {
  /** Node indices around the polygon. */
  nodes: number[];
  /** Kind of the side that starts at each node. */
  edges: Edge[];
}

const key = (a: number, b: number): string => (a < b ? `${a} ${b}` : `${b} ${a}`);

const pairs = (flat: number[]): Set<string> => new Set(flat.flatMap((a, i) => (i % 2 === 0 ? [key(a, flat[i + 1] as number)] : [])));

export function cells_of(nodes: number[], part: SpacePart): Cell[] {
  const cell_edges = pairs(part.edges);
  const sharp = pairs(sharp_edges(nodes, part.triangles));
  const kind = (a: number, b: number): Edge => (sharp.has(key(a, b)) ? "sharp" : cell_edges.has(key(a, b)) ? "cell" : "none");
  const polygon = (corners: number[]): Cell => ({ nodes: corners, edges: corners.map((a, i) => kind(a, corners[(i + 1) % corners.length] as number)) });
  // Triangles that still wait for a partner, by inner edge: the edge and the corner opposite to it.
  const waiting = new Map<string, { triangle: number; opposite: number }>();
  const cells = new Map<number, Cell>();
  for (let t = 0; 3 * t < part.triangles.length; t++) {
    const corners = part.triangles.slice(3 * t, 3 * t + 3);
    const inner = [0, 1, 2].filter((k) => kind(corners[k] as number, corners[(k + 1) % 3] as number) === "none");
    const meeting = inner.find((k) => cells.get(waiting.get(key(corners[k] as number, corners[(k + 1) % 3] as number))?.triangle ?? -1)?.nodes.length === 3);
    if (meeting === undefined) {
      cells.set(t, polygon(corners));
      for (const k of inner) waiting.set(key(corners[k] as number, corners[(k + 1) % 3] as number), { triangle: t, opposite: corners[(k + 2) % 3] as number });
      continue;
    }
    const [a, b, c] = [0, 1, 2].map((k) => corners[(meeting + k) % 3] as number) as [number, number, number];
    const partner = waiting.get(key(a, b)) as { triangle: number; opposite: number };
    cells.set(partner.triangle, polygon([a, partner.opposite, b, c]));
  }
  return [...cells.values()];
}
