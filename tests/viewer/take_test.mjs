// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node take_test.mjs path/to/dermis
// What a user takes along from the page, and what pages tell that come later or look on.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { it } from "node:test";
import {
  assertUnhurt,
  becomes,
  bench,
  browser,
  eventually,
  openPage,
  part,
  readCsv,
  shown,
  useBench,
  WAIT_MS,
} from "./harness.mjs";

const LIVE = ["--from", "sim:contacts?rate=100&frames=300"];

useBench();

const words = (page, role, text) => page.locator(`[data-role=${role}]`, { hasText: text }).waitFor();

const served = (command, look) => shown([...command, ...bench.model], "array", look);

/** The bytes that the browser saves when a button is pressed, and their name; newtons beside a table may come first. */
async function saved(page, role) {
  const isAsked = (download) => !download.suggestedFilename().endsWith("-newtons.csv");
  const [download] = await Promise.all([page.waitForEvent("download", isAsked), part(page, role).click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

it("records under a name, shows the size as it grows, plays the recording and saves it", async () => {
  await served(LIVE, async (page) => {
    await page.keyboard.press("s");
    await page.locator("#recording-name").fill("walk");
    await part(page, "begin-recording").click();
    const row = page.locator("[data-recording='walk.mcap']");
    await row.getByText("is being recorded").waitFor();
    const size = row.locator("[data-field=size]");
    const first = await size.textContent();
    await page.waitForFunction(
      (before) => document.querySelector("[data-recording='walk.mcap'] [data-field=size]").textContent !== before,
      first,
      { timeout: WAIT_MS },
    );
    const told = words(page, "notice", new RegExp(`recorded \\d+ frames: ${bench.path("walk.mcap")}`)); // for 8 s
    await part(page, "begin-recording").click();
    await told;
    await row.getByText("Play it").waitFor();
    await page.locator(".recording-list", { hasText: `Folder: ${bench.folder}` }).waitFor();
    await part(page, "begin-recording").click();
    await words(page, "take-words", "walk.mcap is there already");

    const [download] = await Promise.all([page.waitForEvent("download"), row.locator("[data-act=download]").click()]);
    assert.equal(download.suggestedFilename(), "walk.mcap");
    assert.deepEqual(readFileSync(await download.path()), readFileSync(bench.path("walk.mcap")));

    const [player] = await Promise.all([page.context().waitForEvent("page"), row.getByText("Play it").click()]);
    player.setDefaultTimeout(WAIT_MS);
    await becomes(player, "live");
    await part(player, "transport").waitFor();
    await words(player, "highest-taxel", /N\s+r\d+c\d+/);
    await player.close();
    assert.ok(await part(page, "transport").isHidden(), "the page itself stays live");
  });
});

it("saves the last minute of all arrays as a recording and of one as a table", async () => {
  await served(LIVE, async (page) => {
    await words(page, "highest-taxel", /N\s+r\d+c\d+/);
    await part(page, "show-take").click();
    await part(page, "minute-length").selectOption("60");
    const recording = await saved(page, "save-mcap");
    assert.match(recording.name, /^cut-\d{8}-\d{6}-\d{3}\.mcap$/);
    assert.deepEqual(recording.bytes, readFileSync(bench.path(recording.name)));
    execFileSync(bench.binary, ["info", bench.path(recording.name)], { stdio: ["ignore", "ignore", "pipe"] });
    const table = await saved(page, "save-csv");
    assert.match(table.name, /^small-.*\.csv$/);
    const rows = readCsv(bench.path(table.name));
    assert.ok(rows.length > 1);
    assert.deepEqual(Object.keys(rows[0]).filter((column) => column.startsWith("r")).length, 20);
    await words(page, "take-words", `${rows.length} frames`);
    const newtons = readCsv(bench.path(table.name.replace(".csv", "-newtons.csv")));
    assert.equal(newtons.length, rows.length);
    assert.ok(newtons.some((row) => Number(row.r0c0) > 0 || Number(row.r3c4) > 0 || Number(row.r2c2) > 0));
    await words(page, "take-words", "-newtons.csv");
  });
});

it("saves a picture and a film that a browser can read", async () => {
  await served(LIVE, async (page) => {
    await part(page, "show-take").click();
    for (const [role, type, magic] of [
      ["save-png", "image/png", "\x89PNG"],
      ["save-gif", "image/gif", "GIF89a"],
    ]) {
      const { name, bytes } = await saved(page, role);
      assert.match(name, /^small-\d{8}-\d{6}\.(png|gif)$/);
      assert.equal(bytes.toString("latin1", 0, magic.length), magic);
      const [width, height] = await page.evaluate(
        async ([data, mime]) => {
          const image = new Image();
          image.src = `data:${mime};base64,${data}`;
          await image.decode();
          return [image.naturalWidth, image.naturalHeight];
        },
        [bytes.toString("base64"), type],
      );
      assert.ok(width > 200 && height > 200, `${width} x ${height}`);
    }
  });
});

it("opens a playback that is paused on its frame, and says so", async () => {
  await served(["--from", bench.path("recording.mcap")], async (page, server) => {
    await words(page, "highest-taxel", /N\s+r\d+c\d+/);
    await part(page, "play").click();
    await words(page, "connection", "Paused");
    const highest = (of) => part(of, "highest-taxel").textContent();
    for (let time = 0; time < 2; ++time) {
      const other = await openPage(browser, server.url);
      await words(other, "connection", "Paused");
      // Frames that were under way when it paused may still come.
      const end = Date.now() + WAIT_MS;
      while ((await highest(other)) !== (await highest(page)) && Date.now() < end) await other.waitForTimeout(50);
      assert.equal(await highest(other), await highest(page));
      assertUnhurt(other);
      await other.close();
    }
    await part(page, "show-take").click();
    assert.ok((await saved(page, "save-png")).bytes.length > 1000, "a picture of the frame that stands still");
  });
});

/** A minute of the first frame of the contacts, 50 times a second. */
function heldFrames() {
  const [head, first] = readFileSync(bench.path("contacts/frames.csv"), "utf8").split("\n");
  const readings = first.slice(first.indexOf(","));
  const lines = Array.from({ length: 3000 }, (_, index) => `${0.02 * index}${readings}`);
  writeFileSync(bench.path("held.csv"), [head, ...lines, ""].join("\n"));
  bench.run("convert", bench.path("held.csv"), bench.path("held.mcap"), "--array", bench.path("array.toml"));
  return bench.path("held.mcap");
}

/** In the page: where its parts are. */
function boxesOfThePage() {
  const parts = [".bar", ".bar *", ".toolbar", ".maps", ".map-plot", ".readouts > *"];
  return parts.flatMap((part) =>
    [...document.querySelectorAll(part)].map((one) => {
      const { x, y, width, height } = one.getBoundingClientRect();
      return `${part} ${[x, y, width, height].map(Math.round).join(" ")}`;
    }),
  );
}

/** In the page: keeps all that the button says. */
function hearTareButton() {
  const button = document.querySelector("[data-role=tare]");
  window.said = [];
  new MutationObserver(() => window.said.push(button.textContent)).observe(button, {
    subtree: true,
    childList: true,
    characterData: true,
  });
}

it("refuses a tare under a load, takes it where that is said again, and takes it back", async () => {
  await served(["--from", heldFrames()], async (page) => {
    const force = async () => parseFloat(await part(page, "total-force").innerText());
    await eventually(page, () => parseFloat(document.querySelector("[data-role=total-force]").textContent) > 1);
    const before = await force();
    const boxes = await page.evaluate(boxesOfThePage);
    await page.evaluate(hearTareButton);
    await part(page, "tare").click();
    await words(page, "tare-refused", /^Not tared\. small: .* reads? .* N: take it off and tare again$/);
    await page.locator("[data-role=tare][aria-pressed=false]", { hasText: /^Tare$/ }).waitFor();
    assert.deepEqual(await page.evaluate(boxesOfThePage), boxes);
    assert.ok(!(await page.evaluate(() => window.said)).includes("Tared"), "before the server agreed");
    assert.equal(await page.locator("p:visible, li:visible", { hasText: /take it off and tare again/ }).count(), 1);
    await part(page, "tare-leave").click();
    await part(page, "tare-banner").waitFor({ state: "hidden" });
    await part(page, "tare").click();
    await part(page, "tare-banner").waitFor();
    assert.ok(Math.abs((await force()) - before) < 0.05 * before);
    await part(page, "tare-force").click();
    await words(page, "notice", /small was tared by .*: the tare takes .* N on .* as zero/);
    await part(page, "tare-banner").waitFor({ state: "hidden" });
    await eventually(
      page,
      (most) => parseFloat(document.querySelector("[data-role=total-force]").textContent) < most,
      0.1 * before,
    );
    await part(page, "undo-tare").click();
    await eventually(
      page,
      (least) => parseFloat(document.querySelector("[data-role=total-force]").textContent) > least,
      0.9 * before,
    );
    await part(page, "undo-tare").waitFor({ state: "hidden" });
  });
});

it("tells everybody who has tared", async () => {
  await served(["--from", "sim:idle?rate=100&frames=300"], async (page, server) => {
    const other = await openPage(browser, server.url);
    await becomes(other, "live");
    await page.keyboard.press("t");
    await words(other, "notice", /small was tared by 127\.0\.0\.1:\d+/);
    await part(other, "show-thresholds").click();
    await words(other, "tare-log", /UTC: small was tared by 127\.0\.0\.1:\d+/);
    assertUnhurt(other);
    await other.close();
  });
});
