// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node teaching_test.mjs path/to/dermis
// A person teaches three touches in the browser: a recording of simulated touches stands for the hand.
import assert from "node:assert/strict";
import { readdirSync, writeFileSync } from "node:fs";
import { it } from "node:test";
import {
  assertUnhurt,
  becomes,
  bench,
  browser,
  eventually,
  openPage,
  part,
  readCsv,
  useBench,
  WAIT_MS,
} from "./harness.mjs";

const [ROWS, COLS] = [8, 8];
const HZ = 50;
const KINDS = ["tap", "hold", "stroke"];
const TAUGHT = 10;
const NEW = 60;
const TOUCH_S = 2;
const FASTEST = 8;
// Long enough for a busy machine to stop the playback before the touches of the next kind come.
const PAUSE_S = 60;
const ARRAY = `[array]
name = "palm"
rows = ${ROWS}
cols = ${COLS}
pitch_mm = [10.0, 10.0]

[readout]
circuit = "force"
adc_noise_counts = 0.002
`;

/** Numbers in 0 ... 1 by shifts (G. Marsaglia, "Xorshift RNGs", 2003): those of touches that follow are independent. */
function chance(seed) {
  let state = seed;
  return () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
}

/** Frames of two seconds with a touch of a kind somewhere, in newtons. */
function touch(kind, next) {
  const [row, col] = [2 + 3 * next(), 2 + 1.5 * next()];
  const [newtons, slide] = [(0.8 + 0.4 * next()) * (kind === "hold" ? 3 : 1.5), kind === "stroke" ? 3 : 0];
  const lasts = (0.9 + 0.2 * next()) * (kind === "tap" ? 0.12 : 0.8);
  const wide = kind === "hold" ? 1.3 : 0.7;
  return Array.from({ length: TOUCH_S * HZ }, (_, frame) => {
    const share = (frame / HZ - 0.5) / lasts;
    const force = share > 0 && share < 1 ? newtons * Math.min(1, 6 * Math.min(share, 1 - share)) : 0;
    const at = col + slide * Math.min(1, Math.max(0, share));
    const taxel = (index) => Math.hypot(Math.floor(index / COLS) - row, (index % COLS) - at) / wide;
    return Array.from({ length: ROWS * COLS }, (_, index) =>
      Math.max(0, force * Math.exp(-0.5 * taxel(index) ** 2) + 0.004 * (next() - 0.5)),
    );
  });
}

/** Ten of each kind, each ten after a pause, then sixty of all kinds by turns. */
function recordTouches() {
  const next = chance(7);
  const rest = Array.from({ length: PAUSE_S * HZ }, () =>
    Array.from({ length: ROWS * COLS }, () => Math.max(0, 0.004 * (next() - 0.5))),
  );
  const some = (count, kindOf) => Array.from({ length: count }, (_, index) => touch(kindOf(index), next)).flat();
  const frames = [
    ...KINDS.flatMap((kind) => [...rest, ...some(TAUGHT, () => kind)]),
    ...rest,
    ...some(NEW, (index) => KINDS[index % 3]),
    ...rest,
  ];
  const names = Array.from({ length: ROWS * COLS }, (_, taxel) => `r${Math.floor(taxel / COLS)}c${taxel % COLS}`);
  const lines = frames.map((frame, index) =>
    [(index / HZ).toFixed(3), ...frame.map((newtons) => newtons.toFixed(4))].join(),
  );
  writeFileSync(bench.path("touches.csv"), [["time_s", ...names].join(), ...lines, ""].join("\n"));
  writeFileSync(bench.path("palm.toml"), ARRAY);
  bench.run("convert", bench.path("touches.csv"), bench.path("touches.mcap"), "--array", bench.path("palm.toml"));
}

useBench(recordTouches);

/** Its button says what a click would do. */
const says = (page, word) => part(page, "play").getByText(word, { exact: true }).waitFor();

