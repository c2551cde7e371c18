// Opens a report in Chromium and watches it: console, errors, network.
import { chromium } from "playwright-core";
import { mkdtemp, readFile, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync } from "node:zlib";

const root = fileURLToPath(new URL("..", import.meta.url));
const FLAGS = [
  "--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
];
// WebGL computed by the processor: the same picture with and without a graphics card.
const WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const NO_WEBGL = ["--disable-gpu", "--disable-3d-apis"];

export const DENSE_SAMPLES = 20000;

/** The template with a document in it as plain JSON. */
export async function inject(document) {
  const template = await readFile(join(root, "dist/report.html"), "utf8");
  const json = typeof document === "string" ? document : JSON.stringify(document);
  return template.replace("/*UPLIFT_DATA*/", () => json.replace(/<\//g, "<\\/"));
}

/** The template with compressed data, as the program writes it. */
export async function inject_packed(document) {
  const template = await readFile(join(root, "dist/report.html"), "utf8");
  return template.replace("/*UPLIFT_DATA*/", () => deflateSync(JSON.stringify(document)).toString("base64"));
}

/** A history with many more samples than pixels, to exercise the drawing by pixel columns. */
function dense_chart(section) {
  const x = Array.from({ length: DENSE_SAMPLES }, (_, i) => (4 * i) / DENSE_SAMPLES);
  const y = x.map((t, i) => (i % 7001 === 7000 ? null : 0.02 * Math.exp(-t) * Math.sin(400 * t)));
  return {
    id: "dense", section, title: "Many samples", caption: "", origin: "our choice",
    x: { label: "Time", unit: "s" }, y: { label: "Displacement", unit: "m" }, series: [{ label: "dense", x, y }],
  };
}

/** Writes a file into a fresh folder and returns its path. */
export async function write_page(html, name = "report.html") {
  const path = join(await mkdtemp(join(tmpdir(), "uplift report ")), name);
  await writeFile(path, html);
  return path;
}

/** The report of the sample. */
export async function sample_report() {
  const document = JSON.parse(await readFile(join(root, "test/sample.json"), "utf8"));
  document.charts.push(dense_chart(document.sections[document.sections.length - 1].id));
  return write_page(await inject(document));
}

/** The report with a model in three dimensions. */
export async function space_report(change = (document) => document) {
  return write_page(await inject(change(JSON.parse(await readFile(join(root, "test/sample_space.json"), "utf8")))));
}

export async function start_browser({ webgl = true } = {}) {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: [...FLAGS, ...(webgl ? WEBGL : NO_WEBGL)] });
}

/** Opens a page; `log` collects what should stay empty. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme: "light", acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000); // machines that test are busy, and draw without a graphics card
  const log = { console: [], network: [] };
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) log.console.push(message.text());
  });
  page.on("pageerror", (error) => log.console.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) log.network.push(request.url());
  });
  await page.goto(url);
  await page.waitForFunction(() => window.upliftReport !== undefined);
  return { context, page, log };
}

/** Counts checks; a failing one is told and does not stop the others. */
export class Checks {
  passed = 0;
  failed = 0;

  ok(condition, what, detail = "") {
    if (condition) {
      this.passed++;
      return;
    }
    this.failed++;
    console.log(`FAIL  ${what}${detail === "" ? "" : `: ${detail}`}`);
  }

  equal(found, wanted, what) {
    this.ok(Object.is(found, wanted), what, `wanted ${JSON.stringify(wanted)}, found ${JSON.stringify(found)}`);
  }

  async group(name, body) {
    try {
      await body();
    } catch (error) {
      this.failed++;
      console.log(`FAIL  ${name}: ${error.message.split("\n")[0]}`);
    }
  }
}
