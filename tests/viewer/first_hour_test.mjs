// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node first_hour_test.mjs path/to/dermis
// What a newcomer does on the page, from a device of which nothing is written to newtons.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, it } from "node:test";
import { arrayToml, assertUnhurt, Bench, becomes, openBrowser, openPage, WAIT_MS } from "./harness.mjs";

const MOST_ACTIONS = 20;
const FIT_MS = 240_000;

let browser;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "dermis-first-hour-"));
  browser = await openBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const serve = (...command) =>
  Bench.prototype.serve.call({ binary: process.argv[2], folder }, "--port", "0", ...command);
const part = (page, role) => page.locator(`[data-role=${role}]`);

/** A person at the page, whose actions are counted. */
class Person {
  actions = 0;

  constructor(page) {
    this.page = page;
  }

  click(role) {
    return this.#do(part(this.page, role).click());
  }

  fill(id, text) {
    return this.#do(this.page.locator(`#${id}`).fill(text));
  }

  open(view) {
    return this.#do(this.page.locator(`[data-tab=${view}]`).click());
  }

  async submit() {
    return this.#do(this.page.locator("[data-role=array-setup] button[type=submit]").click());
  }

  async #do(action) {
    this.actions += 1;
    await action;
  }
}

/** A sketch that prints `millis()` and 120 readings in a line, 50 times a second, over TCP. One of them may be `pressed`. */
async function csvMat() {
  const server = createServer((socket) => {
    let millis = 1000;
    const timer = setInterval(() => {
      millis += 20;
      const readings = Array.from(
        { length: 120 },
        (_, taxel) => 100 + ((7 * taxel) % 23) + Math.round(3 * Math.random()),
      );
      if (server.pressed !== undefined) readings[server.pressed] += 900;
      if (!socket.destroyed) socket.write(`${millis},${readings.join(",")}\r\n`);
    }, 20);
    socket.on("error", () => undefined);
    socket.on("close", () => clearInterval(timer));
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return server;
}

it("shows the counts of a CSV mat of which nothing is known but its rows and columns", async () => {
  const mat = await csvMat();
  const server = await serve("--from", `tcp://127.0.0.1:${mat.address().port}`);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    assert.match(await part(page, "found").textContent(), /a time and 120 readings/);
    const person = new Person(page);
    await person.fill("array-name", "csv");
    assert.equal(await page.locator("#array-rows").inputValue(), "12");
    assert.equal(await page.locator("#array-cols").inputValue(), "10");
    await part(page, "live-picture").waitFor();
    await person.submit();
    await part(page, "uncalibrated").waitFor();
    await becomes(page, "live");
    await part(page, "maps").focus();
    await page.keyboard.press("ArrowDown");
    await page.waitForFunction(
      () => Number(document.querySelector("[data-role=cursor] [data-field=counts]").textContent) >= 100,
      null,
      { timeout: WAIT_MS },
    );
    assert.match(await part(page, "highest-taxel").textContent(), /^1[0-2]\d {2}r/);
    assert.ok(await page.locator("section[aria-label='Force map']").isHidden());
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    mat.close();
  }
  assert.match(readFileSync(join(folder, "csv.toml"), "utf8"), /circuit = "auto"/);
});

it("finds out which way round the lines are sent from two touches", async () => {
  const mat = await csvMat();
  const server = await serve("--from", `tcp://127.0.0.1:${mat.address().port}`);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    const words = (text) => page.locator("[data-role=corner-words]", { hasText: text }).waitFor();
    await page.locator("#array-name").fill("turned");
    await page.locator("#array-rows").fill("10");
    await page.locator("#array-cols").fill("12");
    await part(page, "corners").click();
    await words("Press the corner next to the connector.");
    mat.pressed = 60;
    await words("This is no corner.");
    mat.pressed = 11; // the last of the first row that is sent
    await words("Now the other end");
    mat.pressed = 108;
    await words("This is the opposite corner.");
    mat.pressed = 119;
    await words("rows and columns are exchanged, the last row comes first");
    assert.equal(await page.locator("#array-rows").inputValue(), "12");
    assert.equal(await page.locator("#array-cols").inputValue(), "10");
    await page.locator("[data-role=array-setup] button[type=submit]").click();
    await part(page, "uncalibrated").waitFor();
    await becomes(page, "live");
    const highest = (taxel) => page.locator("[data-role=highest-taxel]", { hasText: taxel }).waitFor();
    await highest("r0c9");
    mat.pressed = 11;
    await highest("r0c0");
    mat.pressed = 0;
    await highest("r11c0");
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    mat.close();
  }
  const written = readFileSync(join(folder, "turned.toml"), "utf8");
  assert.match(written, /rows = 12\ncols = 10\n/);
  assert.match(written, /transpose = true\nflip_rows = true\n/);
});

it("lists the serial ports where no device is named, and opens the one that is chosen", async (test) => {
  const port = `/dev/ttyACM_of_test_${process.pid}`;
  const board = spawn(
    process.argv[2],
    ["emulate", "--in", "sim:idle?rate=50&rows=3&cols=4", "--protocol", "dermis", "--to", "pty:"],
    { stdio: ["ignore", "pipe", "pipe"] },
  );
  let server;
  try {
    const terminal = await new Promise((found) => {
      for (const stream of [board.stdout, board.stderr]) {
        stream.on("data", (text) => {
          const name = /\/dev\/pts\/\d+/.exec(String(text));
          if (name !== null) found(name[0]);
        });
      }
    });
    try {
      symlinkSync(terminal, port);
    } catch {
      return test.skip("only root can name a port in /dev");
    }
    server = await serve();
    const page = await openPage(browser, server.url);
    await part(page, "source-setup").waitFor();
    assert.ok(await part(page, "array-setup").isHidden());
    await page.locator(`[data-source="${port}"]`).click();
    await part(page, "array-setup").waitFor();
    assert.ok(await part(page, "source-setup").isHidden());
    assert.match(await part(page, "found").textContent(), /these bytes are dermis, 3x4/);
    assert.equal(await page.locator("#array-cols").inputValue(), "4");
    await page.locator("#array-name").fill("board");
    await page.locator("[data-role=array-setup] button[type=submit]").click();
    await part(page, "uncalibrated").waitFor();
    await becomes(page, "live");
    assertUnhurt(page);
    await page.close();
  } finally {
    await server?.stop();
    rmSync(port, { force: true });
    board.kill();
  }
});

it("goes from a mat of unknown circuit to newtons in few actions, and writes no file by hand", async () => {
  writeFileSync(join(folder, "true.toml"), arrayToml("truth", 12, 10));
  const server = await serve("--from", `sim:rehearsal?rate=400&array=${join(folder, "true.toml")}`);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    const person = new Person(page);
    await person.submit();
    await person.click("calibrate");
    await person.fill("weights", "2, 5, 20");
    await person.fill("hold", "0.1");
    await person.click("start");
    await page.locator("[data-role=walk][data-stage='4']").waitFor({ timeout: FIT_MS });
    await person.click("save");
    await page.waitForFunction(
      () => document.querySelector("[data-role=instruction]").textContent.includes("in use"),
      null,
      { timeout: WAIT_MS },
    );
    await person.open("array");
    await page.locator("section[aria-label='Force map']").waitFor();
    assert.match(await part(page, "faulty-taxels").textContent(), /none/);
    assert.match(await part(page, "highest-taxel").textContent(), / N /);
    assert.ok(person.actions <= MOST_ACTIONS, `${person.actions} actions`);
    assert.ok(existsSync(join(folder, "mat.toml")));
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
  }
});