/** The page, as soon as it knows that the server plays. */
async function openLesson(server) {
  const page = await openPage(browser, `${server.url}#/recognition`);
  await becomes(page, "live");
  await says(page, "Pause");
  return page;
}

async function pause(page) {
  if ((await part(page, "play").textContent()) === "Pause") await part(page, "play").click();
  await says(page, /^(Play|Again)$/);
}

async function play(page, speed) {
  await part(page, "speed").selectOption(String(speed));
  await part(page, "play").click();
  await says(page, "Pause");
}

async function seek(page, seconds) {
  await part(page, "scrub").evaluate(
    (bar, at) => {
      bar.value = String(at);
      bar.dispatchEvent(new Event("input"));
      bar.dispatchEvent(new Event("change"));
    },
    (1000 * seconds) / TOTAL_S,
  );
}

const BLOCK_S = PAUSE_S + TAUGHT * TOUCH_S;
/** The new touches begin. */
const NEW_S = KINDS.length * BLOCK_S + PAUSE_S;
const TOTAL_S = KINDS.length * BLOCK_S + PAUSE_S + NEW * TOUCH_S + PAUSE_S;

async function teach(page, kind, index) {
  await pause(page);
  await seek(page, index * BLOCK_S + PAUSE_S - 1);
  await part(page, "teach-class").fill(kind);
  await part(page, "teach-listen").click();
  await part(page, "teach-listen").getByText("Stop").waitFor();
  await play(page, FASTEST);
  await eventually(
    page,
    ([name, count]) => document.querySelectorAll(`[data-taught="${name}"] canvas`).length === count,
    [kind, TAUGHT],
  );
  await pause(page);
  await part(page, "teach-listen").click();
  await part(page, "teach-listen").getByText("Begin").waitFor();
}

/** Every answer that the bars show, by the number of its touch among the new ones. */
async function watchAnswers(page) {
  await page.evaluate(
    ([firstS, touchS]) => {
      const bars = document.querySelector("[aria-label='What touches']");
      window.answers = {};
      new MutationObserver(() => {
        const touch = Math.floor((Number(bars.dataset.stamp) - firstS) / touchS);
        window.answers[touch] ??= new Set();
        window.answers[touch].add(document.querySelector("[data-role=answer]").textContent);
      }).observe(bars, { attributes: true, attributeFilter: ["data-stamp"] });
    },
    [NEW_S, TOUCH_S],
  );
}

/** Plays the new touches from one of them on, until all have an answer or the recording has ended. What was shown of
 *  these before does not count. It begins after the end of the touch before: a half of that would have an answer of its own. */
async function playNewTouches(page, first, speed) {
  const beginS = NEW_S + first * TOUCH_S - 0.4;
  await pause(page);
  await page.evaluate(
    (from) => Object.keys(window.answers).forEach((touch) => Number(touch) >= from && delete window.answers[touch]),
    first,
  );
  await seek(page, beginS);
  await play(page, speed);
  const isDone = (count) =>
    Object.keys(window.answers).length >= count || document.querySelector("[data-role=play]").textContent === "Again";
  await eventually(page, isDone, NEW, WAIT_MS + (1000 * (TOTAL_S - beginS)) / speed);
}

/** A page that is too busy to show an answer before the next one comes sees the touches again, more slowly. */
async function answersToNewTouches(page) {
  await watchAnswers(page);
  const answers = () =>
    page.evaluate(() => Object.entries(window.answers).map(([touch, answers]) => [Number(touch), [...answers].join()]));
  for (const speed of [FASTEST, 4, 2, 1]) {
    const shown = new Map(await answers());
    const missing = Array.from({ length: NEW }, (_, touch) => touch).find((touch) => !shown.has(touch));
    if (missing === undefined) break;
    await playNewTouches(page, missing, speed);
  }
  return new Map(await answers());
}

