// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node slow_line_test.mjs path/to/dermis
// The page over lines of 100 kbit/s, of 750 kbit/s and without limit: its frames are young, and the pill says how it is.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { it } from "node:test";
import { arrayToml, assertUnhurt, becomes, bench, browser, networkDevice, openPage, useBench } from "./harness.mjs";

const TICK_MS = 20;
const HELD_BYTES = 4096;
const SETTLE_MS = 8000;
/** What was on its way when the line became slow has come by then. */
const DRAINED_MS = 25000;
const LOOK_MS = 4000;
const SAID_MS = 1000;
/** After so long without frames the page says so. */
const QUIET_MS = 2000;

useBench(() => writeFileSync(bench.path("whole.toml"), arrayToml("whole", 16, 16)));

/** A line to a server, over which `kbits` pass in a second. It holds some kilobytes, as a modem does. */
async function lineTo(port) {
  const holding = new Set();
  const line = { kbits: Infinity, port: 0, isEmpty: () => holding.size === 0, close: () => undefined };
  const server = createServer((client) => {
    const upstream = connect({ port, host: "127.0.0.1" });
    let waiting = Buffer.alloc(0);
    const pass = (most) => {
      if (waiting.length === 0) holding.delete(client);
      if (client.destroyed || waiting.length === 0) return;
      client.write(waiting.subarray(0, most));
      waiting = waiting.subarray(most);
      if (waiting.length < HELD_BYTES) upstream.resume();
    };
    const timer = setInterval(() => pass((line.kbits * 125 * TICK_MS) / 1000), TICK_MS);
    upstream.on("data", (piece) => {
      waiting = Buffer.concat([waiting, piece]);
      holding.add(client);
      if (line.kbits === Infinity) pass(waiting.length);
      else if (waiting.length >= HELD_BYTES) upstream.pause();
    });
    client.on("data", (piece) => upstream.write(piece));
    const end = () => {
      clearInterval(timer);
      holding.delete(client);
      client.destroy();
      upstream.destroy();
    };
    for (const socket of [client, upstream]) socket.on("error", end).on("close", end);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  line.port = server.address().port;
  line.close = () => server.close();
  return line;
}

/** In the page: how old each new frame on the maps is, and every word of the pill meanwhile. */
async function watchAges(lookMs) {
  const ages = [];
  const words = new Set();
  let last = "";
  const begin = Date.now();
  while (Date.now() - begin < lookMs) {
    const { stamp } = document.querySelector("[data-view=array]").dataset;
    if (stamp !== last && last !== "") ages.push(Date.now() / 1000 - Number(stamp));
    last = stamp;
    words.add(document.querySelector("[data-role=connection]").textContent);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  ages.sort((a, b) => a - b);
  return { typical: ages[ages.length >> 1], oldest: ages.at(-1), frames: ages.length, words: [...words] };
}

// Without thinning, frames wait in a queue that grows by a second in each: they are seconds old at the end. A picture that a
// busy machine draws late is none of that, so the typical one counts.
for (const [kbits, leastFrames] of [
  [100, 4],
  [750, 8],
  [Infinity, 8],
]) {
  it(`shows frames that are typically no older than 1 s at ${kbits} kbit/s, and says how it is`, async () => {
    const server = await bench.serve(
      "--port",
      "0",
      "--from",
      "sim:contacts?rate=100",
      "--model",
      bench.path("whole.toml"),
    );
    const line = await lineTo(server.port);
    try {
      const page = await openPage(browser, `http://127.0.0.1:${line.port}/#/array`);
      await becomes(page, "live");
      await page.locator("[data-role=highest-taxel]", { hasText: /r\d+c\d+/ }).waitFor();
      line.kbits = kbits;
      const says = (words) => page.locator("[data-role=connection]", { hasText: words }).waitFor({ timeout: SAID_MS });
      await page.waitForTimeout(SETTLE_MS);
      for (const end = Date.now() + DRAINED_MS; !line.isEmpty() && Date.now() < end; )
        await page.waitForTimeout(TICK_MS);
      await page.waitForTimeout(SAID_MS);
      const { typical, oldest, frames, words } = await page.evaluate(watchAges, LOOK_MS);
      console.log(`# ${kbits} kbit/s: typically ${typical} s, at most ${oldest} s, ${frames} frames`);
      assert.ok(typical <= 1, `${typical} s`);
      assert.ok(frames >= leastFrames, `${frames} frames`);
      assert.deepEqual(words, ["Live"]);
      await page.locator("[data-role=pause]").click();
      await says("Paused");
      await page.locator("[data-role=pause]").click();
      await says("Live");
      assertUnhurt(page);
      await page.close();
    } finally {
      line.close();
      await server.stop();
    }
  });
}

/** A page of what is served, over a line of so many kbit/s. */
async function over(kbits, command, look) {
  const server = await bench.serve("--port", "0", ...command);
  const line = await lineTo(server.port);
  try {
    const page = await openPage(browser, `http://127.0.0.1:${line.port}/#/array`);
    line.kbits = kbits;
    await look(page, (words) =>
      page.locator("[data-role=connection]", { hasText: words }).waitFor({ timeout: SAID_MS }),
    );
    assertUnhurt(page);
    await page.close();
  } finally {
    line.close();
    await server.stop();
  }
}

for (const kbits of [100, 750, Infinity]) {
  it(`says within a second what a recording does, at ${kbits} kbit/s`, async () => {
    await over(kbits, ["--from", bench.path("recording.mcap"), ...bench.model], async (page, says) => {
      await becomes(page, "live");
      await page.locator("[data-role=highest-taxel]", { hasText: /r\d+c\d+/ }).waitFor();
      await says("Playing");
      await page.locator("[data-role=play]").click();
      await says("Paused");
      await page.locator("[data-role=play]").click();
      await says("Playing");
      await page.locator("[data-role=scrub]").press("End");
      await says("At its end");
    });
  });

  it(`says within a second that a device has gone silent and is back, at ${kbits} kbit/s`, async () => {
    let isSilent = false;
    const device = await networkDevice(() =>
      isSilent ? "" : "11,12,13,14,15\n21,22,23,24,25\n31,32,33,34,35\n41,42,43,44,45\n\n",
    );
    const from = ["--from", device.uri];
    try {
      await over(kbits, from, async (page, says) => {
        await page.locator("[data-role=array-setup]").waitFor();
        await says("Waiting for your answer");
      });
      await over(kbits, [...from, ...bench.model], async (page, says) => {
        await becomes(page, "live");
        await page.locator("[data-role=highest-taxel]", { hasText: /r\d+c\d+/ }).waitFor();
        await says("Live");
        isSilent = true;
        await page.waitForTimeout(QUIET_MS);
        await says(/^No frames for [23] s$/);
        isSilent = false;
        await says("Live");
      });
    } finally {
      device.close();
    }
  });
}

it("says that what comes is not readable, and why", async () => {
  const device = await networkDevice(() => "x".repeat(4000));
  const server = await bench.serve("--port", "0", "--from", device.uri, "--model", bench.path("whole.toml"));
  try {
    const page = await openPage(browser, `${server.url}#/array`);
    await page.locator("[data-role=connection]", { hasText: "Not readable" }).waitFor();
    assert.match(
      await page.locator("[data-role=connection]").getAttribute("title"),
      /these bytes are of no known protocol/,
    );
    await page.locator("[data-tab=health]").click();
    const faults = page.locator("[data-role=faults]", { hasText: "these bytes are of no known protocol" });
    await faults.waitFor();
    assert.doesNotMatch(await faults.textContent(), /dead/);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
    device.close();
  }
});
