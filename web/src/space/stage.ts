// The box with the drawing of the space model: makes the WebGL view or the picture instead of it, follows size, theme
// and print, and lets the reader choose the direction and what is shown.
import { h } from "../dom";
import { number, pick_scale } from "../format";
import { FlatView } from "./flat";
import type { Direction, Frame } from "./frame";
import { LIGHT, type Ink } from "./ink";
import { layers_of, type Layer, type Look } from "./layers";
import { Overlay } from "./overlay";
import { Pose } from "./pose";
import { plate_of } from "./shape";
import { Box3, point, sub, unit, type Vec3 } from "./vector";
import type { MakeScene, View, ViewInput } from "./view";
import type { SpaceModel } from "../space_types";

const MAX_DENSITY = 2;
type Side = "3D" | "x" | "y" | "z";
const SIDES: [Side, string][] = [["3D", "oblique, towards the corner with the largest uplift"], ["x", "along the negative x axis"], ["y", "along the positive y axis"], ["z", "from above"]];
const STRAIGHT: Record<"x" | "y" | "z", Direction> = {
  x: { out: [1, 0, 0], up: [0, 0, 1] },
  y: { out: [0, -1, 0], up: [0, 0, 1] },
  z: { out: [0, 0, 1], up: [0, 1, 0] },
};
const HELP = "Model in three dimensions. Arrow keys rotate the view, with Shift they move it. Plus and minus zoom, F fits the model.";

/** Runs the bundle of the WebGL view, which the page holds as text. */
function load_scene(): MakeScene | null {
  if (!window.upliftScene) {
    const script = h("script", {}, document.getElementById("uplift-scene")?.textContent ?? "");
    document.head.append(script);
    script.remove();
  }
  return window.upliftScene?.make_scene ?? null;
}

/** Null where the browser offers no WebGL; asked first, because three.js would log an error. */
function webgl_view(input: ViewInput, canvas: HTMLCanvasElement): View | null {
  const context = canvas.getContext("webgl2", { alpha: true, antialias: true, depth: true, stencil: false });
  const make = context ? load_scene() : null;
  return context && make ? make(input, canvas, context) : null;
}

export interface StageEvents {
  /** Largest displacement of the run that is shown, metres. */
  largest_displacement: () => number;
  largest_opening: (face: number) => number;
}

export class SpaceStage {
  readonly element: HTMLElement;
  /** Which parts are shown, and how they are coloured. */
  readonly options: HTMLElement;
  readonly note = h("p", { class: "chart-offer space-note", hidden: true });
  readonly hint = h("span", { class: "space-hint", hidden: true }, "Drag to rotate, drag with the right button to move. After a click into the view the wheel zooms. On a touch screen, drag sideways to rotate and pinch to zoom. ");
  readonly pose: Pose;
  private readonly space_: SpaceModel;
  private readonly events_: StageEvents;
  private readonly layers_: Layer[];
  private readonly overlay_ = new Overlay();
  private readonly still_ = h("canvas", { class: "space-still", "aria-hidden": "true" });
  private readonly legend_ = h("div", { class: "space-legend", hidden: true });
  private readonly chips_ = h("div", { class: "legend space-layers", role: "group", "aria-label": "Visible parts" });
  private readonly translucent_ = h("input", { type: "checkbox", checked: true });
  private readonly colour_ = h("select", { "aria-label": "Colours" }, h("option", { value: "part" }, "by part"), h("option", { value: "displacement" }, "by displacement"));
  private view_: View | null = null;
  private ink_: Ink;
  private printing_ = false;
  private towards_: Vec3 = [0, 0, 0];