it("teaches three touches, throws an example away, trains, and names new touches", async () => {
  const server = await bench.serve(
    "--port",
    "0",
    "--from",
    bench.path("touches.mcap"),
    "--model",
    bench.path("palm.toml"),
  );
  try {
    const page = await openLesson(server);
    assert.ok(await part(page, "teach-train").isDisabled());
    for (const [index, kind] of KINDS.entries()) await teach(page, kind, index);
    assert.match(await part(page, "teach-warnings").textContent(), /one session/);
    await page.locator("[data-taught=tap] button").first().click();
    await eventually(page, () => document.querySelectorAll("[data-taught=tap] canvas").length === 9);

    await part(page, "teach-train").click();
    await part(page, "teach-result")
      .getByText(/were right when left out\. Saved as palm-touches-\d{8}-\d{6}\.safetensors and in use\./)
      .waitFor();
    const answers = await answersToNewTouches(page);
    assert.deepEqual(
      [...answers.keys()].sort((a, b) => a - b),
      Array.from({ length: NEW }, (_, touch) => touch),
    );
    const wrong = [...answers].filter(([touch, answer]) => answer !== KINDS[touch % 3] && answer !== "unknown");
    const right = [...answers].filter(([touch, answer]) => answer === KINDS[touch % 3]).length;
    assert.deepEqual(wrong, []);
    assert.ok(right >= 0.9 * NEW, `${right} of ${NEW}: ${[...answers.values()]}`);
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
  }
  const [model, ...more] = readdirSync(bench.folder).filter((name) => /^palm-touches-.*\.safetensors$/.test(name));
  assert.deepEqual(more, []);
  const saved = bench.path(model.replace(".safetensors", ""));
  assert.equal(readCsv(`${saved}.labels.csv`).length, 3 * TAUGHT - 1);
  bench.run(
    "recognise",
    "learn",
    "--in",
    `${saved}.frames.csv`,
    "--model",
    `${saved}.array.toml`,
    "--labels",
    `${saved}.labels.csv`,
    "--out",
    bench.path("again.safetensors"),
  );
  const again = await bench.serve(
    "--port",
    "0",
    "--from",
    bench.path("touches.mcap"),
    "--model",
    bench.path("palm.toml"),
    "--classes",
    bench.path("again.safetensors"),
  );
  await again.stop();
});

it("warns of few examples, and says why there can be no training", async () => {
  const server = await bench.serve(
    "--port",
    "0",
    "--from",
    bench.path("touches.mcap"),
    "--model",
    bench.path("palm.toml"),
  );
  try {
    const page = await openLesson(server);
    await pause(page);
    await seek(page, PAUSE_S - 1);
    await part(page, "teach-class").fill("tap");
    await part(page, "teach-listen").click();
    await part(page, "teach-listen").getByText("Stop").waitFor();
    await play(page, 1);
    await page.locator("[data-taught=tap] canvas").nth(1).waitFor();
    assert.match(await part(page, "teach-warnings").textContent(), /tap has \d of at least 5 examples/);
    await part(page, "teach-listen").click();
    await part(page, "teach-status").getByText("Teach at least two classes.").waitFor();
    assert.ok(await part(page, "teach-train").isDisabled());
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
  }
});

it("goes on another day with what was taught before", async () => {
  const server = await bench.serve(
    "--port",
    "0",
    "--from",
    bench.path("touches.mcap"),
    "--model",
    bench.path("palm.toml"),
  );
  try {
    const page = await openPage(browser, `${server.url}#/recognition`);
    await becomes(page, "live");
    await part(page, "teach-saved").locator("option").waitFor({ state: "attached" });
    await part(page, "teach-load").click();
    await eventually(
      page,
      (count) => document.querySelectorAll("[data-taught] canvas").length === count,
      KINDS.length * TAUGHT - 1,
    );
    await part(page, "teach-before").waitFor({ state: "hidden" });
    await part(page, "teach-train").click();
    await part(page, "teach-result")
      .getByText(/were right when left out/)
      .waitFor();
    assertUnhurt(page);
    await page.close();
  } finally {
    await server.stop();
  }
});
