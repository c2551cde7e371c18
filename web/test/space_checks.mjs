// Checks of the model in three dimensions. check_space() holds for any report; check_space_sample() knows the closed form of
// the sample (make_space.mjs) and also opens it without WebGL, in dark colours, in print and on a phone.
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { open, space_report, start_browser } from "./harness.mjs";

/** The drawing as pixels: how many are not transparent, and a number that changes with any of them. */
const picture = (page) =>
  page.evaluate(() => {
    const { data } = window.pixels_of(window.upliftReport.space.stage.still());
    let ink = 0;
    let sum = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 0) ink++;
      sum = (sum * 31 + data[i] + 3 * data[i + 1] + 7 * data[i + 2] + data[i + 3]) % 4294967291;
    }
    return { part: ink / (data.length / 4), sum };
  });
const maps = (page) => page.evaluate(() => window.upliftReport.space.faces.flatMap((f) => f.maps.map((m) => m.canvas.toDataURL())).join());
const set_frame = (page, frame) => page.evaluate((f) => window.upliftReport.space.set_frame(f), frame);
const scrub_to = (page, frame) =>
  page.locator(".space-card .scrub").evaluate((input, f) => ((input.value = String(f)), input.dispatchEvent(new Event("input", { bubbles: true }))), frame);

/** Waits for something that the page does in its own time. */
const eventually = (page, what, arg) => page.waitForFunction(what, arg, { timeout: 15000 }).then(() => true, () => false);

export async function check_space(page, check) {
  const has = await page.evaluate(() => window.upliftReport.space !== null);
  const run = await page.evaluate(() => window.upliftScene !== undefined);
  if (!has) {
    check.equal(run, false, "a plane model runs no script of the space view");
    return;
  }
  await page.evaluate(() => {
    // A copy for reading: canvases of the page are left as they are.
    window.pixels_of = (canvas) => {
      const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height }).getContext("2d", { willReadFrequently: true });
      copy.drawImage(canvas, 0, 0);
      return copy.getImageData(0, 0, canvas.width, canvas.height);
    };
    window.upliftReport.space.render();
  });
  await page.locator(".space-card").scrollIntoViewIfNeeded();
  const first = await picture(page);
  check.ok(first.part > 0.02, "the space view is not blank", `${first.part} of the pixels`);
  await check_parts(page, check);
  if (await page.evaluate(() => window.upliftReport.space.frames > 1)) await check_time(page, check);
}

async function check_parts(page, check) {
  const before = (await picture(page)).sum;
  const key = page.locator(".space-layers .key").first();
  await key.click();
  check.equal(await key.getAttribute("aria-pressed"), "false", "the key of a hidden part tells so");
  check.ok((await picture(page)).sum !== before, "hiding a part changes the picture");
  await key.click();
  check.equal((await picture(page)).sum, before, "showing it again gives the picture back");
}

/** Faces that are held or absorb are marked on a model at rest, and where the reader asks for them. */
async function check_borders(page, check, moving) {
  const key = page.locator(".space-layers .key", { hasText: "absorbing faces" });
  check.equal(await key.getAttribute("aria-pressed"), String(!moving), `absorbing faces are ${moving ? "not marked" : "marked"} at first`);
  const before = (await picture(page)).sum;
  await key.click();
  check.ok((await picture(page)).sum !== before, "their key changes the picture");
  await key.click();
  check.equal((await picture(page)).sum, before, "and changes it back");
}

async function check_time(page, check) {
  const frames = await page.evaluate(() => window.upliftReport.space.frames);
  const moving = await page.evaluate(() => {
    const { space, report } = window.upliftReport;
    const { displacement } = report.spaceAnimations.find((a) => a.run === space.run);
    const size = displacement.map((u) => u.reduce((m, v) => Math.max(m, Math.abs(v)), 0));
    return [size.indexOf(Math.min(...size)), size.indexOf(Math.max(...size))];
  });
  await scrub_to(page, moving[0]);
  const [still, still_maps] = [(await picture(page)).sum, await maps(page)];
  await scrub_to(page, moving[1]);
  check.ok((await picture(page)).sum !== still, "the slider moves the model");
  check.ok(frames < 2 || (await maps(page)) !== still_maps, "and the maps");
  const frame = () => page.evaluate(() => window.upliftReport.space.frame);
  await scrub_to(page, 0);
  await page.locator(".space-card .controls select").first().selectOption("0.5");
  await page.locator(".space-card .play").click();
  check.ok(await eventually(page, () => window.upliftReport.space.frame > 0), "play advances the model");
  await page.locator(".space-card .play").click();
  const stopped = await frame();
  await page.waitForTimeout(150);
  check.equal(await frame(), stopped, "pause stops the model");
  await page.locator(".space-card .scrub").focus();
  await page.keyboard.press(" ");
  check.ok(await eventually(page, (f) => window.upliftReport.space.frame !== f, stopped), "the space bar plays too");
  await page.keyboard.press(" ");
  await check_shares(page, check, frames);
}

