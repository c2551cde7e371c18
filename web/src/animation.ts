// The animation card: stage, scrub slider with the history of the uplifted ratio, play, speed, factor, run.
import { h, s, px } from "./dom";
import { fixed, number, pick_scale } from "./format";
import { round_down } from "./geometry";
import { largest_motion, Stage } from "./stage";
import type { Runs } from "./runs";
import type { Animation, Model } from "./types";

// The variation selector asks for text: some systems would draw a coloured picture.
const PLAY = "▶\ufe0e";
const PAUSE = "❚❚";
const SPEEDS = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5];
const COMFORTABLE_SECONDS = 12;
const STRIP_WIDTH = 600;
const STRIP_HEIGHT = 34;

/** Part of the area that is open (opening > 0) in a frame, over all interfaces. */
export function uplifted_ratio(model: Model, animation: Animation, frame: number): number {
  let open = 0;
  let all = 0;
  for (const face of model.interfaces) {
    const openings = animation.openings[face.name]?.[frame];
    face.points.forEach((p, i) => {
      const area = p.area > 0 ? p.area : 1;
      all += area;
      if ((openings?.[i] ?? 0) > 0) open += area;
    });
  }
  return all > 0 ? open / all : 0;
}

function largest_opening(animation: Animation, frame: number): number {
  return Math.max(0, ...Object.values(animation.openings).map((frames) => Math.max(...(frames[frame] ?? [0]))));
}

export class AnimationCard {
  readonly element: HTMLElement;
  private readonly model_: Model;
  private readonly animations_: Animation[];
  private readonly stage_: Stage;
  private current_: Animation;
  private frame_ = 0;
  private factor_ = 1;
  private playing_ = false;
  private clock_ = 0;
  private last_tick_ = 0;
  private readonly run_: HTMLSelectElement;
  private readonly speed_: HTMLSelectElement;
  private readonly play_ = h("button", { type: "button", class: "play", "aria-label": "Play" }, PLAY);
  private readonly scrub_ = h("input", { type: "range", min: 0, step: 1, class: "scrub", "aria-label": "Time" });
  private readonly magnify_ = h("input", { type: "range", min: 0, max: 5, step: 0.05, "aria-label": "Magnification of displacements and gap" });
  private readonly magnify_out_ = h("output", {});
  private readonly strip_ = s("svg", { class: "strip", viewBox: `0 0 ${STRIP_WIDTH} ${STRIP_HEIGHT}`, preserveAspectRatio: "none", "aria-hidden": "true" });
  private readonly strip_now_ = s("path", { class: "strip-now" });
  private readonly time_ = h("b", {});
  private readonly ratio_ = h("b", {});
  private readonly opening_ = h("b", {});

  constructor(model: Model, animations: Animation[], runs: Runs) {
    this.model_ = model;
    this.animations_ = animations;
    this.current_ = animations[0] as Animation;
    this.stage_ = new Stage(model, this.current_);
    const option = (a: Animation, i: number): HTMLElement =>
      h("option", { value: i }, runs.failed(a.run) ? `${a.run} (failed)` : a.run);
    this.run_ = h("select", { "aria-label": "Run" }, ...animations.map(option));
    this.speed_ = h("select", { "aria-label": "Speed" }, ...SPEEDS.map((v) => h("option", { value: v }, `${v}× real time`)));
    this.element = this.build();
    this.listen();
    this.select(0);
  }

  get run(): string {
    return this.current_.run;
  }

  get frame(): number {
    return this.frame_;
  }

  get frames(): number {
    return this.current_.time.length;
  }

  get ratio(): number {
    return uplifted_ratio(this.model_, this.current_, this.frame_);
  }

  get playing(): boolean {
    return this.playing_;
  }

  set_frame(frame: number): void {
    this.frame_ = Math.min(this.frames - 1, Math.max(0, Math.round(frame)));
    this.clock_ = this.current_.time[this.frame_] ?? 0;
    this.draw();
  }

  select(index: number): void {
    this.stop();
    this.current_ = this.animations_[index] ?? this.current_;
    this.run_.value = String(this.animations_.indexOf(this.current_));
    this.stage_.set_animation(this.current_);
    this.scrub_.max = String(Math.max(0, this.frames - 1));
    const duration = (this.current_.time[this.frames - 1] ?? 1) - (this.current_.time[0] ?? 0);
    const wanted = duration / COMFORTABLE_SECONDS;
    this.speed_.value = String([...SPEEDS].reverse().find((v) => v <= wanted * 1.01) ?? SPEEDS[0]);
    const motion = largest_motion(this.current_);
    this.set_factor(motion > 0 ? round_down((0.16 * this.stage_.size) / motion) : 1);
    this.draw_strip();
    this.set_frame(this.worst_frame());
  }

  // The instant that answers the question: the largest opening, else the first frame.
  private worst_frame(): number {
    let worst = 0;
    for (let i = 1; i < this.frames; i++) {
      if (largest_opening(this.current_, i) > largest_opening(this.current_, worst)) worst = i;
    }
    return worst;
  }

