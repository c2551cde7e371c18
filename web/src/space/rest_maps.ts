// The maps of every interface in the last frame of a run: the state of the base after the shaking.
import { h } from "../dom";
import type { ThemeSwitch } from "../theme";
import type { SpaceAnimation, SpaceModel } from "../space_types";
import { FaceMaps } from "./face_maps";
import { ink_of, type Ink } from "./ink";

export class RestMaps {
  readonly element: HTMLElement;
  private readonly faces_: FaceMaps[];
  private ink_: Ink;
  private rendered_ = false;

  /** `animation` needs at least one frame. */
  constructor(space: SpaceModel, animation: SpaceAnimation, themes: ThemeSwitch) {
    // The colours cover this state only: a residual gap is small compared with the gaps during the shaking.
    const last = animation.time.length - 1;
    const end = <T>(frames: T[] | undefined): T[] => (frames && frames[last] !== undefined ? [frames[last] as T] : []);
    const ended = (all: Record<string, number[][]>): Record<string, number[][]> => Object.fromEntries(Object.entries(all).map(([name, frames]) => [name, end(frames)]));
    const still: SpaceAnimation = { ...animation, time: [animation.time[last] ?? 0], displacement: end(animation.displacement), openings: ended(animation.openings), pressures: ended(animation.pressures) };
    if (animation.uplifted) still.uplifted = Object.fromEntries(Object.entries(animation.uplifted).map(([name, shares]) => [name, end(shares)]));
    if (animation.slips) still.slips = ended(animation.slips);
    this.ink_ = ink_of(themes.theme);
    this.faces_ = space.interfaces.map((face) => new FaceMaps(face, [still], [still]));
    this.element = h("figure", { class: "card is-wide rest-maps" },
      h("header", {}, h("h3", {}, "Base at the end of the run")),
      h("div", { class: "space-maps" }, ...this.faces_.map((face) => face.element)),
      h("figcaption", {}, `Last frame of the run “${animation.run}”. The colour scale covers the values of this frame only.`));
    themes.on_change((theme) => {
      this.ink_ = ink_of(theme);
      this.draw();
    });
  }

  render(): void {
    if (this.rendered_) return;
    this.rendered_ = true;
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.resize();
  }

  prepare_print(): void {
    this.render();
    const screen = this.ink_;
    this.ink_ = ink_of("light");
    this.draw();
    this.ink_ = screen;
  }

  end_print(): void {
    this.draw();
  }

  private resize(): void {
    for (const face of this.faces_) face.resize(Math.min(2, Math.max(1, devicePixelRatio)));
    this.draw();
  }

  private draw(): void {
    if (this.rendered_) for (const face of this.faces_) face.draw(this.ink_);
  }
}