/** Open share of each interface in words, against the openings of the document. */
async function check_shares(page, check, frames) {
  for (const frame of new Set([0, Math.floor(frames / 3), Math.floor(frames / 2)])) {
    await set_frame(page, frame);
    const shares = await page.evaluate(() => {
      const { space, report } = window.upliftReport;
      const source = report.spaceAnimations.find((a) => a.run === space.run);
      return report.space.interfaces.map((face, i) => {
        const open = face.area.reduce((sum, a, k) => sum + (source.openings[face.name][space.frame][k] > 0 ? a : 0), 0);
        const said = parseFloat(document.querySelectorAll("#space .face-maps .open-share")[i].textContent);
        return { name: face.name, wanted: (100 * open) / face.area.reduce((sum, a) => sum + a, 0), said };
      });
    });
    for (const { name, wanted, said } of shares) check.ok(Math.abs(said - wanted) <= 0.5, `the open share of ${name} follows the openings`, `${said} %, wanted ${wanted} %`);
  }
}

// ------------------------------------------------------------------------------------------------ the sample

/** Part of the polygon where f > 0, f linear: clip by the line f = 0 and compare areas. */
function positive_part(corners, f) {
  const area = (p) => Math.abs(p.reduce((sum, [x, y], i) => sum + x * p[(i + 1) % p.length][1] - y * p[(i + 1) % p.length][0], 0)) / 2;
  const kept = corners.flatMap((a, i) => {
    const b = corners[(i + 1) % corners.length];
    const [fa, fb] = [f(a), f(b)];
    const crossing = fa > 0 !== fb > 0 ? [[a[0] + (fa / (fa - fb)) * (b[0] - a[0]), a[1] + (fa / (fa - fb)) * (b[1] - a[1])]] : [];
    return [...(fa > 0 ? [a] : []), ...crossing];
  });
  return area(kept) / area(corners);
}

/** Openings of the raft are a plane; its value at the corners gives the plane. */
async function check_map_area(page, check) {
  const frames = await page.evaluate(() => window.upliftReport.space.frames);
  for (const frame of [Math.floor(frames / 3), Math.floor(frames / 2) - 2, Math.floor((2 * frames) / 3)]) {
    await set_frame(page, frame);
    const { drawn, corners, values } = await page.evaluate(() => {
      const { space, report } = window.upliftReport;
      const source = report.spaceAnimations.find((a) => a.run === space.run);
      const face = report.space.interfaces[0];
      const openings = source.openings[face.name][space.frame];
      const [xs, ys] = [0, 1].map((k) => face.area.map((_a, i) => face.plan[2 * i + k]));
      const at = (x, y) => openings[face.area.findIndex((_a, i) => xs[i] === x && ys[i] === y)];
      const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
      const corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
      // Colours of the map of gaps: closed points have one colour of their own.
      const { canvas } = space.faces[0].maps[0];
      const { data, width } = window.pixels_of(canvas);
      const closed = space.stage.ink.closed;
      const rgb = [1, 3, 5].map((i) => parseInt(closed.slice(i, i + 2), 16));
      const orange = (i) => data[i] - data[i + 2] > 12 && data[i + 3] === 255;
      let [open, shut] = [0, 0];
      for (let i = 0; i < data.length; i += 4) {
        if (((i / 4) % width) * (canvas.clientWidth / width) > canvas.clientWidth * 0.62) continue;
        if (rgb.every((v, k) => data[i + k] === v)) shut++;
        else if (orange(i)) open++;
      }
      return { drawn: open / (open + shut), corners, values: corners.map(([x, y]) => at(x, y)) };
    });
    const [[x0, y0], [x1], , [, y1]] = corners;
    const plane = ([x, y]) => values[0] + ((values[1] - values[0]) * (x - x0)) / (x1 - x0) + ((values[3] - values[0]) * (y - y0)) / (y1 - y0);
    const wanted = positive_part(corners, plane);
    check.ok(Math.abs(drawn - wanted) < 0.02, "the map of gaps paints the part of the raft that is open", `${drawn}, wanted ${wanted}`);
  }
}

