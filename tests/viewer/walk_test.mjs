// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node walk_test.mjs path/to/dermis
// From nothing to newtons, with a mat that sends CSV, one that sends JSON, the simulator, and a recording: in few actions, and
// at every step each sentence on the page is true.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, it } from "node:test";
import { assertUnhurt, Bench, becomes, openBrowser, openPage, VIEWS } from "./harness.mjs";

const MOST_ACTIONS = 12;
const FIT_MS = 240_000;
const DONE = 4; // CalibrationStage.done
const ROWS = 12;
const COLS = 10;

let browser;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "dermis-walk-"));
  browser = await openBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const serve = (...command) =>
  Bench.prototype.serve.call({ binary: process.argv[2], folder }, "--port", "0", ...command);
const part = (page, role) => page.locator(`[data-role=${role}]`);

/** A mat of conductive rubber whose columns are read over 200 ohm while the other rows are grounded. */
class Mat {
  pressed = new Map();
  #sockets = new Set();

  constructor(format) {
    this.server = createServer((socket) => {
      const begin = Date.now();
      const timer = setInterval(() => socket.destroyed || socket.write(format(this.#counts(), Date.now() - begin)), 10);
      this.#sockets.add(socket);
      socket.on("error", () => undefined).on("close", () => clearInterval(timer));
    });
  }

  async listen() {
    await new Promise((listening) => this.server.listen(0, "127.0.0.1", listening));
    return `127.0.0.1:${this.server.address().port}`;
  }

  close() {
    this.server.close();
    for (const socket of this.#sockets) socket.destroy();
  }

  #counts() {
    const siemens = Array.from(
      { length: ROWS * COLS },
      (_, taxel) => 5e-6 + (this.pressed.has(taxel) ? 1.1e-3 * (this.pressed.get(taxel) / 10) ** 0.9 : 0),
    );
    const sums = Array.from({ length: COLS }, (_, col) =>
      siemens.reduce((sum, one, taxel) => (taxel % COLS === col ? sum + one : sum), 1 / 200),
    );
    return siemens.map((one, taxel) => Math.round((4095 * one) / sums[taxel % COLS] + Math.random() - 0.5));
  }
}

const csv = (counts, millis) => `${1000 + millis},${counts.join(",")}\r\n`;
const json = (counts) =>
  `${JSON.stringify(Array.from({ length: ROWS }, (_, row) => counts.slice(COLS * row, COLS * (row + 1))))}\n`;

const taxelOf = (name) => {
  const [, row, col] = /r(\d+)c(\d+)/.exec(name);
  return COLS * Number(row) + Number(col);
};

/** Does with the mat what the page says, until there is a model: a first fit may ask for pairs of taxels. */
async function obey(page, mat) {
  const end = Date.now() + FIT_MS;
  for (
    let stage = 0;
    stage < DONE && Date.now() < end;
    stage = Number(await part(page, "walk").getAttribute("data-stage"))
  ) {
    const said = await part(page, "instruction").textContent();
    const press = /put ([\d.]+) N .*? on (r\d+c\d+)(?: and as much on (r\d+c\d+))?/i.exec(said);
    if (press !== null)
      mat.pressed = new Map([press[2], press[3]].filter(Boolean).map((name) => [taxelOf(name), Number(press[1])]));
    else if (!/[Hh]old/.test(said)) mat.pressed.clear();
    await page.waitForTimeout(20);
  }
}

/** What must not be on the page, by what is so. */
const NEVER = [/undefined/, /NaN/, /\[object/, /\bnull\b/, /\u2013 N\b.*\u2013 N\b.*\u2013 N\b/];
const UNTRUE = {
  asking: [/\bLive\b/, /\bPaused\b.*Waiting/],
  uncalibrated: [
    /(?<!\u2013 )\b\d+\.\d+ N\b/,
    /Nothing touches this array/,
    /\bTared\b/,
    /dead since calibration/,
    /\bhealthy\b/,
  ],
  calibrated: [/not calibrated/i, /calibrate first/],
  untouched: [/^#\d+ /m],
};

async function isTrue(page, ...states) {
  const said = await page.evaluate(() => document.body.innerText);
  for (const untrue of [...NEVER, ...states.flatMap((state) => UNTRUE[state])])
    assert.doesNotMatch(said, untrue, `${states}: ${said}`);
}

/** The same of every view, as somebody else sees them. */
async function isTrueEverywhere(server, ...states) {
  const page = await openPage(browser, server.url);
  await becomes(page, "live");
  for (const view of VIEWS.filter((name) => name !== "calibration")) {
    await page.locator(`[data-tab=${view}]`).click();
    await page.waitForTimeout(500);
    await isTrue(page, ...states);
    assert.equal(await part(page, "connection").textContent(), "Live");
  }
  assertUnhurt(page);
  await page.close();
}

/** A person at the page, whose actions are counted. */
class Person {
  actions = 0;

  constructor(page) {
    this.page = page;
  }

  async does(action) {
    this.actions += 1;
    await action;
  }
}

/** From the question which array it is to newtons. */
async function calibrate(person, server, mat) {
  const { page } = person;
  await part(page, "array-setup").waitFor();
  await part(page, "live-picture").waitFor();
  await isTrue(page, "asking");
  await person.does(page.locator("[data-role=array-setup] button[type=submit]").click());
  await part(page, "uncalibrated").waitFor();
  await becomes(page, "live");
  await isTrueEverywhere(server, "uncalibrated");
  await person.does(part(page, "calibrate").click());
  await person.does(part(page, "weights").fill("2, 5, 20"));
  await person.does(part(page, "hold").fill("0.1"));
  await person.does(part(page, "start").click());
  await part(page, "walk").waitFor();
  if (mat !== undefined) await obey(page, mat);
  await page.locator(`[data-role=walk][data-stage='${DONE}']`).waitFor({ timeout: FIT_MS });
  await isTrue(page);
  await person.does(part(page, "save").click());
  await page.locator("[data-role=instruction]", { hasText: "in use" }).waitFor();
  await person.does(page.locator("[data-tab=array]").click());
  await page.locator("section[aria-label='Force map']").waitFor();
}

async function walk(choose, mat, check) {
  const server = await serve();
  try {
    const page = await openPage(browser, server.url);
    const person = new Person(page);
    await part(page, "source-setup").waitFor();
    await isTrue(page, "asking");
    await choose(person);
    await calibrate(person, server, mat);
    await isTrueEverywhere(server, "calibrated");
    await check?.(page);
    assert.ok(person.actions <= MOST_ACTIONS, `${person.actions} actions`);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    mat?.close();
  }
}

for (const [name, format] of [
  ["CSV", csv],
  ["JSON", json],
]) {
  it(`leads a ${name} mat on the network to newtons, and says nothing untrue`, async () => {
    const mat = new Mat(format);
    const address = await mat.listen();
    const choose = async (person) => {
      await person.does(person.page.locator("#address").fill(address));
      await person.does(part(person.page, "network").locator("button").click());
    };
    await walk(choose, mat, async (page) => {
      await page.locator("[aria-label=Contacts]", { hasText: "Nothing touches this array." }).waitFor();
      await isTrue(page, "calibrated", "untouched");
      mat.pressed.set(taxelOf("r4c4"), 8);
      await page.waitForFunction(() => parseFloat(document.querySelector("[data-role=total-force]").textContent) > 4);
      await page.waitForTimeout(500);
      const [, newtons, taxel] = /([\d.]+) N +(r\d+c\d+)/.exec(await part(page, "highest-taxel").textContent());
      assert.equal(taxel, "r4c4");
      assert.ok(Math.abs(Number(newtons) - 8) < 2, newtons);
      mat.close();
      await page.locator("[data-role=connection]", { hasNotText: "Live" }).waitFor({ timeout: 4000 });
    });
  });
}

it("leads somebody with nothing but the simulator to newtons, and says nothing untrue", async () => {
  await walk((person) => person.does(person.page.locator("[data-source=rehearsal]").click()));
});

it("shows the newtons of a recording with a model from last time in two actions", async () => {
  const bench = new Bench(process.argv[2]);
  const server = await bench.serve("--port", "0");
  try {
    const page = await openPage(browser, server.url);
    const person = new Person(page);
    await part(page, "source-setup").waitFor();
    await isTrue(page, "asking");
    await person.does(page.locator("[data-role=source-setup] [data-known='model.safetensors']").click());
    await person.does(page.locator("[data-source='recording.mcap']").click());
    await page.locator("section[aria-label='Force map']").waitFor();
    await page.locator("[data-role=connection]", { hasText: "Playing" }).waitFor();
    await isTrue(page, "calibrated");
    assert.ok(person.actions <= MOST_ACTIONS, `${person.actions} actions`);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    bench.close();
  }
});
