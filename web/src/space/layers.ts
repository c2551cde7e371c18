// What the reader can show and hide in the space view.
import { is_ground } from "./shape";
import type { Ink } from "./ink";
import type { SpaceModel } from "../space_types";

// More supports than this would hide the model behind their marks.
const FEW_SUPPORTS = 40;

/** Faces of the mesh where something is held or leaves; the keys are those of the layers. */
export const BORDERS = [
  { kind: "held", name: "supported faces", colour: (ink: Ink): string => ink.held },
  { kind: "absorbing", name: "absorbing faces", colour: (ink: Ink): string => ink.absorbing },
] as const;

export interface Layer {
  /** "part 0", "lines", "bodies", "masses", "supports", "held", "absorbing", "loads", "gap", "edges", "reference". */
  key: string;
  name: string;
  colour?: (ink: Ink) => string;
  shown: boolean;
  ground?: boolean;
}

export const turn = (colours: string[], i: number): string => colours[i % colours.length] as string;

/** The parts in order, then what else the model has. */
export function layers_of(space: SpaceModel, moving: boolean): Layer[] {
  const layers: Layer[] = [];
  let grounds = 0;
  let others = 0;
  space.parts.forEach((part, i) => {
    const ground = is_ground(space, part);
    const slot = ground ? grounds++ : others++;
    layers.push({ key: `part ${i}`, name: part.name, colour: (ink) => turn(ground ? ink.ground : ink.structure, slot), shown: true, ground });
  });
  const rest: [boolean, Layer][] = [
    [space.bodies.length > 0, { key: "bodies", name: space.bodies.length > 1 ? "rigid bodies" : "rigid body", colour: (ink) => ink.body, shown: true }],
    [space.lines.length > 0, { key: "lines", name: "beams", colour: (ink) => ink.steel, shown: true }],
    [space.masses.length > 0, { key: "masses", name: "masses", colour: (ink) => ink.mass, shown: true }],
    [space.interfaces.length > 0 && moving, { key: "gap", name: "gap", colour: (ink) => ink.open, shown: true }],
    [space.loads.length > 0, { key: "loads", name: "loads", shown: true }],
    [space.supports.length > 0, { key: "supports", name: "supports", shown: space.supports.length <= FEW_SUPPORTS }],
    ...BORDERS.map(({ kind, name, colour }): [boolean, Layer] => [space.borders.some((border) => border.kind === kind), { key: kind, name, colour, shown: !moving }]),
    [space.parts.some((part) => part.edges.length > 0), { key: "edges", name: "element edges", shown: true }],
    [moving, { key: "reference", name: "undeformed position", shown: true }],
  ];
  for (const [present, layer] of rest) if (present) layers.push(layer);
  return layers;
}

/** What a drawing has to know beside the pose. */
export interface Look {
  ink: Ink;
  shown: (key: string) => boolean;
  translucent: boolean;
  /** Largest |displacement| of the colour scale, metres; null colours by part. */
  displacement: number | null;
}
