// The report of a study: first page, figures, tables and tornado say what the closed forms of make_study.mjs say.
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { inject, open, write_page } from "./harness.mjs";
import { BETA, BETA_R, BETA_U, THETA, cloud_study, factored_study, ida_study, page_of, stripes_study } from "./make_study.mjs";

/** Nothing reaches beyond the page or its tile. */
async function check_width(page, check, width, shot) {
  const found = await page.evaluate(() => ({
    page: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    cut: [...document.querySelectorAll(".fact, .fact *, .bar > *")].filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.className),
    tables: [...document.querySelectorAll(".table-box")].filter((e) => e.scrollWidth > e.clientWidth + 1).length,
  }));
  check.ok(found.page <= 0, `the report of a study is not wider than ${width} px`, `${found.page} px too wide`);
  check.equal(found.cut.join(), "", `its tiles hold their text at ${width} px`);
  if (width === 1400) check.equal(found.tables, 0, "its tables show their last column");
  if (shot) await page.screenshot({ path: join(shot.folder, `${shot.name}_${width}.png`), fullPage: true });
}

/** Opens the report of a study, draws everything, and hands its texts over. */
async function shown(browser, check, study, body, shot) {
  const url = pathToFileURL(await write_page(await inject(page_of(study)))).href;
  const { context, page, log } = await open(browser, url, { viewport: { width: 1400, height: 1000 } });
  await page.evaluate(() => window.upliftReport.renderAll());
  const report = await page.evaluate(() => window.upliftReport.report);
  const text = (await page.locator("#verdict").innerText()).replace(/[\s\u00a0]+/g, " ");
  await body({ page, report, text });
  const ink = await page.evaluate(() => window.upliftReport.charts.map((c) => [c.id, c.inkedPixels(), /NaN|undefined|Infinity/.test(c.svg())]));
  for (const [id, pixels, broken] of ink) check.ok(pixels > 20 && !broken, `chart ${id} of a study is drawn`, `${pixels} pixels`);
  await check_width(page, check, 1400, shot);
  check.equal(log.console.length + log.network.length, 0, `a study without a message or a request (${log.console[0] ?? ""})`);
  await context.close();
  const phone = await open(browser, url, { viewport: { width: 390, height: 844 } });
  await check_width(phone.page, check, 390, shot);
  await phone.context.close();
}

const rows_of = (report, id) => report.tables.find((table) => table.id === id)?.rows ?? [];
const chart_of = (report, id) => report.charts.find((chart) => chart.id === id) ?? { series: [] };
const near = (found, wanted, tolerance) => Math.abs(found - wanted) <= tolerance;