/** The ground of the sample does not move: the lower side of every gap lies at z = 0, whatever the magnification. */
async function check_pose(page, check) {
  const { low, turned, lift } = await page.evaluate(() => {
    const { space, report } = window.upliftReport;
    const source = report.spaceAnimations.find((a) => a.run === space.run);
    let [low, turned, lift] = [0, 0, 0];
    for (let frame = 0; frame < space.frames; frame++) {
      space.set_frame(frame);
      const { pose } = space.stage;
      for (const { skin, upper, lower, opening } of pose.faces) {
        const heights = new Map();
        skin.point.forEach((p, v) => {
          if (opening[v] <= 0) return;
          heights.set(p, [...(heights.get(p) ?? []), lower[3 * v + 2] / pose.factor]);
          lift = Math.max(lift, upper[3 * v + 2] - lower[3 * v + 2]);
        });
        // A square of the footing tilts about its point: its corners lie there in the mean.
        for (const list of heights.values()) low = Math.max(low, Math.abs(list.reduce((a, b) => a + b, 0) / list.length));
      }
      // The plinth as a rigid body: rotation [0, r, 0] about its node takes (dx, dy, dz) by (r dz, 0, −r dx).
      const body = report.space.bodies[0];
      const r = source.rotation[body.name][frame][1];
      const [nx, , nz] = report.space.nodes.slice(3 * body.node, 3 * body.node + 3);
      const u = source.displacement[frame].slice(3 * body.node, 3 * body.node + 3);
      for (let c = 0; 3 * c < body.corners.length; c++) {
        const [x, y, z] = body.corners.slice(3 * c, 3 * c + 3);
        const wanted = [x + pose.factor * (u[0] + r * (z - nz)), y + pose.factor * u[1], z + pose.factor * (u[2] - r * (x - nx))];
        wanted.forEach((w, k) => (turned = Math.max(turned, Math.abs(pose.plates[0][3 * c + k] - w))));
      }
    }
    return { low, turned, lift };
  });
  check.ok(lift > 0.1, "the gap is drawn magnified", `${lift} m`);
  // Displacements of the sample are rounded to 0.01 mm.
  check.ok(low < 1.5e-5, "below every gap lies the ground", `${low} m apart`);
  check.ok(turned < 1e-4, "a rigid body moves with its node", `${turned} m apart`);
}

async function check_directions(page, check) {
  const seen = () => page.evaluate(() => window.upliftReport.space.stage.seen);
  const side = (name) => page.locator(".space-sides button", { hasText: new RegExp(`^${name}$`) }).click();
  const near = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 1e-3);
  await side("x");
  check.ok(near((await seen()).right, [0, 1, 0]), "view x shows y to the right");
  await side("y");
  check.ok(near((await seen()).right, [1, 0, 0]) && near((await seen()).up, [0, 0, 1]), "view y shows x to the right and z upwards");
  await side("z");
  check.ok(near((await seen()).right, [1, 0, 0]) && near((await seen()).up, [0, 1, 0]), "view z is a plan");
  await side("3D");
  const oblique = await seen();
  check.ok(oblique.out[2] > 0.2 && Math.abs(oblique.out[0]) > 0.2, "the oblique view looks down");
  await page.locator(".space-layers .key", { hasText: "soil" }).click();
  await side("Fit");
  check.ok((await seen()).scale > 1.1 * oblique.scale, "fit follows the shown parts");
  await page.locator(".space-layers .key", { hasText: "soil" }).click();
  await side("3D");
}

/** The page scrolls smoothly: the place of an element once it has come to rest. */
async function resting_box(page, element) {
  await element.scrollIntoViewIfNeeded();
  let last = await element.boundingBox();
  for (let i = 0; i < 40; i++) {
    await page.waitForTimeout(80);
    const box = await element.boundingBox();
    if (box.y === last.y) break;
    last = box;
  }
  return last;
}

