// What the page makes of the results documents: captions, rounded numbers, rows of tables, figures. The expected texts are written by hand
// from the rules that the terminal follows too (three significant digits, shares in per cent, 0 below the precision of a run).
import { pathToFileURL } from "node:url";
import { inject, open, write_page } from "./harness.mjs";

const peak = (value, unit, time = 1) => ({ value, unit, time });

function run(name, label, more = {}) {
  return {
    name, label, group: "", status: "completed", expected: "completes", bonded: false, steps: 1000, retries: 2, wall_seconds: 0.004,
    max_top_motion: peak(-0.0359, "m", 0.75), max_uplifted_ratio: peak(0.25, "1"), max_opening: peak(4e-10, "m"), max_base_moment: peak(-1.37e6, "N m"),
    energy_created_share: 0.002, agreement: { result: "agrees", deviation: 0.003 }, ...more,
  };
}

const SECTIONS = { beam: "column", along: { value: [0, 2, 4] }, elevation: { value: [1, 3, 5] } };
const range = (size) => ({ max: [3 * size, 2 * size, 0], min: [-size, 0, 0] });
const floor = (changes) => ({
  name: "roof", zero_period_acceleration: peak(-3, "m/s2"),
  spectra: [{ damping: 0.05, peak: { value: 9, frequency: 4 }, ...(changes ? { beside_bonded: changes } : {}) }],
});
const CHANGES = [{ band: "below 2 Hz", from: 0, change: 0.1 }, { band: "above 2 Hz", from: 2, change: -0.25 }];
// the bonded floor stands still above 2 Hz: the change would be that of a threshold
const ARISING = [CHANGES[0], { band: "above 2 Hz", from: 2, change: 4000, arises: true }];

const quantity = (meaning) => ({ meaning });
const share = (meaning) => ({ meaning, share: true, near_zero: true });
const residual = (meaning) => ({ meaning, near_zero: true });
const QUANTITIES = {
  max_top_motion: quantity("motion"), max_shear: quantity("shear"), max_moment: quantity("largest base moment"), min_compression: quantity("least"),
  max_beam_moment: quantity("moment of a beam"), max_beam_shear: quantity("shear of a beam"), max_uplifted_ratio: share("largest share of the area with a gap"),
  residual_rotation: residual("residual rotation of the base"), residual_opening: residual("residual largest gap"), change_of_moment: share("change of the base moment"),
};

