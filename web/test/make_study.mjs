// Results of studies in closed form, as study.json has them: capacities are quantiles of a lognormal distribution, demands are powers of the
// intensity, so that medians, dispersions and counts are known beforehand.
export const THETA = 0.42;
export const BETA_R = 0.3;
export const BETA_U = 0.2;
export const BETA = Math.hypot(BETA_R, BETA_U);
const LIMIT = 0.03;
const DESIGN = 0.2;
const OUTCOMES = ["completed", "overturned", "separated", "failed", "energy", "timeout", "memory", "crashed"];

/** Quantiles of the standard normal distribution at (i + 1/2)/n (Acklam's rational function is not needed: bisection of the integral). */
function normal(z) {
  let sum = 0;
  const steps = 400;
  for (let i = 0; i < steps; i++) sum += Math.exp(-0.5 * (((i + 0.5) / steps) * z) ** 2) / steps;
  return 0.5 + (z * sum) / Math.sqrt(2 * Math.PI);
}
function quantiles(count) {
  return Array.from({ length: count }, (_, i) => {
    let [low, high] = [-6, 6];
    while (high - low > 1e-10) (normal((low + high) / 2) < (i + 0.5) / count ? (low = (low + high) / 2) : (high = (low + high) / 2));
    return (low + high) / 2;
  });
}

const fitted = (theta, beta) => ({ fitted: true, reason: "", theta, beta });
function full_fit(theta, beta, error) {
  const z = Array.from({ length: 41 }, (_, i) => -3 + (6 * i) / 40);
  const shift = error / beta;
  return {
    ...fitted(theta, beta), log_likelihood: 0, se_log_theta: error, se_beta: error, correlation: 0,
    theta_interval: { lower: theta * Math.exp(-1.645 * error), upper: theta * Math.exp(1.645 * error) }, beta_interval: { lower: 0.8 * beta, upper: 1.3 * beta },
    curve: { intensity: z.map((each) => theta * Math.exp(beta * each)), probability: z.map(normal), lower: z.map((each) => normal(each - 1.645 * shift)), upper: z.map((each) => normal(each + 1.645 * shift)) },
  };
}
/** By the formulas of EPRI TR-103959. */
const capacity_of = (median, beta_r, beta_u) => ({
  known: true, reason: "", median, beta_r, beta_u, beta_c: Math.hypot(beta_r, beta_u),
  hclpf: median * Math.exp(-1.65 * (beta_r + beta_u)), hclpf_composite: median * Math.exp(-2.326 * Math.hypot(beta_r, beta_u)),
});
const refused = (reason) => ({ fitted: false, reason });

function motions_of(count) {
  return Array.from({ length: count }, (_, i) => ({
    name: `m_${i + 1}`, label: `m_${i + 1}`, record: "quake", intensity: 0.3, pga: 2.94, pgv: 0.25 + 0.01 * i, arias: 1.2, cav: 9, significant_duration: 8, step: 0.01, duration: 12,
  }));
}

const run = (intensity, demand, outcome = "completed") => {
  const state = outcome === "completed" || outcome === "overturned" ? (demand === null || demand > LIMIT ? "exceeded" : "survived") : "unknown";
  return { id: "0".repeat(64), intensity, factor: intensity / 0.3, outcome, states: [state], demands: [demand] };
};

function limit_of(changes) {
  return {
    name: "uplift of 30 mm", quantity: "max_opening", label: "largest gap", of: "", unit: "m", limit: LIMIT, at_least: false, source: "client", survived: 0, exceeded: 0, unknown: 0,
    capacities: [], stripes: [], confidence: 0.9, fit: refused("there are no runs"), unknown_survived: refused("there are no runs"), unknown_exceeded: refused("there are no runs"),
    dispersion: { known: false, reason: "it takes two samples" }, capacity: { known: false, reason: "it takes two samples" }, tornado: [], tornado_basis: { samples: 0, responses: 0, reason: "" }, ...changes,
  };
}

