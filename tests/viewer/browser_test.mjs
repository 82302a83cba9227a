// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node browser_test.mjs path/to/dermis
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  assertUnhurt,
  becomes,
  bench,
  browser,
  eventually,
  freePort,
  openPage,
  shown,
  tareAnyway,
  useBench,
} from "./harness.mjs";

useBench();

const loop = () => ["--from", "sim:contacts?rate=200", ...bench.model];

/** In the page: whether the maps hold more than two colours. WebGL keeps a drawing only until it is shown, so an
 * animation frame in which nothing was drawn sees an empty canvas: ask again. */
function hasDrawnColours() {
  const canvas = document.querySelector("[data-role=maps] canvas");
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  return new Promise((resolve) =>
    requestAnimationFrame(() => {
      const pen = copy.getContext("2d");
      pen.drawImage(canvas, 0, 0);
      const bytes = pen.getImageData(0, 0, copy.width, copy.height).data;
      const found = new Set();
      for (let at = 0; at < bytes.length; at += 4)
        if (bytes[at + 3] > 0) found.add((bytes[at] << 16) | (bytes[at + 1] << 8) | bytes[at + 2]);
      resolve(found.size > 2);
    }),
  );
}

/** In the page: how well two colours are told apart, 1 to 21 (WCAG). */
function contrast(colors) {
  const pen = document.createElement("canvas").getContext("2d");
  const luminance = (color) => {
    pen.fillStyle = color;
    pen.fillRect(0, 0, 1, 1);
    const [red, green, blue] = [...pen.getImageData(0, 0, 1, 1).data].map((byte) =>
      byte <= 10 ? byte / 3294.6 : ((byte / 255 + 0.055) / 1.055) ** 2.4,
    );
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const [dark, light] = colors.map(luminance).sort((a, b) => a - b);
  return (light + 0.05) / (dark + 0.05);
}

const number = (text) => Number(text.replace("\u2212", "-").replace(/[^-\d.]/g, ""));

describe("a recording", () => {
  it("shows in each taxel what its CSV says, at the place that is sought", async () => {
    await shown(["--from", bench.path("recording.mcap"), ...bench.model], "array", async (page) => {
      await page.locator("[data-role=transport]").waitFor();
      if ((await page.locator("[data-role=play]").textContent()) === "Pause") await page.click("[data-role=play]");
      const maps = page.locator("[data-role=maps]");
      await maps.focus();
      const seen = new Set();
      for (const place of [100, 500, 900]) {
        await page.locator("[data-role=scrub]").fill(String(place));
        await eventually(
          page,
          (before) => {
            const stamp = document.querySelector("[data-view=array]").dataset.stamp;
            return stamp !== undefined && stamp !== before && Number(stamp) > 0;
          },
          [...seen].at(-1),
        );
        await page.waitForTimeout(200);
        const stamp = await page.locator("[data-view=array]").getAttribute("data-stamp");
        seen.add(stamp);
        const frame = bench.counts.findIndex((row) => Math.abs(Number(row.time_s) - Number(stamp)) < 0.01);
        assert.ok(frame >= 0, `no frame at ${stamp}`);
        await maps.press("ArrowRight");
        await page.waitForTimeout(200);
        const row = page.locator("[data-role=cursor]");
        const taxel = await row.getAttribute("data-taxel");
        const field = async (name) => number(await row.locator(`[data-field=${name}]`).textContent());
        assert.equal(await field("counts"), Number(bench.counts[frame][taxel]));
        const newtons = Number(bench.forces[frame][taxel]);
        assert.ok(
          Math.abs((await field("newtons")) - newtons) <= 0.0006 + 0.02 * newtons,
          `${taxel} at ${stamp}: ${await field("newtons")}, not ${newtons}`,
        );
      }
      assert.equal(seen.size, 3);
    });
  });
});

describe("each view", () => {
  it("of the array draws taxels, contacts and figures, and takes pins", async () => {
    await shown(loop(), "array", async (page) => {
      await eventually(page, () => Number(document.querySelector("[data-role=total-force]").textContent) > 0.2);
      await page.locator("[data-contact]").first().waitFor();
      const maps = page.locator("[data-role=maps]");
      await maps.focus();
      await maps.press("ArrowDown");
      await maps.press("Enter");
      await page.locator("[data-role=pin-1][data-taxel]").waitFor();
      await eventually(page, hasDrawnColours);
      await page.keyboard.press("i");
      assert.ok(await page.locator("[data-role=interpolate]").isChecked());
      await page.selectOption("[data-role=scale-force]", "20");
      assert.match(await page.locator("section[aria-label='Force map'] .scale-ticks").textContent(), /20$/);
    });
  });

  it("of time plots totals and contacts, and stands still while paused", async () => {
    await shown(loop(), "time", async (page) => {
      await eventually(page, () => Number(document.querySelector("[data-role=plot-totals] .figure")?.textContent) > 0);
      await page.locator("[data-role=plot-contacts] li:not(.absent)").first().waitFor();
      await page.keyboard.press(" ");
      await page.waitForTimeout(150);
      const words = await page.locator("[data-role=plot-totals] .legend").textContent();
      await page.waitForTimeout(400);
      assert.equal(await page.locator("[data-role=plot-totals] .legend").textContent(), words);
    });
  });

  it("of the array stands still as a whole while paused, and its button can be read under the pointer", async () => {
    await shown(loop(), "array", async (page) => {
      await page.locator("[data-contact]").first().waitFor();
      const pause = page.locator("[data-role=pause]");
      await pause.click();
      await page.waitForTimeout(300);
      const figures = () => page.locator(".readouts").innerText();
      const still = await figures();
      await page.waitForTimeout(500);
      assert.equal(await figures(), still);
      const [ink, ground] = await pause.evaluate((button) => [
        getComputedStyle(button).color,
        getComputedStyle(button).backgroundColor,
      ]);
      assert.ok((await page.evaluate(contrast, [ink, ground])) >= 4.5, `${ink} on ${ground}`);
      await pause.click();
      await eventually(page, (before) => document.querySelector(".readouts").innerText !== before, still);
    });
  });

  it("of the suit shows the array in space and opens it", async () => {
    await shown(loop(), "suit", async (page) => {
      const label = page.locator(".array-label").first();
      await label.waitFor();
      await eventually(page, () => /[1-9]/.test(document.querySelector(".array-label .figure").textContent));
      await page.locator("[data-role=suit]").focus();
      await page.keyboard.press("ArrowLeft");
      await label.click();
      await page.locator("[data-view=array]").waitFor();
    });
  });

  it("of health tells rates and faults", async () => {
    await shown(loop(), "health", async (page) => {
      await eventually(page, () => parseFloat(document.querySelector("[data-field=rate]")?.textContent) > 100);
      await page.locator("[data-role=faults] > li").first().waitFor();
    });
  });
});

describe("the bar", () => {
  it("records, tares and sets thresholds", async () => {
    await shown(loop(), "array", async (page) => {
      await page.click("[data-role=record]");
      await page.locator("[data-role=record][aria-pressed=true]").waitFor();
      await eventually(page, () => document.querySelector("[data-role=recording-file]").textContent.endsWith(".mcap"));
      await page.click("[data-role=record]");
      await page.locator("[data-role=record][aria-pressed=false]").waitFor();
      await tareAnyway(page);
      await page.click("[data-role=show-thresholds]");
      const force = page.locator("[data-parameter='/contacts/onset_force_n']");
      await force.fill("0.75");
      await force.press("Tab");
      const other = await openPage(browser, page.url());
      await eventually(
        other,
        () => document.querySelector("[data-parameter='/contacts/onset_force_n']").value === "0.75",
      );
      await other.close();
    });
  });
});

describe("the connection", () => {
  it("says that the token is wrong and takes the right one", async () => {
    const server = await bench.serve("--port", "0", "--token", "right-one", ...loop());
    try {
      const page = await openPage(browser, `${server.url}?token=wrong`);
      await becomes(page, "wrong token");
      await page.fill("#token", "right-one");
      await page.keyboard.press("Enter");
      await becomes(page, "live");
      assert.ok(page.url().includes("token=right"));
      await page.close();
    } finally {
      await server.stop();
    }
  });

  it("survives a server that ends and comes again", async () => {
    const port = String(await freePort());
    let server = await bench.serve("--port", port, ...loop());
    try {
      const page = await openPage(browser, server.url);
      await page.locator("[data-contact]").first().waitFor();
      await server.stop();
      await becomes(page, "retrying");
      server = await bench.serve("--port", port, ...loop());
      await becomes(page, "live");
      const before = await page.locator("[data-view=array]").getAttribute("data-stamp");
      await eventually(page, (stamp) => document.querySelector("[data-view=array]").dataset.stamp !== stamp, before);
      assertUnhurt(page);
      await page.close();
    } finally {
      await server.stop();
    }
  });

  it("comes back 100 times and keeps nothing of the times before", async () => {
    await shown(loop(), "array", async (page) => {
      const again = (times) =>
        page.evaluate(async (wanted) => {
          const root = document.documentElement;
          for (let time = 0; time < wanted; ++time) {
            document.querySelector("[data-role=connection]").click();
            while (root.dataset.connection !== "live") await new Promise((done) => setTimeout(done, 5));
          }
        }, times);
      const client = await page.context().newCDPSession(page);
      await client.send("Performance.enable");
      const counts = async () => {
        await client.send("HeapProfiler.collectGarbage");
        await page.waitForTimeout(300);
        await client.send("HeapProfiler.collectGarbage");
        const { metrics } = await client.send("Performance.getMetrics");
        return Object.fromEntries(metrics.map(({ name, value }) => [name, value]));
      };
      await again(10);
      const early = await counts();
      await again(100);
      const late = await counts();
      assert.equal(late.JSEventListeners, early.JSEventListeners);
      assert.ok(late.Nodes <= early.Nodes + 250, `${early.Nodes} to ${late.Nodes} nodes`);
      const growth = late.JSHeapUsedSize - early.JSHeapUsedSize;
      assert.ok(growth < 500000, `the heap grew by ${growth} bytes`);
    });
  });
});
