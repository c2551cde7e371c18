// Marks over the view, drawn as SVG: the axes, a scale bar, the loads with their labels. They follow the frame.
import { s, px } from "../dom";
import { number } from "../format";
import { round_down } from "../geometry";
import { arrow } from "../symbols";
import { project, type Frame } from "./frame";
import type { Pose } from "./pose";
import { dot, unit, type Vec3 } from "./vector";
import type { SpaceModel } from "../space_types";

const AXIS = 26;
const LOAD = 46;
const AXES: [string, Vec3][] = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];

function axes(frame: Frame): SVGElement {
  const [x0, y0] = [42, frame.height - 40];
  const group = s("g", { class: "space-axes" });
  for (const [name, axis] of AXES) {
    const [dx, dy] = [AXIS * dot(axis, frame.right), -AXIS * dot(axis, frame.up)];
    const size = Math.hypot(dx, dy);
    // An axis that points at the viewer has no length to draw.
    if (size < 4) continue;
    group.append(arrow([x0, y0], [x0 + dx, y0 + dy], Math.min(6, size), "axis"));
    group.append(s("text", { x: px(x0 + dx * (1 + 9 / size)), y: px(y0 + dy * (1 + 9 / size) + 4) }, name));
  }
  return group;
}

function scale_bar(frame: Frame): SVGElement {
  const metres = round_down(Math.min(110, 0.25 * frame.width) / frame.scale);
  const size = metres * frame.scale;
  const [x, y] = [frame.width - 16, frame.height - 16];
  const d = `M${px(x - size)} ${y - 4}V${y + 4}M${px(x - size)} ${y}H${x}M${x} ${y - 4}V${y + 4}`;
  const text = metres < 1 ? `${number(metres * 1000, 1)} mm` : `${metres} m`;
  return s("g", { class: "scale-bar" }, s("path", { d }), s("text", { x: px(x - size / 2), y: y - 8, "text-anchor": "middle" }, text));
}

/** The head lies at the node; a load along the line of sight keeps a short arrow. */
function load_marks(frame: Frame, space: SpaceModel, pose: Pose): SVGElement {
  const group = s("g", {});
  for (const load of space.loads) {
    const way = unit(load.force);
    const [dx, dy] = [dot(way, frame.right), -dot(way, frame.up)];
    const [x, y] = project(frame, pose.at(load.node));
    const [tx, ty] = [x - LOAD * dx, y - LOAD * dy];
    group.append(arrow([tx, ty], [x, y], 9, "load"), s("text", { class: "load-name", x: px(tx), y: px(ty - 6), "text-anchor": dx > 0.3 ? "end" : dx < -0.3 ? "start" : "middle" }, load.label));
  }
  return group;
}

export class Overlay {
  readonly svg = s("svg", { class: "model-svg space-marks", "aria-hidden": "true" });

  draw(frame: Frame, space: SpaceModel, pose: Pose, loads: boolean): void {
    this.svg.setAttribute("viewBox", `0 0 ${px(frame.width)} ${px(frame.height)}`);
    this.svg.replaceChildren(axes(frame), scale_bar(frame));
    if (loads) this.svg.append(load_marks(frame, space, pose));
  }
}