async function check_ida(browser, check, shot) {
  await shown(browser, check, ida_study(), async ({ page, report, text }) => {
    check.ok(text.includes(`Median capacity for “uplift of 30 mm”: 0.420 g (90 % interval 0.381 to 0.464 g), β ${BETA.toPrecision(3)}`), "the headline gives median, interval and dispersion", text.slice(0, 160));
    check.ok(text.includes("Largest gap at most 30.0 mm, PGA as the intensity. All 420 runs count."), "and what was counted");
    check.ok(text.includes(`HCLPF ${(THETA * Math.exp(-1.65 * (BETA_R + BETA_U))).toPrecision(3)} g`), "the HCLPF follows from both dispersions");
    check.ok(text.includes("between motions 0.300, between samples 0.200"), "which are told apart");
    check.ok(/rotation of 2 mrad \(residual rotation of the base at most 2\.00 mrad\): median 0\.900 g/.test(text), "the other limit has a line", text);
    check.ok(text.includes("2 of 60 capacities are not within the tolerance of the search"), "searches that did not come to their end are stated", text);
    check.ok(text.split("within the tolerance").length === 2, "of the limit whose they are");
    check.equal(await page.locator("#verdict .fragility-line").count(), 4, "the first page draws both curves, with a key each");
    check.equal(report.charts.map((chart) => chart.id).join(), "fragility_all,fragility_1,fragility_2,ida_1,ida_2", "figures in their order");
    // the capacities are the quantiles of the curve: their shares lie on it
    const { x, y } = chart_of(report, "fragility_1").series.find((each) => each.label === "60 capacities");
    const middle = x.findIndex((_, i) => y[i] > 0.5);
    check.ok(near(x[middle] / THETA, 1, 0.03) && near(y[0], 0.5 / 60, 1e-12), "the middle capacity is the median", `${x[middle]}`);
    // of the drawn records, half reach the limit below the median capacity, by the power law
    const ida = chart_of(report, "ida_1");
    const median = ida.series.find((each) => each.label === "median");
    check.ok(near(median.y[median.y.length - 1] / THETA, 1, 0.03) && near(median.x[median.x.length - 1], 0.03, 1e-12), "the median of the curves reaches the limit at the median capacity", `${median.y[median.y.length - 1]}`);
    check.ok(near(median.y[20] / median.y[40], 0.5 ** (2 / 3), 1e-12), "and follows its values in between");
    check.equal(chart_of(report, "ida_2").series.filter((each) => each.group === "percentiles").map((each) => each.x.length).join(), "3,2,1", "a fractile ends where so many curves never reach the demand");
    const records = ida.series.find((each) => each.style === "thin");
    check.equal(records.x.filter((each) => each === null).length, 60, "every motion and sample is drawn");
    check.ok(Math.max(...records.x) <= 0.075 + 1e-12, "up to 2.5 times the limit");
    const motions = rows_of(report, "motions");
    check.equal(motions.length, 12, "every motion has a row");
    check.equal(`${motions[0].resurrections} ${motions[1].resurrections}`, "2 0", "resurrections are counted");
    check.equal(motions[0].limit_1, "> 6.00", "a capacity beyond the range is said to be so");
    // of the lognormal curve: P(0.2 g) = 1.98 %, P(0.3 g) = 17.5 % with the table of the normal distribution at -2.0577 and -0.9332
    check.ok(/AT THE DESIGN MOTION, 0\.200 G 1\.98 % 17\.5 % at 1\.5 times it; aims of ASCE\/SEI 43: 1 % and 10 %, not met/i.test(text), "the design motion has its probabilities", text);
    // 1e-4 (0.42/0.2)^-2.5 exp(2.5^2 0.13/2) = 2.35e-5 a year
    check.ok(/ANNUAL RATE 2\.35e-5 exceedances a year/i.test(text), "and the hazard curve its rate", text);
    // and with the composite dispersion, of 0.3^2 + 0.15^2 + 0.2^2 = 0.1525: 1e-4 (0.42/0.2)^-2.5 exp(2.5^2 0.1525/2) = 2.52e-5 a year
    check.ok(/2\.52e-5 with the composite \u03b2 of motions and samples/.test(text), "and that of the composite dispersion", text);
    const [first] = rows_of(report, "limits");
    const [capacity] = rows_of(report, "capacity");
    check.ok(near(capacity.rate, 2.52e-5, 1e-7), "which is in the table", `${capacity.rate}`);
    check.ok(near(first.at_design, 0.0198, 1e-4) && near(first.rate, 2.35e-5, 1e-7), "both are in the table", `${first.at_design} ${first.rate}`);
    const bars = await page.locator(".tornado").first().locator("rect").evaluateAll((list) => list.map((e) => Number(e.getAttribute("width"))));
    check.equal(bars.length, 4, "the tornado has two bars for each variable");
    check.ok(bars[0] > 5 * bars[2] && near(bars[0] / bars[1], (1 - 0.8) / (1.25 - 1), 1e-3), "as long as the variables move the capacity", bars.join());
    const captions = await page.locator(".tornado figcaption").allInnerTexts();
    check.ok(captions[0].includes("under the same motions by the effects of both") && captions[0].endsWith("They rest on 46 capacities of 4 of 5 samples."), "it says on what it rests", captions[0]);
    check.equal(captions[1], "Not given: it takes three samples at least.", "and why another limit has none");
    check.ok((await page.locator("#case").innerText()).includes("Plan of the study"), "the plan can be read");
    check.ok((await page.locator("#choices").innerText()).includes("factor, lognormal, median 1, β 0.4"), "the variables are stated");
  }, shot && { folder: shot, name: "study_ida" });
}

async function check_factors(browser, check, shot) {
  await shown(browser, check, factored_study(), async ({ page, report, text }) => {
    // 1.5 x 0.42 exp(-1.65 (0.5 + 0.2)) = 0.1985; with beta_c = 0.5385 the composite curve has 1 % at 0.63 exp(-2.326 x 0.5385) = 0.180
    check.ok(/HCLPF 0\.198 g 95 % confidence of less than 5 % probability, with the factors of safety/i.test(text), "the HCLPF has the factors in it", text);
    const [first, second] = rows_of(report, "limits");
    const [capacity, unknown] = rows_of(report, "capacity");
    check.ok(near(capacity.hclpf, 0.1985, 1e-4) && near(capacity.hclpf_composite, 0.18, 1e-3) && near(capacity.median, 0.63, 1e-12), "and so have the columns", JSON.stringify(capacity));
    check.ok(near(capacity.at_design, 0.0165, 1e-4) && near(first.at_design, 0.0198, 1e-4) && unknown.reason === "it takes two samples", "the fit has none of them; an unknown capacity has its reason", JSON.stringify(unknown));
    // ln(0.63/0.2)/0.5385 = 2.1307, ln(0.63/0.3)/0.5385 = 1.3777: 1.66 % and 8.41 %
    check.ok(/AT THE DESIGN MOTION, 0\.200 G 1\.66 % 8\.41 % at 1\.5 times it, with the factors of safety; aims of ASCE\/SEI 43: 1 % and 10 %, not met/i.test(text), "and the design motion", text);
    // 1e-4 (0.63/0.2)^-2.5 exp(2.5^2 0.29/2) = 1.405e-5 a year
    check.ok(/ANNUAL RATE 1\.4[01]e-5 exceedances a year, by the hazard curve of the plan, with the factors of safety.*; 2\.35e-5 by the fitted curve alone/i.test(text), "and the annual rate", text);
    check.equal(`${first.bootstrap.replace("\u00a0", " ")}; ${first.beta_bootstrap}; ${second.bootstrap}`, "0.390 to 0.450 g; 0.300 to 0.410; 1900 of 2000 draws have no fit", "the bootstrap stands beside the intervals, or why there is none");
    const choices = await page.locator("#choices").innerText();
    check.ok(choices.includes("anchors") && choices.includes("median 1.5, β_R 0.4, β_U 0") && choices.includes("tests of the maker"), "the factor and its source are among the choices", choices);
  }, shot && { folder: shot, name: "study_factors" });
}

