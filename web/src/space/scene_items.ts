// The objects of the WebGL view. Nodes share one buffer; an item updates what it draws from the pose.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, FrontSide, Group, InstancedMesh, LineBasicMaterial, LineDashedMaterial, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Points, PointsMaterial, ShapeUtils, SphereGeometry, SRGBColorSpace, Vector2, type Object3D,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { rgb, type Ramp } from "./ink";
import { BORDERS, type Layer, type Look } from "./layers";
import type { FacePose, Pose } from "./pose";
import { plate_of, sharp_edges, structure_box } from "./shape";
import { cross, dot, sub, unit, type Vec3 } from "./vector";
import type { ViewInput } from "./view";
import type { SpaceModel } from "../space_types";

export interface Item {
  /** The layer that shows it. */
  key: string;
  object: Object3D;
  update(pose: Pose, look: Look): void;
}

// Translucent surfaces come last: the gap, then the ground over it, what is marked on its faces, then its edges.
const ORDER = { gap: 1, ground: 2, border: 3, ground_edges: 4 };
const GROUND_OPACITY = 0.5;
const BORDER_OPACITY = 0.4;

const buffer = (array: Float32Array): BufferAttribute => new BufferAttribute(array, 3).setUsage(DynamicDrawUsage);

function geometry_of(position: BufferAttribute, index: ArrayLike<number>): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", position);
  geometry.setIndex(new BufferAttribute(Uint32Array.from(index), 1));
  return geometry;
}

/** Bounds would have to follow every frame; everything is near the middle of the picture anyway. */
function always<T extends Object3D>(object: T, order = 0): T {
  object.frustumCulled = false;
  object.renderOrder = order;
  return object;
}

/** Writes the linear colour of a ramp at `part` into vertex `i`. */
function paint(colours: BufferAttribute, i: number, [r, g, b]: [number, number, number]): void {
  scratch.setRGB(r / 255, g / 255, b / 255, SRGBColorSpace);
  colours.setXYZ(i, scratch.r, scratch.g, scratch.b);
}
const scratch = new Color();

/** Positions and colours of the nodes, shared by all that is made of nodes. */
class Nodes {
  readonly position: BufferAttribute;
  readonly colour: BufferAttribute;

  constructor(pose: Pose) {
    this.position = buffer(pose.nodes);
    this.colour = buffer(new Float32Array(pose.nodes.length).fill(1));
  }

  update(pose: Pose, look: Look): void {
    this.position.needsUpdate = true;
    if (look.displacement === null) return;
    const ramp = look.ink.displacement;
    const largest = look.displacement || 1;
    pose.moved.forEach((size, i) => paint(this.colour, i, ramp.at(size / largest)));
    this.colour.needsUpdate = true;
  }
}

function part_item(space: SpaceModel, index: number, layer: Layer, nodes: Nodes): Item {
  const part = space.parts[index] as SpaceModel["parts"][number];
  const ground = layer.ground === true;
  const surface = geometry_of(nodes.position, part.triangles);
  surface.setAttribute("color", nodes.colour);
  const material = new MeshLambertMaterial({ flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, side: ground ? FrontSide : DoubleSide });
  const thin = new LineBasicMaterial({ transparent: true, opacity: ground ? 0.16 : 0.3 });
  const bold = new LineBasicMaterial({ transparent: true, opacity: ground ? 0.45 : 0.85 });
  const order = ground ? ORDER.ground_edges : 0;
  const mesh = always(new Mesh(surface, material), ground ? ORDER.ground : 0);
  const cells = always(new LineSegments(geometry_of(nodes.position, part.edges), thin), order);
  const ridges = always(new LineSegments(geometry_of(nodes.position, sharp_edges(space.nodes, part.triangles)), bold), order);
  const object = new Group();
  object.add(mesh, cells, ridges);
  return {
    key: layer.key,
    object,
    update(_pose, look) {
      const coloured = look.displacement !== null;
      if (material.vertexColors !== coloured) material.needsUpdate = true;
      material.vertexColors = coloured;
      material.color.set(coloured ? "#ffffff" : (layer.colour?.(look.ink) ?? "#888888"));
      const clear = ground && look.translucent;
      if (material.transparent !== clear) material.needsUpdate = true;
      material.transparent = clear;
      material.opacity = clear ? GROUND_OPACITY : 1;
      thin.color.set(look.ink.edge);
      bold.color.set(look.ink.edge);
      cells.visible = look.shown("edges");
    },
  };
}