const SUMMARY = {
  version: "1", built_with: "", title: "Documents", command: "uplift trust case.toml", created: "2025-01-15T09:30:00Z", case: { file: "case.toml", sha256: "0" }, inputs: [], motions: [],
  runs: [
    run("run", "springs", { floor_spectra: [floor(CHANGES)], beam_envelopes: [{ ...SECTIONS, moment: range(10), shear: range(2), axial: range(1) }] }),
    run("bonded", "bonded", { bonded: true, agreement: { result: "-", deviation: 0 }, floor_spectra: [floor()], beam_envelopes: [{ ...SECTIONS, moment: range(20), shear: range(4), axial: range(1) }] }),
    run("end", "end of step", { status: "failed", expected: "may_fail", max_top_motion: undefined, steps: 0, agreement: { result: "failed", deviation: 0 } }),
  ],
  floor_envelopes: [{ damping_case: "", runs: 2, floors: [floor(ARISING)] }],
  verdict: {
    level: "uplift", headline: "h", consequence: "", step_check: { result: "converged", sentence: "s" }, per_metre: true, floors: [],
    numbers: { max_top_motion: { value: 0.0359, unit: "m", time: 0.75, bonded: 0.0003, change_percent: 11866.67, at_twice_the_step: 0.0361 }, max_storey_shear: { value: 3e6, unit: "N", time: 2 } },
    interfaces: [
      {
        name: "soil", role: "base",
        numbers: {
          max_shear: { value: 999.9e3, unit: "N", bonded: 714e3, change_percent: 40.04, at_twice_the_step: 999.95e3 },
          max_moment: { value: 1.37e6, unit: "N m", bonded: 2.85e6, change_percent: -51.9, at_twice_the_step: 1.3e6 },
          max_bearing_utilisation: { value: 0.87312, unit: "1", time: 3.2, at_twice_the_step: 0.8732 },
          min_compression: { value: 1e-12, unit: "N", bonded: 1e-13, change_note: "no excitation in this direction" },
          max_uplifted_ratio: { value: 0.6931, unit: "1" },
          residual_rotation: { value: 1.2e-6, unit: "rad", swing: 2.2e-5, at_twice_the_step: 1.3e-6 },
          residual_opening: { value: 0, unit: "m", swing: 0 },
        },
        above: [{ uplifted_ratio: 0.05, duration: 0.085 }], full_loss: [],
      },
      { name: "wall", role: "wall", numbers: { max_slip: { value: 2e-3, unit: "m" } } },
    ],
    beams: [{ name: "column", numbers: { max_beam_moment: { value: 5e6, unit: "N m" }, max_beam_shear: { value: 0, unit: "N" } } }],
    storeys: [{ name: "level 3 m", numbers: { max_storey_shear_x: { value: 3e6, unit: "N" }, max_storey_shear_y: { value: 0, unit: "N" }, max_storey_shear: { value: 3e6, unit: "N", time: 2 } } }],
    criteria: [{ quantity: "change_of_moment", unit: "1", interface: "soil", result: "met", value: -0.519, limit: 0.1, kind: "at_most", source: "x" }],
  },
  band: 0.02, compared_columns: [],
  interfaces: [{ name: "wall" }, {
    name: "soil",
    soil: {
      source: "Pais & Kausel", embedment: 0, frequency: 2, radiation: true,
      motions: [
        { motion: "vertical", shear_modulus: 80e6, depth: 5, at_surface: 2.5e9, embedment_factor: 1, dynamic_factor: 0.99, stiffness: 2.475e9, damping: 7e7 },
        { motion: "tilting the width", shear_modulus: 80e6, depth: 5, at_surface: 5e10, embedment_factor: 1, dynamic_factor: 1, stiffness: 5e10, damping: 0 },
      ],
    },
  }],
  stiffness_sweep: [{ k_F: 0.1, created_share_path: 0, status_path: "completed", created_share_end: 0.4, status_end: "failed (expected)" }],
};

const TRUST = {
  spectrum_band: 0.15,
  runs: [{ choice: "time step", label: "half", status: "completed", reason: "" }], not_changed: [{ choice: "mesh", reason: "the case has no mesh" }],
  bands: [
    { quantity: "max_moment", interface: "soil", unit: "N m", value: 2e6, least: 1.9e6, most: 2.14e6, band: 0.06, dominant: "time step" },
    { quantity: "residual_rotation", interface: "soil", unit: "rad", value: 1.2e-6, least: 0, most: 2e-6, swing: 2.2e-5, dominant: "" },
  ],
  spectra: [{ floor: "roof", damping: 0.02, speaks_to: 12.34, limited_by: "time step", reaches: [{ choice: "time step", to: 12.34 }], above_broadened: 0.123, above_at: 8, frequencies: [1, 10], value: [1, 2], least: [0.9, 1.5], most: [1.1, 2.5] }],
};

export const DOCUMENT = {
  format: "uplift-report-2", subtitle: "", resolved: "", summary: SUMMARY, trust: TRUST, quantities: QUANTITIES, uplifted: [{ time: [0, 1], share: [0, 0.69] }],
  figures: { beam_shear_1: { origin: "paper", caption: "of the case" } }, verdict: { facts: [], paragraphs: [] }, choices: [], tables: [], charts: [], model: null, animations: [],
};

