// Controls of an animation: run, time slider with the history of the uplifted share, play, speed, magnification.
// The card draws the model; the player passes it the frame and the magnification factor.
import { h, s, px } from "./dom";
import { fixed, NEGLIGIBLE, number, pick_scale } from "./format";
import type { Runs } from "./runs";

// The variation selector asks for text: some systems would draw a coloured picture.
const PLAY = "▶\ufe0e";
const PAUSE = "❚❚";
const SPEEDS = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5];
const COMFORTABLE_SECONDS = 12;
const STRIP_WIDTH = 600;
const STRIP_HEIGHT = 34;

/** One run as the player needs it: per frame the time, the uplifted part of the area and the largest opening. */
export interface Track {
  run: string;
  time: number[];
  ratio: number[];
  opening: number[];
  /** Magnification at the start. */
  factor: number;
}

/** Part of the area that is open. A point without an area counts as one. */
export function open_part(area: number[], opening: number[] | undefined): number {
  const parts = area.map((given) => (given > 0 ? given : 1));
  const open = parts.reduce((sum, part, i) => ((opening?.[i] ?? 0) > NEGLIGIBLE ? sum + part : sum), 0);
  return parts.length > 0 ? open / parts.reduce((sum, part) => sum + part, 0) : 0;
}

interface Moving {
  openings: Record<string, number[][]>;
  uplifted?: Record<string, number[]>;
}

/** Uplifted share of an interface in a frame: as the run counted it, else counted by points. */
export function uplifted_share(face: { name: string; area: number[] }, animation: Moving, frame: number): number {
  return animation.uplifted?.[face.name]?.[frame] ?? open_part(face.area, animation.openings[face.name]?.[frame]);
}

/** Uplifted share of all interfaces together. */
export function uplifted_ratio(faces: { name: string; area: number[] }[], animation: Moving, frame: number): number {
  const size = (face: { area: number[] }): number => face.area.reduce((sum, part) => sum + part, 0) || 1;
  const all = faces.reduce((sum, face) => sum + size(face), 0);
  return all > 0 ? faces.reduce((sum, face) => sum + size(face) * uplifted_share(face, animation, frame), 0) / all : 0;
}

/** The largest opening of a frame over all interfaces, at least 0. */
export function largest_opening(openings: Record<string, number[][]>, frame: number): number {
  let largest = 0;
  for (const frames of Object.values(openings)) for (const value of frames[frame] ?? []) if (value > largest) largest = value;
  return largest;
}

export class Player {
  readonly select: HTMLSelectElement;
  readonly readouts: HTMLElement;
  readonly timeline: HTMLElement;
  readonly controls: HTMLElement;
  private readonly tracks_: Track[];
  private readonly show_: (track: number, frame: number, factor: number) => void;
  private index_ = 0;
  private frame_ = 0;
  private factor_ = 1;
  private playing_ = false;
  private clock_ = 0;
  private last_tick_ = 0;
  private readonly speed_: HTMLSelectElement;
  private readonly play_ = h("button", { type: "button", class: "play", "aria-label": "Play" }, PLAY);
  private readonly scrub_ = h("input", { type: "range", min: 0, step: 1, class: "scrub", "aria-label": "Time" });
  private readonly magnify_ = h("input", { type: "range", min: 0, max: 5, step: 0.05, "aria-label": "Magnification of displacements and gap" });
  private readonly magnify_out_ = h("output", {});
  private readonly strip_ = s("svg", { class: "strip", viewBox: `0 0 ${STRIP_WIDTH} ${STRIP_HEIGHT}`, preserveAspectRatio: "none", "aria-hidden": "true" });
  private readonly strip_now_ = s("path", { class: "strip-now" });
  private readonly time_out_ = h("b", {});
  private readonly ratio_out_ = h("b", {});
  private readonly opening_out_ = h("b", {});

  /** `show` draws a frame of a track, displacements times the factor. */
  constructor(tracks: Track[], runs: Runs, show: (track: number, frame: number, factor: number) => void) {
    this.tracks_ = tracks;
    this.show_ = show;
    this.select = h("select", { "aria-label": "Run" }, ...tracks.map(({ run }, i) => h("option", { value: i }, runs.failed(run) ? `${run} (failed)` : run)));
    this.speed_ = h("select", { "aria-label": "Speed" }, ...SPEEDS.map((v) => h("option", { value: v }, `${v}× real time`)));
    this.readouts = h("div", { class: "readouts" },
      h("div", {}, h("span", {}, "time"), this.time_out_),
      h("div", {}, h("span", {}, "uplifted area"), this.ratio_out_),
      h("div", {}, h("span", {}, "largest opening"), this.opening_out_));
    this.timeline = h("div", { class: "timeline" }, this.strip_, this.scrub_);
    this.controls = h("div", { class: "controls" },
      this.play_,
      h("label", {}, "Speed ", this.speed_),
      h("label", { class: "grow" }, "Magnify ", this.magnify_, this.magnify_out_));
  }

