// Small vectors and the box around points.

export type Vec3 = [number, number, number];

export const add = (a: Vec3, b: Vec3, by = 1): Vec3 => [a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => add(a, b, -1);
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);

export function unit(a: Vec3): Vec3 {
  const size = length(a) || 1;
  return [a[0] / size, a[1] / size, a[2] / size];
}

/** Point `i` of a flat list x, y, z. */
export const point = (flat: ArrayLike<number>, i: number): Vec3 => [flat[3 * i] ?? 0, flat[3 * i + 1] ?? 0, flat[3 * i + 2] ?? 0];

export class Box3 {
  min: Vec3 = [Infinity, Infinity, Infinity];
  max: Vec3 = [-Infinity, -Infinity, -Infinity];

  include(p: Vec3): void {
    for (let k = 0; k < 3; k++) {
      this.min[k] = Math.min(this.min[k] as number, p[k] as number);
      this.max[k] = Math.max(this.max[k] as number, p[k] as number);
    }
  }

  get empty(): boolean {
    return !(this.max[0] >= this.min[0]);
  }

  get centre(): Vec3 {
    return add(this.min, sub(this.max, this.min), 0.5);
  }

  /** The largest side. */
  get size(): number {
    return Math.max(...sub(this.max, this.min));
  }

  get corners(): Vec3[] {
    return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1 ? this.max[0] : this.min[0], i & 2 ? this.max[1] : this.min[1], i & 4 ? this.max[2] : this.min[2]]);
  }
}