  private set_factor(factor: number): void {
    this.factor_ = Math.max(1, factor);
    this.magnify_.value = String(Math.log10(this.factor_));
    this.magnify_out_.textContent = `×${number(this.factor_, 2)}`;
  }

  private build(): HTMLElement {
    const key = (cls: string, d: string, text: string): HTMLElement =>
      h("li", {}, s("svg", { viewBox: "-7 -7 14 14", width: 14, height: 14, class: "model-svg", "aria-hidden": "true" }, s("path", { class: cls, d })), text);
    const pressures = this.animations_.some((a) => a.pressures);
    return h(
      "figure",
      { class: "card animation-card", id: "animation" },
      h("header", {}, h("h3", {}, "Motion"), h("label", { class: "run-select" }, this.run_)),
      this.stage_.svg,
      h("div", { class: "readouts" },
        h("div", {}, h("span", {}, "time"), this.time_),
        h("div", {}, h("span", {}, "uplifted (by gap)"), this.ratio_),
        h("div", {}, h("span", {}, "largest opening"), this.opening_)),
      h("div", { class: "timeline" }, this.strip_, this.scrub_),
      h("div", { class: "controls" },
        this.play_,
        h("label", {}, "Speed ", this.speed_),
        h("label", { class: "grow" }, "Magnify ", this.magnify_, this.magnify_out_)),
      h("ul", { class: "keys" },
        key("pt-contact", "M0 -4A4 4 0 1 0 0 4A4 4 0 1 0 0 -4Z", "in contact"),
        key("pt-open", "M0 -5L5 0L0 5L-5 0Z", "open"),
        pressures ? key("push-key", "M0 6V-5M-3 -1L0 -5L3 -1", "pressure on the upper side") : null),
      h("figcaption", {}, "Displacements, rotation and gap are multiplied by the same factor; grey lines show the position before loading. The band above the slider is the uplifted ratio."),
    );
  }

  private listen(): void {
    this.play_.addEventListener("click", () => (this.playing_ ? this.stop() : this.start()));
    this.scrub_.addEventListener("input", () => {
      this.stop();
      this.set_frame(Number(this.scrub_.value));
    });
    this.magnify_.addEventListener("input", () => {
      this.set_factor(Number(Math.pow(10, Number(this.magnify_.value)).toPrecision(2)));
      this.draw();
    });
    this.run_.addEventListener("change", () => this.select(Number(this.run_.value)));
    this.element.addEventListener("keydown", (event) => {
      const on_control = (event.target as Element).closest("button, select");
      if (event.key !== " " || on_control) return;
      event.preventDefault();
      if (this.playing_) this.stop();
      else this.start();
    });
  }

  private start(): void {
    if (this.frame_ >= this.frames - 1) this.set_frame(0);
    this.playing_ = true;
    this.play_.textContent = PAUSE;
    this.play_.setAttribute("aria-label", "Pause");
    this.last_tick_ = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  private stop(): void {
    this.playing_ = false;
    this.play_.textContent = PLAY;
    this.play_.setAttribute("aria-label", "Play");
  }

  private tick(now: number): void {
    if (!this.playing_) return;
    // A page in the background gets no ticks: do not jump when it comes back.
    const passed = Math.min(0.2, (now - this.last_tick_) / 1000);
    this.last_tick_ = now;
    this.clock_ += passed * Number(this.speed_.value);
    const time = this.current_.time;
    while (this.frame_ < time.length - 1 && (time[this.frame_ + 1] as number) <= this.clock_) this.frame_++;
    this.draw();
    if (this.frame_ >= time.length - 1) this.stop();
    else requestAnimationFrame((next) => this.tick(next));
  }

  private draw(): void {
    this.stage_.draw(this.frame_, this.factor_);
    const time = this.current_.time[this.frame_] ?? 0;
    const opening = largest_opening(this.current_, this.frame_);
    const scale = pick_scale(opening, "m");
    this.scrub_.value = String(this.frame_);
    this.time_.textContent = `${fixed(time, 3)} s`;
    this.ratio_.textContent = `${fixed(100 * this.ratio, 0)} %`;
    this.opening_.textContent = opening > 0 ? `${number(opening / scale.factor, 3)} ${scale.unit}` : "closed";
    this.scrub_.setAttribute("aria-valuetext", `${fixed(time, 3)} s, ${fixed(100 * this.ratio, 0)} % uplifted`);
    const x = px((STRIP_WIDTH * this.frame_) / Math.max(1, this.frames - 1));
    this.strip_now_.setAttribute("d", `M${x} 0V${STRIP_HEIGHT}`);
  }

  private draw_strip(): void {
    let d = `M0 ${STRIP_HEIGHT}`;
    const step = STRIP_WIDTH / Math.max(1, this.frames - 1);
    for (let i = 0; i < this.frames; i++) {
      const y = STRIP_HEIGHT - uplifted_ratio(this.model_, this.current_, i) * (STRIP_HEIGHT - 2);
      d += `L${px(i * step)} ${px(y)}`;
    }
    this.strip_.replaceChildren(s("path", { class: "strip-area", d: `${d}L${STRIP_WIDTH} ${STRIP_HEIGHT}Z` }), this.strip_now_);
  }
}
