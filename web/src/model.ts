// The drawing of the model: what was computed, with the normals of the interfaces and the sign conventions.
import { h, s, px } from "./dom";
import { number } from "./format";
import { carrier, contact_line, Map2, model_box, node_map, outline_of, round_down, type Point } from "./geometry";
import { arrow, hatched, Labels, path_of, spring, support } from "./symbols";
import type { Interface, InterfacePoint, Model, ModelNode, Support } from "./types";

const WIDTH = 440;
const HEIGHT = 390;
const NORMAL = 18;
const ABSORBER = 26;
const LOAD_GAP = 15;
const LOAD_LENGTH = 40;
const MAX_NAMED_NODES = 40;

/** 52 000 kg as "52 t". */
export function mass_text(mass: number): string {
  const short = (value: number): string => (value >= 1e5 ? number(value, 3) : String(Number(value.toPrecision(3))));
  return mass >= 1000 ? `${short(mass / 1000)} t` : `${short(mass)} kg`;
}

function titled<E extends SVGElement>(element: E, title: string): E {
  element.prepend(s("title", {}, title));
  return element;
}

/** A label to place; those of a lower rank first, because they get the best positions and must not be left out. */
interface WantedLabel {
  anchor: Point;
  away: number;
  content: string;
  cls: string;
  rank: number;
}

