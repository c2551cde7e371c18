// Tables made from summary.json and trust.json: runs, storeys, floor spectra, trust bands, stiffness sweep.
import { NEGLIGIBLE } from "./format";
import { format_change, format_quantity, format_within, percent, significant } from "./quantity";
import { quantity_of, type Catalog } from "./result_verdict";
import type { FloorSummary, ResultNumbers, RunSummary, SoilSummary, Summary, Trust } from "./summary";
import type { Column, ColumnKind, Row, Table } from "./types";

function column(key: string, label: string, kind: ColumnKind, unit = "", digits?: number): Column {
  return { key, label, kind, unit, ...(digits === undefined ? {} : { digits }) };
}

const magnitude = (value: number | null | undefined): number | null => (value === null || value === undefined ? null : Math.abs(value));

function run_row(run: RunSummary): Row {
  const failed_as_expected = run.expected === "may_fail" && run.status === "failed";
  const opening = run.max_opening.value;
  const row: Row = {
    group: run.group, run: run.label, name: run.name,
    status: run.status + (failed_as_expected ? " (expected)" : ""),
    moment: magnitude(run.max_base_moment.value),
    pressure: run.max_pressure?.value ?? null,
    created: run.energy_created_share,
    retries: run.retries,
    per_step: run.steps > 0 && run.wall_seconds !== null ? (run.wall_seconds / run.steps) * 1e6 : 0,
  };
  if (run.max_top_motion) Object.assign(row, { top: magnitude(run.max_top_motion.value), top_time: run.max_top_motion.time });
  // A bonded base stretches instead of opening.
  if (!run.bonded) Object.assign(row, { ratio: run.max_uplifted_ratio.value, opening: opening !== null && opening < NEGLIGIBLE ? 0 : opening });
  if (run.agreement) {
    row["agreement"] = run.agreement.result;
    if (["agrees", "differs"].includes(run.agreement.result)) row["deviation"] = run.agreement.deviation;
  }
  return row;
}

function runs_table(summary: Summary): Table {
  const { runs, band, compared_columns: compared } = summary;
  const what = compared && compared.length > 0 ? `their peaks of ${compared.join(", ")}` : "all numbers of the verdict";
  const agreement = band === undefined ? "" : ` Runs that passed all checks agree when ${what} lie within ${significant(100 * band, 6)} % of the median of their group.`;
  return {
    id: "runs",
    title: compared ? "Comparison of all runs" : "Runs",
    caption: `Largest magnitudes. Spurious energy: energy created by the computation, divided by the external work.${agreement}`,
    columns: [
      column("run", "Run", "text"),
      column("status", "Status", "status"),
      ...(compared ? [column("agreement", "Agreement", "status"), column("deviation", "Deviation", "percent", "", 2)] : []),
      column("top", "Top motion", "number", "m", 4),
      column("top_time", "at time", "number", "s", 4),
      column("ratio", "Uplifted", "percent", "", 3),
      column("opening", "Gap", "number", "m", 4),
      column("moment", "Base moment", "number", "N m", 4),
      ...(runs.some((run) => run.max_pressure?.value) ? [column("pressure", "Pressure", "number", "Pa", 4)] : []),
      column("created", "Spurious energy", "percent", "", 3),
      column("retries", "Retries", "number", "", 6),
      column("per_step", "Time per step (µs)", "number", "", 3),
    ],
    rows: runs.map(run_row),
    ...(runs[0]?.group ? { rowGroup: "group" } : {}),
  };
}

// Instead of a change: the bonded floor is not excited in the band.
const ARISES = "arises";

function floor_row(run: string, group: string, floor: FloorSummary, d: number): Row {
  const spectrum = floor.spectra[d];
  const row: Row = {
    floor: floor.name, run, group,
    damping: spectrum?.damping, rigid: magnitude(floor.zero_period_acceleration.value), peak: spectrum?.peak.value, at: spectrum?.peak.frequency,
  };
  for (const band of spectrum?.beside_bonded ?? []) row[`from_${band.from}`] = band.arises ? ARISES : band.change;
  return row;
}

