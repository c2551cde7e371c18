// The animation card of a plane model: drawing and player.
import { h, s } from "./dom";
import { round_down } from "./geometry";
import { largest_opening, Player, uplifted_ratio, type Track } from "./player";
import { largest_motion, Stage } from "./stage";
import type { Runs } from "./runs";
import type { Animation, Model } from "./types";

function track(model: Model, animation: Animation, size: number): Track {
  const motion = largest_motion(animation);
  const faces = model.interfaces.map((face) => ({ name: face.name, area: face.points.map((p) => p.area) }));
  return {
    run: animation.run,
    time: animation.time,
    ratio: animation.time.map((_t, i) => uplifted_ratio(faces, animation, i)),
    opening: animation.time.map((_t, i) => largest_opening(animation.openings, i)),
    factor: motion > 0 ? round_down((0.16 * size) / motion) : 1,
  };
}

export class AnimationCard {
  readonly element: HTMLElement;
  private readonly stage_: Stage;
  private readonly player_: Player;

  constructor(model: Model, animations: Animation[], runs: Runs) {
    this.stage_ = new Stage(model, animations[0] as Animation);
    let shown = 0;
    this.player_ = new Player(animations.map((a) => track(model, a, this.stage_.size)), runs, (index, frame, factor) => {
      if (index !== shown) this.stage_.set_animation(animations[index] as Animation);
      shown = index;
      this.stage_.draw(frame, factor);
    });
    this.element = this.build(animations.some((a) => a.pressures));
    this.player_.start(this.element);
  }

  get run(): string {
    return this.player_.track.run;
  }

  get frame(): number {
    return this.player_.frame;
  }

  get frames(): number {
    return this.player_.frames;
  }

  get ratio(): number {
    return this.player_.ratio;
  }

  get playing(): boolean {
    return this.player_.playing;
  }

  set_frame(frame: number): void {
    this.player_.set_frame(frame);
  }

  private build(pressures: boolean): HTMLElement {
    const key = (cls: string, d: string, text: string): HTMLElement =>
      h("li", {}, s("svg", { viewBox: "-7 -7 14 14", width: 14, height: 14, class: "model-svg", "aria-hidden": "true" }, s("path", { class: cls, d })), text);
    const { player_: player } = this;
    return h(
      "figure",
      { class: "card animation-card", id: "animation" },
      h("header", {}, h("h3", {}, "Motion"), h("label", { class: "run-select" }, player.select)),
      this.stage_.svg,
      player.readouts,
      player.timeline,
      player.controls,
      h("ul", { class: "keys" },
        key("pt-contact", "M0 -4A4 4 0 1 0 0 4A4 4 0 1 0 0 -4Z", "in contact"),
        key("pt-open", "M0 -5L5 0L0 5L-5 0Z", "open"),
        pressures ? key("push-key", "M0 6V-5M-3 -1L0 -5L3 -1", "pressure on the upper face") : null),
      h("figcaption", {}, "Displacements, rotations and gaps are magnified by the same factor. Grey lines show the position before loading. The band above the slider shows the uplifted share of the area over time; the animation starts at its peak."),
    );
  }
}
