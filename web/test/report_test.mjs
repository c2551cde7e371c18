// Drives the report in a browser:
//
//   node test/report_test.mjs [REPORT.html] [--shots DIR]
//
// Without a report the sample is put into dist/report.html. What only the sample has is checked only there.
import { mkdir, readFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Checks, DENSE_SAMPLES, inject, inject_packed, open, sample_report, space_report, start_browser, write_page } from "./harness.mjs";
import { check_documents } from "./document_checks.mjs";
import { check_studies } from "./study_checks.mjs";
import { check_space, check_space_sample } from "./space_checks.mjs";

const args = process.argv.slice(2);
const shots_at = args.indexOf("--shots");
const shots = shots_at >= 0 ? args.splice(shots_at, 2)[1] : undefined;
const given = args[0];
const report = given ? resolve(given) : await sample_report();
const url = pathToFileURL(report).href;
const check = new Checks();
const browser = await start_browser();

const canvas_hash = (page, id) => page.evaluate((i) => window.upliftReport.chart(i).canvas.toDataURL().length + window.upliftReport.chart(i).canvas.toDataURL().slice(-400), id);
const stage = (page) => page.evaluate(() => document.querySelector(".stage").innerHTML);

/** What a click downloads, as text. */
async function download_of(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), text: await readFile(await download.path(), "utf8") };
}

async function check_charts(page) {
  const lazy = await page.evaluate(() => window.upliftReport.charts.filter((c) => !c.rendered).length);
  const total = await page.evaluate(() => window.upliftReport.charts.length);
  check.ok(total > 0, "the report has charts");
  if (total > 6) check.ok(lazy > 0, "charts far below are not drawn at once");
  await page.evaluate(() => window.upliftReport.renderAll());
  await page.waitForTimeout(150);
  const charts = await page.evaluate(() =>
    window.upliftReport.charts.map((c) => ({ id: c.id, rendered: c.rendered, lengths: c.series.map((s) => s.length), ink: c.inkedPixels(), visible: c.series.filter((s) => s.visible).length })));
  for (const chart of charts) {
    check.ok(chart.rendered, `chart ${chart.id} is drawn`);
    check.ok(chart.lengths.length > 0 && chart.lengths.every((n) => n > 0), `chart ${chart.id} has data in every series`, chart.lengths.join());
    check.ok(chart.visible === 0 || chart.ink > 50, `chart ${chart.id} shows its curves`, `${chart.ink} coloured pixels`);
  }
}

async function check_ranges(page) {
  const views = await page.evaluate(() =>
    window.upliftReport.charts.map((c) => {
      const chart = window.upliftReport.report.charts.find((d) => d.id === c.id);
      const peak = (list) => list.flatMap((s) => s.y).reduce((m, v) => (v === null ? m : Math.max(m, Math.abs(v))), 0);
      const shown = chart.series.filter((_, i) => c.series[i].visible);
      return { id: c.id, log: chart.y.log ?? false, top: Math.max(Math.abs(c.view.ymin), Math.abs(c.view.ymax)), sound: peak(shown.filter((s) => !s.failed)), failed: peak(shown.filter((s) => s.failed)) };
    }));
  for (const { id, log, top, sound, failed } of views) {
    if (log || sound === 0) continue;
    check.ok(top >= sound, `chart ${id} shows the sound runs whole`, `${top} < ${sound}`);
    check.ok(top <= 1.6 * sound, `chart ${id} is not flattened by failed runs`, `range to ${top}, sound to ${sound}, failed to ${failed}`);
    const note = page.locator(`[id="chart-${id}"] .chart-note`);
    if (failed > 1.6 * sound) check.ok(await note.isVisible(), `chart ${id} tells that a failed run leaves the picture`);
  }
  const noted = page.locator(".chart-note:visible").first();
  if ((await noted.count()) === 0) return;
  const id = (await noted.locator("xpath=..").getAttribute("id")).replace(/^chart-/, "");
  const height = (i) => page.evaluate((k) => window.upliftReport.chart(k).view.ymax - window.upliftReport.chart(k).view.ymin, i);
  const before = await height(id);
  const width = (i) => page.evaluate((k) => window.upliftReport.chart(k).view.xmax - window.upliftReport.chart(k).view.xmin, i);
  const wide = await width(id);
  await noted.getByRole("button").click();
  check.ok((await height(id)) > before || (await width(id)) > wide, "the full range can be shown");
  await noted.getByRole("button").click();
  check.equal(await height(id), before, "the range of the sound runs comes back");
}

