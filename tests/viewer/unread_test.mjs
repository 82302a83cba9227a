// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node unread_test.mjs path/to/dermis
// Streams that nothing reads: each ends at a question that shows its bytes and says why, and never at a blank map.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, it } from "node:test";
import { assertUnhurt, Bench, openBrowser, openPage } from "./harness.mjs";

let browser;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "dermis-unread-"));
  browser = await openBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const serve = (...command) =>
  Bench.prototype.serve.call({ binary: process.argv[2], folder }, "--port", "0", ...command);
const part = (page, role) => page.locator(`[data-role=${role}]`);

let noise = 1;
/** The same on every run. */
const random = () => (noise = (noise * 48271) % 2147483647);

/** What a device says every 20 ms; `reason`: what the page must say of it. */
const STREAMS = [
  {
    name: "noise",
    say: () => Buffer.from(Array.from({ length: 64 }, () => random() % 256)),
    reason: /no known protocol.*not text/,
  },
  { name: "zeros", say: () => Buffer.alloc(64), reason: /0x00/ },
  {
    name: "a log",
    say: () => "[I][wifi] heap 21340, channel six\r\n",
    reason: /not numbers alone, such as '\[I\]\[wifi\] heap/,
  },
  {
    name: "names and values",
    say: () => `temp=${20 + (random() % 9)}.5 hum=41\n`,
    reason: /not numbers alone, such as 'temp=2/,
  },
  {
    name: "positions",
    say: () => "$GPGGA,123519,4807.038,N,01131.000,E,1,08\r\n",
    reason: /not numbers alone, such as '\$GPGGA/,
  },
  {
    name: "other JSON",
    say: () => `{"celsius": ${random() % 40}, "name": "hall"}\n`,
    reason: /no known protocol|json/,
  },
  {
    name: "ragged lines",
    say: () => `${Array.from({ length: 3 + (random() % 7) }, () => random() % 1000).join(",")}\n`,
    reason: /3 to 9 numbers/,
  },
  { name: "lone numbers", say: () => `${random() % 4096}\r\n`, reason: /one number/ },
  {
    name: "a page",
    say: () => "HTTP/1.1 400 Bad Request\r\nServer: esp\r\n\r\n",
    reason: /not numbers alone, such as/,
  },
  {
    name: "a wrong baud",
    say: () => Buffer.from(Array.from({ length: 40 }, () => [0x00, 0x80, 0xf8, 0xfe][random() % 4])),
    reason: /not text/,
    terminal: true,
  },
];

/** A port of the network that says it. */
async function networkDevice(say) {
  const server = createServer((socket) => {
    const timer = setInterval(() => socket.destroyed || socket.write(say()), 20);
    socket.on("error", () => undefined);
    socket.on("close", () => clearInterval(timer));
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return { uri: `tcp://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

const TERMINAL = `
import os, pty, sys, tty
device, terminal = pty.openpty()
tty.setraw(terminal)
print(os.ttyname(terminal), flush=True)
os.set_blocking(device, False)
while data := sys.stdin.buffer.read1(4096):
    try:
        os.write(device, data)
    except BlockingIOError:
        pass  # nobody reads
`;

/** A serial port that says it. */
async function serialDevice(say) {
  const board = spawn("python3", ["-c", TERMINAL], { stdio: ["pipe", "pipe", "inherit"] });
  const name = await new Promise((found) => board.stdout.once("data", (text) => found(String(text).trim())));
  const timer = setInterval(() => board.stdin.write(say()), 20);
  const close = () => {
    clearInterval(timer);
    board.stdin.end();
  };
  return { uri: `serial://${name}`, close };
}

async function endsAtTheQuestion({ name, say, reason, terminal }) {
  const device = await (terminal === true ? serialDevice(say) : networkDevice(say));
  const server = await serve("--from", device.uri);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    assert.match(await part(page, "found").textContent(), reason, name);
    assert.match(await part(page, "first-bytes").textContent(), /^00 {2}([0-9a-f]{2} ){7}/, name);
    for (const [id, value] of [
      ["array-name", name.replaceAll(" ", "_")],
      ["array-rows", "3"],
      ["array-cols", "5"],
    ])
      await page.locator(`#${id}`).fill(value);
    await page.locator("[data-role=array-setup] button[type=submit]").click();
    await part(page, "setup-problem").waitFor();
    assert.notEqual(await part(page, "setup-problem").textContent(), "", name);
    assert.ok(await part(page, "array-setup").isVisible(), name);
    assert.ok(await page.locator("main").isHidden(), `${name}: a map`);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
}

it("stays at a question that shows the bytes and the reason, for ten streams that nothing reads", async () => {
  assert.equal(STREAMS.length, 10);
  await Promise.all(STREAMS.map(endsAtTheQuestion));
  assert.deepEqual(readdirSync(folder), []);
});

it("says so where nothing comes, and listens again", async () => {
  let isQuiet = true;
  const device = await networkDevice(() => (isQuiet ? "" : "1,2,3\r\n4,5,6\r\n\r\n"));
  const server = await serve("--from", device.uri);
  try {
    const page = await openPage(browser, server.url);
    await page.locator("[data-role=found]", { hasText: "is the device powered and sending?" }).waitFor();
    assert.ok(await part(page, "first-bytes").isHidden());
    isQuiet = false;
    await part(page, "listen-again").click();
    await page.locator("[data-role=found]", { hasText: "2x3" }).waitFor();
    await part(page, "live-picture").waitFor();
    assert.match(await part(page, "live-words").textContent(), /1 to 6 counts/);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});

it("offers a network address, the simulator, and the way back to that choice", async () => {
  const [, , log] = STREAMS;
  const device = await networkDevice(log.say);
  const server = await serve();
  try {
    const page = await openPage(browser, server.url);
    await part(page, "source-setup").waitFor();
    await page.locator("#address").fill(device.uri.slice("tcp://".length));
    await part(page, "network").locator("button").click();
    await part(page, "array-setup").waitFor();
    assert.match(await part(page, "found").textContent(), log.reason);
    await part(page, "other-source").click();
    await part(page, "source-setup").waitFor();
    await page.locator("[data-source=contacts]").click();
    await part(page, "live-picture").waitFor();
    assert.equal(await page.locator("#array-rows").inputValue(), "16");
    await page.locator("[data-role=array-setup] button[type=submit]").click();
    await part(page, "uncalibrated").waitFor();
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});

it("offers the arrays and recordings of its folder from last time", async () => {
  const bench = new Bench(process.argv[2]);
  const server = await bench.serve("--port", "0");
  try {
    const page = await openPage(browser, server.url);
    await page.locator("[data-role=source-setup] [data-known='model.safetensors']").click();
    await page.locator("[data-role=source-words]", { hasText: "Where is small now?" }).waitFor();
    await page.locator("[data-source='recording.mcap']").click();
    await page.locator("section[aria-label='Force map']").waitFor();
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    bench.close();
  }
});