  get track(): Track {
    return this.tracks_[this.index_] as Track;
  }

  get frame(): number {
    return this.frame_;
  }

  get frames(): number {
    return this.track.time.length;
  }

  get ratio(): number {
    return this.track.ratio[this.frame_] ?? 0;
  }

  get factor(): number {
    return this.factor_;
  }

  get playing(): boolean {
    return this.playing_;
  }

  /** Attaches the listeners and shows the first run at its largest uplift. The space bar plays and pauses anywhere in the card. */
  start(card: HTMLElement): void {
    this.play_.addEventListener("click", () => this.toggle());
    this.scrub_.addEventListener("input", () => {
      this.stop();
      this.set_frame(Number(this.scrub_.value));
    });
    this.magnify_.addEventListener("input", () => {
      this.set_factor(Number(Math.pow(10, Number(this.magnify_.value)).toPrecision(2)));
      this.draw();
    });
    this.select.addEventListener("change", () => this.select_track(Number(this.select.value)));
    card.addEventListener("keydown", (event) => {
      const on_control = (event.target as Element).closest("button, select, input[type=checkbox]");
      if (event.key !== " " || on_control) return;
      event.preventDefault();
      this.toggle();
    });
    this.select_track(0);
  }

  set_frame(frame: number): void {
    this.frame_ = Math.min(this.frames - 1, Math.max(0, Math.round(frame)));
    this.clock_ = this.track.time[this.frame_] ?? 0;
    this.draw();
  }

  select_track(index: number): void {
    this.stop();
    if (this.tracks_[index]) this.index_ = index;
    this.select.value = String(this.index_);
    this.scrub_.max = String(Math.max(0, this.frames - 1));
    const { time } = this.track;
    const wanted = ((time[this.frames - 1] ?? 1) - (time[0] ?? 0)) / COMFORTABLE_SECONDS;
    this.speed_.value = String([...SPEEDS].reverse().find((v) => v <= wanted * 1.01) ?? SPEEDS[0]);
    this.set_factor(this.track.factor);
    this.draw_strip();
    this.set_frame(this.worst_frame());
  }

  // The largest uplifted share, which the verdict states; of several such frames the one with the largest opening; else the first frame.
  private worst_frame(): number {
    const { opening, ratio } = this.track;
    const worse = (a: number, b: number): boolean =>
      ratio[a] !== ratio[b] ? (ratio[a] as number) > (ratio[b] as number) : (opening[a] as number) > (opening[b] as number);
    return opening.reduce((worst, _value, i) => (worse(i, worst) ? i : worst), 0);
  }

  private set_factor(factor: number): void {
    this.factor_ = Math.max(1, factor);
    this.magnify_.value = String(Math.log10(this.factor_));
    this.magnify_out_.textContent = `×${number(this.factor_, 2)}`;
  }

  private toggle(): void {
    if (this.playing_) this.stop();
    else this.play();
  }

  private play(): void {
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
    const { time } = this.track;
    const before = this.frame_;
    while (this.frame_ < time.length - 1 && (time[this.frame_ + 1] as number) <= this.clock_) this.frame_++;
    if (this.frame_ !== before) this.draw();
    if (this.frame_ >= time.length - 1) this.stop();
    else requestAnimationFrame((next) => this.tick(next));
  }

  private draw(): void {
    this.show_(this.index_, this.frame_, this.factor_);
    const time = `${fixed(this.track.time[this.frame_] ?? 0, 3)} s`;
    const percent = `${fixed(100 * this.ratio, 0)} %`;
    const opening = this.track.opening[this.frame_] ?? 0;
    const scale = pick_scale(opening, "m");
    this.scrub_.value = String(this.frame_);
    this.time_out_.textContent = time;
    this.ratio_out_.textContent = percent;
    this.opening_out_.textContent = opening > NEGLIGIBLE ? `${number(opening / scale.factor, 3)} ${scale.unit}` : "in contact";
    this.scrub_.setAttribute("aria-valuetext", `${time}, ${percent} uplifted`);
    const x = px((STRIP_WIDTH * this.frame_) / Math.max(1, this.frames - 1));
    this.strip_now_.setAttribute("d", `M${x} 0V${STRIP_HEIGHT}`);
  }

  private draw_strip(): void {
    const step = STRIP_WIDTH / Math.max(1, this.frames - 1);
    const line = this.track.ratio.map((ratio, i) => `L${px(i * step)} ${px(STRIP_HEIGHT - ratio * (STRIP_HEIGHT - 2))}`).join("");
    this.strip_.replaceChildren(s("path", { class: "strip-area", d: `M0 ${STRIP_HEIGHT}${line}L${STRIP_WIDTH} ${STRIP_HEIGHT}Z` }), this.strip_now_);
  }
}
