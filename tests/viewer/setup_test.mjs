// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node setup_test.mjs path/to/dermis
// Arrays of which nothing is written: the page asks where they are and how they are made, and shows the bytes and the reason
// where nothing reads them.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readdirSync, readFileSync, renameSync, rmSync, symlinkSync } from "node:fs";
import { join } from "node:path";
import { describe, it } from "node:test";
import {
  assertUnhurt,
  becomes,
  browser,
  folder,
  networkDevice,
  openPage,
  part,
  serveEmpty,
  useEmptyFolder,
} from "./harness.mjs";

useEmptyFolder();

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

/** An array of 3x5 taxels, of which the bytes are not. */
async function describeInVain(page, name) {
  for (const [id, value] of [
    ["array-name", name],
    ["array-rows", "3"],
    ["array-cols", "5"],
  ])
    await page.locator(`#${id}`).fill(value);
  await page.locator("[data-role=array-setup] button[type=submit]").click();
  await part(page, "setup-problem").waitFor();
}

async function endsAtTheQuestion({ name, say, reason, terminal }) {
  const device = await (terminal === true ? serialDevice(say) : networkDevice(say));
  const server = await serveEmpty("--from", device.uri);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    assert.match(await part(page, "found").textContent(), reason, name);
    assert.match(await part(page, "first-bytes").textContent(), /^00 {2}([0-9a-f]{2} ){7}/, name);
    await describeInVain(page, name.replaceAll(" ", "_"));
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

it("keeps what was typed where the connection begins anew", async () => {
  const device = await networkDevice(STREAMS[0].say);
  const server = await serveEmpty("--from", device.uri);
  try {
    const page = await openPage(browser, server.url);
    await part(page, "array-setup").waitFor();
    await describeInVain(page, "glove");
    const again = page.waitForResponse((response) => response.url().includes("suit.json"));
    await part(page, "connection").click();
    await (await again).finished();
    await page.waitForTimeout(500);
    const typed = ["name", "rows", "cols"].map((field) => page.locator(`#array-${field}`).inputValue());
    assert.deepEqual(await Promise.all(typed), ["glove", "3", "5"]);
    assert.ok(await part(page, "setup-problem").isVisible());
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});

describe("an array of which nothing is written", { concurrency: true }, () => {
  it("says so where nothing comes, and listens again", async () => {
    let isQuiet = true;
    const device = await networkDevice(() => (isQuiet ? "" : "1,2,3\r\n4,5,6\r\n\r\n"));
    const server = await serveEmpty("--from", device.uri);
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
    const server = await serveEmpty();
    try {
      const page = await openPage(browser, server.url);
      await part(page, "source-setup").waitFor();
      await page.locator("#address").fill(device.address);
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

  it("finds out which way round the lines are sent from two touches", async () => {
    let pressed;
    const reading = (taxel) => 100 + ((7 * taxel) % 23) + Math.round(3 * Math.random()) + (taxel === pressed ? 900 : 0);
    const mat = await networkDevice(
      () => `${Date.now()},${Array.from({ length: 120 }, (_, taxel) => reading(taxel))}\r\n`,
    );
    const server = await serveEmpty("--from", mat.uri);
    try {
      const page = await openPage(browser, server.url);
      await part(page, "array-setup").waitFor();
      const words = (text) => page.locator("[data-role=corner-words]", { hasText: text }).waitFor();
      await page.locator("#array-name").fill("turned");
      await page.locator("#array-rows").fill("10");
      await page.locator("#array-cols").fill("12");
      await part(page, "corners").click();
      await words("Press the corner next to the connector.");
      pressed = 60;
      await words("This is no corner.");
      pressed = 11; // the last of the first row that is sent
      await words("Now the other end");
      pressed = 108;
      await words("This is the opposite corner.");
      pressed = 119;
      await words("rows and columns are exchanged, the last row comes first");
      assert.equal(await page.locator("#array-rows").inputValue(), "12");
      assert.equal(await page.locator("#array-cols").inputValue(), "10");
      await page.locator("[data-role=array-setup] button[type=submit]").click();
      await part(page, "uncalibrated").waitFor();
      await becomes(page, "live");
      const highest = (taxel) => page.locator("[data-role=highest-taxel]", { hasText: taxel }).waitFor();
      await highest("r0c9");
      pressed = 11;
      await highest("r0c0");
      pressed = 0;
      await highest("r11c0");
      assertUnhurt(page);
      await page.close();
    } finally {
      await server.stop();
      mat.close();
    }
    const written = readFileSync(join(folder, "turned/array.toml"), "utf8");
    assert.match(written, /rows = 12\ncols = 10\n/);
    assert.match(written, /transpose = true\nflip_rows = true\n/);
  });

  it("lists the serial ports where no device is named, and finds the board at another one the next day", async (test) => {
    const port = `/dev/ttyACM_of_test_${process.pid}`;
    const otherPort = `${port}_b`;
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
      server = await serveEmpty();
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
      await server.stop();

      renameSync(port, otherPort);
      server = await serveEmpty();
      const nextDay = await openPage(browser, server.url);
      await nextDay.locator('[data-role=source-setup] [data-known="board/array.toml"]').click();
      await part(nextDay, "uncalibrated").waitFor();
      await becomes(nextDay, "live");
      assert.match(
        readFileSync(join(folder, "board/source.toml"), "utf8"),
        new RegExp(`from = "serial://${otherPort}`),
      );
      assertUnhurt(nextDay);
      await nextDay.close();
    } finally {
      await server?.stop();
      for (const path of [port, otherPort]) rmSync(path, { force: true });
      board.kill();
    }
  });
});