async function check_orbit(page, check) {
  const seen = () => page.evaluate(() => window.upliftReport.space.stage.seen);
  const canvas = page.locator(".space-live");
  const box = await resting_box(page, canvas);
  const [x, y] = [box.x + box.width / 2, box.y + Math.min(box.height, 400) / 2];
  const before = await seen();
  await page.evaluate(() => document.activeElement.blur());
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -120);
  await page.waitForTimeout(120);
  check.equal((await seen()).scale, before.scale, "the wheel scrolls the page until the picture is clicked");
  const again = await resting_box(page, canvas);
  await page.mouse.move(again.x + again.width / 2, again.y + 200);
  await page.mouse.down();
  await page.mouse.move(again.x + again.width / 2 + 90, again.y + 200, { steps: 4 });
  await page.mouse.up();
  check.ok(Math.abs((await seen()).out[0] - before.out[0]) > 0.1, "a drag turns the model");
  await page.mouse.wheel(0, -120);
  check.ok(await eventually(page, (scale) => window.upliftReport.space.stage.seen.scale > scale, before.scale), "then the wheel zooms");
  await page.locator(".space-sides button", { hasText: "3D" }).click();
  await canvas.focus();
  await page.keyboard.press("ArrowLeft");
  const turned = await seen();
  check.ok(Math.abs(turned.out[0] - before.out[0]) > 0.01, "arrow keys turn the model");
  await page.keyboard.press("+");
  check.ok((await seen()).scale > turned.scale, "plus zooms the model");
  await page.keyboard.press("Shift+ArrowUp");
  check.ok((await seen()).centre.some((v, i) => Math.abs(v - turned.centre[i]) > 0.01), "shift and an arrow move it");
  await page.keyboard.press("f");
  check.ok(Math.abs((await seen()).scale / turned.scale - 1) < 0.02, "F fits it");
}

async function check_colours(page, check) {
  const before = (await picture(page)).sum;
  await page.locator(".space-options select").selectOption("displacement");
  check.ok((await picture(page)).sum !== before, "colours by displacement change the picture");
  check.ok(/mm/.test(await page.locator(".space-legend").innerText()), "and say their range");
  await page.locator(".space-options select").selectOption("part");
  const map = page.locator("#space .plan-map").first();
  await map.scrollIntoViewIfNeeded();
  const summary = await page.locator("#space .plan-readout").first().innerText();
  await map.hover({ position: { x: 80, y: 60 } });
  const point = await page.locator("#space .plan-readout").first().innerText();
  check.ok(point !== summary && /^x .* m, y .* m: /.test(point), "the pointer reads values off the map", point);
  await page.mouse.move(2, 2);
}

/** After the shock: a map of every interface at the last picture. */
async function check_rest_maps(page, check) {
  const maps = page.locator("#after-shock .rest-maps .face-maps");
  const faces = await page.evaluate(() => window.upliftReport.report.space.interfaces.length);
  check.equal(await maps.count(), faces, "the base after the shock has a map for every interface");
  const { said, wanted } = await page.evaluate(() => {
    const { space, spaceAnimations } = window.upliftReport.report;
    const [face] = space.interfaces;
    const last = spaceAnimations[0].openings[face.name].at(-1);
    const all = face.area.reduce((sum, a) => sum + a, 0);
    return {
      said: parseFloat(document.querySelector("#after-shock .open-share").textContent),
      wanted: (100 * face.area.reduce((sum, a, i) => sum + (last[i] > 0 ? a : 0), 0)) / all,
    };
  });
  check.ok(Math.abs(said - wanted) <= 0.51, "it shows the last picture", `${said} %, wanted ${wanted} %`);
}

async function check_lost(page, check) {
  await page.evaluate(() => document.querySelector(".space-live").getContext("webgl2").getExtension("WEBGL_lose_context").loseContext());
  await page.waitForFunction(() => !window.upliftReport.space.stage.webgl, undefined, { timeout: 5000 }).catch(() => undefined);
  check.ok((await page.locator(".space-note").isVisible()) && (await picture(page)).part > 0.02, "a lost context leaves pictures");
}