async function check_hiding(page) {
  const target = await page.evaluate(() => {
    const c = window.upliftReport.charts.find((d) => d.series.filter((s) => s.visible && s.run).length > 1);
    if (!c) return null;
    const index = c.series.findIndex((k) => k.visible && k.run);
    const { label, run } = c.series[index];
    return { id: c.id, index, label, run };
  });
  if (!target) return;
  const visible = () => page.evaluate(({ id, label }) => window.upliftReport.chart(id).series.find((s) => s.label === label).visible, target);
  const elsewhere = () => page.evaluate(({ id, run }) => window.upliftReport.charts.filter((c) => c.id !== id).flatMap((c) => c.series).filter((s) => s.run === run && s.visible).length, target);
  const card = page.locator(`[id="chart-${target.id}"]`);
  const key = card.locator(".legend .key").nth(target.index);
  await card.scrollIntoViewIfNeeded();
  const picture = await canvas_hash(page, target.id);
  await key.click();
  await page.waitForTimeout(60);
  check.equal(await visible(), false, "a click on the legend hides the curve");
  check.equal(await key.getAttribute("aria-pressed"), "false", "the legend tells that it is hidden");
  check.ok((await canvas_hash(page, target.id)) !== picture, "the picture changes when a curve is hidden");
  const others = await elsewhere();
  await card.locator(".everywhere").click();
  check.ok(others === 0 || (await elsewhere()) < others, "the run can be hidden everywhere");
  await key.click();
  await page.waitForTimeout(60);
  check.equal(await visible(), true, "a second click shows it again");
  check.equal(await elsewhere(), others, "and everywhere");
  check.equal(await canvas_hash(page, target.id), picture, "with the same picture as before");
}

async function check_zoom_and_hover(page) {
  const card = page.locator(".chart").first();
  const id = (await card.getAttribute("id")).replace(/^chart-/, "");
  const over = card.locator(".u-over");
  await card.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  const view = () => page.evaluate((i) => window.upliftReport.chart(i).view, id);
  const before = await view();
  await page.mouse.move(box.x + box.width * 0.3, box.y + box.height * 0.5);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + box.height * 0.52, { steps: 6 });
  await page.mouse.up();
  await page.waitForTimeout(80);
  const zoomed = await view();
  const part = (zoomed.xmax - zoomed.xmin) / (before.xmax - before.xmin);
  check.ok(Math.abs(part - 0.3) < 0.02, "a drag zooms to the dragged range", `part ${part}`);
  check.ok(zoomed.ymax === before.ymax, "a horizontal drag leaves the other axis");
  await page.mouse.dblclick(box.x + box.width * 0.5, box.y + box.height * 0.5);
  await page.waitForTimeout(80);
  check.equal(JSON.stringify(await view()), JSON.stringify(before), "a double click resets the zoom");
  const history = await page.evaluate(() => window.upliftReport.report.charts.find((c) => c.series.length > 1 && c.series.every((s) => s.x.every((v, i) => i === 0 || v >= s.x[i - 1])))?.id);
  if (!history) return;
  const plot = page.locator(`[id="chart-${history}"]`);
  await plot.scrollIntoViewIfNeeded();
  const area = await plot.locator(".u-over").boundingBox();
  await page.mouse.move(area.x + area.width * 0.25, area.y + area.height * 0.5);
  const shown = await page.evaluate((i) => window.upliftReport.chart(i).series.filter((s) => s.visible).length, history);
  const rows = await plot.locator(".readout-row").count();
  check.ok(rows >= 1 && rows <= shown, "the readout lists the curves at the cursor", `${rows} of ${shown}`);
  await page.mouse.move(2, 2);
  check.equal(await plot.locator(".readout").isVisible(), false, "the readout goes with the cursor");
}

async function check_keyboard(page) {
  const plot = page.locator(".chart .plot-live").first();
  await plot.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  check.ok(await plot.locator(".readout").isVisible(), "arrow keys move the cursor of a plot");
  await page.keyboard.press("+");
  check.ok(await page.locator(".chart").first().getByText("Reset zoom").isVisible(), "plus zooms");
  await page.keyboard.press("0");
  check.equal(await page.locator(".chart").first().getByText("Reset zoom").isVisible(), false, "0 resets the zoom");
}

