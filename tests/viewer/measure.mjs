// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node measure.mjs path/to/dermis MODEL [SECONDS]
// How many maps headless Chromium draws a second, how old a frame is when it is on the screen, and how the heap grows, for one
// array at 1,000 frames/s. No test: it measures the machine, too.
import { resolve } from "node:path";
import { becomes, Bench, openBrowser, openPage } from "./harness.mjs";

const [binary, model, seconds = "20"] = process.argv.slice(2);
const bench = new Bench(binary);
const server = await bench.serve("--port", "0", "--from", "sim:contacts?rate=1000", "--model", resolve(model));
const browser = await openBrowser();
try {
  const page = await openPage(browser, `${server.url}#/array`);
  await becomes(page, "live");
  await page.waitForTimeout(3000);
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable");
  const sample = async () => {
    await client.send("HeapProfiler.collectGarbage");
    const { metrics } = await client.send("Performance.getMetrics");
    const drawn = await page.evaluate(() => [Number(document.querySelector("[data-view=array]").dataset.frames), performance.now()]);
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
