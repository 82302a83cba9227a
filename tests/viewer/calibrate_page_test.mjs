// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node calibrate_page_test.mjs path/to/dermis
// The guided calibration in the page of site/try, by the hand that obeys the guide; and what the command makes of the
// files that it writes.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, renameSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { it } from "node:test";
import { gzipSync } from "node:zlib";
import { assertUnhurt, becomes, eventually, openPage, part, readCsv } from "./harness.mjs";
import { saved, site, useSite } from "./try_page.mjs";

const WEIGHTS = [1, 4, 10];
const PRESSES = 48;
const LEAST_N = 1e-3;
/** Products and sums are rounded otherwise in the page, and a training ends a little elsewhere. */
const MOST_RELATIVE = 1e-4;
const KINDS = ["safetensors", "array.toml", "frames.csv", "loads.csv"];

useSite();

/** The place of a file of the page, saved as its user does. */
const savedFile = (page, ending) =>
  saved(page, page.locator(`[data-role=files] li[data-file$='${ending}']`).getByRole("button", { name: /^Save/ }));

async function openRehearsal() {
  const page = await openPage(site.browser, "about:blank");
  await page.goto(`${site.url}?rehearsal#/calibration`);
  await becomes(page, "live");
  return page;
}

async function start(page) {
  await part(page, "weights").fill(WEIGHTS.join(", "));
  await part(page, "hold").fill("0.1");
  await part(page, "quiet").fill("0.4");
  await part(page, "start").click();
}

const instruction = (page, hasText) => page.locator("[data-role=instruction]", { hasText });

async function reaches(page, presses) {
  await eventually(page, (least) => document.querySelector("[data-role=progress]").value >= least, presses);
}

/** The greatest difference of two tables of forces, relative, of those beyond a millinewton. */
function apart(some, others) {
  assert.equal(some.length, others.length);
  const differences = some.flatMap((row, number) =>
    Object.keys(row)
      .filter((name) => /^r\d+c\d+$/.test(name) && Math.abs(Number(row[name])) > LEAST_N)
      .map((name) => Math.abs(Number(others[number][name]) / Number(row[name]) - 1)),
  );
  assert.ok(differences.length >= PRESSES, `${differences.length} forces`);
  return Math.max(...differences);
}

/** Newtons of the model that the page saved, and of the command's own calibration of what the page measured. */
function compare(folder) {
  const dermis = (...command) =>
    execFileSync(resolve(process.argv[2]), command, { stdio: ["ignore", "ignore", "pipe"] });
  const file = (name) => join(folder, name);
  const data = ["--frames", file("frames.csv"), "--loads", file("loads.csv")];
  dermis("calibrate", "--array", file("array.toml"), ...data, "--out", file("own.safetensors"));
  return apart(
    ...["own", "page"].map((name) => {
      const model = file(name === "own" ? "own.safetensors" : "safetensors");
      dermis("run", "--model", model, "--in", file("frames.csv"), "--out", file(`${name}.csv`));
      return readCsv(file(`${name}.csv`));
    }),
  );
}

it("leads from a sheet without a model to newtons, and the command makes the same model of what was measured", async () => {
  const page = await openRehearsal();
  await start(page);
  await reaches(page, 10);
  await instruction(page, /^Fitting \d+ presses/).waitFor();
  await instruction(page, /^\d+ presses of 1 to 10 N\..*median error \d+\.\d %/).waitFor();
  await part(page, "save").click();
  await instruction(page, /Saved as \S+\.safetensors and in use/).waitFor();
  const name = /Saved as (\S+)\.safetensors/.exec(await part(page, "instruction").textContent())[1];
  const folder = mkdtempSync(join(tmpdir(), "dermis-page-"));
  try {
    await part(page, "files").locator("summary").click();
    for (const kind of KINDS) renameSync(await savedFile(page, `/${name}.${kind}`), join(folder, kind));
    const relative = compare(folder);
    console.log(`the page's model beside the command's own: forces ${relative.toExponential(1)} apart, relative`);
    assert.ok(relative < MOST_RELATIVE, `${relative}`);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
  await page.evaluate(() => {
    location.hash = "#/array";
  });
  await eventually(page, () => / N/.test(document.querySelector("[data-view=array]")?.textContent ?? ""));
  assertUnhurt(page);
  await page.close();
});

it("leaves a fit off at once when it is cancelled, and calibrates again", async () => {
  const page = await openRehearsal();
  await start(page);
  await reaches(page, 9);
  await part(page, "cancel").click();
  await part(page, "forget").click();
  await part(page, "setup").waitFor();
  await start(page);
  await reaches(page, 12);
  await part(page, "finish").click();
  await instruction(page, /^Fitting \d+ presses/).waitFor();
  await part(page, "cancel").click();
  await part(page, "setup").waitFor();
  await start(page);
  await reaches(page, 9);
  await part(page, "finish").click();
  await instruction(page, /^\d+ presses of 1 to 10 N\./).waitFor();
  assertUnhurt(page);
  await page.close();
});

it("says that a fit could not be done, and saves what was measured", async () => {
  const worker = [...site.packed.keys()].find((path) => path.includes("fit_worker"));
  const whole = site.packed.get(worker);
  site.packed.set(worker, gzipSync("throw new Error('no room')"));
  const page = await openRehearsal();
  await start(page);
  await reaches(page, 9);
  await part(page, "finish").click();
  await instruction(page, /^The fit was not done: its worker ended/).waitFor();
  await part(page, "save").click();
  await page.locator("[data-role=problem]", { hasText: /what was measured is in \S+\.frames\.csv/ }).waitFor();
  site.packed.set(worker, whole);
  await page.close();
});
