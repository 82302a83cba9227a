// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node recognition_test.mjs path/to/dermis
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { it } from "node:test";
import { bench, eventually, shown, useBench } from "./harness.mjs";

const [ROWS, COLS] = [4, 5];
const LIMITS = `[[zone]]
name = "edge"
array = "small"
rows = [0, 1]
cols = [1, 3]

[[threat]]
name = "edge"
quantity = "taxel_pressure"
limit_kpa = 5
zone = "edge"
latched = true

[[threat]]
name = "pushed"
quantity = "total_force"
limit_n = 1000
`;

/** Floats as numpy.save writes them. */
function writeNpy(path, rows) {
  const header = Buffer.from(
    `{'descr': '<f4', 'fortran_order': False, 'shape': (${rows.length}, ${rows[0].length}), }\n`,
  );
  const length = Buffer.alloc(2);
  length.writeUInt16LE(header.length);
  const numbers = Buffer.from(Float32Array.from(rows.flat()).buffer);
  writeFileSync(path, Buffer.concat([Buffer.from("\x93NUMPY\x01\x00", "latin1"), length, header, numbers]));
}

/** Classes of presses on single taxels: "upper", "left" and "right". */
function learn() {
  const places = Array.from({ length: 40 }, (_, press) => [press % ROWS, Math.floor(press / ROWS) % COLS]);
  writeNpy(
    bench.path("frames.npy"),
    places.map(([row, col], press) =>
      Array.from({ length: ROWS * COLS }, (_, taxel) => (taxel === row * COLS + col ? 2 + press / 10 : 0)),
    ),
  );
  writeFileSync(bench.path("arrays.csv"), `array,rows,cols,first_column\nskin,${ROWS},${COLS},0\n`);
  const classOf = ([row, col]) => (row < 2 ? "upper" : col < 2 ? "left" : "right");
  writeFileSync(
    bench.path("labels.csv"),
    ["id,first,last,class", ...places.map((place, press) => `t${press},${press},${press},${classOf(place)}`), ""].join(
      "\n",
    ),
  );
  bench.run(
    "recognise",
    "learn",
    "--frames",
    bench.path("frames.npy"),
    "--arrays",
    bench.path("arrays.csv"),
    "--labels",
    bench.path("labels.csv"),
    "--out",
    bench.path("classes.safetensors"),
  );
}

useBench(() => {
  learn();
  writeFileSync(bench.path("threats.toml"), LIMITS);
});

const showContacts = (view, test, ...options) =>
  shown(["--from", "sim:contacts?rate=200", ...bench.model, ...options], view, test);

const served = () => ["--classes", bench.path("classes.safetensors"), "--threats", bench.path("threats.toml")];

it("shows a bar for each class, the answer, and unknown with its reason", async () => {
  await showContacts(
    "recognition",
    async (page) => {
      await eventually(page, () =>
        ["upper", "left", "right"].includes(document.querySelector("[data-role=answer]").textContent),
      );
      await eventually(page, () => {
        const bars = [...document.querySelectorAll("[data-role=class-bars] li")];
        const answer = document.querySelector("[data-role=answer]").textContent;
        const width = (bar) =>
          bar.querySelector(".class-fill").getBoundingClientRect().width /
          bar.querySelector(".class-track").getBoundingClientRect().width;
        const widest = bars.reduce((a, b) => (width(b) > width(a) ? b : a));
        const total = bars.reduce((sum, bar) => sum + parseFloat(bar.querySelector(".figure").textContent), 0);
        return (
          bars.length === 3 &&
          Math.abs(total - 100) < 0.5 &&
          widest.dataset.class === answer &&
          widest.dataset.answer === "true" &&
          width(widest) > 0.3
        );
      });
      await eventually(page, () => {
        const reason = document.querySelector("[data-role=reason]").textContent;
        return (
          document.querySelector("[data-role=answer]").textContent === "unknown" &&
          /^(unlike the examples|between classes: )/.test(reason)
        );
      });
      assert.equal(await page.locator("[data-role=class-bars] li").count(), 3);
    },
    ...served(),
  );
});

it("warns of a threat above every view, logs it, and resets one that is latched", async () => {
  await showContacts(
    "time",
    async (page) => {
      await page.locator("[data-role=last-event]").evaluate((line) => {
        window.said = "";
        new MutationObserver(() => (window.said += `${line.textContent}\n`)).observe(line, {
          subtree: true,
          childList: true,
          characterData: true,
        });
      });
      const banner = page.locator("[data-role=threat-banner]");
      await banner.waitFor();
      assert.match(
        await banner.textContent(),
        /edge \(small, edge\): taxel pressure (was )?\d+\.\d kPa, limit 5\.0 kPa/,
      );
      await banner.getByText("Reset").click();
      await eventually(page, () => /^last: edge( over)?, /m.test(window.said));
      await page.click("[data-tab=recognition]");
      await eventually(page, () =>
        /threat/.test(document.querySelector("[data-limit=edge] [data-field=state]")?.textContent),
      );
      assert.equal(await page.locator("[data-limit=pushed] [data-field=state]").textContent(), "below");
      assert.match(
        await page.locator("[data-role=threat-log] li").last().textContent(),
        /^\d\d:\d\d:\d\d\.\d{3}edgesmall: \d+\.\d kPa, limit 5\.0 kPa$/,
      );
      await page.click("[data-role=reset-threats]");
      await page.locator("[data-role=threat-log] li[data-level=good]").first().waitFor();
    },
    ...served(),
  );
});

it("frames the zones of limits on the map of forces", async () => {
  await showContacts(
    "array",
    async (page) => {
      const zone = page.locator("[data-zone=edge]");
      await zone.waitFor({ state: "attached" });
      assert.equal(await page.locator(".zone").count(), 1);
      assert.equal(await zone.textContent(), "edge  5.0 kPa");
      // The banner comes and goes above the map, which is laid out anew in the next frame.
      await eventually(page, () => {
        const [box, plot] = [".zone", "section[aria-label='Force map'] .map-plot"].map((part) =>
          document.querySelector(part).getBoundingClientRect(),
        );
        const isInside = box.left > plot.left && box.right < plot.right && box.top >= plot.top - 1;
        return Math.abs(box.width / box.height - 3 / 2) < 0.02 && isInside && box.height > 0.3 * plot.height;
      });
    },
    ...served(),
  );
});

it("fits on a telephone", async () => {
  await showContacts(
    "recognition",
    async (page) => {
      await page.setViewportSize({ width: 390, height: 844 });
      await page.locator("[data-role=threat-banner]").waitFor();
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390);
    },
    ...served(),
  );
});

it("says how classes and limits are served where there are none", async () => {
  await showContacts("recognition", async (page) => {
    await page.getByText("dermis serve --classes").waitFor();
    await page.getByText("dermis serve --threats").waitFor();
    assert.ok(await page.locator("[data-role=threat-banner]").isHidden());
  });
});