  constructor(space: SpaceModel, moving: boolean, ink: Ink, events: StageEvents) {
    this.space_ = space;
    this.events_ = events;
    this.ink_ = ink;
    this.pose = new Pose(space);
    this.layers_ = layers_of(space, moving);
    const sides = SIDES.map(([side, title]) => h("button", { type: "button", title: `View ${title}`, onclick: () => this.aim(side) }, side));
    const fit = h("button", { type: "button", title: "Fit the visible parts into the view", onclick: () => this.aim(null) }, "Fit");
    this.element = h("div", { class: "space-stage" }, this.still_, this.overlay_.svg, this.legend_, h("div", { class: "space-sides", role: "group", "aria-label": "Direction of view" }, ...sides, fit));
    this.options = h("div", { class: "space-options" },
      this.chips_,
      h("div", { class: "controls" },
        this.layers_.some((layer) => layer.ground) ? h("label", {}, this.translucent_, "translucent ground") : null,
        moving && space.parts.length > 0 ? h("label", {}, "Colours ", this.colour_) : null));
    this.listen();
    this.draw_chips();
  }

  get webgl(): boolean {
    return this.view_?.free === true;
  }

  /** The projection as it now is. */
  get seen(): Frame | null {
    return this.view_?.frame ?? null;
  }

  get layers(): readonly Layer[] {
    return this.layers_;
  }

  get ink(): Ink {
    return this.printing_ ? LIGHT : this.ink_;
  }