/** Bottom, top and sides of a plate; the outline need not be convex. */
function plate_triangles(bottom: Vec3[]): number[] {
  const n = bottom.length;
  const first = bottom[0] ?? [0, 0, 0];
  const along = unit(sub(bottom[1] ?? first, first));
  const normal = unit(bottom.reduce<Vec3>((sum, p, i) => {
    const c = cross(p, bottom[(i + 1) % n] as Vec3);
    return [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]];
  }, [0, 0, 0]));
  const across = cross(normal, along);
  const faces = ShapeUtils.triangulateShape(bottom.map((p) => new Vector2(dot(sub(p, first), along), dot(sub(p, first), across))), []);
  const sides = bottom.flatMap((_p, i) => {
    const j = (i + 1) % n;
    return [i, j, n + j, i, n + j, n + i];
  });
  return [...faces.flatMap((f) => [...f].reverse()), ...faces.flatMap((f) => f.map((i) => n + i)), ...sides];
}

/** Outline of bottom and top, and the corners between them. */
const plate_edges = (n: number): number[] => Array.from({ length: n }, (_, i) => [i, (i + 1) % n, n + i, n + ((i + 1) % n), i, n + i]).flat();

function bodies_item(space: SpaceModel, pose: Pose): Item {
  const object = new Group();
  const material = new MeshLambertMaterial({ flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, side: DoubleSide });
  const line = new LineBasicMaterial({ transparent: true, opacity: 0.85 });
  const positions = space.bodies.map((body, b) => {
    const position = buffer(pose.plates[b] as Float32Array);
    const { bottom } = plate_of(space, body);
    object.add(always(new Mesh(geometry_of(position, plate_triangles(bottom)), material)));
    object.add(always(new LineSegments(geometry_of(position, plate_edges(bottom.length)), line)));
    return position;
  });
  return {
    key: "bodies",
    object,
    update(_pose, look) {
      positions.forEach((position) => (position.needsUpdate = true));
      material.color.set(look.ink.body);
      line.color.set(look.ink.edge);
    },
  };
}

function lines_item(space: SpaceModel): Item {
  const pairs = space.lines.flatMap((line) => line.nodes.slice(1).flatMap((node, i) => [line.nodes[i] as number, node]));
  const places = new Float32Array(3 * pairs.length);
  const geometry = new LineSegmentsGeometry().setPositions(places);
  const material = new LineMaterial({ linewidth: 3.5 });
  const object = always(new LineSegments2(geometry, material));
  return {
    key: "lines",
    object,
    update(pose, look) {
      pairs.forEach((node, i) => places.set(pose.at(node), 3 * i));
      const start = geometry.getAttribute("instanceStart");
      if ("data" in start) start.data.needsUpdate = true;
      material.color.set(look.ink.steel);
    },
  };
}

function masses_item(space: SpaceModel): Item {
  const largest = Math.max(...space.masses.map((m) => m.mass), 0) || 1;
  const size = 0.035 * structure_box(space).size;
  const material = new MeshLambertMaterial();
  const object = always(new InstancedMesh(new SphereGeometry(1, 24, 16), material, space.masses.length));
  const matrix = new Matrix4();
  return {
    key: "masses",
    object,
    update(pose, look) {
      space.masses.forEach(({ node, mass }, i) => {
        const r = size * Math.max(0.3, Math.cbrt(Math.max(0, mass) / largest));
        object.setMatrixAt(i, matrix.makeScale(r, r, r).setPosition(...pose.at(node)));
      });
      object.instanceMatrix.needsUpdate = true;
      material.color.set(look.ink.mass);
    },
  };
}

function supports_item(space: SpaceModel, nodes: Nodes): Item {
  const material = new PointsMaterial({ size: 5, sizeAttenuation: false });
  const object = always(new Points(geometry_of(nodes.position, space.supports.map((s) => s.node)), material));
  return { key: "supports", object, update: (_pose, look) => void material.color.set(look.ink.soft) };
}