function study_of(changes) {
  const curves = changes.curves;
  const outcomes = Object.fromEntries(OUTCOMES.map((name) => [name, curves.flatMap(({ runs }) => runs).filter((each) => each.outcome === name).length]));
  return {
    format: "uplift-study-1", name: "pier", title: "Bridge pier", complete: curves.every(({ complete }) => complete),
    provenance: { version: "1", case_file: "../case.toml", case_sha256: "c0", plan_sha256: "b1", inputs: [], seed: 3 },
    intensity: { measure: "pga", label: "PGA", unit: "g_n", period: 0, damping: 0.05 }, method: { type: "ida", levels: [], largest: 6, tolerance: 0.02 },
    samples: 1, pairing: "crossed", variables: [], factors: [], failures: [], floor_spectra: [], outcomes, ...changes,
  };
}

/** Every motion with every sample; capacities exact; one motion survives again above its capacity. */
export function ida_study(count = 12, samples = 5) {
  const [z, w] = [quantiles(count), quantiles(samples)];
  const [motions, curves, capacities] = [motions_of(count), [], []];
  motions.forEach(({ name }, i) =>
    w.forEach((u, sample) => {
      const intensity = THETA * Math.exp(BETA_R * z[i] + BETA_U * u);
      const levels = [0.25, 0.5, 0.75, 0.99, 1.01, 1.5, 2.5].map((part) => part * intensity);
      const runs = levels.map((level) => run(level, LIMIT * (level / intensity) ** 1.5, level > 2 * intensity ? "overturned" : "completed"));
      curves.push({ motion: name, sample, complete: true, runs });
      const known = { known: "exact", intensity };
      capacities.push({ motion: name, sample, found: true, capacity: known, unknown_survived: known, unknown_exceeded: known, resurrections: i === 0 && sample === 0 ? [2 * intensity] : [] });
    }));
  const counts = { survived: 4 * curves.length, exceeded: 3 * curves.length, unknown: 0 };
  const fit = full_fit(THETA, BETA, 0.06);
  // fractiles of the curves LIMIT (im/capacity)^1.5: those of the capacities, straight between them in their order
  const sorted = capacities.map(({ capacity }) => capacity.intensity).sort((a, b) => a - b);
  const share = (part) => { const at = part * (sorted.length - 1), i = Math.floor(at); return sorted[i] + (at - i) * ((sorted[i + 1] ?? sorted[i]) - sorted[i]); };
  const demands = Array.from({ length: 40 }, (_, i) => (LIMIT * (i + 1)) / 40);
  const [p16, p50, p84] = [0.16, 0.5, 0.84].map((part) => demands.map((demand) => share(part) * (demand / LIMIT) ** (2 / 3)));
  const pair = (fit) => ({ at_design: normal(Math.log(DESIGN / fit.theta) / fit.beta), at_one_and_a_half: normal(Math.log((1.5 * DESIGN) / fit.theta) / fit.beta) });
  const rate = (fit) => 1e-4 * (DESIGN / fit.theta) ** 2.5 * Math.exp(0.5 * (2.5 * fit.beta) ** 2); // of the hazard 1e-4 (a/DESIGN)^-2.5
  const composite = Math.hypot(BETA_R, 0.15, BETA_U); // of motions, samples and both together
  const site = (fit) => ({
    performance: { ...pair(fit), at_design_interval: { lower: 0, upper: 1 }, at_one_and_a_half_interval: { lower: 0, upper: 1 }, met: false, unknown_survived: pair(fit), unknown_exceeded: pair(fit), composite: pair({ theta: fit.theta, beta: composite }) },
    risk: { rate: rate(fit), composite: rate({ theta: fit.theta, beta: composite }), reason: "", share_below: 0.1, share_above: 0.01, unknown_survived: rate(fit), unknown_exceeded: rate(fit) },
  });
  const rotation = limit_of({
    name: "rotation of 2 mrad", quantity: "residual_rotation", label: "residual rotation of the base", unit: "rad", limit: 2e-3, ...counts,
    fit: full_fit(0.9, 0.5, 0.1), unknown_survived: fitted(0.9, 0.5), unknown_exceeded: fitted(0.9, 0.5), ...site({ theta: 0.9, beta: 0.5 }),
    fractiles: { demands: [5e-4, 1e-3, 2e-3], p16: [0.2, 0.4, null], p50: [0.3, null, null], p84: [null, null, null] },
    tornado_basis: { samples: 0, responses: 0, reason: "it takes three samples at least" },
    capacities: capacities.map((each, i) => ({ ...each, found: i > 1, capacity: { known: "at_least", intensity: 6 } })),
  });
  for (const curve of curves) for (const each of curve.runs) (each.states.push("survived"), each.demands.push(each.demands[0] / 40));
  return study_of({
    samples, motions, curves,
    design: { intensity: DESIGN, source: "site report" }, hazard: { intensities: [DESIGN, 10 * DESIGN], rates: [1e-4, 1e-4 * 10 ** -2.5], source: "" },
    variables: [
      { name: "soil stiffness", paths: ["interface[0].law.K_n"], meaning: "factor", unit: "1", distribution: "lognormal", parameters: [1, 0.4], values: w.map((u) => Math.exp(0.4 * u)) },
      { name: "friction", paths: ["interface[0].law.friction"], meaning: "value", unit: "1", distribution: "uniform", parameters: [0.45, 0.75], values: w.map((_, i) => 0.45 + 0.06 * i) },
    ],
    limits: [
      limit_of({
        ...counts, capacities, fit, ...site(fit), fractiles: { demands, p16, p50, p84 }, unknown_survived: fitted(THETA, BETA), unknown_exceeded: fitted(THETA, BETA),
        dispersion: { known: true, reason: "", median: THETA, beta_r: BETA_R, beta_u: BETA_U, hclpf: THETA * Math.exp(-1.65 * (BETA_R + BETA_U)) },
        capacity: capacity_of(THETA, BETA_R, BETA_U),
        tornado: [{ variable: "soil stiffness", low: 0.8 * THETA, high: 1.25 * THETA }, { variable: "friction", low: 1.02 * THETA, high: THETA / 1.02 }],
        tornado_basis: { samples: samples - 1, responses: 46, reason: "" },
      }),
      rotation,
    ],
  });
}