async function check_tables(page) {
  const tables = await page.evaluate(() => window.upliftReport.tables.map((t) => ({ ...t, wanted: window.upliftReport.report.tables.find((u) => u.id === t.id).rows.length })));
  for (const { id, rows, wanted } of tables) check.equal(rows, wanted, `table ${id} has a row for each run`);
  const first = page.locator(".table-card").first();
  if (tables.length === 0) return;
  const column = await first.locator("thead th.is-number").first();
  if ((await column.count()) === 0) return;
  await column.getByRole("button").click();
  check.equal(await column.getAttribute("aria-sort"), "ascending", "a click sorts the table");
  const sorted = await page.evaluate(() => {
    const table = window.upliftReport.report.tables[0];
    const index = table.columns.findIndex((c) => c.kind === "number");
    const texts = [...document.querySelectorAll(".table-card")][0].querySelectorAll("tbody tr");
    const groups = [[]];
    for (const row of texts) {
      if (row.classList.contains("group")) groups.push([]);
      else groups[groups.length - 1].push(parseFloat(row.children[index].title));
    }
    return groups.every((g) => g.filter((v) => !Number.isNaN(v)).every((v, i, a) => i === 0 || v >= a[i - 1]));
  });
  check.ok(sorted, "the rows of each group are in order");
  const csv = await download_of(page, first.locator(".tool-csv"));
  check.equal(csv.text.trim().split("\n").length, tables[0].wanted + 1, "the table downloads as CSV");
}

/** The first page: share over time, the bonded run beside, the user's limits, what is left. */
async function check_verdict(page) {
  const { interfaces, criteria } = await page.evaluate(() => window.upliftReport.report.verdict);
  const card = page.locator("#verdict");
  check.equal(await card.locator(".base-verdict").count(), interfaces.length, "the verdict speaks of every interface");
  check.equal(await card.locator(".criterion").count(), criteria.length, "every criterion has a row");
  for (const state of ["met", "not met", "undetermined"]) {
    const wanted = criteria.filter((c) => c.state === state).length;
    check.equal(await card.locator(`.criterion.is-${state.replace(" ", "-")}`).count(), wanted, `criteria that are ${state} are marked so`);
  }
  for (const [i, base] of interfaces.entries()) {
    const block = card.locator(".base-verdict").nth(i);
    check.equal(await block.locator("table.beside tbody tr").count(), base.beside.length, "every number stands beside the bonded run");
    const moved = base.beside.filter((row) => row.stepText !== undefined);
    if (moved.length > 0) check.equal(await block.locator("table.beside .step-change").count(), base.beside.length, "every number says how far the step moves it");
    const opens = base.share.some((v) => v > 0);
    check.equal(await block.locator(".share-chart").count(), opens ? 1 : 0, "a base that opens shows its uplifted share over time");
    if (opens) check.equal(await block.locator(".share-chart .threshold").count(), base.above.length, "with a line for each threshold");
    if (opens) {
      const box = await block.locator(".share-chart .line").evaluate((path) => {
        const { x, y, width, height } = path.getBBox();
        const [, , w, h] = path.ownerSVGElement.getAttribute("viewBox").split(" ").map(Number);
        return { inside: x >= 0 && y >= 0 && x + width <= w && y + height <= h, width, height };
      });
      check.ok(box.inside && box.width > 100 && box.height > 20, "the curve fills its drawing and stays inside", JSON.stringify(box));
    }
    if (base.linear) check.equal(await block.locator(".bar").count(), base.linear.tension > 0 || base.linear.computed > 0 ? 3 : 0, "the tension ratio stands beside what happened");
  }
  const { floors, consequence, charts } = await page.evaluate(() => {
    const { verdict, charts: all } = window.upliftReport.report;
    return { floors: verdict.floors, consequence: verdict.consequence, charts: all.map((chart) => chart.id) };
  });
  check.equal(await card.locator(".so-what").count(), consequence ? 1 : 0, "the headline is followed by what it means");
  const drawn = floors.some(({ floor, damping }) => charts.includes(`floor_${floor}_${Number((100 * damping).toFixed(6))}`));
  check.equal(await card.locator(".spectrum-chart").count(), drawn ? 1 : 0, "the first page draws one floor spectrum");
  if (drawn) {
    const lines = await card.locator(".spectrum-chart > svg .spectrum").evaluateAll((paths) => paths.map((path) => path.getBBox().width));
    check.ok(lines.length >= 2 && lines.every((width) => width > 200), "with the run and the bonded run over all frequencies", lines.join());
  }
  check.equal(await card.locator(".floors tbody tr").count(), floors.length, "every floor spectrum has a row of changes");
  const left = interfaces.reduce((sum, base) => sum + base.rest.length, 0);
  if (left > 0) check.equal(await page.locator("#after-shock .rest-card tbody tr").count(), left, "what is left at the end has a row for each number");
}

