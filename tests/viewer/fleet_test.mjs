// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node fleet_test.mjs path/to/dermis
// A nats-server, two robots that publish to it, and the page of `dermis fleet page`.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { connect } from "node:net";
import { after, before, describe, it } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import {
  arrayToml,
  assertUnhurt,
  becomes,
  bench,
  browser,
  eventually,
  freePort,
  openPage,
  part,
  useBench,
  WAIT_MS,
} from "./harness.mjs";

const AXE = readFileSync(
  createRequire(new URL("../npm/package.json", import.meta.url)).resolve("axe-core/axe.min.js"),
  "utf8",
);
const SIZES = [
  { width: 375, height: 800 },
  { width: 900, height: 700 },
  { width: 1440, height: 900 },
];

/** Why fleets cannot be tested here; false: they can. */
function missing() {
  try {
    execFileSync("nats-server", ["--version"], { stdio: "ignore" });
  } catch {
    return "nats-server is not installed";
  }
  try {
    execFileSync(process.argv[2], ["fleet", "list", "nats://127.0.0.1:1"], { stdio: ["ignore", "ignore", "pipe"] });
  } catch (error) {
    return error.status === 2 ? `the plugin of NATS is not there: ${error.stderr}` : false;
  }
  return false;
}

const skip = missing();
const robots = {};
let hub;
let nats;
let fleet;

function startHub() {
  const port = new URL(hub).port;
  nats = spawn("nats-server", ["-a", "127.0.0.1", "-p", port, "-js", "-sd", bench.path("store")], { stdio: "ignore" });
}

async function stopHub() {
  const ended = new Promise((resolve) => nats.on("exit", resolve));
  nats.kill("SIGKILL");
  await ended;
}

async function answers(port) {
  for (const end = Date.now() + WAIT_MS; Date.now() < end; await pause(50)) {
    const isThere = await new Promise((resolve) => {
      const socket = connect(port, "127.0.0.1", () => resolve(true)).on("error", () => resolve(false));
      socket.on("close", () => undefined).on("connect", () => socket.destroy());
    });
    if (isThere) return;
  }
  throw new Error("nats-server does not answer");
}

/** Says something in the place of a robot. */
async function publish(subject, text) {
  const socket = connect(Number(new URL(hub).port), "127.0.0.1");
  socket.write(`CONNECT {"verbose":false}\r\nPUB ${subject} ${Buffer.byteLength(text)}\r\n${text}\r\nPING\r\n`);
  for await (const bytes of socket) if (bytes.toString().includes("PONG")) break;
  socket.destroy();
}

useBench(() => writeFileSync(bench.path("plain.toml"), arrayToml("plain", 4, 5)));

before(async () => {
  if (skip) return;
  hub = `nats://127.0.0.1:${await freePort()}`;
  startHub();
  await answers(Number(new URL(hub).port));
  const robot = (name, ...command) => bench.serve("--port", "0", ...command, "--publish", hub, "--robot", name);
  robots.anna = await robot("anna", "--from", "sim:contacts?rate=100", ...bench.model);
  robots.bob = await robot("bob", "--from", "sim:contacts?rate=50", "--model", bench.path("plain.toml"));
  fleet = await bench.start("fleet", "page", hub, "--port", "0");
});

after(async () => {
  await Promise.all([fleet, robots.anna, robots.bob].map((one) => one?.stop()));
  if (nats !== undefined) await stopHub();
});

async function shownFleet(test, size = SIZES[2]) {
  const page = await openPage(browser, fleet.url);
  await page.setViewportSize(size);
  await becomes(page, "live");
  await test(page);
  assertUnhurt(page);
  await page.close();
}

const rowOf = (page, robot) => page.locator(`tbody[data-robot=${robot}]`);
const field = (page, robot, name) => rowOf(page, robot).locator(`.robot-row [data-field=${name}]`);
const shownRobots = (page) =>
  page.locator("tbody[data-robot]").evaluateAll((rows) => rows.map((row) => row.dataset.robot));