/** The same with a factor of safety of 1.5 (0.4, 0), so that beta_r is 0.5, and a bootstrap of the first limit. */
export function factored_study() {
  const study = ida_study();
  const [first] = study.limits;
  const capacity = capacity_of(1.5 * THETA, 0.5, BETA_U);
  const composite = { at_design: normal(Math.log(DESIGN / capacity.median) / capacity.beta_c), at_one_and_a_half: normal(Math.log((1.5 * DESIGN) / capacity.median) / capacity.beta_c) };
  const bootstrap = { known: true, reason: "", draws: 2000, refused: 0, theta_interval: { lower: 0.39, upper: 0.45 }, beta_interval: { lower: 0.3, upper: 0.41 } };
  study.factors = [{ name: "anchors", median: 1.5, beta_r: 0.4, beta_u: 0, source: "tests of the maker" }];
  study.limits[0] = { ...first, capacity, bootstrap, performance: { ...first.performance, composite }, risk: { ...first.risk, composite: 1e-4 * (DESIGN / capacity.median) ** 2.5 * Math.exp(0.5 * (2.5 * capacity.beta_c) ** 2) } };
  study.limits[1] = { ...study.limits[1], bootstrap: { known: false, reason: "1900 of 2000 draws have no fit" } };
  return study;
}