class Drawing {
  readonly svg = s("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "model-svg", role: "img", "aria-label": "Drawing of the model" });
  private readonly model_: Model;
  private readonly map_: Map2;
  private readonly nodes_: Map<string, ModelNode>;
  private readonly labels_ = new Labels(WIDTH, HEIGHT);
  private readonly ground_ends_: { face: Interface; end: Point }[] = [];
  private readonly solid_names_: { low: Point; high: Point; name: string }[] = [];
  private readonly wanted_: WantedLabel[] = [];
  private readonly text_ = s("g", { class: "labels" });

  constructor(model: Model) {
    this.model_ = model;
    this.nodes_ = node_map(model);
    // Loads that act downwards stand above their node.
    const top = model.loads.some((load) => load.fy < 0) ? LOAD_GAP + LOAD_LENGTH + 22 : 30;
    this.map_ = new Map2(model_box(model), WIDTH, HEIGHT, { left: 78, right: 78, top, bottom: 56 });
    this.mesh();
    this.ground();
    this.bodies();
    this.beams();
    this.springs();
    this.absorbing();
    this.supports();
    this.masses();
    this.interfaces();
    this.loads();
    this.nodes();
    this.svg.append(this.text_, this.scale_bar());
    this.write_labels();
  }

  private at(name: string | null | undefined): Point | null {
    const node = name ? this.nodes_.get(name) : undefined;
    return node ? this.map_.at(node.x, node.y) : null;
  }

  private mesh(): void {
    const grid = this.model_.grid.map(([x1, y1, x2, y2]) => path_of([this.map_.at(x1, y1), this.map_.at(x2, y2)]));
    const outlines = this.model_.outlines;
    const lines = outlines.map((part) => part.lines.map((line) => line.map((name) => this.at(name)).filter((p): p is Point => p !== null)));
    outlines.forEach((part, i) => this.svg.append(titled(s("path", { class: "solid", d: (lines[i] as Point[][]).map((line) => path_of(line, true)).join("") }), part.name)));
    if (grid.length > 0) this.svg.append(s("path", { class: "grid-lines", d: grid.join("") }));
    outlines.forEach((part, i) => {
      const points = (lines[i] as Point[][]).flat();
      const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
      if (points.length > 0) this.solid_names_.push({ low: [Math.min(...xs), Math.min(...ys)], high: [Math.max(...xs), Math.max(...ys)], name: part.name });
    });
  }

  private ground(): void {
    for (const face of this.model_.interfaces) {
      const line = contact_line(face);
      if (!line) continue;
      const [a, b] = line.map(([x, y]) => this.map_.at(x, y)) as [Point, Point];
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      const by = 0.16 * length;
      const [ux, uy] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
      const [p, q]: [Point, Point] = [[a[0] - ux * by, a[1] - uy * by], [b[0] + ux * by, b[1] + uy * by]];
      if (!face.opened) this.svg.append(hatched(p, q, 11, "hatch ground"));
      this.labels_.block_line(p, q);
      this.labels_.block_line([p[0] - uy * 9, p[1] + ux * 9], [q[0] - uy * 9, q[1] + ux * 9]);
      this.ground_ends_.push({ face, end: q });
    }
  }

  private bodies(): void {
    for (const body of this.model_.bodies) {
      const corners = outline_of(this.model_, body).map(([x, y]) => this.map_.at(x, y));
      if (corners.length === 0) continue;
      this.svg.append(titled(s("path", { class: "body", d: path_of(corners, true) }), `rigid body ${body.name}, moves with node ${body.node}`));
      corners.forEach((c, i) => this.labels_.block_line(c, corners[(i + 1) % corners.length] as Point));
    }
  }

  private beams(): void {
    for (const beam of this.model_.beams) {
      const points = beam.nodes.map((name) => this.at(name)).filter((p): p is Point => p !== null);
      const nodes = beam.nodes.length > 6 ? [beam.nodes[0], "…", beam.nodes[beam.nodes.length - 1]] : beam.nodes;
      this.svg.append(titled(s("path", { class: "beam", d: path_of(points) }), `beam ${beam.name}: ${nodes.join(" – ")}`));
      for (let i = 1; i < points.length; i++) this.labels_.block_line(points[i - 1] as Point, points[i] as Point);
    }
  }

  private springs(): void {
    for (const item of this.model_.springs) {
      const a = this.at(item.nodes[0]);
      if (!a) continue;
      // A spring to the fixed ground has no second node: draw it to the lower left.
      const b: Point = this.at(item.nodes[1]) ?? [a[0] - 40, a[1] + 24];
      this.svg.append(titled(spring(a, b, item.kind), `${item.kind} ${item.nodes.map((n) => n ?? "ground").join(" – ")}`));
      if (!item.nodes[1]) this.svg.append(hatched([b[0] - 10, b[1]], [b[0] + 10, b[1]], 6));
      this.labels_.block_line(a, b);
    }
  }

  private supports(): void {
    for (const item of this.model_.supports) {
      const at = this.support_place(item);
      if (!at) continue;
      const symbol = support(at, item.dofs);
      // On the right side of a mesh the symbol stands outside, too.
      const right = this.model_.outlines.length > 0 && at[0] > this.map_.middle[0] + 1 && !item.dofs.includes("uy");
      if (right) symbol.setAttribute("transform", `translate(${px(2 * at[0])} 0) scale(-1 1)`);
      if (item.staticsOnly) symbol.classList.add("statics-only");
      const when = item.staticsOnly ? " in static stages only" : "";
      this.svg.append(titled(symbol, `support at ${item.node}: ${item.dofs.join(", ")} blocked${when}`));
      this.labels_.block(at, 14);
    }
  }

  // Dashpots at equal distances along the faces, out of the model; an arrow where a wave comes in.
  private absorbing(): void {
    const middle = this.map_.middle;
    for (const face of this.model_.absorbing) {
      const edges = face.edges.map(([x1, y1, x2, y2]) => [this.map_.at(x1, y1), this.map_.at(x2, y2)] as [Point, Point]);
      const group = s("g", { class: "absorbing" }, s("path", { class: "face-line", d: edges.map((edge) => path_of(edge)).join("") }));
      const length = edges.reduce((sum, [a, b]) => sum + Math.hypot(b[0] - a[0], b[1] - a[1]), 0);
      const every = length / Math.max(2, Math.min(8, Math.round(length / 40)));
      let next = every / 2;
      let done = 0;
      for (const [a, b] of edges) {
        const size = Math.hypot(b[0] - a[0], b[1] - a[1]);
        for (; size > 0 && next <= done + size; next += every) {
          const share = (next - done) / size;
          const at: Point = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
          const out: Point = [-(b[1] - a[1]) / size, (b[0] - a[0]) / size];
          const side = (at[0] - middle[0]) * out[0] + (at[1] - middle[1]) * out[1] < 0 ? -1 : 1;
          const end: Point = [at[0] + side * out[0] * ABSORBER, at[1] + side * out[1] * ABSORBER];
          group.append(spring(at, end, "dashpot"));
          this.labels_.block_line(at, end);
        }
        done += size;
      }
      const parts = [`absorbing face ${face.group}`, face.freeField ? "with free-field column" : "", face.incident ? "with incident wave" : ""];
      this.svg.append(titled(group, parts.filter((text) => text !== "").join("; ")));
    }
  }

  // A support against sliding of a body is drawn at the side of the body, clear of the interface.
  private support_place(item: Support): Point | null {
    const body = this.model_.bodies.find((b) => b.node === item.node);
    const corners = body ? outline_of(this.model_, body).map(([x, y]) => this.map_.at(x, y)) : [];
    if (item.dofs.includes("uy") || !item.dofs.includes("ux") || corners.length === 0) return this.at(item.node);
    const left = Math.min(...corners.map(([x]) => x));
    const side = corners.filter(([x]) => x < left + 1).map(([, y]) => y);
    return [left, (Math.min(...side) + Math.max(...side)) / 2];
  }

  private masses(): void {
    const largest = Math.max(...this.model_.masses.map((m) => m.mass), 0);
    for (const { node, mass } of this.model_.masses) {
      const at = this.at(node);
      if (!at || !(mass > 0)) continue;
      const r = Math.max(4.5, 13 * Math.cbrt(mass / largest));
      this.svg.append(titled(s("circle", { class: "mass", cx: px(at[0]), cy: px(at[1]), r: px(r) }), `mass at ${node}: ${mass_text(mass)}`));
      this.labels_.block(at, r);
    }
  }

  private interfaces(): void {
    for (const face of this.model_.interfaces) {
      const owner = carrier(this.model_, face);
      let last: Point | null = null;
      face.points.forEach((p: InterfacePoint, i) => {
        const at = this.map_.at(p.x, p.y);
        const title = `${face.name}, point ${i + 1}: x ${number(p.x)} m, y ${number(p.y)} m, area ${number(p.area)} m²${owner ? `, upper face on ${owner}` : ""}`;
        const g = titled(s("g", { class: "face" }, s("circle", { cx: px(at[0]), cy: px(at[1]), r: 2.4 })), title);
        // Normals of many points would merge into a block; leave room between them.
        if (!last || Math.hypot(at[0] - last[0], at[1] - last[1]) >= 12) {
          const tip: Point = [at[0] + p.nx * NORMAL, at[1] - p.ny * NORMAL];
          g.append(arrow(at, tip, 6, "normal"));
          this.labels_.block_line(at, tip);
          last = at;
        }
        this.svg.append(g);
        this.labels_.block(at, 3);
      });
    }
  }

  private loads(): void {
    for (const load of this.model_.loads) {
      const at = this.at(load.node);
      const size = Math.hypot(load.fx, load.fy);
      if (!at || size === 0) continue;
      const [ux, uy] = [load.fx / size, -load.fy / size];
      const tail: Point = [at[0] - ux * (LOAD_GAP + LOAD_LENGTH), at[1] - uy * (LOAD_GAP + LOAD_LENGTH)];
      this.svg.append(titled(arrow(tail, [at[0] - ux * LOAD_GAP, at[1] - uy * LOAD_GAP], 9, "load"), `load at ${load.node}: ${load.label}`));
      this.labels_.block_line(tail, at);
      this.wanted_.push({ anchor: tail, away: 2, content: load.label, cls: "load-name", rank: 0 });
    }
  }

  private nodes(): void {
    const named = this.model_.nodes.filter((node) => !node.hidden).length <= MAX_NAMED_NODES;
    for (const node of this.model_.nodes) {
      if (node.hidden) continue;
      const at = this.map_.at(node.x, node.y);
      const mass = this.model_.masses.find((m) => m.node === node.name && m.mass > 0);
      const title = `node ${node.name}: x ${number(node.x)} m, y ${number(node.y)} m`;
      this.svg.append(titled(s("circle", { class: "node", cx: px(at[0]), cy: px(at[1]), r: mass ? 1.8 : 3 }), title));
      this.labels_.block(at, 3);
      const label = mass ? `${node.name}  ${mass_text(mass.mass)}` : node.name;
      if (named || mass) this.wanted_.push({ anchor: at, away: mass ? 14 : 5, content: label, cls: "node-name", rank: mass ? 0 : 2 });
    }
  }

  // Last, when all symbols are drawn.
  private write_labels(): void {
    for (const { face, end } of this.ground_ends_) {
      const count = face.points.length === 1 ? "1 point" : `${face.points.length} points`;
      this.wanted_.push({ anchor: end, away: 10, content: `${face.name}: ${count}`, cls: "face-name", rank: 1 });
    }
    const solids = this.solid_names_.map(({ low, high, name }) => this.labels_.place_inside(low, high, name, "solid-name"));
    const others = this.wanted_
      .sort((a, b) => a.rank - b.rank)
      .map(({ anchor, away, content, cls }) => this.labels_.place(anchor, away, content, cls));
    this.text_.append(...[...solids, ...others].filter((text) => text !== null));
  }

  private scale_bar(): SVGElement {
    const metres = round_down(90 / this.map_.scale);
    const length = metres * this.map_.scale;
    const y = HEIGHT - 18;
    const d = `M20 ${y - 4}V${y + 4}M20 ${y}H${px(20 + length)}M${px(20 + length)} ${y - 4}V${y + 4}`;
    const text = metres < 1 ? `${number(metres * 1000, 1)} mm` : `${metres} m`;
    this.labels_.block_line([20, y], [28 + length + 7 * text.length, y]);
    return s("g", { class: "scale-bar" }, s("path", { d }), s("text", { x: px(28 + length), y: y + 4 }, text));
  }
}

function legend_item(symbol: SVGElement, text: string): HTMLElement {
  return h("li", {}, s("svg", { viewBox: "0 0 30 22", width: 30, height: 22, class: "model-svg", "aria-hidden": "true" }, symbol), text);
}

/** Only what the model has, and the sign conventions. */
function legend(model: Model): HTMLElement {
  const items: (HTMLElement | null)[] = [
    model.outlines.length > 0 ? legend_item(s("path", { class: "solid", d: "M4 5H26V17H4Z" }), "solid (mesh)") : null,
    model.beams.length > 0 ? legend_item(s("path", { class: "beam", d: "M3 11H27" }), "beam") : null,
    model.bodies.length > 0 ? legend_item(s("path", { class: "body", d: "M4 6H26V16H4Z" }), "rigid body") : null,
    model.masses.length > 0 ? legend_item(s("circle", { class: "mass", cx: 15, cy: 11, r: 7 }), "mass") : null,
    model.springs.some((i) => i.kind === "spring") ? legend_item(spring([2, 11], [28, 11], "spring"), "spring") : null,
    model.springs.some((i) => i.kind === "dashpot") ? legend_item(spring([2, 11], [28, 11], "dashpot"), "dashpot") : null,
    model.absorbing.length > 0
      ? legend_item(s("g", { class: "absorbing" }, s("path", { class: "face-line", d: "M3 3V19" }), spring([3, 11], [28, 11], "dashpot")),
        `absorbing face${model.absorbing.some((face) => face.incident) ? `; incident wave through ${model.absorbing.filter((face) => face.incident).map((face) => face.group).join(", ")}` : ""}`)
      : null,
    model.supports.some((item) => item.staticsOnly)
      ? legend_item(s("g", { class: "support statics-only" }, s("path", { d: "M15 3L7 17H23Z" })), "support in static stages only")
      : null,
    model.loads.length > 0 ? legend_item(arrow([3, 11], [27, 11], 8, "load"), "load") : null,
  ];
  if (model.interfaces.length > 0) {
    const mark = s("g", { class: "face" }, s("circle", { cx: 15, cy: 18, r: 2.4 }), arrow([15, 18], [15, 2], 6, "normal"));
    items.push(legend_item(mark, "interface point, normal n from the lower to the upper face"));
  }
  const signs = h("p", { class: "signs" }, h("b", {}, "opening > 0"), " the faces separate along n; ", h("b", {}, "tension > 0"), " pulls the upper face against n.");
  return h("div", { class: "model-legend" }, h("ul", {}, ...items), model.interfaces.length > 0 ? signs : null);
}

/** The figure with the drawing of the model. */
export function model_card(model: Model): HTMLElement {
  return h(
    "figure",
    { class: "card model-card", id: "model-drawing" },
    h("header", {}, h("h3", {}, "Model as computed")),
    new Drawing(model).svg,
    legend(model),
  );
}