async function check_stripes(browser, check, shot) {
  await shown(browser, check, stripes_study(), async ({ page, report, text }) => {
    check.ok(text.includes("48 of 50 runs count; 2 without outcome change the median by at most 3.0 %."), "runs without outcome and what they change", text);
    check.ok(/failed unknown 1 \(2\.0 %\)/.test(text) && /timeout unknown 1/.test(text), "outcomes are counted", text);
    const [limit] = rows_of(report, "limits");
    check.equal(`${limit.survived + limit.exceeded} ${limit.unknown}; ${limit.as_survived.replace("\u00a0", " ")}`, `48 2; ${(1.03 * THETA).toPrecision(3)} g, β ${BETA.toPrecision(3)}`, "both ends are in the table");
    // half of the known runs exceed where the intensity is the median of the known capacities
    const share = chart_of(report, "fragility_1").series.find((each) => each.label === "share of the runs");
    check.equal(rows_of(report, "stripes").map(({ runs, exceeded, unknown, share: s }, i) => s === exceeded / (runs - unknown) && share.y[i] === s).join(), "true,true,true,true,true", "shares leave out the unknown runs");
    check.equal(chart_of(report, "fragility_1").series.filter((each) => /^unknown as/.test(each.label)).length, 2, "both ends are drawn");
    const failures = rows_of(report, "failures");
    check.equal(failures.map((each) => `${each.outcome}: ${each.run}; ${each.replay}`).join(" | "),
      "failed: uplift run runs/a1/case.resolved.toml; uplift replay runs/a1/problem.json | timeout: uplift run runs/a2/case.resolved.toml; ", "failed runs can be repeated");
    const demands = chart_of(report, "demand_1");
    check.equal(demands.series[0].x.length, 42, "unknown runs are no demands, and zeros are not drawn");
    check.ok(demands.caption.endsWith("6 runs whose demand is zero are not drawn; percentiles count them."), "which is said", demands.caption);
    // at 0.2 g six of ten demands are 0: so is the median, and 84 % lies between the second and the third largest
    const [low, middle, high] = [0.16, 0.5, 0.84].map((_, i) => demands.series.filter((each) => each.group === "percentiles")[i].y[0]);
    const largest = demands.series[0].y.filter((_, i) => demands.series[0].x[i] === 0.2).sort((a, b) => b - a);
    check.ok(low === null && middle === null && near(high, largest[2] + 0.56 * (largest[1] - largest[2]), 1e-15), "percentiles are those of all runs", `${low} ${middle} ${high}`);
    check.equal(chart_of(report, "floor_1").series.map((each) => each.style).join(), "line,band,line,band,line,band", "floor spectra show the median and the range of each intensity");
    check.ok(chart_of(report, "floor_1").caption.replaceAll("\u00a0", " ").includes("(10 at 0.200 g; 8 at 0.450 g, and 2 without an outcome left out; 10 at 1.00 g, of which 3 lost the structure; none at 2.00 g, all 10 without an outcome)."), "with the number of runs", chart_of(report, "floor_1").caption);
    check.equal(await page.locator(".chip-failed").count(), 2, "failures are marked");
  }, shot && { folder: shot, name: "study_stripes" });
}

async function check_cloud(browser, check) {
  await shown(browser, check, cloud_study(), async ({ page, report, text }) => {
    check.ok(text.startsWith("NO FIT No fragility curve for “uplift of 30 mm”: no run exceeded the limit"), "a study without a fit says why", text.slice(0, 100));
    check.ok(text.includes("The study is not complete: 2 of 8 curves lack runs."), "and that runs are missing");
    const line = chart_of(report, "demand_1").series.find((each) => each.label === "regression");
    const points = chart_of(report, "demand_1").series[0];
    check.ok(points.x.every((x, i) => near(Math.log(points.y[i]), -4 + 1.2 * Math.log(x), 1e-12)) && near(Math.log(line.y[41] / line.y[0]) / Math.log(line.x[41] / line.x[0]), 1.2, 1e-9), "the regression goes through the demands");
    check.ok(chart_of(report, "demand_1").caption.endsWith("2 runs whose demand is zero count as at most the limit."), "what has no logarithm is stated", chart_of(report, "demand_1").caption);
    check.equal(await page.locator(".tornado").count(), 0, "no tornado without variables");
  });
}

export async function check_studies(browser, check, shots) {
  await check_ida(browser, check, shots);
  await check_factors(browser, check, shots);
  await check_stripes(browser, check, shots);
  await check_cloud(browser, check);
}
