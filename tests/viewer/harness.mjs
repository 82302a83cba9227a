// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// A small array, its model and a recording of it, `dermis serve`, and pages of headless Chromium that look at it.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before } from "node:test";

const { chromium } = createRequire(new URL("../npm/package.json", import.meta.url))("playwright-core");

export const WAIT_MS = 180_000;
/** As the tabs name them. */
export const VIEWS = ["array", "time", "suit", "recognition", "health", "calibration"];

/** An array.toml. */
export function arrayToml(name, rows, cols) {
  return `[array]
name = "${name}"
rows = ${rows}
cols = ${cols}
pitch_mm = [10.0, 10.0]
taxel_area_mm2 = 38.48

[readout]
circuit = "divider"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
`;
}

/** The rows of a CSV file as objects by column. */
export function readCsv(path) {
  const [head, ...lines] = readFileSync(path, "utf8").trim().split("\n");
  const columns = head.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((value, index) => [columns[index], value])));
}

export function freePort() {
  return new Promise((resolve, reject) => {
    const server = createServer();
    server.on("error", reject);
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

/** A command that serves a page, in a folder, once it says where it serves. */
async function start(binary, folder, ...command) {
  const server = spawn(binary, command, { stdio: ["ignore", "pipe", "pipe"], cwd: folder });
  const ended = new Promise((resolve) => server.on("exit", resolve));
  let said = "";
  const url = await new Promise((found, reject) => {
    const hear = (text) => {
      said += text;
      const address = /http:\/\/[^\s/]+\//.exec(said);
      if (address !== null) found(address[0]);
    };
    server.stdout.on("data", hear);
    server.stderr.on("data", hear);
    ended.then((status) => reject(new Error(`${command[0]} ended with ${status}: ${said}`)));
  });
  const stop = () => {
    server.kill("SIGINT");
    return ended;
  };
  return { url, port: Number(new URL(url).port), stop };
}

/** A device on the network that says something every so often. */
export async function networkDevice(say, periodMs = 20) {
  const sockets = new Set();
  const server = createServer((socket) => {
    const timer = setInterval(() => socket.destroyed || socket.write(say()), periodMs);
    sockets.add(socket);
    socket.on("error", () => undefined).on("close", () => clearInterval(timer));
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const address = `127.0.0.1:${server.address().port}`;
  const close = () => {
    server.close();
    for (const socket of sockets) socket.destroy();
  };
  return { address, uri: `tcp://${address}`, close };
}

/** A temporary folder with array.toml, model.safetensors, recording.mcap (200 frames, a second apart), and as CSV its counts
 *  and what `dermis run` makes of it. */
export class Bench {
  constructor(binary) {
    this.binary = resolve(binary);
    this.folder = mkdtempSync(join(tmpdir(), "dermis-viewer-"));
    writeFileSync(this.path("array.toml"), arrayToml("small", 4, 5));
    const array = ["--array", this.path("array.toml")];
    this.run("simulate", ...array, "--scene", "calibration", "--out", this.path("calibration"));
    this.run(
      "simulate",
      ...array,
      "--scene",
      "multitouch",
      "--frames",
      "200",
      "--seed",
      "2",
      "--out",
      this.path("contacts"),
    );
    const samples = ["--frames", this.path("calibration/frames.csv"), "--loads", this.path("calibration/loads.csv")];
    this.run("calibrate", ...array, ...samples, "--out", this.path("model.safetensors"));
    this.run("convert", this.path("contacts/frames.csv"), this.path("recording.mcap"), ...array);
    this.run("run", ...this.model, "--in", this.path("recording.mcap"), "--out", this.path("forces.csv"));
    this.counts = readCsv(this.path("contacts/frames.csv"));
    this.forces = readCsv(this.path("forces.csv"));
  }

  get model() {
    return ["--model", this.path("model.safetensors")];
  }

  path(name) {
    return join(this.folder, name);
  }

  run(...command) {
    execFileSync(this.binary, command, { stdio: ["ignore", "ignore", "pipe"], timeout: 120000 });
  }

  start(...command) {
    return start(this.binary, this.folder, ...command);
  }

  serve(...command) {
    return this.start("serve", ...command);
  }

  close() {
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export async function openBrowser() {
  return chromium.launch({
    executablePath: process.env.DERMIS_CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--enable-precise-memory-info",
      "--js-flags=--expose-gc",
    ],
  });
}

/** A page that fails the test where a script of it fails. */
export async function openPage(browser, url) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.setDefaultTimeout(WAIT_MS);
  page.failures = [];
  page.on("pageerror", (error) => page.failures.push(String(error)));
  await page.goto(url);
  return page;
}

export async function becomes(page, connection) {
  await page.locator(`html[data-connection="${connection}"]`).waitFor({ state: "attached" });
}

export function assertUnhurt(page) {
  assert.deepEqual(page.failures, []);
}

export const part = (page, role) => page.locator(`[data-role=${role}]`);

/** Tares, over a load where one stands there. */
export async function tareAnyway(page) {
  await part(page, "tare").click();
  const [refused, taken] = ["[data-role=tare-force]:visible", "[data-role=tare][aria-pressed=true]"];
  await page.locator(`${refused}, ${taken}`).first().waitFor();
  if (await page.locator(refused).isVisible()) await page.locator(refused).click();
  await page.locator(taken).waitFor();
}

/** Those of useBench() or useEmptyFolder(), during the tests of a file. */
export let bench;
export let browser;
export let folder;

/** The tests of this file share a bench and a browser; `prepare()` adds to the bench what they need. */
export function useBench(prepare = () => {}) {
  before(async () => {
    bench = new Bench(process.argv[2]);
    prepare();
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    bench?.close();
  });
}

/** The tests of this file share a browser and a folder in which nothing is written yet. */
export function useEmptyFolder() {
  before(async () => {
    folder = mkdtempSync(join(tmpdir(), "dermis-viewer-"));
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    rmSync(folder, { recursive: true, force: true });
  });
}

/** `dermis serve` in that folder, on any port. */
export const serveEmpty = (...command) => start(resolve(process.argv[2]), folder, "serve", "--port", "0", ...command);

/** Becomes true in the page. */
export async function eventually(page, check, argument, limitMs = WAIT_MS) {
  await page.waitForFunction(check, argument, { polling: 20, timeout: limitMs });
}

/** Serves and shows for the time of a test, in the colours of the browser or in these. */
export async function shown(command, view, test, colorScheme = null) {
  const server = await bench.serve("--port", "0", ...command);
  try {
    const page = await openPage(browser, `${server.url}#/${view}`);
    await page.emulateMedia({ colorScheme });
    await becomes(page, "live");
    await test(page, server);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
  }
}
