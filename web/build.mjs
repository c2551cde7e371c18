// Bundles src/ into the single file dist/report.html.
// The same sources give the same bytes: no date, no path and no hash enters the output.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL(".", import.meta.url));
const PLACEHOLDER = "/*UPLIFT_DATA*/";

/** Bundles one entry point (script or style sheet) and returns its text. */
async function bundle(entry, options = {}) {
  const result = await build({
    absWorkingDir: root,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2020",
    charset: "utf8",
    legalComments: "inline",
    logLevel: "warning",
    ...options,
  });
  return result.outputFiles[0].text.trim();
}

const [template, script, scene, style, uplot, three] = await Promise.all([
  readFile(root + "src/template.html", "utf8"),
  bundle("src/main.ts"),
  // A script of its own, which the page runs only for a report with a model in three dimensions.
  bundle("src/space/scene.ts", { globalName: "upliftScene" }),
  bundle("src/style/main.css"),
  readFile(root + "node_modules/uplot/LICENSE", "utf8"),
  readFile(root + "node_modules/three/LICENSE", "utf8"),
]);

// Replacement by functions: "$" in the bundle must not be read as a pattern.
// The licences of uPlot and three.js ask that their notices go with every copy.
const plain = (licence) => licence.trim().replace(/\r/g, "").replace(/--/g, "- -");
const notice = `uPlot, bundled below:\n\n${plain(uplot)}\n\nthree.js, bundled below:\n\n${plain(three)}`;
const html = template
  .replace("NOTICE", () => notice)
  .replace("/*STYLE*/", () => style)
  .replace("/*SCENE*/", () => scene)
  .replace("/*SCRIPT*/", () => script);

const found = html.split(PLACEHOLDER).length - 1;
if (found !== 1) throw new Error(`report.html holds the placeholder ${found} times instead of once`);
if (/<\/script|<!--/i.test(script + scene)) throw new Error("a script bundle would end its own script element");

await mkdir(root + "dist", { recursive: true });
await writeFile(root + "dist/report.html", html);
const size = (text) => `${(Buffer.byteLength(text) / 1024).toFixed(1)} kB`;
console.log(`dist/report.html  ${size(html)}, of it ${size(scene)} for the space view`);