function floors_table(summary: Summary): Table[] {
  const runs = summary.runs.filter((run) => (run.floor_spectra ?? []).length > 0);
  const envelopes = summary.floor_envelopes ?? [];
  const floors = runs[0]?.floor_spectra ?? [];
  if (floors.length === 0) return [];
  const all = [...runs.flatMap((run) => run.floor_spectra ?? []), ...envelopes.flatMap((each) => each.floors)];
  const bands = new Map(all.flatMap(({ spectra }) => spectra.flatMap(({ beside_bonded: beside = [] }) => beside.map(({ from, band }): [number, string] => [from, band]))));
  const rows = floors.flatMap((floor, k) =>
    floor.spectra.flatMap((_, d) => [
      ...runs.map((run) => floor_row(run.label, run.group, run.floor_spectra?.[k] as FloorSummary, d)),
      ...envelopes.map((each) => floor_row(`envelope of ${each.runs} runs`, each.damping_case, each.floors[k] as FloorSummary, d)),
    ]));
  const arises = rows.some((row) => Object.values(row).includes(ARISES));
  return [{
    id: "floors",
    title: "Floor spectra",
    caption:
      "Zero period: largest absolute acceleration of the floor, which is the demand on rigid equipment. Peak: largest pseudo-acceleration and its frequency. " +
      "Frequency bands: change of the largest value in the band compared with the bonded model." +
      (arises ? ` "${ARISES}": the bonded model does not excite the floor in the band, so there is nothing to compare with; the first page gives the acceleration.` : ""),
    columns: [
      column("run", "Run", "text"),
      ...(summary.runs[0]?.group ? [column("group", "Case", "text")] : []),
      column("damping", "Damping", "percent", "", 2),
      column("rigid", "Zero period", "number", "m/s2", 4),
      column("peak", "Peak", "number", "m/s2", 4),
      column("at", "Peak at", "number", "Hz", 3),
      ...[...bands].sort(([a], [b]) => a - b).map(([from, band]) => column(`from_${from}`, band, "percent", "", 2)),
    ],
    rows,
    rowGroup: "floor",
  }];
}

function bands_table(trust: Trust, catalog: Catalog): Table[] {
  if (trust.bands.length === 0) return [];
  return [{
    id: "trust",
    title: "Trust bands of the results",
    caption:
      "Range of each result of the verdict over all runs in which one computational choice was changed. Band: half of the range divided by the value; " +
      "results that are themselves shares, changes or residuals have a smallest and a largest value only. Most sensitive to: the choice with the largest deviation from the case.",
    columns: [
      column("number", "Result", "text"), column("of", "Interface", "text"), column("value", "Case", "text"), column("least", "Smallest", "text"),
      column("most", "Largest", "text"), column("band", "Band", "text"), column("by", "Most sensitive to", "text"),
    ],
    rows: trust.bands.map((each) => {
      const quantity = quantity_of(catalog, each.quantity, each.unit);
      const text = (value: number | null): string => format_within(quantity, value, each.swing);
      return {
        number: quantity.meaning, of: each.interface, value: text(each.value), least: text(each.least), most: text(each.most),
        band: each.band === undefined ? "" : `±${percent(each.band)}`, by: each.dominant,
      };
    }),
  }];
}

function reaches_table(trust: Trust): Table[] {
  const [first] = trust.spectra;
  if (!first) return [];
  const choices = first.reaches.map(({ choice }) => choice);
  return [{
    id: "trust_reaches",
    title: "Reliable frequency range of the floor spectra",
    rowGroup: "floor",
    caption:
      `Up to the stated frequency, no repetition with the changed choice differs from the case by more than ${percent(trust.spectrum_band)} of the raw curve. ` +
      "A peak that shifts in frequency counts in full; broadened spectra cover such shifts. Elements and step: frequency that they resolve, with ten nodes per wavelength and " +
      "ten steps per period. Above broadened: largest excess of the raw curve of a repetition over the broadened curve of the case, and its frequency.",
    columns: [
      column("damping", "Damping", "percent", "", 2),
      column("to", "Reliable to", "number", "Hz", 3),
      ...choices.map((choice) => column(choice, choice, "number", "Hz", 3)),
      column("above", "Above broadened", "text"),
    ],
    rows: trust.spectra.map(({ floor, damping, speaks_to, reaches, above_broadened: above, above_at }) => ({
      floor, damping, to: speaks_to,
      ...Object.fromEntries(reaches.map(({ choice, to }) => [choice, to])),
      ...(above === undefined ? {} : { above: above < 5e-3 ? "nowhere" : `${percent(above)} at ${significant(above_at ?? 0, 3)} Hz` }),
    })),
  }];
}

function trust_tables(trust: Trust, catalog: Catalog): Table[] {
  return [
    ...bands_table(trust, catalog),
    ...reaches_table(trust),
    {
      id: "trust_runs",
      title: "Changed computational choices",
      caption: "One choice is changed at a time. Runs that failed or were interrupted do not count for the bands.",
      columns: [column("choice", "Choice", "text"), column("label", "Changed to", "text"), column("status", "Status", "text"), column("why", "Why", "text")],
      rows: [
        ...trust.runs.map(({ choice, label, status, reason }) => ({ choice, label, status, why: reason })),
        ...trust.not_changed.map(({ choice, reason }) => ({ choice, label: "–", status: "not changed", why: reason })),
      ],
    },
  ];
}

