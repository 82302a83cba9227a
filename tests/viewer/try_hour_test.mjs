// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node try_hour_test.mjs path/to/dermis [FRAMES]
// An hour of 32x32 taxels at 100 Hz (360,000 frames) is recorded by the writer of the module into the files of the page, as
// quickly as it can: every frame is there, and the memory stays flat. Without FRAMES, a few minutes of it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { it } from "node:test";
import { skipWithoutCompiler } from "./try_page.mjs";

const { chromium } = createRequire(new URL("../npm/package.json", import.meta.url))("playwright-core");
const binary = resolve(process.argv[2]);
const frames = Number(process.argv[3] ?? 20_000);
const AT_ONCE = 1000;
const MOST_GROWTH_BYTES = 20e6;
const project = new URL("../../", import.meta.url).pathname;

skipWithoutCompiler();

function program() {
  execFileSync("cmake", ["--preset", "browser"], { cwd: project, stdio: "ignore" });
  execFileSync("cmake", ["--build", "--preset", "browser", "--target", "record_frames"], {
    cwd: project,
    stdio: "ignore",
  });
  return readFileSync(join(project, "build/browser/bindings/browser/record_frames.wasm"));
}

/** A worker that records as it is told. */
async function workerScript() {
  const { build } = await import(join(project, "viewer/node_modules/esbuild/lib/main.js"));
  const contents = `
    import { blobOf, openFiles } from "./kept_files";
    import { systemOf } from "./system";
    let recorder, page, system;
    const acts = {
      async begin() {
        page = await openFiles();
        if (page.lost !== undefined) throw new Error(page.lost);
        if (page.files.find("/recordings") === undefined) page.files.createFolder("/recordings");
        system = systemOf(page.files);
        const code = await WebAssembly.compileStreaming(fetch("record_frames.wasm"));
        recorder = (await WebAssembly.instantiate(code, system.imports)).exports;
        system.memory = recorder.memory;
        recorder._initialize();
        return recorder.begin();
      },
      record: async ({ first, count }) => {
        const recorded = recorder.record(first, count);
        await page.settle();
        return { recorded, memory: recorder.memory.buffer.byteLength };
      },
      end: () => recorder.end(),
      blob: () => blobOf(page.files, "/recordings/hour.mcap"),
    };
    onmessage = async ({ data }) => {
      try { postMessage({ done: await acts[data.act](data) }); } catch (error) { postMessage({ failed: String(error) }); }
    };`;
  const { outputFiles } = await build({
    stdin: { contents, resolveDir: join(project, "viewer/src/try") },
    bundle: true,
    format: "esm",
    write: false,
  });
  return Buffer.from(outputFiles[0].contents);
}

const ORIGIN = "http://localhost/";

async function openRecorder(context) {
  const given = new Map([
    ["", { body: "<!doctype html><title>hour</title>", contentType: "text/html" }],
    ["worker.js", { body: await workerScript(), contentType: "text/javascript" }],
    ["record_frames.wasm", { body: program(), contentType: "application/wasm" }],
  ]);
  await context.route(`${ORIGIN}**`, (route) =>
    route.fulfill(given.get(route.request().url().slice(ORIGIN.length)) ?? { status: 404 }),
  );
  const page = await context.newPage();
  page.setDefaultTimeout(600_000);
  await page.goto(ORIGIN);
  await page.evaluate(() => {
    const worker = new Worker("worker.js", { type: "module" });
    globalThis.act = (act, more) =>
      new Promise((done, failed) => {
        worker.onmessage = ({ data }) => (data.failed ? failed(new Error(data.failed)) : done(data.done));
        worker.postMessage({ act, ...more });
      });
  });
  return page;
}

/** Bytes in memory of the process of the page. */
async function residentBytes(context) {
  const session = await context.browser().newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  const sizes = processInfo
    .filter(({ type }) => type === "renderer")
    .map(({ id }) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, "utf8"))[1]) * 1024);
  return Math.max(...sizes);
}

it("records an hour with every frame, in flat memory", async () => {
  const folder = mkdtempSync(join(tmpdir(), "dermis-hour-"));
  const context = await chromium.launchPersistentContext(join(folder, "profile"), {
    executablePath: process.env.DERMIS_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox"],
  });
  const page = await openRecorder(context);
  assert.equal(await page.evaluate(() => globalThis.act("begin")), 1);
  const memories = [];
  const residents = [];
  const begun = performance.now();
  for (let first = 0; first < frames; first += AT_ONCE) {
    const { recorded, memory } = await page.evaluate((more) => globalThis.act("record", more), {
      first,
      count: AT_ONCE,
    });
    assert.equal(recorded, AT_ONCE);
    memories.push(memory);
    if (first % 10_000 === 0) residents.push(await residentBytes(context));
  }
  const tookS = (performance.now() - begun) / 1000;
  assert.equal(await page.evaluate(() => globalThis.act("end")), 1);
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.evaluate(async () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(await globalThis.act("blob"));
      link.download = "hour.mcap";
      link.click();
    }),
  ]);
  const file = join(folder, "hour.mcap");
  copyFileSync(await download.path(), file);
  await context.close();
  const info = JSON.parse(execFileSync(binary, ["info", file, "--json"], { encoding: "utf8" }));
  const { size } = statSync(file);
  rmSync(folder, { recursive: true });
  assert.equal(info.frames, frames);
  assert.equal(info.lost, 0);
  assert.ok(info.complete);
  const growth = memories.at(-1) - memories[1];
  const resident = Math.max(...residents.slice(1)) - residents[1];
  console.log(
    `${frames} frames, ${size} bytes in ${tookS.toFixed(1)} s; the module's memory ${memories.at(-1)} bytes, ${growth} more than at the beginning; the page's ${resident} more`,
  );
  assert.ok(growth + resident < MOST_GROWTH_BYTES);
});
