// The first page from summary.json: rows of numbers with their captions, compared with the bonded run and with the criteria of the case.
import { format_change, format_quantity, format_step_change, format_swing, format_value, format_within, percent } from "./quantity";
import type { InterfaceSummary, Quantity, ResultNumber, ResultNumbers, Summary } from "./summary";
import type { BaseVerdict, Criterion, Fact, Verdict, VerdictRow } from "./types";

type Captions = [quantity: string, label: string][];

const OF_RUN: Captions = [
  ["max_top_motion", "Motion of the top"],
  ["max_drift", "Drift of the top"],
  ["max_drift_without_rotation", "Drift without base rotation"],
  ["max_storey_shear", "Largest storey shear"],
  ["max_drift_ratio", "Largest drift ratio"],
  ["max_total_shear", "Horizontal force, all bases and walls"],
  ["max_total_moment", "Moment, all bases and walls"],
];
const OF_BASE: Captions = [
  ["max_shear", "Base shear"],
  ["max_moment", "Base moment"],
  ["max_compression", "Largest compression"],
  ["min_compression", "Least compression"],
  ["max_toe_pressure", "Toe pressure"],
  ["toe_pressure_ratio", "Toe pressure over static mean"],
  ["max_eccentricity", "Eccentricity over width"],
  ["min_overturning_safety", "Safety against overturning"],
  ["min_sliding_safety", "Safety against sliding"],
  ["max_bearing_utilisation", "Utilisation of bearing capacity"],
  ["max_sliding_utilisation", "Utilisation of sliding resistance"],
];
const OF_WALL: Captions = [
  ["max_opening", "Largest gap"],
  ["max_slip", "Largest slip"],
  ["max_toe_pressure", "Largest pressure"],
  ["share_of_horizontal_force", "Share of the horizontal force"],
  ["share_of_base_moment", "Share of the base moment"],
];
const OF_BEAM: Captions = [
  ["max_beam_moment", "Moment of"],
  ["max_beam_shear", "Shear of"],
  ["max_beam_compression", "Compression of"],
  ["max_beam_tension", "Tension of"],
];
const RESIDUAL: Captions = [
  ["residual_rotation", "Rotation"],
  ["residual_settlement", "Settlement"],
  ["residual_slip", "Slip"],
  ["residual_opening", "Largest gap"],
  ["residual_uplifted_ratio", "Uplifted area"],
];

/** What the report has besides summary.json for its first page. */
export interface VerdictExtras {
  facts: Fact[];
  paragraphs: string[];
  /** Uplifted share over time, by interface. */
  uplifted: { time: number[]; share: number[] }[];
}

/** Quantities of the verdict by name; what is not said of one does not hold. */
export type Catalog = Record<string, Omit<Quantity, "name" | "unit">>;

export function quantity_of(catalog: Catalog, name: string, unit: string): Quantity {
  return { name, unit, ...(catalog[name] ?? { meaning: name }) };
}

function row_of(catalog: Catalog, name: string, label: string, number: ResultNumber): VerdictRow {
  const quantity = quantity_of(catalog, name, number.unit);
  const { value, unit, time, bonded, swing, change_percent } = number;
  const row: VerdictRow = { label, value: value ?? NaN, unit, text: format_within(quantity, value, swing) };
  const step_text = format_step_change(quantity, number);
  if (step_text !== undefined) row.stepText = step_text;
  if (time !== undefined) row.time = time;
  const swing_text = format_swing(quantity, swing);
  if (swing_text !== "") row.swingText = swing_text;
  if (bonded !== undefined && bonded !== null) {
    row.bonded = bonded;
    row.bondedText = format_value(quantity, bonded);
    row.changeText = number.change_note ?? (typeof change_percent === "number" ? format_change(change_percent / 100) : "not comparable");
  }
  return row;
}

function rows_of(catalog: Catalog, captions: Captions, numbers: ResultNumbers, strip = false): VerdictRow[] {
  return captions.flatMap(([name, label]) => {
    const number = numbers[name];
    if (!number) return [];
    const force = number.unit === "N" || number.unit === "N m";
    return [row_of(catalog, name, label + (strip && force ? " per metre" : ""), number)];
  });
}

/** Beams in which there is a force at all. */
function beam_rows(catalog: Catalog, beams: { name: string; numbers: ResultNumbers }[]): VerdictRow[] {
  return beams.flatMap(({ name: beam, numbers }) =>
    OF_BEAM.flatMap(([name, label]) => {
      const number = numbers[name];
      return number && (number.value !== 0 || (number.bonded ?? 0) !== 0) ? [row_of(catalog, name, `${label} ${beam}`, number)] : [];
    }));
}