/** Ten motions at five intensities, two runs without outcome, floor spectra. */
export function stripes_study() {
  const z = quantiles(10);
  const closed = (i, k) => k === 0 && i > 3; // the strongest six stay closed at the lowest intensity
  const levels = [0.2, 0.3, 0.45, 0.7, 1];
  const motions = motions_of(10);
  const fails = (i, k) => k === 2 && i < 2;
  const curves = motions.map(({ name }, i) => ({
    motion: name, sample: 0, complete: true, runs: levels.map((level, k) => (fails(i, k) ? run(level, null, i === 0 ? "failed" : "timeout") : run(level, closed(i, k) ? 0 : LIMIT * (level / (THETA * Math.exp(BETA * z[i]))) ** 1.5))),
  }));
  const stripes = levels.map((intensity, k) => {
    const states = curves.map(({ runs }) => runs[k].states[0]);
    const count = (state) => states.filter((each) => each === state).length;
    return { intensity, runs: 10, exceeded: count("exceeded"), unknown: count("unknown") };
  });
  const sum = (key) => stripes.reduce((all, each) => all + each[key], 0);
  const frequencies = Array.from({ length: 60 }, (_, i) => 0.5 * 100 ** (i / 59));
  const spectrum = (level, part) => frequencies.map((f) => part * level * 9.81 * (1 + 2 / (1 + 4 * Math.log(f / 3) ** 2)));
  return study_of({
    method: { type: "stripes", levels, largest: 0, tolerance: 0 }, motions, curves,
    limits: [limit_of({
      survived: 50 - sum("exceeded") - sum("unknown"), exceeded: sum("exceeded"), unknown: sum("unknown"), stripes,
      fit: full_fit(THETA, BETA, 0.08), unknown_survived: fitted(1.03 * THETA, BETA), unknown_exceeded: fitted(0.98 * THETA, BETA),
    })],
    failures: [
      { id: "a1", motion: "m_1", sample: 0, intensity: 0.45, factor: 1.5, outcome: "failed", reason: "step 812 did not converge", case: "runs/a1/case.resolved.toml", replay: "runs/a1/problem.json" },
      { id: "a2", motion: "m_2", sample: 0, intensity: 0.45, factor: 1.5, outcome: "timeout", reason: "longer than 10 min", case: "runs/a2/case.resolved.toml", replay: "" },
    ],
    floor_spectra: [0.2, 0.45, 1, 2].map((level) => level === 2 ? { floor: "deck", damping: 0.05, level, runs: 0, lost: 0, missing: 10, frequencies: [], p16: [], p50: [], p84: [] } : ({ floor: "deck", damping: 0.05, level, runs: level === 0.45 ? 8 : 10, lost: level === 1 ? 3 : 0, missing: level === 0.45 ? 2 : 0, frequencies, p16: spectrum(level, 0.8), p50: spectrum(level, 1), p84: spectrum(level, 1.25) })),
  });
}

/** Demands on the line ln d = a + b ln im; not complete, and no fit: none exceeds. */
export function cloud_study() {
  const motions = motions_of(8);
  const curves = motions.map(({ name }, i) => ({ motion: name, sample: 0, complete: i < 6, runs: i < 6 ? [run(0.1 * (i + 1), Math.exp(-4 + 1.2 * Math.log(0.1 * (i + 1))))] : [] }));
  return study_of({
    method: { type: "cloud", levels: [1], largest: 0, tolerance: 0 }, motions, curves,
    limits: [limit_of({ survived: 6, fit: refused("no run exceeded the limit"), unknown_survived: refused("no run exceeded the limit"), unknown_exceeded: refused("no run exceeded the limit"), regression: { a: -4, b: 1.2, sigma: 0.1, without_demand: 2 } })],
  });
}

/** The document of the page. */
export const page_of = (study) => ({
  format: "uplift-report-2", title: study.title, subtitle: `study "${study.name}"`, version: "1", created: "2025-01-15T09:30:00Z", command: "uplift study report pier.study",
  resolved: 'case = "../case.toml"\nseed = 3\n', case: { file: "pier.study/plan.toml", sha256: "b1" }, study,
});
