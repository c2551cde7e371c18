// The maps of one interface side by side, what they say in numbers, and the values under the pointer.
import { h } from "../dom";
import { fixed, NEGLIGIBLE, number, quantity_text } from "../format";
import { uplifted_share } from "../player";
import type { Ink } from "./ink";
import { PlanMap } from "./map";
import { range_of, type Quantity, type Range } from "./raster";
import type { SpaceAnimation, SpaceInterface } from "../space_types";

const FRAMES: Record<Quantity, (animation: SpaceAnimation, name: string) => number[][] | undefined> = {
  gap: (animation, name) => animation.openings[name],
  pressure: (animation, name) => animation.pressures[name],
  slip: (animation, name) => animation.slips?.[name],
};

const UNITS: Record<Quantity, string> = { gap: "m", pressure: "Pa", slip: "m" };

export class FaceMaps {
  readonly element: HTMLElement;
  readonly face: SpaceInterface;
  readonly maps: PlanMap[];
  private readonly share_ = h("span", { class: "open-share" });
  private readonly readout_ = h("p", { class: "plan-readout" });
  private animation_: SpaceAnimation;
  private frame_ = 0;
  private marked_: number | null = null;
  private ink_: Ink | null = null;

  /** `sound` sets the ranges of the colours: the same for every run, so that runs can be compared. */
  constructor(face: SpaceInterface, animations: SpaceAnimation[], sound: SpaceAnimation[]) {
    this.face = face;
    this.animation_ = animations[0] as SpaceAnimation;
    // A map without any value would be an empty grey area: the summary below the maps says "in contact everywhere".
    const has_values = (q: Quantity): boolean =>
      animations.some((a) => (FRAMES[q](a, face.name) ?? []).some((frame) => frame.some((v) => (q === "pressure" ? v !== 0 : v > NEGLIGIBLE))));
    const quantities = face.foundation ? [] : (["gap", "pressure", "slip"] as Quantity[]).filter(has_values);
    const range = (q: Quantity): Range => {
      const found = range_of(sound.flatMap((a) => (FRAMES[q](a, face.name) ?? []).flat()));
      // Closed points may lie a little below zero: no part of the scale of gaps.
      return q === "pressure" ? found : { ...found, low: 0 };
    };
    this.maps = quantities.map((q) => new PlanMap(face, q, range(q)));
    this.element = h("div", { class: `face-maps${this.maps.length > 2 ? " is-many" : ""}` },
      h("header", {}, h("h4", {}, face.name), this.share_),
      h("div", { class: "plans" }, ...this.maps.map((map) => map.element)),
      this.readout_);
    this.listen();
  }

  /** Uplifted share of the area at the instant shown. */
  get open_share(): number {
    return uplifted_share(this.face, this.animation_, this.frame_);
  }

  resize(density: number): void {
    for (const map of this.maps) {
      const width = map.element.clientWidth;
      if (width > 0) map.resize(width, this.maps.length > 2 ? 180 : 250, density);
    }
  }

  show(animation: SpaceAnimation, frame: number): void {
    this.animation_ = animation;
    this.frame_ = frame;
  }

  draw(ink: Ink): void {
    this.ink_ = ink;
    const openings = this.values("gap");
    for (const map of this.maps) map.draw({ openings, values: this.values(map.quantity), marked: this.marked_ }, ink);
    const area = this.face.area.reduce((sum, a) => sum + a, 0);
    this.share_.textContent = `${fixed(100 * this.open_share, 0)} % of ${number(area, 3)} m² open`;
    this.readout_.textContent = this.marked_ === null ? this.summary() : this.point_text(this.marked_);
  }

  private values(quantity: Quantity): number[] {
    return FRAMES[quantity](this.animation_, this.face.name)?.[this.frame_] ?? [];
  }

  private largest(quantity: Quantity): number {
    return this.values(quantity).reduce((m, v) => (Math.abs(v) > Math.abs(m) ? v : m), 0);
  }

  private summary(): string {
    const gap = Math.max(0, ...this.values("gap"));
    const words = [gap > NEGLIGIBLE ? `largest gap ${quantity_text(gap, "m")}` : "in contact everywhere"];
    if (!this.face.foundation && this.values("pressure").length > 0) words.push(`largest pressure ${quantity_text(this.largest("pressure"), "Pa")}`);
    if (this.values("slip").length > 0) words.push(`largest slip ${quantity_text(this.largest("slip"), "m")}`);
    return words.join(", ");
  }

  private point_text(i: number): string {
    const [s, t] = this.face.axes;
    const values = this.maps.map(({ quantity: q }) => {
      const value = this.values(q)[i] ?? 0;
      return q === "gap" && !(value > NEGLIGIBLE) ? "in contact" : `${q} ${quantity_text(value, UNITS[q])}`;
    });
    return `${s} ${fixed(this.face.plan[2 * i] ?? 0, 2)} m, ${t} ${fixed(this.face.plan[2 * i + 1] ?? 0, 2)} m: ${values.join(", ")}`;
  }

  private listen(): void {
    const mark = (point: number | null): void => {
      if (point === this.marked_) return;
      this.marked_ = point;
      if (this.ink_) this.draw(this.ink_);
    };
    for (const map of this.maps) {
      map.canvas.addEventListener("pointermove", (event) => mark(map.point_at(event.offsetX, event.offsetY)));
      map.canvas.addEventListener("pointerleave", () => mark(null));
    }
  }
}
