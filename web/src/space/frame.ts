// The parallel projection that every drawing of the space model uses: WebGL, pictures, and the marks over both.
import { Box3, cross, dot, sub, unit, type Vec3 } from "./vector";

/** Where the viewer stands: the direction towards him, and what is upwards in the picture. */
export interface Direction {
  out: Vec3;
  up: Vec3;
}

export interface Frame {
  right: Vec3;
  up: Vec3;
  /** Towards the viewer. */
  out: Vec3;
  /** Shown in the middle of the picture. */
  centre: Vec3;
  /** Picture units per metre. */
  scale: number;
  width: number;
  height: number;
}

const MARGIN = 0.05;

/** The frame of a direction in which the box just fits. */
export function fitted({ out, up: upward }: Direction, box: Box3, width: number, height: number): Frame {
  const right = unit(cross(upward, out));
  return fit_to({ right, up: cross(out, right), out, centre: box.centre, scale: 1, width, height }, box);
}

/** The same directions, moved and scaled so that the box just fits. */
export function fit_to(frame: Frame, box: Box3): Frame {
  if (box.empty) return frame;
  const centre = box.centre;
  const reach = (axis: Vec3): number => Math.max(...box.corners.map((c) => Math.abs(dot(sub(c, centre), axis))), 1e-9);
  const room = (size: number): number => (size * (1 - 2 * MARGIN)) / 2;
  return { ...frame, centre, scale: Math.min(room(frame.width) / reach(frame.right), room(frame.height) / reach(frame.up)) };
}

/** Picture place of a point, y downwards. */
export function project(frame: Frame, p: Vec3): [number, number] {
  const d = sub(p, frame.centre);
  return [frame.width / 2 + frame.scale * dot(d, frame.right), frame.height / 2 - frame.scale * dot(d, frame.up)];
}