/** What the numbers of the sample must read as. */
async function check_sample_verdict(page) {
  const texts = async (selector) => (await page.locator(`#verdict ${selector}`).allInnerTexts()).map((text) => text.replace(/\s+/g, " "));
  const bars = await texts(".bar");
  check.ok(bars[1].includes("40 %"), "the uplift by equal energy is given in per cent", bars[1]);
  const [first] = await texts(".criterion");
  check.ok(/✕ not met .*60 %, limit ≤ 30 %.*specification of the client, 4\.2/.test(first), "a criterion shows state, value, limit and source", first);
  check.ok((await texts(".criteria h3"))[0].includes("1 of 3 met"), "the number of criteria that are met is said");
  check.equal((await texts(".floors tbody tr"))[0], "roof, 5.0 % +12 % −38 % +140 %", "the floor spectra's changes are given band by band");
  const [top] = await page.evaluate(() => window.upliftReport.report.verdict.interfaces[0].beside);
  const change = Math.round(100 * (top.value / top.bonded - 1));
  const shown = (await texts("table.beside .change"))[0];
  check.ok(top.value / top.bonded >= 2 ? shown.startsWith("×") : shown.includes(String(Math.abs(change))), "the change against the bonded run is given", `${shown}, ${change} %`);
}

async function check_animation(page) {
  if (!(await page.evaluate(() => window.upliftReport.animation !== null))) return;
  const card = page.locator(".animation-card");
  await card.scrollIntoViewIfNeeded();
  const frames = await page.evaluate(() => window.upliftReport.animation.frames);
  const scrub = card.locator(".scrub");
  const set = (value) => scrub.evaluate((input, v) => ((input.value = String(v)), input.dispatchEvent(new Event("input", { bubbles: true }))), value);
  await set(0);
  const first = await stage(page);
  await set(Math.round(frames * 0.4));
  const later = await stage(page);
  check.ok(first !== later, "the scrub slider moves the drawing");
  await scrub.focus();
  await page.keyboard.press("ArrowRight");
  check.ok((await stage(page)) !== later, "and so do the arrow keys");
  const magnify = card.locator(".controls input[type=range]");
  const before = await stage(page);
  await magnify.evaluate((input) => ((input.value = String(Number(input.value) + 0.5)), input.dispatchEvent(new Event("input", { bubbles: true }))));
  check.ok((await stage(page)) !== before, "the magnification changes the drawing");
  const frame = () => page.evaluate(() => window.upliftReport.animation.frame);
  await set(0);
  await card.locator(".play").click();
  await page.waitForTimeout(700);
  check.ok((await frame()) > 0, "play advances");
  await card.locator(".play").click();
  const stopped = await frame();
  await page.waitForTimeout(200);
  check.equal(await frame(), stopped, "pause stops");
  const count = await card.locator(".run-select option").count();
  check.equal(count, await page.evaluate(() => window.upliftReport.report.animations.length), "every animated run can be chosen");
  if (count > 1) {
    await card.locator(".run-select select").selectOption("1");
    check.equal(await page.evaluate(() => window.upliftReport.animation.run), await page.evaluate(() => window.upliftReport.report.animations[1].run), "the run changes");
    await card.locator(".run-select select").selectOption("0");
  }
}

async function check_uplift_readout(page) {
  const same = await page.evaluate(() => {
    const { animation, report: data } = window.upliftReport;
    if (!animation) return true;
    const source = data.animations.find((a) => a.run === animation.run);
    const areas = Object.fromEntries(data.model.interfaces.map((f) => [f.name, f.points.map((p) => p.area)]));
    for (const frame of [0, Math.floor(animation.frames / 3), Math.floor(animation.frames / 2)]) {
      animation.set_frame(frame);
      let open = 0;
      let all = 0;
      for (const [name, list] of Object.entries(areas)) {
        const counted = list.reduce((sum, a, i) => sum + (source.openings[name][frame][i] > 1e-9 ? a : 0), 0);
        const area = list.reduce((sum, a) => sum + a, 0);
        all += area;
        open += source.uplifted ? area * source.uplifted[name][frame] : counted;
      }
      if (Math.abs(animation.ratio - open / all) > 1e-12) return false;
      const marks = document.querySelectorAll(".stage .pt-open").length;
      if (marks !== Object.entries(source.openings).flatMap(([, f]) => f[frame]).filter((g) => g > 1e-9).length) return false;
    }
    return true;
  });
  check.ok(same, "the uplifted ratio and the open points follow the openings");
}