function storey_row(catalog: Catalog, storey: string, numbers: ResultNumbers, name: string, quantity: string): Row[] {
  const resultant = numbers[name];
  if (!resultant) return [];
  const row: Row = { storey, quantity };
  for (const [key, number] of [["x", numbers[`${name}_x`]], ["y", numbers[`${name}_y`]], ["length", resultant]] as const) {
    if (!number) continue;
    row[key] = format_within(quantity_of(catalog, name, number.unit), number.value, number.swing);
    if (typeof number.change_percent === "number") row[`${key}_change`] = format_change(number.change_percent / 100);
  }
  if (resultant.time !== undefined) row["time"] = resultant.time;
  return [row];
}

function storeys_table(summary: Summary, catalog: Catalog): Table[] {
  const rows = (summary.verdict.storeys ?? []).flatMap(({ name: storey, numbers }) => [
    ...storey_row(catalog, storey, numbers, "max_storey_shear", "shear"), ...storey_row(catalog, storey, numbers, "max_drift_ratio", "drift ratio"),
  ]);
  if (rows.length === 0) return [];
  const changes = rows.some((row) => "length_change" in row);
  const axis = (key: string, label: string): Column[] => [
    column(key, label, "text"), ...(changes ? [column(`${key}_change`, "Change", "text")] : []),
  ];
  return [{
    id: "storeys",
    title: "Storeys",
    caption: `Largest magnitudes along both axes and of the horizontal resultant, which need not occur together.${changes ? " Changes are those from the bonded model." : ""}`,
    columns: [
      column("storey", "Storey", "text"), column("quantity", "Quantity", "text"), ...axis("x", "Along x"), ...axis("y", "Along y"),
      ...axis("length", "Resultant"), column("time", "at time", "number", "s", 4),
    ],
    rows,
  }];
}

function sweep_table(summary: Summary): Table[] {
  const rows = summary.stiffness_sweep ?? [];
  if (rows.length === 0) return [];
  return [{
    id: "sweep",
    title: "Spurious energy against the stiffness of the joint",
    caption: "Largest spurious energy divided by the external work. The stiffness ratio k F belongs to the stiffest interface point and the time step.",
    columns: [
      column("ratio", "k F", "number", "", 3), column("path", "Path average", "percent", "", 3), column("path_status", "Status", "status"),
      column("end", "End of step", "percent", "", 3), column("end_status", "Status", "status"),
    ],
    rows: rows.map((row) => ({ ratio: row.k_F, path: row.created_share_path, path_status: row.status_path, end: row.created_share_end, end_status: row.status_end })),
  }];
}

function soil_table(name: string, soil: SoilSummary, only: boolean): Table {
  const frequency = soil.frequency > 0 ? ` Frequency factors and dashpots of rotations belong to ${significant(soil.frequency, 3)} Hz.` : " Static stiffness.";
  const dashpots = soil.radiation ? " The dashpots of the radiated waves are part of the model; the forces of the foundation contain theirs." : " The dashpots of the radiated waves are not part of the model.";
  return {
    id: only ? "soil" : `soil_${name}`,
    title: `Stiffness of the ground, foundation “${name}”`,
    caption: `Source: ${soil.source}. Stiffnesses that the case states itself replace these.${frequency}${dashpots}`,
    columns: [
      column("motion", "Motion", "text"), column("modulus", "Shear modulus", "number", "Pa", 3), column("depth", "Mean down to", "number", "m", 3),
      column("surface", "At the surface", "text"), column("embedment", "Embedment", "number", "", 4), column("dynamic", "Frequency", "number", "", 4),
      column("stiffness", "Stiffness", "text"), column("damping", "Dashpot", "text"),
    ],
    rows: soil.motions.map((each, k) => {
      const unit = k < soil.motions.filter(({ motion }) => motion === "vertical" || motion.startsWith("along")).length ? "N/m" : "N m/rad";
      return {
        motion: each.motion, modulus: each.shear_modulus, depth: each.depth, surface: format_quantity(each.at_surface, unit),
        embedment: each.embedment_factor, dynamic: each.dynamic_factor, stiffness: format_quantity(each.stiffness, unit),
        damping: each.damping ? format_quantity(each.damping, unit === "N/m" ? "N s/m" : "N m s/rad") : "–",
      };
    }),
  };
}

function soil_tables(summary: Summary): Table[] {
  const grounds = summary.interfaces.flatMap(({ name, soil }) => (soil ? [{ name, soil }] : []));
  return grounds.map(({ name, soil }) => soil_table(name, soil, grounds.length === 1));
}

/** All of them; `others`: tables of the program on the motions, which follow that of the runs. */
export function tables_of(summary: Summary, trust: Trust | undefined, catalog: Catalog, others: Table[]): Table[] {
  const runs = summary.runs.length > 0 ? [runs_table(summary)] : [];
  return [...runs, ...others, ...storeys_table(summary, catalog), ...floors_table(summary), ...(trust ? trust_tables(trust, catalog) : []), ...sweep_table(summary), ...soil_tables(summary)];
}