describe("the page of a fleet", { skip }, () => {
  it("shows robots with their rates and what they ask for, and leads to their own pages", async () => {
    await shownFleet(async (page) => {
      await page.locator("tbody[data-robot=anna][data-state=well]").waitFor();
      await page.locator("tbody[data-robot=bob][data-state=warning]").waitFor();
      await eventually(page, () => {
        const rate = document.querySelector("[data-robot=anna] [data-field=rate]").textContent;
        return Math.abs(Number.parseFloat(rate) - 100) < 20;
      });
      assert.equal(await field(page, "bob", "calibration").textContent(), "plain");
      assert.match(await field(page, "bob", "remarks").textContent(), /not calibrated yet/);
      const popup = page.waitForEvent("popup");
      await rowOf(page, "anna").locator("a").click();
      const own = await popup;
      await becomes(own, "live");
      assert.equal(new URL(own.url()).origin, new URL(robots.anna.url).origin);
      await own.close();
    });
  });

  it("finds and sorts them by hand and by key", async () => {
    await shownFleet(async (page) => {
      await rowOf(page, "bob").waitFor();
      await eventually(page, () => document.querySelector("tbody").dataset.robot === "bob");
      await page.locator("[data-head=Robot] button").click();
      assert.deepEqual(await shownRobots(page), ["anna", "bob"]);
      await page.locator("[data-head=Robot] button").click();
      assert.deepEqual(await shownRobots(page), ["bob", "anna"]);
      await page.keyboard.press("/");
      await page.keyboard.type("an");
      assert.deepEqual(await shownRobots(page), ["anna"]);
      await page.keyboard.press("Escape");
      await page.locator("[data-kind='to calibrate']").click();
      assert.deepEqual(await shownRobots(page), ["bob"]);
      await rowOf(page, "bob").locator(".unfold").focus();
      await page.keyboard.press("Enter");
      assert.match(await rowOf(page, "bob").locator(".array-row").textContent(), /plain4 \u00d7 5/);
    });
  });

  it("tells what changed, and how a recording is got", async () => {
    await shownFleet(async (page) => {
      await rowOf(page, "bob").locator(".unfold").click();
      const command = await rowOf(page, "bob").locator("code").textContent();
      assert.equal(command, `dermis record --from '${hub}?robot=bob&array=plain&from=1&to=last' --out bob-plain.mcap`);
      await part(page, "history").locator("summary").click();
      await eventually(page, () =>
        /\d{4}-\d\d-\d\d [\d:]{8} UTCbobbegins to publish/.test(
          document.querySelector("[data-role=history]").textContent,
        ),
      );
    });
  });

  it("shows nonsense of a robot as what it is", async () => {
    const array = { name: "<img src=x onerror=alert(1)>\u202e", level: "error", message: "\u001b[2J\u0007" };
    await publish("dermis.anna.health", JSON.stringify({ live: "javascript:alert(1)", arrays: [array] }));
    const listed = execFileSync(process.argv[2], ["fleet", "list", hub], { encoding: "utf8" });
    for (const control of ["\u0007", "\u001b", "\u202e"]) assert.ok(!listed.includes(control));
    await robots.anna.stop();
    robots.anna = undefined;
    await publish("dermis.anna.health", JSON.stringify({ live: "javascript:alert(1)", arrays: [array] }));
    await shownFleet(async (page) => {
      await page.locator("tbody[data-robot=anna][data-state=error]").waitFor();
      assert.equal(await rowOf(page, "anna").locator("a, img").count(), 0);
      await publish("dermis.anna.health", "{ this is no JSON");
      await page.locator("tbody[data-robot=anna][data-state=unreadable]").waitFor();
    });
  });

  it("fits telephones and is accessible, light and dark", async () => {
    for (const size of SIZES) {
      await shownFleet(async (page) => {
        await rowOf(page, "bob").locator(".unfold").click();
        await part(page, "history").locator("summary").click();
        assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
        await page.evaluate(AXE);
        for (const colorScheme of ["light", "dark"]) {
          await page.emulateMedia({ colorScheme });
          await page.locator(`html[data-theme=${colorScheme}]`).waitFor();
          const found = await page.evaluate(async () => {
            const { violations } = await globalThis.axe.run(document, { resultTypes: ["violations"] });
            return violations
              .filter(({ impact }) => impact === "serious" || impact === "critical")
              .map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(" "))}`);
          });
          assert.deepEqual(found, [], `${size.width} px, ${colorScheme}`);
        }
      }, size);
    }
  });

  it("says who is silent, and that a hub is away and comes back", async () => {
    await robots.bob.stop();
    robots.bob = undefined;
    await shownFleet(async (page) => {
      await page.locator("tbody[data-robot=bob][data-state=silent]").waitFor();
      assert.match(await rowOf(page, "bob").locator(".state").first().textContent(), /silent\d+ s/);
      await stopHub();
      await becomes(page, "lost");
      assert.match(await part(page, "notice").textContent(), /as the hub told it last/);
      assert.equal(await rowOf(page, "bob").count(), 1);
      startHub();
      await becomes(page, "live");
    });
  });
});