/** On a fixed flat ground a point of the footing is drawn at (ground − factor · opening), a mass at the end of its beam. */
async function check_stage_geometry(page) {
  if (given) return;
  const { spread, apart } = await page.evaluate(() => {
    const { animation, report: data } = window.upliftReport;
    const source = data.animations.find((a) => a.run === animation.run);
    const factors = [];
    let ground = null;
    let apart = 0;
    const height = (mark) => Number(/translate\(\S+ (\S+)\)/.exec(mark.getAttribute("transform"))[1]);
    for (const frame of [10, 25, 54, 80]) {
      animation.set_frame(frame);
      const marks = [...document.querySelectorAll(".stage .pt-open, .stage .pt-contact")];
      const gaps = source.openings.soil[frame];
      const last = marks.length - 1;
      if (Math.abs(gaps[0] - gaps[last]) < 1e-3) continue;
      const factor = (height(marks[last]) - height(marks[0])) / (gaps[0] - gaps[last]);
      factors.push(factor);
      ground ??= height(marks[0]) + factor * gaps[0];
      marks.forEach((m, i) => (apart = Math.max(apart, Math.abs(height(m) + factor * gaps[i] - ground))));
      const end = /L(\S+) (\S+)$/.exec(document.querySelector(".stage > .beam").getAttribute("d"));
      const mass = document.querySelector(".stage > .mass");
      apart = Math.max(apart, Math.hypot(end[1] - mass.getAttribute("cx"), end[2] - mass.getAttribute("cy")));
    }
    return { spread: factors.length > 1 ? Math.max(...factors) / Math.min(...factors) - 1 : Infinity, apart };
  });
  check.ok(spread >= 0 && spread < 2e-2, "one factor magnifies the gap in every frame", `spread ${spread}`);
  check.ok(apart < 0.5, "every point is drawn at its opening, the mass at the end of the column", `${apart} px apart`);
}

async function check_downloads(page) {
  const cards = page.locator(".chart");
  const count = await cards.count();
  for (const i of new Set([0, count >> 1, count - 1])) {
    const card = cards.nth(i);
    const id = (await card.getAttribute("id")).replace(/^chart-/, "");
    const csv = await download_of(page, card.locator(".tool-csv"));
    const longest = await page.evaluate((k) => Math.max(...window.upliftReport.chart(k).series.map((s) => s.length)), id);
    check.equal(csv.text.trim().split("\n").length, longest + 1, `chart ${id}: CSV has a line per sample`);
    const svg = await download_of(page, card.locator(".tool-svg"));
    const parsed = await page.evaluate((text) => {
      const doc = new DOMParser().parseFromString(text, "image/svg+xml");
      return doc.querySelector("parsererror") ? null : { name: doc.documentElement.nodeName, paths: [...doc.querySelectorAll("g[clip-path] path")].filter((p) => p.getAttribute("d").length > 10).length };
    }, svg.text);
    check.ok(parsed?.name === "svg" && parsed.paths > 0, `chart ${id}: SVG is well formed and has curves`, JSON.stringify(parsed));
    check.ok(!/NaN|Infinity|undefined/.test(svg.text), `chart ${id}: SVG has only numbers`);
  }
}

/** Media queries tell the page of a change only with the next frames. */
async function emulate(page, media, wanted) {
  await page.emulateMedia(media);
  await page.waitForFunction(wanted, undefined, { timeout: 60_000, polling: 50 }).catch(() => undefined);  // long: machines that test are busy
}

async function check_theme(page) {
  const colours = () => page.evaluate(() => ({ page: getComputedStyle(document.body).backgroundColor, theme: document.documentElement.dataset.theme }));
  check.equal((await colours()).theme, "light", "light when the system is light");
  const light = (await colours()).page;
  await emulate(page, { colorScheme: "dark" }, () => document.documentElement.dataset.theme === "dark");
  check.equal((await colours()).theme, "dark", "dark when the system is dark");
  check.ok((await colours()).page !== light, "the page changes its colours");
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.locator(".theme-toggle").click();
  check.equal((await colours()).theme, "light", "the toggle wins over the system");
  await page.reload();
  await page.locator(".theme-toggle").waitFor();  // the page is made when its data are unpacked
  check.equal((await colours()).theme, "light", "and is remembered");
  await page.locator(".theme-toggle").click();
  check.equal((await colours()).theme, "dark", "and toggles back");
  if (shots) await shoot(page, "desktop_dark");
}

async function check_print(page) {
  await emulate(page, { media: "print", colorScheme: "dark" }, () => {
    const drawn = [...document.querySelectorAll(".plot-print svg")].filter((e) => e.getClientRects().length > 0);
    return drawn.length >= document.querySelectorAll(".chart").length;
  });
  for (const cls of [".toc", ".page-tools", ".tools", ".controls", ".timeline", ".run-bar", ".plot-live"]) {
    const seen = await page.locator(cls).evaluateAll((list) => list.filter((e) => e.getClientRects().length > 0).length);
    check.equal(seen, 0, `print hides ${cls}`);
  }
  const figures = await page.evaluate(() => document.querySelectorAll(".chart").length);
  const drawn = await page.locator(".plot-print svg").evaluateAll((list) => list.filter((e) => e.getClientRects().length > 0).length);
  check.equal(drawn, figures, "print draws every chart, scrolled to or not");
  const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  check.equal(background, "rgb(255, 255, 255)", "print is light even in dark mode");
  const { resolved, sha256 } = await page.evaluate(() => window.upliftReport.report.case);
  if (resolved) {
    const words = await page.locator("#case").innerText();
    check.ok(words.includes(resolved.split("\n")[0]), "print opens the resolved case");
    check.ok(words.includes(sha256), "beside the hash of the case file");
  }
  const pdf = await page.pdf({ format: "A4", printBackground: true, preferCSSPageSize: true, ...(shots ? { path: join(shots, "print.pdf") } : {}) });
  check.ok(pdf.length > 20_000, "the report prints", `${pdf.length} bytes`);
  await page.emulateMedia({ media: "screen" });
}

