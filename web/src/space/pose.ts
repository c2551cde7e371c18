// Where everything is at one instant, displacements multiplied by one factor.
// Rotations are those of the small-displacement model: a body moves by u + r × d, so that the drawn gap is the
// computed opening times the factor.
import { plate_of, skin_of, type Skin } from "./shape";
import { add, cross, point, sub, type Vec3 } from "./vector";
import type { SpaceAnimation, SpaceModel } from "../space_types";

const STILL: Vec3 = [0, 0, 0];

export interface FacePose {
  skin: Skin;
  /** Flat places of the skin's vertices on the upper side. */
  upper: Float32Array;
  /** The same below the gap. */
  lower: Float32Array;
  /** Opening of each vertex, metres, not magnified. */
  opening: Float32Array;
}

export class Pose {
  /** Flat places of the nodes. */
  readonly nodes: Float32Array;
  /** Displacement of each node, metres, not magnified. */
  readonly moved: Float32Array;
  /** Per body: the corners of its bottom, then those of its top. */
  readonly plates: Float32Array[];
  readonly faces: FacePose[];
  private readonly space_: SpaceModel;
  private readonly plates_at_rest_: Vec3[][];
  private animation_: SpaceAnimation | undefined;
  private frame_ = 0;
  private factor_ = 1;

  constructor(space: SpaceModel) {
    this.space_ = space;
    this.nodes = Float32Array.from(space.nodes);
    this.moved = new Float32Array(space.nodes.length / 3);
    this.plates_at_rest_ = space.bodies.map((body) => {
      const { bottom, top } = plate_of(space, body);
      return [...bottom, ...top];
    });
    this.plates = this.plates_at_rest_.map((corners) => Float32Array.from(corners.flat()));
    this.faces = space.interfaces.map((face) => {
      const skin = skin_of(face);
      return { skin, upper: Float32Array.from(skin.vertices), lower: Float32Array.from(skin.vertices), opening: new Float32Array(skin.point.length) };
    });
  }

  get factor(): number {
    return this.factor_;
  }

  set(animation: SpaceAnimation, frame: number, factor: number): void {
    this.animation_ = animation;
    this.frame_ = frame;
    this.factor_ = factor;
    const u = animation.displacement[frame] ?? [];
    const { nodes } = this.space_;
    for (let i = 0; i < nodes.length; i++) this.nodes[i] = (nodes[i] as number) + factor * (u[i] ?? 0);
    for (let i = 0; i < this.moved.length; i++) this.moved[i] = Math.hypot(u[3 * i] ?? 0, u[3 * i + 1] ?? 0, u[3 * i + 2] ?? 0);
    this.plates_at_rest_.forEach((corners, b) => corners.forEach((p, i) => (this.plates[b] as Float32Array).set(this.with_body(b, p), 3 * i)));
    this.faces.forEach((_face, i) => this.set_face(i));
  }

  /** Place of a node. */
  at(node: number): Vec3 {
    return point(this.nodes, node);
  }

  private displacement(node: number): Vec3 {
    return point(this.animation_?.displacement[this.frame_] ?? [], node);
  }

  private with_body(index: number, p: Vec3): Vec3 {
    const body = this.space_.bodies[index];
    if (!body) return p;
    const rotation = (this.animation_?.rotation?.[body.name]?.[this.frame_] ?? STILL) as Vec3;
    const turned = cross(rotation, sub(p, point(this.space_.nodes, body.node)));
    return add(p, add(this.displacement(body.node), turned), this.factor_);
  }

  private set_face(index: number): void {
    const face = this.space_.interfaces[index];
    const pose = this.faces[index];
    if (!face || !pose) return;
    const openings = this.animation_?.openings[face.name]?.[this.frame_] ?? [];
    const normal = face.normal as Vec3;
    pose.skin.point.forEach((of, v) => {
      const rest = point(pose.skin.vertices, v);
      const node = face.node?.[of];
      const upper = node !== undefined ? add(rest, this.displacement(node), this.factor_) : face.body !== undefined ? this.with_body(face.body, rest) : rest;
      const opening = openings[of] ?? 0;
      pose.opening[v] = opening;
      pose.upper.set(upper, 3 * v);
      pose.lower.set(add(upper, normal, -this.factor_ * Math.max(0, opening)), 3 * v);
    });
  }
}
