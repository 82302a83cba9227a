// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node ghosts.mjs path/to/dermis ARRAY MODEL FOLDER OUT.png
// No test: one frame as a plain viewer shows it, beside the same frame by dermis, as a picture for the documents
// (scripts/pictures). FOLDER holds frames.csv and loads.csv of the simulator. The frame is the one with the strongest ghost:
// the largest reading of a taxel around which nothing is pressed, as a share of the largest of all.
import { readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { Bench, becomes, openBrowser, openPage, readCsv } from "./harness.mjs";

const SHOWN_FRAMES = 6000;
const RATE_HZ = 100;
const QUIET_N = 0.02;
const REACH = 2;
const LEAST_PRESS_N = 10;

const [binary, array, model, folder, out] = process.argv.slice(2);

/** The forces of each frame by the names of taxels. */
function readTruth() {
  const truth = [];
  for (const { frame, where, value } of readCsv(join(folder, "loads.csv")))
    truth[Number(frame)] = (truth[Number(frame)] ?? new Map()).set(where, Number(value));
  return truth;
}

function strongestGhost(frames, truth) {
  const taxels = Object.keys(frames[0]).filter((name) => /^r\d+c\d+$/.test(name));
  const force = (frame, row, col) => truth[frame]?.get(`r${row}c${col}`) ?? 0;
  let best = { share: 0, frame: 0 };
  frames.forEach((line, frame) => {
    const forces = [...(truth[frame]?.values() ?? [])];
    if (Math.max(0, ...forces) < LEAST_PRESS_N) return;
    const most = Math.max(...taxels.map((taxel) => Number(line[taxel])));
    for (const taxel of taxels) {
      const [row, col] = taxel.match(/\d+/g).map(Number);
      const share = Number(line[taxel]) / most;
      if (share <= best.share) continue;
      let isQuiet = true;
      for (let r = row - REACH; r <= row + REACH; ++r)
        for (let c = col - REACH; c <= col + REACH; ++c) isQuiet &&= force(frame, r, c) < QUIET_N;
      if (isQuiet) best = { share, frame };
    }
  });
  return {
    ...best,
    counts: Math.max(...taxels.map((taxel) => Number(frames[best.frame][taxel]))),
    newtons: Math.max(...truth[best.frame].values()),
  };
}

/** A recording in which that frame stands still. */
function record(bench, frame) {
  const [head, ...lines] = readFileSync(join(folder, "frames.csv"), "utf8").trim().split("\n");
  const cells = lines[frame].split(",").slice(1).join(",");
  const still = Array.from({ length: SHOWN_FRAMES }, (_, index) => `${index / RATE_HZ},${cells}`);
  writeFileSync(bench.path("still.csv"), [head, ...still].join("\n"));
  bench.run("convert", bench.path("still.csv"), bench.path("still.mcap"), "--array", resolve(array));
}

/** The smallest scale that holds `most`. */
async function setScale(page, quantity, most) {
  const select = page.locator(`[data-role=scale-${quantity}]`);
  const ends = await select.locator("option").evaluateAll((options) => options.map((option) => option.value));
  const fitting = ends.filter((end) => Number(end) >= most).sort((a, b) => Number(a) - Number(b));
  await select.selectOption(fitting[0]);
}

async function picture(page, panel) {
  const bytes = await page.locator(`section[aria-label='${panel} map']`).screenshot();
  return `data:image/png;base64,${bytes.toString("base64")}`;
}

const frames = readCsv(join(folder, "frames.csv"));
const ghost = strongestGhost(frames, readTruth());
const bench = new Bench(binary);
record(bench, ghost.frame);
const server = await bench.serve("--port", "0", "--from", "still.mcap", "--model", resolve(model));
const browser = await openBrowser();
try {
  const page = await openPage(browser, `${server.url}#/array`);
  await page.setViewportSize({ width: 1800, height: 1000 });
  await page.emulateMedia({ colorScheme: "light" });
  await becomes(page, "live");
  await page.locator("[data-contact]").first().waitFor();
  await page.getByRole("checkbox", { name: "Contacts" }).uncheck();
  await setScale(page, "raw", ghost.counts);
  await setScale(page, "force", ghost.newtons);
  await page.waitForTimeout(1000);
  const images = [await picture(page, "Raw"), await picture(page, "Force")];
  const page2 = await openPage(browser, "about:blank");
  await page2.setViewportSize({ width: 1240, height: 800 });
  await page2.setContent(`<style>
body { margin: 0; background: #fff; color: #12171c; font: 600 20px "Liberation Sans", Arial, sans-serif }
main { display: grid; grid-template-columns: 1fr 1fr; gap: 20px; width: 1200px; padding: 16px 20px }
p { margin: 0 0 8px } small { display: block; color: #4f5a65; font-weight: 400; font-size: 15px } img { width: 100%; display: block }
</style><main>
<section><p>A plain viewer: counts<small>Taxels that nobody touches read up to ${Math.round(100 * ghost.share)} % of the largest: ghosts.</small></p><img src="${images[0]}"></section>
<section><p>dermis: newtons<small>The same frame, the circuit solved: what is touched remains.</small></p><img src="${images[1]}"></section>
</main>`);
  await page2.locator("main").screenshot({ path: out });
} finally {
  await browser.close();
  await server.stop();
  bench.close();
}
