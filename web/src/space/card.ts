// The card of a model in three dimensions: the view, the maps of its interfaces, and the player that moves both.
import { h } from "../dom";
import { round_down } from "../geometry";
import { largest_opening, Player, uplifted_ratio, type Track } from "../player";
import type { Runs } from "../runs";
import type { ThemeSwitch } from "../theme";
import type { SpaceAnimation, SpaceModel } from "../space_types";
import { FaceMaps } from "./face_maps";
import { ink_of } from "./ink";
import { structure_box } from "./shape";
import { SpaceStage } from "./stage";

// The largest displacement is drawn this long, as a part of the size of the structure.
const DRAWN = 0.12;

/** Largest displacement of any drawn node over all frames, metres. */
function largest_displacement(animation: SpaceAnimation): number {
  let largest = 0;
  for (const u of animation.displacement) {
    for (let i = 0; i < u.length; i += 3) largest = Math.max(largest, Math.hypot(u[i] as number, u[i + 1] as number, u[i + 2] as number));
  }
  return largest;
}

const largest_of = (frames: number[][] = []): number => frames.reduce((m, values) => values.reduce((n, v) => Math.max(n, v), m), 0);

/** Largest displacement of a run, and largest opening of each interface, metres. */
interface Peaks {
  displacement: number;
  openings: number[];
}

function track(space: SpaceModel, animation: SpaceAnimation, size: number, motion: number): Track {
  return {
    run: animation.run,
    time: animation.time,
    ratio: animation.time.map((_t, i) => uplifted_ratio(space.interfaces, animation, i)),
    opening: animation.time.map((_t, i) => largest_opening(animation.openings, i)),
    factor: motion > 0 ? round_down((DRAWN * size) / motion) : 1,
  };
}

export class SpaceCard {
  readonly element: HTMLElement;
  readonly stage: SpaceStage;
  private readonly animations_: SpaceAnimation[];
  private readonly player_: Player | null;
  private readonly faces_: FaceMaps[];
  private readonly maps_ = h("div", { class: "space-maps" });
  private readonly peaks_: Peaks[];
  private index_ = 0;
  private rendered_ = false;

  constructor(space: SpaceModel, animations: SpaceAnimation[], runs: Runs, themes: ThemeSwitch) {
    this.animations_ = animations;
    this.peaks_ = animations.map((a) => ({ displacement: largest_displacement(a), openings: space.interfaces.map((face) => largest_of(a.openings[face.name])) }));
    this.stage = new SpaceStage(space, animations.length > 0, ink_of(themes.theme), {
      largest_displacement: () => this.peaks_[this.index_]?.displacement ?? 0,
      largest_opening: (face) => this.peaks_[this.index_]?.openings[face] ?? 0,
    });
    const sound = animations.filter((a) => !runs.failed(a.run));
    this.faces_ = animations.length > 0 ? space.interfaces.map((face) => new FaceMaps(face, animations, sound.length > 0 ? sound : animations)) : [];
    const size = structure_box(space).size;
    this.player_ = animations.length > 0 ? new Player(animations.map((a, i) => track(space, a, size, this.peaks_[i]?.displacement ?? 0)), runs, (index, frame, factor) => this.show(index, frame, factor)) : null;
    this.element = this.build();
    this.player_?.start(this.element);
    themes.on_change((theme) => {
      this.stage.repaint(ink_of(theme));
      this.draw_maps();
    });
  }

  get run(): string {
    return this.player_?.track.run ?? "";
  }

  get frame(): number {
    return this.player_?.frame ?? 0;
  }

  get frames(): number {
    return this.player_?.frames ?? 0;
  }

  get ratio(): number {
    return this.player_?.ratio ?? 0;
  }

  get faces(): readonly FaceMaps[] {
    return this.faces_;
  }

  set_frame(frame: number): void {
    this.player_?.set_frame(frame);
  }

  /** Makes the view and the maps: called when the card comes near the screen. */
  render(): void {
    if (this.rendered_) return;
    this.rendered_ = true;
    this.stage.render();
    new ResizeObserver(() => this.resize_maps()).observe(this.maps_);
    this.resize_maps();
  }

  prepare_print(): void {
    this.render();
    this.stage.set_printing(true);
    this.draw_maps();
  }

  end_print(): void {
    this.stage.set_printing(false);
    this.draw_maps();
  }

  private build(): HTMLElement {
    const { player_: player, stage } = this;
    this.maps_.append(...this.faces_.map((face) => face.element));
    const beside = this.faces_.length === 1;
    const words = player
      ? "Displacements and gaps are magnified by the same factor. The maps show computed values with the same colour scale for every run; the line separates the areas that are open from those in contact. The band above the slider shows the uplifted share of the area over time; the animation starts at its peak."
      : null;
    return h(
      "figure",
      { class: `card is-wide space-card${beside ? " is-beside" : ""}`, id: "space" },
      h("header", {}, h("h3", {}, player ? "Motion in 3D" : "Model as computed"), player ? h("label", { class: "run-select" }, player.select) : null),
      h("div", { class: "space-body" },
        h("div", { class: "space-main" }, stage.element, stage.note, player?.readouts, player?.timeline, player?.controls, stage.options),
        this.faces_.length > 0 ? this.maps_ : null),
      h("figcaption", {}, stage.hint, words),
    );
  }

  private show(index: number, frame: number, factor: number): void {
    const animation = this.animations_[index];
    if (!animation) return;
    this.index_ = index;
    this.stage.pose.set(animation, frame, factor);
    this.stage.draw();
    for (const face of this.faces_) face.show(animation, frame);
    this.draw_maps();
  }

  private resize_maps(): void {
    for (const face of this.faces_) face.resize(Math.min(2, Math.max(1, devicePixelRatio)));
    this.draw_maps();
  }

  private draw_maps(): void {
    if (this.rendered_) for (const face of this.faces_) face.draw(this.stage.ink);
  }
}