async function check_phone() {
  const { context, page, log } = await open(browser, url, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await page.evaluate(() => window.upliftReport.renderAll());
  await page.waitForTimeout(200);
  const { wide, worst } = await page.evaluate(() => ({
    wide: document.documentElement.scrollWidth,
    worst: [...document.querySelectorAll("main *")].filter((e) => !e.closest(".table-box, .floors-box, .run-chips, pre, .uplot, svg") && e.getBoundingClientRect().right > 391).map((e) => e.className || e.nodeName).slice(0, 4),
  }));
  check.ok(wide <= 390, "no horizontal overflow at 390 px", `${wide} px; ${worst.join()}`);
  check.equal(worst.length, 0, "nothing reaches beyond 390 px");
  const columns = await page.evaluate(() => Math.max(0, ...[...document.querySelectorAll(".grid")].map((g) => getComputedStyle(g).gridTemplateColumns.split(" ").length)));
  check.ok(columns <= 1, "one column on a phone");
  const plot = page.locator(".chart .u-over").first();
  await plot.scrollIntoViewIfNeeded();
  await plot.tap();
  check.equal(log.console.length, 0, "no message in the console on a phone");
  if (shots) await shoot(page, "phone");
  await context.close();
}

/** Nothing is cut off on a desktop screen: tables show their last column, tiles hold their text, labels of the model are apart. */
async function check_layout() {
  for (const width of [1400, 1000, 390]) {
    const { context, page } = await open(browser, url, { viewport: { width, height: 1000 } });
    await page.evaluate(() => window.upliftReport.renderAll());
    await page.waitForTimeout(200);
    const found = await page.evaluate(() => {
      const cut = (e) => e.scrollWidth > e.clientWidth + 1;
      const name = (e) => `${e.className} in ${e.closest("[id]")?.id}`;
      const tables = [...document.querySelectorAll(".table-box, .floors-box")].filter(cut);
      const labels = [...document.querySelectorAll("#model-drawing > svg text")].map((text) => ({ text: text.textContent, box: text.getBBox() }));
      const [, , w, h] = document.querySelector("#model-drawing > svg")?.getAttribute("viewBox").split(" ").map(Number) ?? [0, 0, 0, 0];
      const meet = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y + 1 < b.y + b.height && b.y + 1 < a.y + a.height;
      return {
        page: document.documentElement.scrollWidth - document.documentElement.clientWidth,
        tables: tables.map(name),
        untold: tables.filter((e) => e.matches(".table-card .table-box") && !e.closest("details:not([open])") && e.parentElement.querySelector(".cut-note")?.hidden !== false).map(name),
        tiles: [...document.querySelectorAll(".fact, .fact *, .readouts > div, .run-chips, .beside th, .beside td, .criterion > *")].filter(cut).map(name),
        beyond: [...document.querySelectorAll(".beside")].filter((e) => e.offsetWidth > e.parentElement.clientWidth + 1).map(name),
        bare: window.upliftReport.charts.filter((c) => c.ticks.some((count) => count < 2)).map((c) => c.id),
        overlaps: labels.flatMap((a, i) => labels.slice(i + 1).filter((b) => meet(a.box, b.box)).map((b) => `${a.text} / ${b.text}`)),
        outside: labels.filter(({ box }) => box.x < 0 || box.y < 0 || box.x + box.width > w || box.y + box.height > h).map(({ text }) => text),
      };
    });
    check.ok(found.page <= 0, `the page is not wider than ${width} px`, `${found.page} px too wide`);
    if (width === 1400) check.equal(found.tables.length, 0, `all tables show their last column at ${width} px (${found.tables.join("; ")})`);
    check.equal(found.untold.length, 0, `a table that is cut at ${width} px says so (${found.untold.join("; ")})`);
    check.equal(found.tiles.length, 0, `tiles hold their text at ${width} px (${found.tiles.join("; ")})`);
    check.equal(found.beyond.length, 0, `numbers of the verdict lie inside their card at ${width} px (${found.beyond.join("; ")})`);
    check.equal(found.bare.length, 0, `axes have two ticks at least at ${width} px (${found.bare.join("; ")})`);
    check.equal(found.overlaps.length, 0, `labels of the model do not overlap (${found.overlaps.join("; ")})`);
    check.equal(found.outside.length, 0, `labels of the model lie inside the drawing (${found.outside.join("; ")})`);
    await context.close();
  }
}

/** The animation starts at the largest uplift, and with the share that the verdict states (one interface). */
async function check_first_frame() {
  const { context, page } = await open(browser, url);
  const { ratio, largest, stated } = await page.evaluate(() => {
    const { animation, space, report: data } = window.upliftReport;
    const player = animation ?? space;
    const source = (animation ? data.animations : data.spaceAnimations)[0];
    const interfaces = (data.model ?? data.space)?.interfaces ?? [];
    if (!player || player.frames === 0 || interfaces.length !== 1) return { ratio: 0, largest: 0, stated: null };
    const shares = source.uplifted?.[interfaces[0].name];
    return { ratio: player.ratio, largest: shares ? Math.max(...shares) : player.ratio, stated: shares ? Math.max(0, ...(data.verdict.interfaces[0]?.share ?? [])) : null };
  });
  check.ok(ratio >= largest - 1e-9, "the animation starts at the largest uplift", `${ratio} of ${largest}`);
  if (stated !== null && stated > 0) check.ok(Math.abs(ratio - stated) < 1e-4, "which is the one that the verdict states", `${ratio}, ${stated}`);
  await context.close();
}

/** Compressed data and quantised frames are read as what they were made of. */
async function check_packed() {
  const values = [[0, 1e-3, 0, 5e-4, 0, -2e-3], [1e-3, 2e-3, -1e-3, 0, 0, 1e-3], [0, 0, 0, 1e-3, 5e-4, 0]];
  const unit = 5e-4;
  const levels = values.map((row) => row.map((v) => Math.round(v / unit)));
  const changes = levels.map((row, f) => row.map((v, i) => v - (f > 0 ? levels[f - 1][i] : 0)));
  const differences = changes.map((row) => row.map((v, i) => v - (i >= 3 ? row[i - 3] : 0)));
  const document = { format: "uplift-report-2", title: "Packed ✓", spaceAnimations: [{ run: "r", time: [0, 1, 2], displacement: { unit, stride: 3, differences }, openings: {}, pressures: {} }] };
  const { context, page, log } = await open(browser, pathToFileURL(await write_page(await inject_packed(document))).href);
  check.equal(await page.locator("h1").innerText(), "Packed ✓", "compressed data are read");
  const read = await page.evaluate(() => window.upliftReport.report.spaceAnimations[0].displacement);
  check.ok(read.every((row, f) => row.every((v, i) => Math.abs(v - values[f][i]) < 1e-15)), "quantised frames are read", JSON.stringify(read));
  check.equal(log.console.length + log.network.length, 0, "without a message or a request");
  await context.close();
}

/** Where nothing opens there is no map of gaps: it would be an empty grey area. */
async function check_closed_maps() {
  const closed = (document) => {
    for (const animation of document.spaceAnimations) {
      for (const frames of Object.values(animation.openings)) frames.forEach((row) => row.fill(1e-13));
      delete animation.slips;
    }
    return document;
  };
  const { context, page } = await open(browser, pathToFileURL(await space_report(closed)).href);
  await page.evaluate(() => window.upliftReport.renderAll());
  check.equal(await page.locator(".plan-gap").count(), 0, "a base in contact has no map of gaps");
  check.ok(/in contact everywhere/.test(await page.locator("#space .plan-readout").first().innerText()), "but says that it is in contact");
  check.ok(!/\b0 nm|\b0\.0+ nm/.test(await page.locator("main").innerText()), "no length reads 0 nm");
  await context.close();
}

async function check_other_pages() {
  const states = [
    [await write_page(await readFile(new URL("../dist/report.html", import.meta.url), "utf8")), /contains no data/, "the template says that it has no data"],
    [await write_page(await inject("{ not json")), /cannot be read/, "unreadable data are named"],
    [await write_page(await inject({ format: "uplift-report-99" })), /uplift-report-99/, "a foreign format is named"],
  ];
  for (const [path, words, what] of states) {
    const { context, page, log } = await open(browser, pathToFileURL(path).href);
    check.ok(words.test(await page.locator("#report").innerText()), what);
    check.equal(log.console.length, 0, `${what}: without a console message`);
    await context.close();
  }
  const bare = await open(browser, pathToFileURL(await write_page(await inject({ format: "uplift-report-2", title: "Bare" }))).href);
  check.ok(/Bare/.test(await bare.page.locator("h1").innerText()) && bare.log.console.length === 0, "a document with a title only is shown");
  await bare.context.close();
  for (const [level, word] of [["motion", "GROUND MOTION"], ["separated", "CONTACT LOST"]]) {
    const other = await open(browser, pathToFileURL(await write_page(await inject({ format: "uplift-report-2", title: "Level", verdict: { level, headline: "h" } }))).href);
    check.equal(await other.page.locator(".verdict-level").innerText(), word, `the level ${level} has its words`);
    check.ok((await other.page.locator(".sign path").getAttribute("d")) && other.log.console.length === 0, `the level ${level} has its sign`);
    await other.context.close();
  }
}

async function check_sample(page) {
  if (given) return;
  await check_sample_verdict(page);
  const text = await page.locator("main").innerText();
  check.ok(text.includes("Penalty </script>"), "markup in names is text");
  const chips = await page.locator(".chip-failed.chip-expected").count();
  check.equal(chips, 1, "an expected failure is marked");
  const colours = await page.evaluate(() => window.upliftReport.charts.flatMap((c) => [...document.getElementById(`chart-${c.id}`).querySelectorAll(".key")].map((k) => [k.querySelector("span").textContent, k.querySelector("path").getAttribute("style")])).filter(([n]) => n === "Tensionless springs").map(([, c]) => c));
  check.ok(colours.length > 2 && new Set(colours).size === 1, "a run has one colour in every figure");
  const svg = await page.evaluate(() => window.upliftReport.chart("dense").svg());
  check.ok(svg.length < DENSE_SAMPLES * 4, "dense curves are thinned in the drawing", `${svg.length} characters`);
  const swing = await page.evaluate(() => {
    const d = [...new DOMParser().parseFromString(window.upliftReport.chart("dense").svg(), "image/svg+xml").querySelectorAll("g[clip-path] path")][0].getAttribute("d");
    const ys = [...d.matchAll(/[ML][\d.]+ ([\d.]+)/g)].map((m) => Number(m[1]));
    return (Math.max(...ys) - Math.min(...ys)) / 400;
  });
  check.ok(swing > 0.6, "thinning keeps the peaks", `${swing} of the height`);
  const gap = await page.evaluate(() => (window.upliftReport.chart("moment").svg().match(/<g clip-path.*?<path d="([^"]*)"/)[1].match(/M/g) ?? []).length);
  check.equal(gap, 2, "a null breaks the curve");
  await page.locator(".case-card summary").click();
  check.ok(await page.locator(".source pre").isVisible(), "the resolved case opens");
  await page.locator(".copy").click();
  await page.waitForTimeout(50);
  check.ok(/Copied|Ctrl-C/.test(await page.locator(".copy").innerText()), "the case can be copied");
}

async function shoot(page, name) {
  await mkdir(shots, { recursive: true });
  await page.evaluate(() => {
    window.upliftReport.renderAll();
    window.scrollTo(0, 0);
  });
  await page.waitForTimeout(250);
  await page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
}

if (shots) await mkdir(shots, { recursive: true });
const { context, page, log } = await open(browser, url);
check.ok(await page.evaluate(() => window.upliftReport.hasData), "the report has data", await page.evaluate(() => window.upliftReport.message));
const groups = { check_charts, check_ranges, check_zoom_and_hover, check_keyboard, check_hiding, check_verdict, check_tables, check_animation, check_uplift_readout, check_stage_geometry, check_downloads, check_sample };
for (const [name, body] of Object.entries(groups)) await check.group(name, () => body(page));
if (shots) {
  const fresh = await open(browser, url);
  await shoot(fresh.page, "desktop_light");
  await fresh.context.close();
}
await check.group("check_space", () => check_space(page, check));
await check.group("check_theme", () => check_theme(page));
await check.group("check_print", () => check_print(page));
await check.group("check_phone", check_phone);
await check.group("check_layout", check_layout);
await check.group("check_first_frame", check_first_frame);
await check.group("check_other_pages", check_other_pages);
await check.group("check_packed", check_packed);
await check.group("check_closed_maps", check_closed_maps);
if (!given) await check.group("check_documents", () => check_documents(browser, check));
if (!given) await check.group("check_studies", () => check_studies(browser, check, shots));
if (!given) await check.group("check_space_sample", () => check_space_sample(browser, check, shots));
check.equal(log.console.length, 0, `no error or warning in the console (${log.console[0] ?? ""})`);
check.equal(log.network.length, 0, `no request beyond the file (${log.network[0] ?? ""})`);
await context.close();
await browser.close();
console.log(`${check.passed} passed, ${check.failed} failed`);
process.exit(check.failed === 0 ? 0 : 1);