/** The upper side coloured by its opening, and the open space below it. */
function gap_item({ skin, upper, lower, opening }: FacePose, largest: () => number): Item {
  const n = skin.point.length;
  const above = buffer(upper);
  const colour = buffer(new Float32Array(3 * n));
  const patch = geometry_of(above, skin.triangles);
  patch.setAttribute("color", colour);
  const patch_material = new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -2 });
  const both = buffer(new Float32Array(6 * n));
  const walls: number[] = [];
  for (let i = 0; i < skin.rim.length; i += 2) {
    const [a, b] = [skin.rim[i] as number, skin.rim[i + 1] as number];
    walls.push(a, b, n + b, a, n + b, n + a);
  }
  const wall_material = new MeshBasicMaterial({ transparent: true, opacity: 0.6, side: DoubleSide });
  const rim_material = new LineBasicMaterial();
  const object = new Group();
  object.add(always(new Mesh(patch, patch_material)), always(new Mesh(geometry_of(both, walls), wall_material), ORDER.gap));
  object.add(always(new LineSegments(geometry_of(buffer(lower), skin.rim), rim_material), ORDER.gap));
  const rim = object.children[2] as LineSegments;
  return {
    key: "gap",
    object,
    update(_pose, look) {
      const ramp: Ramp = look.ink.gap;
      const range = largest() || 1;
      const closed = rgb(look.ink.closed);
      opening.forEach((g, i) => paint(colour, i, g > 0 ? ramp.at(g / range) : closed));
      (both.array as Float32Array).set(upper, 0);
      (both.array as Float32Array).set(lower, 3 * n);
      for (const attribute of [above, colour, both, rim.geometry.getAttribute("position")]) attribute.needsUpdate = true;
      wall_material.color.set(look.ink.open);
      rim_material.color.set(look.ink.open);
    },
  };
}

function border_item(space: SpaceModel, { kind, colour }: (typeof BORDERS)[number], nodes: Nodes): Item {
  const material = new MeshBasicMaterial({ transparent: true, opacity: BORDER_OPACITY, depthWrite: false });
  const triangles = space.borders.filter((border) => border.kind === kind).flatMap((border) => border.triangles);
  const object = always(new Mesh(geometry_of(nodes.position, triangles), material), ORDER.border);
  return { key: kind, object, update: (_pose, look) => void material.color.set(colour(look.ink)) };
}

/** Edges, beams and plates where they were before loading. */
function reference_item(space: SpaceModel, layers: Layer[]): Item {
  const places: number[] = [];
  const take = (flat: ArrayLike<number>, indices: number[]): void => indices.forEach((i) => places.push(flat[3 * i] as number, flat[3 * i + 1] as number, flat[3 * i + 2] as number));
  space.parts.forEach((part, i) => {
    if (!layers.find((layer) => layer.key === `part ${i}`)?.ground) take(space.nodes, sharp_edges(space.nodes, part.triangles));
  });
  for (const line of space.lines) take(space.nodes, line.nodes.slice(1).flatMap((node, i) => [line.nodes[i] as number, node]));
  for (const body of space.bodies) {
    const { bottom, top } = plate_of(space, body);
    take([...bottom, ...top].flat(), plate_edges(bottom.length));
  }
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(Float32Array.from(places), 3));
  const dash = 0.018 * structure_box(space).size;
  const material = new LineDashedMaterial({ dashSize: dash, gapSize: dash });
  const object = always(new LineSegments(geometry, material).computeLineDistances());
  return { key: "reference", object, update: (_pose, look) => void material.color.set(look.ink.soft) };
}

export function scene_items({ space, pose, layers, largest_opening }: ViewInput): Item[] {
  const nodes = new Nodes(pose);
  const has = (key: string): boolean => layers.some((layer) => layer.key === key);
  // First what all others share.
  const items: Item[] = [{ key: "nodes", object: new Group(), update: (p, look) => nodes.update(p, look) }];
  space.parts.forEach((_part, i) => items.push(part_item(space, i, layers.find((layer) => layer.key === `part ${i}`) as Layer, nodes)));
  if (has("bodies")) items.push(bodies_item(space, pose));
  if (has("lines")) items.push(lines_item(space));
  if (has("masses")) items.push(masses_item(space));
  if (has("supports")) items.push(supports_item(space, nodes));
  for (const border of BORDERS) if (has(border.kind)) items.push(border_item(space, border, nodes));
  if (has("gap")) pose.faces.forEach((face, i) => items.push(gap_item(face, () => largest_opening(i))));
  if (has("reference")) items.push(reference_item(space, layers));
  return items;
}
