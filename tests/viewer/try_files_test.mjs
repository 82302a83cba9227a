// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node try_files_test.mjs path/to/dermis
// The files of the page of site/try: what is recorded there leaves it as the command's own, and is there again later.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { it } from "node:test";
import { assertUnhurt, becomes, openPage, part, readCsv } from "./harness.mjs";
import { saved, site, useSite } from "./try_page.mjs";

const binary = resolve(process.argv[2]);
const dermis = (...command) => execFileSync(binary, command, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
const info = (file) => JSON.parse(dermis("info", file, "--json"));

useSite();

async function live(context) {
  const page = await openPage(context, site.url);
  await becomes(page, "live");
  return page;
}

async function record(page, name) {
  await page.keyboard.press("s");
  await page.locator("#recording-name").fill(name);
  await part(page, "begin-recording").click();
  await page.locator(`[data-recording='${name}.mcap']`).getByText("is being recorded").waitFor();
}

async function end(page) {
  const told = page.locator("[data-role=notice]", { hasText: /recorded \d+ frames/ });
  await part(page, "begin-recording").click();
  return Number(/recorded (\d+) frames/.exec(await told.textContent())[1]);
}

const row = (page, name) => page.locator(`[data-recording='${name}']`);

/** Until the recording has more bytes than that. */
async function grows(page, name, kilobytes) {
  const size = row(page, name).locator("[data-field=size]");
  for (let have = 0; have < kilobytes; have = Number.parseFloat(await size.textContent()))
    await page.waitForTimeout(200);
}

it("records every frame, and the command reads the download", async () => {
  const context = await site.browser.newContext();
  const page = await live(context);
  await record(page, "walk");
  await grows(page, "walk.mcap", 100);
  const frames = await end(page);
  const file = await saved(page, row(page, "walk.mcap").locator("[data-act=download]"));
  const { complete, frames: read, lost, compression } = info(file);
  assert.deepEqual(
    { complete, read, lost, compression },
    { complete: true, read: frames, lost: 0, compression: "none" },
  );
  const forces = join(site.folder, "forces.csv");
  dermis("run", "--model", join(site.folder, "sheet.model"), "--in", file, "--out", forces);
  assert.equal(readCsv(forces).length, frames);
  const table = join(site.folder, "walk.csv");
  dermis("convert", file, table);
  assert.equal(readCsv(table).length, frames);
  assertUnhurt(page);
  await context.close();
});

it("saves the last minute, as the server does", async () => {
  const context = await site.browser.newContext();
  const page = await live(context);
  await page.keyboard.press("s");
  const recording = await saved(page, part(page, "save-mcap"));
  assert.ok(info(recording).frames > 0);
  await context.close();
});

it("has a recording again whose tab was closed", async () => {
  const context = await site.browser.newContext();
  const first = await live(context);
  await record(first, "cut-off");
  await grows(first, "cut-off.mcap", 100);
  await first.close();
  const page = await live(context);
  await page.keyboard.press("s");
  const file = await saved(page, row(page, "cut-off.mcap").locator("[data-act=download]"));
  const mended = join(site.folder, "mended.mcap");
  dermis("info", "recover", file, "--out", mended);
  assert.ok(info(mended).frames > 40);
  assertUnhurt(page);
  await context.close();
});

it("tells a second tab that another has the files", async () => {
  const context = await site.browser.newContext();
  const first = await live(context);
  await record(first, "alone");
  const second = await live(context);
  await part(second, "files-note").filter({ hasText: "Another tab of this page has its files." }).waitFor();
  assert.ok((await end(first)) > 0);
  await first.close();
  await context.close();
});

it("removes a file that nothing has open, once the user has confirmed it", async () => {
  const context = await site.browser.newContext();
  const page = await live(context);
  page.on("dialog", (dialog) => dialog.accept());
  await record(page, "old");
  await page.keyboard.press("Escape");
  await page.getByText("Files of this page").click();
  const remove = page.getByRole("button", { name: "Remove old.mcap" });
  await remove.click();
  await part(page, "files-note").filter({ hasText: "recordings/old.mcap is in use." }).waitFor();
  await page.keyboard.press("s");
  await end(page);
  await page.keyboard.press("Escape");
  await remove.click();
  await remove.waitFor({ state: "detached" });
  await page.reload();
  await becomes(page, "live");
  await page.keyboard.press("s");
  await part(page, "begin-recording").waitFor();
  assert.equal(await row(page, "old.mcap").count(), 0);
  assertUnhurt(page);
  await context.close();
});

const open = (page, ...path) => part(page, "chosen-file").setInputFiles(join(site.folder, ...path));
const told = (page, words) => part(page, "files-note").filter({ hasText: words }).waitFor();

/** A recording is played, and there is more than one frame of it. */
async function plays(page) {
  await part(page, "transport").waitFor();
  await page.locator("[data-contact]").first().waitFor();
}

it("plays what it has recorded, and goes back to what is live", async () => {
  const context = await site.browser.newContext();
  const page = await live(context);
  await record(page, "short");
  await grows(page, "short.mcap", 100);
  await end(page);
  await row(page, "short.mcap").getByText("Play it").click();
  await page.keyboard.press("Escape");
  await plays(page);
  await part(page, "go-live").click();
  await part(page, "transport").waitFor({ state: "hidden" });
  await becomes(page, "live");
  assertUnhurt(page);
  await context.close();
});

it("opens recordings, tables and models of the command, and says in one line what it cannot read", async () => {
  const here = (name) => join(site.folder, name);
  const array = ["--array", new URL("../../examples/chest/array.toml", import.meta.url).pathname];
  dermis("simulate", ...array, "--scene", "multitouch", "--frames", "300", "--out", here("contacts"));
  dermis("convert", here("contacts/frames.csv"), here("packed.mcap"), ...array);
  dermis("convert", here("contacts/frames.csv"), here("frames.npy"));
  writeFileSync(here("wrong.mcap"), "no recording");
  const context = await site.browser.newContext();
  const page = await live(context);
  await open(page, "wrong.mcap");
  await told(page, "wrong.mcap");
  await open(page, "packed.mcap"); // with lz4
  await plays(page);
  await part(page, "go-live").click();
  await part(page, "transport").waitFor({ state: "hidden" });
  await open(page, "frames.npy");
  await told(page, "frames.npy: does not say what array it is of; open its model or array.toml first");
  await open(page, "sheet.model");
  await becomes(page, "live");
  await open(page, "frames.npy");
  await plays(page);
  await part(page, "go-live").click();
  await part(page, "transport").waitFor({ state: "hidden" });
  await open(page, "contacts/frames.csv");
  await plays(page);
  assertUnhurt(page);
  await context.close();
});

it("ends a recording complete where the browser gives no more room, and says so", async () => {
  const context = await site.browser.newContext();
  const page = await live(context);
  await record(page, "full");
  const session = await context.newCDPSession(page);
  const { usage } = await session.send("Storage.getUsageAndQuota", { origin: new URL(site.url).origin });
  await session.send("Storage.overrideQuotaForOrigin", {
    origin: new URL(site.url).origin,
    quotaSize: usage + 300_000,
  });
  await page.locator("[data-role=notice]", { hasText: "the recording has ended: cannot write" }).first().waitFor();
  const file = await saved(page, row(page, "full.mcap").locator("[data-act=download]"));
  const { complete, frames } = info(file);
  assert.ok(complete && frames > 20, `${complete}, ${frames} frames`);
  assertUnhurt(page);
  await context.close();
});
