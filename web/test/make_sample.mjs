// Makes test/sample.json: a report document for the tests of the page, computed by a small model of its own, and
// test/sample_space.json: one with a model in three dimensions (make_space.mjs).
//
//   node test/make_sample.mjs
//
// The model: a mass on an elastic column on a rigid footing that rests on tensionless springs spread over its width.
// Unknowns: v (rise of the footing), r (rotation, counter-clockwise), u (elastic displacement of the top).
//   opening of point i:  g_i = v + r x_i              force on the footing: f_i = -k_i min(g_i, 0)
//   top of the column:   ux = u - r h,  uy = v
// Symplectic Euler with a step far below the stability limit keeps the energy; explicit Euler creates energy and
// stands for the run that fails.
import { writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { space_document } from "./make_space.mjs";

const G = 9.81;
const HEIGHT = 10; // m
const HALF_WIDTH = 3; // m
const TOP_MASS = 50e3; // kg
const FOOTING_MASS = 30e3; // kg
const FOOTING_INERTIA = (FOOTING_MASS * (2 * HALF_WIDTH) ** 2) / 12; // kg m²
const FREQUENCY = 2; // Hz, fixed base
const COLUMN = TOP_MASS * (2 * Math.PI * FREQUENCY) ** 2; // N/m
const POINTS = 11;
const LOAD = 1.8e5; // N
const LOAD_FREQUENCY = 1.6; // Hz
const END = 4; // s
const STEP = 1e-4; // s
const EVERY = 50;
const FRAME_EVERY = 4; // stored samples per frame of the animation

/** Nodal points: half the part of the width at both ends. */
function points() {
  const spacing = (2 * HALF_WIDTH) / (POINTS - 1);
  return Array.from({ length: POINTS }, (_, i) => ({
    x: -HALF_WIDTH + i * spacing,
    part: (i === 0 || i === POINTS - 1 ? 0.5 : 1) / (POINTS - 1),
  }));
}

/** Two cycles of a sine that swells and dies. */
function load(t) {
  const duration = 2.5 / LOAD_FREQUENCY;
  return t < duration ? LOAD * Math.sin(Math.PI * (t / duration)) * Math.sin(2 * Math.PI * LOAD_FREQUENCY * t) : 0;
}

/** Solves the 2x2 system of rotation and elastic displacement (they share the inertia of the top). */
function accelerations(state, k, damping, t, bonded) {
  const [v, r, u, , , du] = state;
  let force = -(TOP_MASS + FOOTING_MASS) * G;
  let moment = 0;
  for (const { x, part } of points()) {
    const opening = v + r * x;
    const f = -k * part * (bonded ? opening : Math.min(opening, 0));
    force += f;
    moment += f * x;
  }
  const push = load(t);
  const elastic = -COLUMN * u - damping * du;
  const a11 = FOOTING_INERTIA + TOP_MASS * HEIGHT ** 2;
  const a12 = -TOP_MASS * HEIGHT;
  const b1 = moment - push * HEIGHT;
  const b2 = push + elastic;
  const det = a11 * TOP_MASS - a12 * a12;
  return { av: force / (TOP_MASS + FOOTING_MASS), ar: (b1 * TOP_MASS - a12 * b2) / det, au: (a11 * b2 - a12 * b1) / det, moment };
}

function energies(state, k, bonded) {
  const [v, r, u, dv, dr, du] = state;
  const dx = du - HEIGHT * dr;
  let stored = 0;
  for (const { x, part } of points()) {
    const g = bonded ? v + r * x : Math.min(v + r * x, 0);
    stored += 0.5 * k * part * g * g;
  }
  const kinetic = 0.5 * (TOP_MASS + FOOTING_MASS) * dv * dv + 0.5 * FOOTING_INERTIA * dr * dr + 0.5 * TOP_MASS * dx * dx;
  return { kinetic, strain: 0.5 * COLUMN * u * u, stored, weight: (TOP_MASS + FOOTING_MASS) * G * v };
}

function simulate({ name, group, k, damping = 0, explicit = false, bonded = false }) {
  const run = { name, group, k, bonded, failed: explicit, t: [], top: [], velocity: [], rotation: [], moment: [], ratio: [], kinetic: [], strain: [], stored: [], error: [], states: [] };
  const c = 2 * damping * Math.sqrt(COLUMN * TOP_MASS);
  let s = [(-(TOP_MASS + FOOTING_MASS) * G) / k, 0, 0, 0, 0, 0];
  const h = explicit ? 5 * STEP : STEP;
  const every = explicit ? EVERY / 5 : EVERY;
  const first = energies(s, k, bonded);
  const start = first.kinetic + first.strain + first.stored + first.weight;
  let work = 0;
  let lost = 0;
  for (let i = 0; i <= END / h; i++) {
    const t = i * h;
    const a = accelerations(s, k, c, t, bonded);
    if (i % every === 0) {
      const e = energies(s, k, bonded);
      run.t.push(t);
      run.top.push(s[2] - HEIGHT * s[1]);
      run.velocity.push(s[5] - HEIGHT * s[4]);
      run.rotation.push(s[1]);
      run.moment.push(-a.moment);
      run.ratio.push(points().reduce((sum, p) => sum + (s[0] + s[1] * p.x > 0 ? p.part : 0), 0));
      run.kinetic.push(e.kinetic);
      run.strain.push(e.strain);
      run.stored.push(e.stored);
      run.error.push(e.kinetic + e.strain + e.stored + e.weight - start - work + lost);
      run.states.push(s.slice(0, 3));
    }
    const dx = s[5] - HEIGHT * s[4];
    work += load(t) * dx * h;
    lost += c * s[5] * s[5] * h;
    const rate = [s[3] + h * a.av, s[4] + h * a.ar, s[5] + h * a.au];
    const used = explicit ? s.slice(3) : rate;
    s = [s[0] + h * used[0], s[1] + h * used[1], s[2] + h * used[2], ...rate];
    if (Math.abs(s[1]) > 0.5) break;
  }
  run.work = work;
  return run;
}

const sig = (v, digits = 5) => (v === null || !Number.isFinite(v) ? null : Number(v.toPrecision(digits)));
const sigs = (values, digits) => values.map((v) => sig(v, digits));
const peak = (values) => values.reduce((m, v) => Math.max(m, Math.abs(v)), 0);
const openings = (run, j) => points().map((p) => run.states[j][0] + run.states[j][1] * p.x);

function series(runs, x, y, extra = () => ({})) {
  return runs.map((run) => ({ label: run.name, run: run.name, x: sigs(x(run)), y: sigs(y(run)), ...(run.failed ? { failed: true } : {}), ...extra(run) }));
}

function animation(run) {
  const picked = run.t.map((_, j) => j).filter((j) => j % FRAME_EVERY === 0);
  const top = ([v, r, u]) => sigs([u - HEIGHT * r, v, r - (1.5 * u) / HEIGHT]);
  return {
    run: run.name,
    time: picked.map((j) => sig(run.t[j])),
    nodes: { top: picked.map((j) => top(run.states[j])), base: picked.map((j) => sigs([0, run.states[j][0], run.states[j][1]])) },
    openings: { soil: picked.map((j) => sigs(openings(run, j), 4)) },
    pressures: { soil: picked.map((j) => sigs(openings(run, j).map((g) => (-run.k * Math.min(g, 0)) / (2 * HALF_WIDTH)), 4)) },
  };
}

function model() {
  return {
    nodes: [{ name: "top", x: 0, y: HEIGHT }, { name: "base", x: 0, y: 0 }],
    beams: [{ name: "column", nodes: ["base", "top"] }],
    bodies: [{ name: "footing", node: "base", outline: [[-HALF_WIDTH, 0], [HALF_WIDTH, 0], [HALF_WIDTH, 0.8], [-HALF_WIDTH, 0.8]] }],
    masses: [{ node: "top", mass: TOP_MASS }, { node: "base", mass: FOOTING_MASS }],
    supports: [{ node: "base", dofs: ["ux"] }],
    springs: [],
    interfaces: [{ name: "soil", body: "base", points: points().map((p) => ({ x: sig(p.x), y: 0, nx: 0, ny: 1, area: sig(p.part * 2 * HALF_WIDTH) })) }],
    loads: [{ node: "top", fx: LOAD, fy: 0, label: "F(t), 180 kN" }],
  };
}

function charts(runs, bonded) {
  const sdm = runs[0];
  const all = [...runs, bonded];
  const chart = (id, section, title, caption, origin, x, y, list) => ({ id, section, title, caption, origin, x, y, series: list });
  const time = { label: "Time", unit: "s" };
  const gap = Array.from({ length: 61 }, (_, i) => (i - 20) * 1e-5);
  const ratios = [0.01, 0.1, 1, 10, 100];
  return [
    chart("law", "laws", "Traction against opening", "The law of the interface; compression is linear, tension is released.", "paper, figure 3",
      { label: "Opening", unit: "m" }, { label: "Traction", unit: "Pa" },
      [
        { label: "tensionless", x: sigs(gap), y: sigs(gap.map((g) => (g < 0 ? 4e8 * g : 0))) },
        { label: "softening", x: sigs(gap), y: sigs(gap.map((g) => (g < 0 ? 4e8 * g : g < 2e-5 ? 4e8 * g : 8e3 * Math.exp(-(g - 2e-5) / 8e-5)))) },
      ]),
    chart("load", "laws", "Load at the top", "", "paper, figure 4", time, { label: "Force", unit: "N" }, [{ label: "F(t)", x: sigs(sdm.t), y: sigs(sdm.t.map(load)) }]),
    chart("top", "histories", "Displacement of the top", "Positive in the direction of the load.", "paper, figure 5a", time, { label: "Displacement", unit: "m" }, series(all, (r) => r.t, (r) => r.top)),
    chart("velocity", "histories", "Velocity of the top", "", "paper, figure 6a", time, { label: "Velocity", unit: "m/s" }, series(all, (r) => r.t, (r) => r.velocity, (r) => (r.name.startsWith("Penalty") ? { hidden: true } : {}))),
    chart("ratio", "histories", "Uplifted part of the base", "By gap.", "our choice", time, { label: "Uplifted ratio", unit: "1" }, series(runs, (r) => r.t, (r) => r.ratio)),
    chart("moment", "histories", "Base moment against rotation", "Moment of the footing on the soil. The loop softens when the edge lifts. A gap in a curve is a restart.", "paper, figure 7b",
      { label: "Rotation", unit: "rad" }, { label: "Base moment", unit: "N m" },
      series(all, (r) => r.rotation, (r) => r.moment.map((m, i) => (r === sdm && i === 280 ? null : m)))),
    chart("ledger", "energy", "Energies of one run", "All of the first run.", "our choice", time, { label: "Energy", unit: "J" },
      ["kinetic", "strain", "stored"].map((key) => ({ label: key, run: sdm.name, x: sigs(sdm.t), y: sigs(sdm[key]) }))),
    chart("error", "energy", "Energy created, absolute", "Difference between the energy held and the work done.", "our choice", time, { label: "Energy error", unit: "J", log: true },
      series(runs, (r) => r.t.slice(5), (r) => r.error.slice(5).map((e) => Math.abs(e) + 1e-3))),
    chart("sweep", "energy", "Energy error against stiffness", "Exact path average against end of step, one mark per computation.", "our choice",
      { label: "k·F_ii", unit: "", log: true }, { label: "Energy error / external work", unit: "", log: true },
      [
        { label: "path average", x: ratios, y: [2e-14, 4e-14, 3e-13, 8e-13, 6e-12] },
        { label: "end of step", x: ratios, y: [3e-6, 2e-4, 1.2e-2, 0.4, null], dash: true },
      ]),
  ];
}

function table(runs) {
  const rows = runs.map((run) => {
    const high = run.ratio.indexOf(Math.max(...run.ratio));
    return {
      run: run.name, group: run.group,
      status: run.failed ? "failed (expected)" : "completed",
      ratio: run.bonded ? null : sig(run.ratio[high]), when: run.bonded ? null : sig(run.t[high]),
      opening: run.bonded ? null : sig(Math.max(...run.t.map((_, j) => Math.max(...openings(run, j))))),
      top: sig(peak(run.top)), moment: sig(peak(run.moment)), rotation: sig(peak(run.rotation)),
      error: sig(peak(run.error) / Math.abs(runs[0].work)), steps: Math.round(run.t[run.t.length - 1] / STEP), note: run.failed ? null : "in the band",
    };
  });
  const column = (key, label, kind, unit, digits) => ({ key, label, kind, ...(unit ? { unit } : {}), ...(digits ? { digits } : {}) });
  return {
    id: "comparison", title: "Every method, one model", caption: "Peaks over the whole history. Energy created is given as a part of the external work of the first run.",
    columns: [
      column("run", "Run", "text"), column("status", "Outcome", "status"), column("ratio", "Uplifted", "percent", "", 3), column("when", "at", "number", "s", 3),
      column("opening", "Opening", "number", "m", 3), column("top", "Top", "number", "m", 3), column("moment", "Base moment", "number", "N m", 3),
      column("rotation", "Rotation", "number", "rad", 3), column("error", "Energy created", "percent", "", 3), column("steps", "Steps", "number"), column("note", "Judgement", "text"),
    ],
    rows, rowGroup: "group",
  };
}

/** The sentences of the first page. */
function sentences(runs, bonded) {
  const [sdm] = runs;
  const high = sdm.ratio.indexOf(Math.max(...sdm.ratio));
  const opening = Math.max(...sdm.t.map((_, j) => Math.max(...openings(sdm, j))));
  const change = peak(sdm.moment) / peak(bonded.moment) - 1;
  const spell = sdm.ratio.filter((r) => r > 0).length * STEP * EVERY;
  return {
    headline: `The footing lifts off: up to ${(100 * sdm.ratio[high]).toFixed(0)} % of the base, ${(1000 * opening).toFixed(1)} mm at the edge.`,
    facts: [
      { label: "Uplifted part of the base", value: `${(100 * sdm.ratio[high]).toFixed(0)} %`, detail: `at ${sdm.t[high].toFixed(3)} s, by gap` },
      { label: "Largest opening", value: `${(1000 * opening).toFixed(2)} mm`, detail: "at the edge" },
      { label: "Time with uplift", value: `${spell.toFixed(2)} s`, detail: `of ${END} s` },
      { label: "Base moment", value: `${(100 * change).toFixed(0)} %`.replace("-", "−"), detail: "against the bonded base" },
    ],
    paragraphs: [
      "Uplift limits the moment that the soil can return to the structure: the peak base moment falls far below that of the bonded base, and the oscillation becomes slower.",
      "The sound methods agree within the band of the table. One run creates energy; it is kept, marked as failed and drawn dashed.",
    ],
  };
}

/** A number of the verdict with its bonded value and its value with twice the step. */
function compared(value, bonded, unit, time, coarse) {
  return { value, unit, time, at_twice_the_step: coarse * value, bonded, change_percent: 100 * (value / bonded - 1) };
}

const QUANTITIES = {
  max_top_motion: { meaning: "largest motion of the top" },
  max_moment: { meaning: "largest base moment" },
  min_overturning_safety: { meaning: "least safety against overturning" },
  min_sliding_safety: { meaning: "least safety against sliding" },
  residual_rotation: { meaning: "residual rotation of the base", near_zero: true },
  residual_settlement: { meaning: "residual settlement of the base", near_zero: true },
  full_loss_time: { meaning: "time without any contact" },
  ...Object.fromEntries(["max_uplifted_ratio", "residual_uplifted_ratio", "linear_tension_ratio", "predicted_uplifted_ratio"].map((name) => [name, { meaning: name.replaceAll("_", " "), share: true, near_zero: true }])),
};

/** summary.json: numbers compared with the bonded run, criteria in each state, and what is left; of one base. */
function summary_of(runs, bonded) {
  const [sdm] = runs;
  const share = Math.max(...sdm.ratio);
  return {
    version: "0.1.0", built_with: "", title: "Rocking oscillator on tensionless springs", command: "uplift compare sample/case.toml", created: "2025-01-15T09:30:00Z",
    case: { file: "sample/case.toml", sha256: "0".repeat(64) }, inputs: [], interfaces: [{ name: "footing" }], motions: [], runs: [],
    verdict: {
      level: "uplift", headline: sentences(runs, bonded).headline, consequence: "", per_metre: false,
      step_check: { result: "not converged", sentence: "Not converged: with twice the step (0.200 ms instead of 0.100 ms) base moment of footing changes by 7.0 %; a step of 0.0500 ms is expected to be sufficient." },
      numbers: { max_top_motion: compared(peak(sdm.top), peak(bonded.top), "m", 0.4, 0.998) },
      interfaces: [{
        name: "footing", role: "base",
        numbers: {
          max_moment: compared(peak(sdm.moment), peak(bonded.moment), "N m", 0.3, 0.93),
          min_overturning_safety: { value: 1.1, unit: "1", time: 0.5 },
          max_uplifted_ratio: { value: share, unit: "1" }, linear_tension_ratio: { value: 0.3, unit: "1" }, predicted_uplifted_ratio: { value: 0.3975, unit: "1" },
          residual_rotation: { value: 1e-4, unit: "rad", swing: 2e-4 }, residual_settlement: { value: -2e-4, unit: "m", swing: 1e-5 }, residual_uplifted_ratio: { value: 0, unit: "1", swing: 0.05 },
          full_loss_time: { value: 0.05, unit: "s" },
        },
        above: [{ uplifted_ratio: 0.3, duration: sdm.ratio.filter((r) => r > 0.3).length * STEP * EVERY }],
        full_loss: [{ from: 0.5, to: 0.52 }, { from: 0.9, to: 0.93 }],
      }],
      criteria: [
        { quantity: "max_uplifted_ratio", unit: "1", interface: "footing", result: "not met", value: 0.6, limit: 0.3, kind: "at_most", source: "specification of the client, 4.2" },
        { quantity: "min_overturning_safety", unit: "1", interface: "footing", result: "met", value: 1.1, limit: 1, kind: "at_least", source: "judgement" },
        { quantity: "min_sliding_safety", unit: "1", interface: "footing", result: "undetermined", value: null, limit: 1.1, kind: "at_least", source: "code <script>" },
      ],
      floors: [
        { floor: "roof", damping: 0.05, bands: [{ band: "below 2 Hz", change_percent: 12.4, change: "+12 %" }, { band: "2 to 5 Hz", change_percent: -38.2, change: "-38 %" }, { band: "above 5 Hz", change_percent: 140, change: "+140 %" }] },
      ],
    },
  };
}

/** Gap along the base at the end. */
function rest_chart(run) {
  const last = openings(run, run.t.length - 1);
  return {
    id: "rest_gap", section: "rest", title: "Gap along the base", caption: "At the end.", origin: "added by uplift",
    x: { label: "Along the base", unit: "m" }, y: { label: "Gap", unit: "m" }, series: [{ label: "at the end", x: last.map((_, i) => i), y: last.map((v) => Math.max(0, v)) }],
  };
}

function document_of(runs, bonded) {
  return {
    format: "uplift-report-2", subtitle: "Sample for the tests of the report page",
    resolved: `title = "Rocking oscillator"\n\n[beam.column]\nheight = "${HEIGHT} m"\n\n[footing]\nwidth = "${2 * HALF_WIDTH} m"\nmass = "30 t"\n`,
    summary: summary_of(runs, bonded), quantities: QUANTITIES, uplifted: [{ time: runs[0].t, share: runs[0].ratio }],
    verdict: { facts: sentences(runs, bonded).facts, paragraphs: sentences(runs, bonded).paragraphs },
    choices: [
      { what: "Fixed-base frequency", value: "2 Hz", origin: "paper" },
      { what: "Points over the width", value: String(POINTS), origin: "our choice", note: "Enough to place the edge of the contact within a tenth of the width." },
      { what: "Time step", value: "0.1 ms", origin: "user" },
    ],
    tables: [table([...runs, bonded])],
    sections: [
      { id: "rest", title: "After the shock", text: "How the base stands when the run ends." },
      { id: "laws", title: "Law and load" },
      { id: "histories", title: "Response", text: "Bonded base for comparison. Runs that failed are dashed and do not set the range." },
      { id: "energy", title: "Energy" },
    ],
    charts: [...charts(runs, bonded), rest_chart(runs[0])], model: model(), animations: runs.map(animation),
  };
}

const runs = [
  simulate({ name: "SDM, path average", group: "damped 2 %", k: 4e8, damping: 0.02 }),
  simulate({ name: "Tensionless springs", group: "damped 2 %", k: 3e8, damping: 0.02 }),
  simulate({ name: "Penalty </script>", group: "undamped", k: 5e8 }),
  simulate({ name: "Lagrange, no correction", group: "undamped", k: 9e8, explicit: true }),
];
const bonded = simulate({ name: "Bonded base", group: "damped 2 %", k: 4e8, damping: 0.02, bonded: true });
const plane = document_of(runs, bonded);
const path = (name) => fileURLToPath(new URL(name, import.meta.url));
await writeFile(path("sample.json"), JSON.stringify(plane) + "\n");
await writeFile(path("sample_space.json"), JSON.stringify(space_document(plane)) + "\n");
for (const run of [...runs, bonded]) {
  console.log(`${run.name.padEnd(26)} top ${peak(run.top).toFixed(3)} m  uplifted ${Math.max(...run.ratio).toFixed(2)}  error ${(peak(run.error) / Math.abs(runs[0].work)).toExponential(1)}`);
}
