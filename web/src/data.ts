// Reads the JSON document out of the page and fills what an older or shorter document leaves out.
import { FORMAT, type Model, type Report, type SpaceModel } from "./types";

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
    },
    choices: raw.choices ?? [],
    tables: raw.tables ?? [],
    sections: raw.sections ?? [],
    charts: raw.charts ?? [],
    model: complete_model(raw.model),
    animations: raw.animations ?? [],
    space: complete_space(raw.space),
    spaceAnimations: raw.spaceAnimations ?? [],
  };
}

/** The report held by the page, or why there is none. */
export function read_report(): ReadResult {
  const text = document.getElementById("uplift-data")?.textContent?.trim() ?? "";
  // The untouched placeholder is a comment, which no JSON document starts with.
  if (text === "" || text.startsWith("/*")) return { kind: "empty" };
  let raw: Partial<Report>;
  try {
    raw = JSON.parse(text) as Partial<Report>;
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