function linear_of(catalog: Catalog, numbers: ResultNumbers): BaseVerdict["linear"] {
  const { linear_tension_ratio: tension, predicted_uplifted_ratio: predicted, max_uplifted_ratio: computed } = numbers;
  if (!tension || !computed) return undefined;
  const text = (name: string, number: ResultNumber): string => format_within(quantity_of(catalog, name, number.unit), number.value, number.swing);
  return {
    tension: tension.value ?? 0,
    tensionText: text("linear_tension_ratio", tension),
    predicted: predicted?.value ?? null,
    predictedText: predicted ? text("predicted_uplifted_ratio", predicted) : "",
    computed: computed.value ?? 0,
    computedText: text("max_uplifted_ratio", computed),
  };
}

function lost_text(catalog: Catalog, { numbers, full_loss = [] }: InterfaceSummary): string {
  const lost = numbers["full_loss_time"];
  if (!lost || !(Number(lost.value) > 0)) return "";
  const times = full_loss.length === 1 ? "once" : `${full_loss.length} times`;
  return `full loss of contact ${times}, ${format_value(quantity_of(catalog, "full_loss_time", "s"), lost.value)} in total`;
}

/** Rows of the structure as a whole, before those of a single base and after them. */
function whole_of(catalog: Catalog, { verdict: { per_metre: strip, numbers, beams = [] } }: Summary): [VerdictRow[], VerdictRow[]] {
  return [rows_of(catalog, OF_RUN, numbers, strip), beam_rows(catalog, beams)];
}

/** Of several bases the rows of the whole stand by themselves, else among those of the first interface. */
function blocks_of(catalog: Catalog, summary: Summary, extras: VerdictExtras, statics: boolean): BaseVerdict[] {
  const { interfaces } = summary.verdict;
  const several = interfaces.filter(({ role }) => role !== "wall").length > 1;
  const blocks = interfaces.map((_, k) => base_of(catalog, summary, extras, k, statics, k === 0 && !several));
  if (!several || statics) return blocks;
  const whole: BaseVerdict = { name: "Whole structure", time: [], share: [], above: [], lost: [], lostText: "", beside: whole_of(catalog, summary).flat(), rest: [] };
  return [whole, ...blocks];
}

function base_of(catalog: Catalog, summary: Summary, extras: VerdictExtras, k: number, statics: boolean, with_whole: boolean): BaseVerdict {
  const given = summary.verdict.interfaces[k] as InterfaceSummary;
  const { name, role, numbers } = given;
  const base: BaseVerdict = { name, role, time: [], share: [], above: [], lost: [], lostText: "", beside: [], rest: [] };
  if (statics) return base; // the facts contain everything
  if (role === "wall") return { ...base, beside: rows_of(catalog, OF_WALL, numbers) };
  const [before, after] = with_whole ? whole_of(catalog, summary) : [[], []];
  const linear = linear_of(catalog, numbers);
  return {
    ...base,
    ...(extras.uplifted[k] ?? {}),
    above: (given.above ?? []).map(({ uplifted_ratio, duration }) => ({
      threshold: uplifted_ratio, duration, text: `above ${percent(uplifted_ratio)} for ${format_quantity(duration, "s")}`,
    })),
    lost: (given.full_loss ?? []).map(({ from, to }): [number, number] => [from, to]),
    lostText: lost_text(catalog, given),
    beside: [...before, ...rows_of(catalog, OF_BASE, numbers, summary.verdict.per_metre), ...after],
    rest: rows_of(catalog, RESIDUAL, numbers),
    ...(linear ? { linear } : {}),
  };
}

/** A change that grows says so: "+32 %". */
const signed = (quantity: Quantity, value: number, text: string): string => (quantity.name.startsWith("change_of") && value > 0 ? `+${text}` : text);

function criteria_of(catalog: Catalog, summary: Summary): Criterion[] {
  return summary.verdict.criteria.map((each) => {
    const quantity = quantity_of(catalog, each.quantity, each.unit);
    // A residual has no more decimals than its remaining variation, here as in its own row.
    const swing = summary.verdict.interfaces.find(({ name }) => name === each.interface)?.numbers[each.quantity]?.swing;
    return {
      label: quantity.meaning,
      interface: each.interface ?? each.beam ?? "",
      state: each.result,
      valueText: each.value === null ? (each.result === "met" ? "none" : "not computed") : signed(quantity, each.value, format_within(quantity, each.value, swing)),
      limitText: signed(quantity, each.limit, format_value(quantity, each.limit)),
      atLeast: each.kind === "at_least",
      source: each.source,
      uncertain: each.within_step_change ?? false,
    };
  });
}

/** `statics`: static stages alone, whose facts contain everything. */
export function verdict_of(summary: Summary, extras: VerdictExtras, catalog: Catalog, statics: boolean): Verdict {
  const { level, headline, consequence, step_check, floors } = summary.verdict;
  return {
    level,
    headline,
    consequence,
    facts: extras.facts,
    paragraphs: extras.paragraphs,
    run: summary.runs[0]?.label ?? "",
    interfaces: blocks_of(catalog, summary, extras, statics),
    criteria: criteria_of(catalog, summary),
    floors,
    ...(statics ? {} : { stepCheck: step_check }),
  };
}
