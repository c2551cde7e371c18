// What the card asks of a drawing of the space model; WebGL and pictures both give it.
import type { Direction, Frame } from "./frame";
import type { Layer, Look } from "./layers";
import type { Pose } from "./pose";
import type { Box3 } from "./vector";
import type { SpaceModel } from "../space_types";

export interface View {
  readonly canvas: HTMLCanvasElement;
  readonly frame: Frame;
  /** False: only the named directions can be seen. */
  readonly free: boolean;
  /** Size in CSS pixels; `density` device pixels each. Keeps what is seen. */
  resize(width: number, height: number, density: number): void;
  /** Looks from a direction; null keeps the one it has. The box just fits. */
  aim(from: Direction | null, box: Box3): void;
  /** Draws the pose as it now is. */
  draw(look: Look): void;
  dispose(): void;
}

export interface ViewInput {
  space: SpaceModel;
  pose: Pose;
  layers: Layer[];
  /** Over all frames of the run that is shown, metres, of one interface. */
  largest_opening: (face: number) => number;
  /** The reader turned or moved the view. */
  on_move: () => void;
}

/** Made by the script in #uplift-scene, which runs only when a report has a space model. */
export type MakeScene = (input: ViewInput, canvas: HTMLCanvasElement, context: WebGL2RenderingContext) => View;

declare global {
  interface Window {
    upliftScene?: { make_scene: MakeScene };
  }
}