function check_verdict(check, { interfaces: [base, wall], criteria: [criterion] }) {
  const row = (label) => [...base.beside, ...base.rest, ...wall.beside].find((each) => each.label === label) ?? {};
  const same = (label, key, text) => check.equal(row(label)[key], text, `${label}: ${key}`);
  check.equal(base.beside.map((each) => each.label).join("; "), "Motion of the top; Largest storey shear per metre; Base shear per metre; Base moment per metre; Least compression per metre; Utilisation of bearing capacity; Moment of column", "captions in their order");
  same("Motion of the top", "text", "35.9 mm");
  same("Motion of the top", "changeText", "120 times as large");
  same("Motion of the top", "stepText", "±0.6 %");
  same("Base shear per metre", "text", "1.00 MN"); // not 1000 kN
  same("Base shear per metre", "changeText", "+40 %");
  same("Base shear per metre", "stepText", "< 0.1 %");
  same("Base moment per metre", "text", "1.37 MN m");
  same("Base moment per metre", "bondedText", "2.85 MN m");
  same("Base moment per metre", "changeText", "-52 %");
  same("Base moment per metre", "stepText", "±5.1 %");
  same("Least compression per metre", "text", "0 N");
  same("Least compression per metre", "changeText", "no excitation in this direction");
  same("Utilisation of bearing capacity", "text", "0.873");
  same("Utilisation of bearing capacity", "stepText", "< 0.1 %");
  same("Rotation", "text", "0.001 mrad"); // no finer than it varies
  same("Rotation", "swingText", "0.022 mrad");
  same("Rotation", "stepText", "±0");
  same("Largest gap", "text", "0 m");
  same("Largest gap", "swingText", undefined);
  same("Largest slip", "text", "2.00 mm");
  check.equal(base.above[0].text, "above 5.0 % for 85.0 ms", "the time above a threshold");
  check.equal(`${criterion.label}: ${criterion.valueText}, ${criterion.limitText}`, "change of the base moment: -52 %, +10 %", "a criterion");
}

function check_tables(check, tables) {
  const table = (id) => tables.find((each) => each.id === id) ?? { rows: [], columns: [] };
  check.equal(tables.map((each) => each.id).join(), "runs,storeys,floors,trust,trust_reaches,trust_runs,sweep,soil", "tables in their order");
  const storey = table("storeys").rows[0] ?? {};
  check.equal([storey.storey, storey.quantity, storey.x, storey.y, storey.length, storey.time].join("; "), "level 3 m; shear; 3.00 MN; 0 N; 3.00 MN; 2", "a storey along both axes and as resultant");
  check.equal(table("storeys").columns.map((each) => each.label).join("; "), "Storey; Quantity; Along x; Along y; Resultant; at time", "no changes without a bonded run");
  const [first, bonded, failed] = table("runs").rows;
  check.equal([first.top, first.top_time, first.ratio, first.opening, first.moment, first.per_step].join(), "0.0359,0.75,0.25,0,1370000,4", "magnitudes of a run; a gap below the precision is 0");
  check.equal([bonded.ratio, bonded.opening, bonded.deviation].join(), ",,", "a bonded base has no gap, and is not compared");
  check.equal([failed.status, failed.top, failed.per_step].join(), "failed (expected),,0", "a run that was expected to fail");
  check.ok(!table("runs").columns.some((each) => each.key === "pressure"), "runs of whole foundations have no pressure", "a column of pressures");
  check.ok(table("runs").caption.includes("agree when all numbers of the verdict lie within 2 % of the median"), "the band is stated", table("runs").caption);
  check.equal(table("floors").columns.map((each) => each.label).join("; "), "Run; Damping; Zero period; Peak; Peak at; below 2 Hz; above 2 Hz", "columns of the floor spectra");
  check.equal(table("floors").rows.map((row) => [row.run, row.rigid, row.peak, row.at, row.from_0, row.from_2].join()).join("; "), "springs,3,9,4,0.1,-0.25; bonded,3,9,4,,; envelope of 2 runs,3,9,4,0.1,arises", "rows of the floor spectra");
  check.ok(table("floors").caption.includes('"arises": the bonded model does not excite the floor in the band'), "what stands for a change is explained", table("floors").caption);
  const [moment, rotation] = table("trust").rows;
  check.equal([moment.number, moment.value, moment.least, moment.most, moment.band, moment.by].join("; "), "largest base moment; 2.00 MN m; 1.90 MN m; 2.14 MN m; ±6.0 %; time step", "a band");
  check.equal([rotation.value, rotation.least, rotation.band].join("; "), "0.001 mrad; 0.000 mrad; ", "a band of a residual value");
  check.equal(table("trust_reaches").rows[0].above, "12 % at 8 Hz", "an excess over the broadened curve");
  check.equal(table("trust_runs").rows.map((row) => row.status).join(), "completed,not changed", "changed choices");
  check.equal(table("sweep").rows[0].end, 0.4, "the stiffness sweep");
  const ground = table("soil").rows.map((row) => [row.motion, row.stiffness, row.damping].join()).join("; ");
  check.equal(ground, "vertical,2.48 GN/m,7.00·10⁷ N s/m; tilting the width,5.00·10¹⁰ N m/rad,–", "the ground under a footing");
  check.ok(table("soil").caption.includes("belong to 2 Hz"), "the frequency is stated", table("soil").caption);
}

