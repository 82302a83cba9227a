// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node walk_test.mjs path/to/dermis
// From nothing to newtons, with a mat that sends CSV, the simulator, and a recording: in few actions, and at every step each
// sentence on the page is true.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { it } from "node:test";
import {
  assertUnhurt,
  Bench,
  becomes,
  browser,
  folder,
  networkDevice,
  openPage,
  part,
  serveEmpty,
  useEmptyFolder,
  VIEWS,
} from "./harness.mjs";

const MOST_ACTIONS = 12;
const FIT_MS = 240_000;
const DONE = 4; // CalibrationStage.done
const ROWS = 12;
const COLS = 10;
/** What is there where a view has shown all that it has to say. */
const SHOWN = {
  array: "[data-role=highest-taxel]:not(:empty)",
  time: ".legend li:not(.absent)",
  suit: ".array-label",
  recognition: ".note:not([hidden]):not(:empty)",
  health: "[data-role=faults] > li",
};

useEmptyFolder();

/** A mat of conductive rubber whose columns are read over 200 ohm while the other rows are grounded. */
class Mat {
  pressed = new Map();

  static async sending(format) {
    const mat = new Mat();
    const begin = Date.now();
    return Object.assign(mat, await networkDevice(() => format(mat.#counts(), Date.now() - begin), 10));
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
    await page.locator(`[data-view=${view}] ${SHOWN[view]}`).first().waitFor();
    await page.locator("[data-role=connection]", { hasText: /^Live$/ }).waitFor();
    await isTrue(page, ...states);
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

/** From the question which array it is to its counts. */
async function describeArray(person) {
  const { page } = person;
  await part(page, "array-setup").waitFor();
  await part(page, "live-picture").waitFor();
  await isTrue(page, "asking");
  await person.does(page.locator("[data-role=array-setup] button[type=submit]").click());
  await part(page, "uncalibrated").waitFor();
  await becomes(page, "live");
}

/** From the counts to newtons. */
async function calibrate(person, weights, obey = () => {}) {
  const { page } = person;
  await person.does(part(page, "calibrate").click());
  await person.does(part(page, "weights").fill(weights));
  await person.does(part(page, "hold").fill("0.1"));
  await person.does(part(page, "start").click());
  await part(page, "walk").waitFor();
  await obey(page);
  await page.locator(`[data-role=walk][data-stage='${DONE}']`).waitFor({ timeout: FIT_MS });
  await isTrue(page);
  await person.does(part(page, "save").click());
  await page.locator("[data-role=instruction]", { hasText: "in use" }).waitFor();
  await person.does(page.locator("[data-tab=array]").click());
  await page.locator("section[aria-label='Force map']").waitFor();
}

const highest = (page, words) => page.locator("[data-role=highest-taxel]", { hasText: words }).waitFor();

/** The page from its first question on, with all that a person does there. */
async function walk(test) {
  const server = await serveEmpty();
  try {
    const page = await openPage(browser, server.url);
    const person = new Person(page);
    await part(page, "source-setup").waitFor();
    await isTrue(page, "asking");
    await test(person, server);
    assert.ok(person.actions <= MOST_ACTIONS, `${person.actions} actions`);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
  }
}

/** On the network, from its address to its counts. */
async function showCounts(person, mat) {
  const { page } = person;
  await person.does(page.locator("#address").fill(mat.address));
  await person.does(part(page, "network").locator("button").click());
  await part(page, "array-setup").waitFor();
  assert.equal(await page.locator("#array-rows").inputValue(), String(ROWS));
  assert.equal(await page.locator("#array-cols").inputValue(), String(COLS));
  await describeArray(person);
  mat.pressed.set(taxelOf("r4c4"), 8);
  await highest(page, /^\d{3,4} +r4c4$/);
  mat.pressed.clear();
  assert.ok(await page.locator("section[aria-label='Force map']").isHidden());
}

it("leads a CSV mat on the network to newtons, and says nothing untrue", async () => {
  const mat = await Mat.sending(csv);
  try {
    await walk(async (person, server) => {
      const { page } = person;
      await showCounts(person, mat);
      await isTrueEverywhere(server, "uncalibrated");
      await calibrate(person, "5, 20", () => obey(page, mat));
      await isTrueEverywhere(server, "calibrated");
      await page.locator("[aria-label=Contacts]", { hasText: "Nothing touches this array." }).waitFor();
      await isTrue(page, "calibrated", "untouched");
      mat.pressed.set(taxelOf("r4c4"), 8);
      await highest(page, /^(6\.[5-9]|7|8|9\.[0-4])[\d.]* N +r4c4$/);
      mat.close();
      await page.locator("[data-role=connection]", { hasNotText: "Live" }).waitFor({ timeout: 4000 });
    });
  } finally {
    mat.close();
  }
  assert.match(readFileSync(join(folder, "mat/array.toml"), "utf8"), /circuit = "auto"/);
});

it("leads a JSON mat on the network to its counts", async () => {
  const mat = await Mat.sending(json);
  try {
    await walk((person) => showCounts(person, mat));
  } finally {
    mat.close();
  }
});

it("leads somebody with nothing but the simulator to newtons, and says nothing untrue", async () => {
  await walk(async (person) => {
    const { page } = person;
    await person.does(page.locator("[data-source=rehearsal]").click());
    await describeArray(person);
    await isTrue(page, "uncalibrated");
    await calibrate(person, "5");
    await isTrue(page, "calibrated");
    await highest(page, / N /);
    assert.equal(await part(page, "faulty-taxels").textContent(), "none");
  });
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
    await page.locator("[data-role=source-words]", { hasText: "Where is small now?" }).waitFor();
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