  /** Makes the view; until then draw() does nothing. */
  render(): void {
    if (this.view_) return;
    this.towards_ = this.widest_gap();
    this.use_view(true);
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  draw(): void {
    if (!this.view_) return;
    const look = this.look();
    this.view_.draw(look);
    this.draw_marks();
    this.draw_legend(look);
    if (this.printing_) this.keep();
  }

  repaint(ink: Ink): void {
    this.ink_ = ink;
    this.draw_chips();
    this.draw();
  }

  set_shown(key: string, shown: boolean): void {
    const layer = this.layers_.find((one) => one.key === key);
    if (!layer) return;
    layer.shown = shown;
    this.draw_chips();
    this.draw();
  }

  aim(side: Side | null): void {
    this.view_?.aim(side && this.direction(side), this.box());
    this.draw();
  }

  set_printing(on: boolean): void {
    this.printing_ = on;
    this.render();
    this.draw();
  }

  /** The picture as it now is, on a canvas that can be read. */
  still(): HTMLCanvasElement {
    this.draw();
    return this.keep();
  }

  // A canvas of WebGL is empty once it has been shown: copy it right after drawing.
  private keep(): HTMLCanvasElement {
    const from = this.view_?.canvas;
    if (!from || from.width === 0) return this.still_;
    Object.assign(this.still_, { width: from.width, height: from.height });
    this.still_.getContext("2d")?.drawImage(from, 0, 0);
    return this.still_;
  }

  private look(): Look {
    return {
      ink: this.ink,
      shown: (key) => this.layers_.find((layer) => layer.key === key)?.shown ?? true,
      translucent: this.translucent_.checked,
      displacement: this.colour_.value === "displacement" ? this.events_.largest_displacement() : null,
    };
  }

  private use_view(try_webgl: boolean): void {
    const input: ViewInput = { space: this.space_, pose: this.pose, layers: this.layers_, largest_opening: this.events_.largest_opening, on_move: () => this.draw_marks() };
    const fresh = (): HTMLCanvasElement => h("canvas", { class: "space-live", role: "img", "aria-label": "Picture of the model in three dimensions" });
    let view: View | null = null;
    try {
      view = try_webgl ? webgl_view(input, fresh()) : null;
    } catch {
      // A driver that refuses the shaders: pictures serve as well.
    }
    this.view_?.canvas.remove();
    this.view_ = view ?? new FlatView(input, fresh());
    this.element.prepend(this.view_.canvas);
    if (view) this.prepare_webgl(view);
    this.note.hidden = view !== null;
    this.hint.hidden = view === null;
    this.note.textContent = "WebGL is not available in this browser. The model is drawn from four fixed directions; time, parts and maps work as usual.";
    this.element.classList.toggle("is-free", view !== null);
    this.resize(true);
  }

  private prepare_webgl(view: View): void {
    view.canvas.tabIndex = 0;
    view.canvas.setAttribute("aria-label", HELP);
    view.canvas.addEventListener("webglcontextlost", () => {
      if (this.view_ !== view) return;
      this.use_view(false);
      view.dispose();
    });
    view.canvas.addEventListener("keydown", (event) => {
      if (event.key === "f" && !event.ctrlKey && !event.metaKey) this.aim(null);
    });
  }

  private resize(first = false): void {
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    if (!this.view_ || width === 0 || height === 0) return;
    const { frame } = this.view_;
    const fresh = first || frame.width <= 1;
    const density = this.printing_ ? MAX_DENSITY : Math.min(MAX_DENSITY, devicePixelRatio);
    this.view_.resize(width, height, density);
    // Pictures have no place of the reader's own to keep.
    if (fresh || !this.view_.free) this.view_.aim(fresh ? this.direction("3D") : null, this.box());
    this.draw();
  }

  /** From the middle of its interface to the point that is most open in the pose shown first. */
  private widest_gap(): Vec3 {
    let widest = 0;
    let towards: Vec3 = [0, 0, 0];
    for (const { skin, opening } of this.pose.faces) {
      const box = new Box3();
      skin.point.forEach((_p, v) => box.include(point(skin.vertices, v)));
      opening.forEach((value, v) => {
        if (value > widest) [widest, towards] = [value, sub(point(skin.vertices, v), box.centre)];
      });
    }
    return towards;
  }

  private direction(side: Side): Direction {
    if (side !== "3D") return STRAIGHT[side];
    // The oblique view stands before the corner that lifts most in the run shown first.
    const [x, y] = this.towards_;
    return { out: unit([x >= 0 ? 0.6 : -0.6, y > 0 ? 0.72 : -0.72, 0.42]), up: [0, 0, 1] };
  }

  /** What is shown, at rest and as it now is. */
  private box(): Box3 {
    const { space_: space, pose } = this;
    const shown = this.look().shown;
    const box = new Box3();
    const node = (i: number): void => {
      box.include(point(space.nodes, i));
      box.include(pose.at(i));
    };
    space.parts.forEach((part, i) => shown(`part ${i}`) && new Set(part.triangles).forEach(node));
    if (shown("lines")) space.lines.forEach((line) => line.nodes.forEach(node));
    if (shown("masses")) space.masses.forEach((mass) => node(mass.node));
    if (shown("bodies")) space.bodies.forEach((body) => [...plate_of(space, body).bottom, ...plate_of(space, body).top].forEach((p) => box.include(p)));
    if (box.empty) for (let i = 0; 3 * i < space.nodes.length; i++) node(i);
    return box;
  }

  private draw_marks(): void {
    if (this.view_) this.overlay_.draw(this.view_.frame, this.space_, this.pose, this.look().shown("loads"));
  }

  private draw_legend({ displacement, ink }: Look): void {
    this.legend_.hidden = displacement === null;
    if (displacement === null) return;
    const scale = pick_scale(displacement, "m");
    const bar = h("span", { class: "space-ramp", style: `background:linear-gradient(90deg,${ink.displacement.stops.join()})` });
    this.legend_.replaceChildren("displacement", "0", bar, `${number(displacement / scale.factor, 3)} ${scale.unit}`);
  }

  private draw_chips(): void {
    const focus = [...this.chips_.children].indexOf(document.activeElement as Element);
    this.chips_.replaceChildren(
      ...this.layers_.map((layer) => {
        const colour = layer.colour?.(this.ink_);
        const flip = (): void => this.set_shown(layer.key, !layer.shown);
        return h("button", { type: "button", class: "key", "aria-pressed": String(layer.shown), onclick: flip }, colour ? h("i", { class: "dot", style: `background:${colour}` }) : null, h("span", {}, layer.name));
      }),
    );
    (this.chips_.children[focus] as HTMLElement | undefined)?.focus({ preventScroll: true });
  }

  private listen(): void {
    for (const control of [this.translucent_, this.colour_]) control.addEventListener("change", () => this.draw());
    // The wheel scrolls the page until the reader has clicked into the picture.
    const scrolls = (event: WheelEvent): void => {
      if (document.activeElement !== this.view_?.canvas && !event.ctrlKey) event.stopPropagation();
    };
    this.element.addEventListener("wheel", scrolls, { capture: true, passive: true });
  }
}