function check_charts(check, charts) {
  const chart = (id) => charts.find((each) => each.id === id) ?? { series: [] };
  check.equal(charts.map((each) => each.id).join(), "beam_moment_1,beam_shear_1,beam_axial_1,trust_roof_2,stiffness_sweep", "figures in their order");
  const moment = chart("beam_moment_1");
  check.equal(moment.series.map((each) => `${each.label}: ${each.x.join(" ")}${each.dash ? " dashed" : ""}`).join("; "),
    "springs, largest: 30 20 0; springs, smallest: -10 0 0; bonded, largest: 60 40 0 dashed; bonded, smallest: -20 0 0 dashed", "envelopes along a beam");
  check.equal(`${moment.y.label}: ${moment.series[0].y.join(" ")}`, "Height: 1 3 5", "an upright beam over its height");
  check.equal(`${chart("beam_shear_1").origin}: ${chart("beam_shear_1").caption}`, "paper: of the case", "the case states origin and caption");
  check.equal(chart("trust_roof_2").caption, "Reliable up to 12.3 Hz, limited by the time step.", "the reach of a floor spectrum");
  check.equal(chart("stiffness_sweep").series.map((each) => each.y[0]).join(), "1e-16,0.4", "no energy is drawn at the lower limit");
}

export async function check_documents(browser, check) {
  const { context, page, log } = await open(browser, pathToFileURL(await write_page(await inject(DOCUMENT))).href);
  const { verdict, tables, charts, sections } = await page.evaluate(() => window.upliftReport.report);
  check_verdict(check, verdict);
  check_tables(check, tables);
  check_charts(check, charts);
  check.ok(sections.some(({ id }) => id === "trust"), "trust bands have a section");
  check.equal(log.console.length, 0, `results documents: no message in the console (${log.console[0] ?? ""})`);
  await context.close();
  const still = await open(browser, pathToFileURL(await write_page(await inject({ ...DOCUMENT, statics: true }))).href);
  const stands = await still.page.evaluate(() => window.upliftReport.report);
  check.equal(stands.verdict.interfaces[0].beside.length + stands.verdict.interfaces[0].rest.length, 0, "the facts of static stages alone contain everything");
  check.equal(stands.verdict.stepCheck, undefined, "static stages have no time step");
  check.equal(stands.sections[0].title, "State under the static loads", "static stages have sections of their own");
  await still.context.close();
  // with a second base, what belongs to the whole structure stands by itself
  const [soil, wall] = SUMMARY.verdict.interfaces;
  const several = { ...DOCUMENT, summary: { ...SUMMARY, verdict: { ...SUMMARY.verdict, interfaces: [soil, { ...soil, name: "second" }, wall] } } };
  const two = await open(browser, pathToFileURL(await write_page(await inject(several))).href);
  const blocks = await two.page.evaluate(() => window.upliftReport.report.verdict.interfaces.map(({ name, beside }) => `${name}: ${beside.map(({ label }) => label).join(", ")}`));
  const own = "Base shear per metre, Base moment per metre, Least compression per metre, Utilisation of bearing capacity";
  check.equal(blocks.join("; "), `Whole structure: Motion of the top, Largest storey shear per metre, Moment of column; soil: ${own}; second: ${own}; wall: Largest slip`, "rows of several bases");
  check.equal((await two.page.locator(".base-name").allInnerTexts()).join("; "), "Whole structure; soil; second; wall (wall)", "their headings");
  await two.context.close();
}
