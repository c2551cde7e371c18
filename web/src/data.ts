// Reads the document out of the page and makes of it what the page shows: verdict, tables and figures of summary.json and trust.json, with
// what only the report has. What a shorter document leaves out is empty.
import { charts_of, stated } from "./result_charts";
import { sections_of } from "./result_sections";
import { tables_of } from "./result_tables";
import { verdict_of } from "./result_verdict";
import { study_charts, STUDY_SECTIONS } from "./study_charts";
import { study_tables } from "./study_tables";
import { study_choices, study_verdict } from "./study_verdict";
import type { QuantisedFrames, SpaceAnimation, SpaceModel } from "./space_types";
import { FORMAT, type Model, type RawReport, type Report, type Verdict } from "./types";

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

type Results = Pick<Report, "title" | "version" | "created" | "command" | "builtWith" | "case" | "verdict" | "tables" | "sections" | "charts">;

/** Of a report of ground motions, which writes its pages itself. */
function stated_results(raw: RawReport): Results {
  const verdict: Verdict = { level: "none", headline: "", facts: [], paragraphs: [], run: "", interfaces: [], criteria: [], floors: [], ...raw.verdict };
  return {
    title: raw.title ?? "Untitled case", version: raw.version ?? "", created: raw.created ?? "", command: raw.command ?? "", builtWith: raw.builtWith,
    case: { file: "", sha256: "", resolved: "", ...raw.case },
    verdict, tables: raw.tables ?? [], sections: raw.sections ?? [], charts: (raw.charts ?? []).map((chart) => stated(chart, {})),
  };
}

/** Of a study: its plan stands in the place of the case, its case among the files. */
function study_results(raw: RawReport): Results {
  const { study } = raw;
  if (!study) return stated_results(raw);
  const { case_file: file, case_sha256: sha256, inputs } = study.provenance;
  return {
    ...stated_results(raw),
    case: { file: "", sha256: "", ...raw.case, resolved: raw.resolved ?? "", inputs: [{ file, sha256 }, ...inputs] },
    verdict: study_verdict(study), tables: study_tables(study), sections: STUDY_SECTIONS, charts: study_charts(study),
  };
}

/** Of a run or a comparison. */
function results(raw: RawReport): Results {
  const { summary, trust, quantities = {}, statics = false, verdict, floorsWarning = "" } = raw;
  if (!summary) return study_results(raw);
  const extras = { facts: verdict?.facts ?? [], paragraphs: verdict?.paragraphs ?? [], uplifted: raw.uplifted ?? [] };
  return {
    title: summary.title, version: summary.version, created: summary.created, command: summary.command, builtWith: summary.built_with,
    case: { ...summary.case, resolved: raw.resolved ?? "", inputs: summary.inputs },
    verdict: verdict_of(summary, extras, quantities, statics),
    tables: tables_of(summary, trust, quantities, raw.tables ?? []),
    sections: raw.sections ?? sections_of(summary, trust, floorsWarning, statics),
    charts: charts_of(summary, trust, raw.charts ?? [], raw.figures ?? {}),
  };
}

function complete(raw: RawReport): Report {
  return {
    format: FORMAT,
    ...results(raw),
    subtitle: raw.subtitle,
    choices: raw.study ? study_choices(raw.study) : (raw.choices ?? []),
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
  let raw: RawReport;
  try {
    raw = JSON.parse(plain ? held : await inflated(held)) as RawReport;
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
