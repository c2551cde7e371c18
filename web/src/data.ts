// Reads the JSON document out of the page and fills what an older or shorter document leaves out.
import { FORMAT, type Model, type QuantisedFrames, type Report, type SpaceAnimation, type SpaceModel } from "./types";

export type ReadResult =
  | { kind: "report"; report: Report }
  | { kind: "empty" }
  | { kind: "error"; message: string };

function complete_model(model: Partial<Model> | null | undefined): Model | null {
  if (!model || !model.nodes || model.nodes.length === 0) return null;
  return {
    nodes: model.nodes,
    beams: model.beams ?? [],
    bodies: model.bodies ?? [],
    masses: model.masses ?? [],
    supports: model.supports ?? [],
    absorbing: model.absorbing ?? [],
    springs: model.springs ?? [],
    interfaces: model.interfaces ?? [],
    loads: model.loads ?? [],
    outlines: model.outlines ?? [],
    grid: model.grid ?? [],
  };
}

function complete_space(space: Partial<SpaceModel> | null | undefined): SpaceModel | null {
  if (!space || !space.nodes || space.nodes.length === 0) return null;
  return {
    nodes: space.nodes,
    parts: space.parts ?? [],
    lines: space.lines ?? [],
    bodies: space.bodies ?? [],
    masses: space.masses ?? [],
    supports: space.supports ?? [],
    borders: space.borders ?? [],
    interfaces: space.interfaces ?? [],
    loads: space.loads ?? [],
  };
}

/** Values of all frames, see QuantisedFrames. */
function frames_of(given: number[][] | QuantisedFrames): number[][] {
  if (Array.isArray(given)) return given;
  const { unit, stride, differences } = given;
  let levels: number[] = [];
  return differences.map((row) => {
    const changes: number[] = [];
    row.forEach((difference, i) => changes.push(difference + (i >= stride ? (changes[i - stride] as number) : 0)));
    levels = changes.map((change, i) => change + (levels[i] ?? 0));
    return levels.map((level) => level * unit);
  });
}

/** The program writes fields with many values as quantised frames; the rest of the page sees plain numbers. */
function complete_animation(raw: SpaceAnimation): SpaceAnimation {
  const fields = (all: Record<string, number[][]>): Record<string, number[][]> =>
    Object.fromEntries(Object.entries(all).map(([name, frames]) => [name, frames_of(frames)]));
  return { ...raw, displacement: frames_of(raw.displacement), openings: fields(raw.openings), pressures: fields(raw.pressures) };
}

function complete(raw: Partial<Report>): Report {
  const verdict = raw.verdict;
  return {
    format: FORMAT,
    title: raw.title ?? "Untitled case",
    subtitle: raw.subtitle,
    version: raw.version ?? "",
    created: raw.created ?? "",
    command: raw.command ?? "",
    builtWith: raw.builtWith,
    case: { file: "", sha256: "", resolved: "", ...raw.case },
    verdict: {
      level: verdict?.level ?? "none",
      headline: verdict?.headline ?? "",
      consequence: verdict?.consequence ?? "",
      facts: verdict?.facts ?? [],
      paragraphs: verdict?.paragraphs ?? [],
      run: verdict?.run ?? "",
      interfaces: verdict?.interfaces ?? [],
      criteria: verdict?.criteria ?? [],
      floors: verdict?.floors ?? [],
      stepCheck: verdict?.stepCheck,
    },
    choices: raw.choices ?? [],
    tables: raw.tables ?? [],
    sections: raw.sections ?? [],
    charts: raw.charts ?? [],
    model: complete_model(raw.model),
    animations: raw.animations ?? [],
    space: complete_space(raw.space),
    spaceAnimations: (raw.spaceAnimations ?? []).map(complete_animation),
  };
}

/** The bytes of a zlib stream in base64, as text. */
async function inflated(base64: string): Promise<string> {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).text();
}

/** The report held by the page, or why there is none. The program writes compressed data; plain JSON serves as well. */
export async function read_report(): Promise<ReadResult> {
  const held = document.getElementById("uplift-data")?.textContent?.trim() ?? "";
  // The untouched placeholder is a comment, which neither JSON nor base64 starts with.
  if (held === "" || held.startsWith("/*")) return { kind: "empty" };
  const plain = held.startsWith("{");
  if (!plain && typeof DecompressionStream === "undefined") {
    return { kind: "error", message: "This browser cannot decompress the data of the report. Please use a version from 2023 or later (Chrome 80, Firefox 113, Safari 16.4)." };
  }
  let raw: Partial<Report>;
  try {
    raw = JSON.parse(plain ? held : await inflated(held)) as Partial<Report>;
  } catch (error) {
    return { kind: "error", message: `The data of this report cannot be read: ${(error as Error).message}` };
  }
  if (raw.format !== FORMAT) {
    return {
      kind: "error",
      message: `The data of this report has the format “${String(raw.format)}”; this page reads “${FORMAT}”.`,
    };
  }
  return { kind: "report", report: complete(raw) };
}
