// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node measure.mjs path/to/dermis MODEL [SECONDS]
// How soon after its load the page draws its first map, and how large it is; how many maps headless Chromium draws a second,
// how old a frame is when it is on the screen, and how the heap grows, for one array at 1,000 frames/s. No test: it measures
// the machine, too.
import { resolve } from "node:path";
import { Bench, becomes, openBrowser, openPage } from "./harness.mjs";

const LOADS = 9;
const [binary, model, seconds = "20"] = process.argv.slice(2);
const bench = new Bench(binary);
const server = await bench.serve("--port", "0", "--from", "sim:contacts?rate=1000", "--model", resolve(model));
const browser = await openBrowser();

/** Milliseconds from the navigation to the first figures of a map, and the bytes of the page. */
async function load(view) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.addInitScript(() => {
    const look = () => {
      if (Number(document.querySelector("[data-view=array]")?.dataset.stamp ?? 0) > 0)
        window.firstMapMs = performance.now();
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  await page.goto(`${server.url}#/${view}`);
  if (view === "array") await page.waitForFunction(() => window.firstMapMs !== undefined);
  else await page.locator(".array-label").first().waitFor();
  const loaded = await page.evaluate(() => {
    const files = [...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")];
    return {
      ms: window.firstMapMs,
      sent: files.reduce((sum, file) => sum + file.encodedBodySize, 0),
      whole: files.reduce((sum, file) => sum + file.decodedBodySize, 0),
    };
  });
  await page.close();
  return loaded;
}

try {
  const loads = [];
  for (let time = 0; time < LOADS; ++time) loads.push(await load("array"));
  const times = loads.map(({ ms }) => ms).sort((a, b) => a - b);
  console.log(
    `first map: ${times[Math.floor(LOADS / 2)].toFixed(0)} ms after the load (median of ${LOADS}; ${times[0].toFixed(0)} ... ${times.at(-1).toFixed(0)})`,
  );
  const suit = await load("suit");
  console.log(
    `page: ${loads[0].sent} bytes sent, ${loads[0].whole} unpacked; with the suit ${suit.sent}, ${suit.whole}`,
  );
  const page = await openPage(browser, `${server.url}#/array`);
  await becomes(page, "live");
  await page.waitForTimeout(3000);
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable");
  const sample = async () => {
    await client.send("HeapProfiler.collectGarbage");
    const { metrics } = await client.send("Performance.getMetrics");
    const drawn = await page.evaluate(() => [
      Number(document.querySelector("[data-view=array]").dataset.frames),
      performance.now(),
    ]);
    return { heap: metrics.find(({ name }) => name === "JSHeapUsedSize").value, frames: drawn[0], ms: drawn[1] };
  };
  const before = await sample();
  await page.waitForTimeout(1000 * Number(seconds));
  const after = await sample();
  await page.evaluate(() => (window.location.hash = "#/health"));
  const figure = (name) => page.locator(`[data-figure="${name}"]`).textContent();
  const [median, most] = [await figure("Time of frame to screen, p50"), await figure("p99")];
  const rate = (1000 * (after.frames - before.frames)) / (after.ms - before.ms);
  console.log(`maps drawn: ${rate.toFixed(1)} a second; time of frame to screen: p50 ${median}, p99 ${most}`);
  console.log(`heap after collection: ${before.heap} bytes, ${seconds} s later ${after.heap}`);
} finally {
  await browser.close();
  await server.stop();
  bench.close();
}