/** Without WebGL: pictures, the same parts, the same maps. */
async function check_pictures(path, check, shots) {
  const browser = await start_browser({ webgl: false });
  const { context, page, log } = await open(browser, pathToFileURL(path).href);
  await page.evaluate(() => window.upliftReport.renderAll());
  check.equal(await page.evaluate(() => window.upliftReport.space.stage.webgl), false, "no WebGL in this browser");
  check.equal(await page.evaluate(() => window.upliftScene !== undefined), false, "and three.js is not run");
  check.ok(/WebGL is not available/.test(await page.locator(".space-note").innerText()), "the page says why there are pictures");
  await check_space(page, check);
  await check_map_area(page, check);
  await check_directions(page, check);
  if (shots) await shoot(page, shots, "space_pictures");
  check.equal(log.console.length, 0, `no message without WebGL (${log.console[0] ?? ""})`);
  await context.close();
  await browser.close();
}

async function check_print_and_dark(page, check, shots) {
  const light = (await picture(page)).sum;
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForFunction(() => document.documentElement.dataset.theme === "dark");
  check.ok((await picture(page)).sum !== light, "the model follows the theme");
  if (shots) await shoot(page, shots, "space_dark");
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  await page.waitForFunction(() => document.querySelector(".space-still").getClientRects().length > 0).catch(() => undefined);
  await page.waitForTimeout(200);
  const still = await page.evaluate(() => {
    const { data } = window.pixels_of(document.querySelector(".space-still"));
    let ink = 0;
    for (let i = 3; i < data.length; i += 4) if (data[i] > 0) ink++;
    return { part: ink / (data.length / 4), light: window.upliftReport.space.stage.ink.card, live: document.querySelector(".space-live").getClientRects().length };
  });
  check.ok(still.part > 0.02 && still.live === 0, "print has a picture in place of the view", JSON.stringify(still));
  check.equal(still.light, "#ffffff", "print is light");
  await page.emulateMedia({ media: "screen", colorScheme: "light" });
  await page.waitForFunction(() => document.documentElement.dataset.theme === "light");
}

async function check_phone(browser, url, check, shots) {
  const { context, page, log } = await open(browser, url, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await page.evaluate(() => window.upliftReport.renderAll());
  await page.waitForTimeout(200);
  check.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, "the model fits a phone");
  await check_space(page, check);
  check.equal(await page.locator(".space-live").evaluate((c) => c.style.touchAction), "pan-y", "a finger can scroll past it");
  if (shots) await shoot(page, shots, "space_phone");
  check.equal(log.console.length, 0, `no message on a phone (${log.console[0] ?? ""})`);
  await context.close();
}

async function shoot(page, shots, name) {
  await mkdir(shots, { recursive: true });
  await page.waitForTimeout(200);
  await page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
}

export async function check_space_sample(browser, check, shots) {
  const path = await space_report();
  const url = pathToFileURL(path).href;
  const { context, page, log } = await open(browser, url);
  await page.evaluate(() => window.upliftReport.renderAll());
  check.equal(await page.evaluate(() => window.upliftReport.space.stage.webgl), true, "the view is drawn by WebGL");
  const groups = { check_space, check_pose, check_map_area, check_directions, check_orbit, check_colours, check_rest_maps };
  for (const [name, body] of Object.entries(groups)) await check.group(name, () => body(page, check));
  await check.group("check_borders", () => check_borders(page, check, true));
  if (shots) await shoot(page, shots, "space_light");
  await check.group("check_print_and_dark", () => check_print_and_dark(page, check, shots));
  await check.group("check_lost", () => check_lost(page, check));
  check.equal(log.console.length, 0, `no message with a space model (${log.console[0] ?? ""})`);
  check.equal(log.network.length, 0, "no request beyond the file");
  await context.close();
  await check.group("check_phone", () => check_phone(browser, url, check, shots));
  await check.group("check_pictures", () => check_pictures(path, check, shots));
  await check.group("check_still_model", async () => {
    const bare = await open(browser, pathToFileURL(await space_report((d) => ({ ...d, spaceAnimations: [] }))).href);
    await check_space(bare.page, check);
    await check_borders(bare.page, check, false);
    check.equal(await bare.page.locator(".space-card .scrub").count(), 0, "a model without motion has no slider");
    check.equal(bare.log.console.length, 0, "and no message");
    await bare.context.close();
  });
}
