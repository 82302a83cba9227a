// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node board_test.mjs path/to/dermis
// Boards at the page of site/try, behind a stand-in for navigator.serial that behaves as its specification says.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { resolve } from "node:path";
import { describe, it } from "node:test";
import { playMat, standInForBluetooth, standInForSerial, standInForUsb } from "./boards.mjs";
import { assertUnhurt, becomes, eventually, openPage, part } from "./harness.mjs";
import { site, useSite } from "./try_page.mjs";

useSite();

/** What an emulated device sends in some frames. */
const emulated = (protocol, source) =>
  execFileSync(
    resolve(process.argv[2]),
    ["emulate", "--protocol", protocol, "--in", source, "--rate", "1000", "--to", "stdout:"],
    { maxBuffer: 1 << 26, stdio: ["ignore", "pipe", "ignore"] },
  );

/** Frames of 12x10 in lines of text, which say what they are not. */
function mat(frames = 50) {
  const lines = [];
  for (let frame = 0; frame < frames; ++frame) {
    const counts = Array.from(
      { length: 120 },
      (_, taxel) => 300 + ((taxel * 7 + frame) % 5) + (taxel === 57 ? 900 : 0),
    );
    lines.push(counts.join(","));
  }
  return Buffer.from(`${lines.join("\n")}\n`);
}

/** A page with a board that sends those bytes. */
async function withBoard(bytes, bytesPerSecond, test, { baud = 115200 } = {}) {
  const context = await site.browser.newContext({ viewport: { width: 1280, height: 800 } });
  try {
    await context.addInitScript(standInForSerial);
    const page = await openPage(context, site.url);
    await becomes(page, "live");
    await play(page, bytes, bytesPerSecond);
    await page.locator("#board-baud").selectOption(String(baud));
    await test(page);
    assertUnhurt(page);
  } finally {
    await context.close();
  }
}

async function play(page, bytes, bytesPerSecond) {
  await page.evaluate(
    ([text, rate]) => {
      board.bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
      board.bytesPerSecond = rate;
    },
    [Buffer.from(bytes).toString("base64"), bytesPerSecond],
  );
}

const connect = (page) => part(page, "connect-board").click();
const says = (page, words) => part(page, "board-words").filter({ hasText: words }).waitFor();
const fieldOf = (page, id) => page.locator(`#${id}`).inputValue();

/** Describes the array as its frames show it, and waits for its map. */
async function describeArray(page, name = "mat") {
  await page.locator("#array-name").fill(name);
  await page.getByRole("button", { name: "Show it" }).click();
  await page.locator("[data-view=array]").waitFor();
  await eventually(page, () => document.querySelector("[data-view=array]")?.dataset.stamp !== undefined);
}

/** A page beside a board that notifies its bytes by Bluetooth. */
async function withRadio(test) {
  const context = await site.browser.newContext();
  await context.addInitScript(standInForBluetooth);
  const page = await openPage(context, site.url);
  await becomes(page, "live");
  await page.evaluate(
    (text) => (radio.bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))),
    mat(20).toString("base64"),
  );
  await page.getByText("Other ways").click();
  await test(page);
  assertUnhurt(page);
  await context.close();
}

async function describeRadio(page) {
  await says(page, "Connected: Mat");
  await page.locator("#array-rows").fill("12");
  await page.locator("#array-cols").fill("10");
  await describeArray(page);
}

const stampOf = (page) => page.evaluate(() => document.querySelector("[data-view=array]").dataset.stamp);

async function isLive(page) {
  const stamp = await stampOf(page);
  await eventually(page, (before) => document.querySelector("[data-view=array]").dataset.stamp !== before, stamp);
}

/** Packets of 12x10 with a mark before each, which no protocol of dermis knows. */
function packets(frames = 60) {
  const all = [];
  for (let frame = 0; frame < frames; ++frame) {
    const packet = Buffer.alloc(4 + 240);
    packet.set([0xa5, 0x5a, 0xc3, frame % 256]);
    for (let taxel = 0; taxel < 120; ++taxel) packet.writeUInt16LE(700 + ((taxel * 13 + frame) % 9), 4 + 2 * taxel);
    all.push(packet);
  }
  return Buffer.concat(all);
}

const LAYOUT = `[layout]
rows = 12
cols = 10
packet = ["A5 5A C3", "frame u8", "values u16le"]
`;

const DONE = 4; // CalibrationStage.done
const FIT_MS = 600_000;
const MOST_ACTIONS = 20;

const taxelOf = (row, col) => 10 * Number(row) + Number(col);

/** Does with the mat what the page says, until there is a model. */
async function obey(page) {
  const stageOf = async () => Number(await part(page, "walk").getAttribute("data-stage"));
  for (const end = Date.now() + FIT_MS; Date.now() < end && (await stageOf()) < DONE; ) {
    const said = await part(page, "instruction").textContent();
    const press = /put ([\d.]+) N .*? on r(\d+)c(\d+)(?: and as much on r(\d+)c(\d+))?/i.exec(said);
    let pressed;
    if (press !== null) {
      const [, newtons, row, col, otherRow, otherCol] = press;
      pressed = { [taxelOf(row, col)]: Number(newtons) };
      if (otherRow !== undefined) pressed[taxelOf(otherRow, otherCol)] = Number(newtons);
    } else if (!/[Hh]old/.test(said)) pressed = {};
    if (pressed !== undefined) await page.evaluate((taxels) => Object.assign(board, { pressed: taxels }), pressed);
    await page.waitForTimeout(20);
  }
}

describe("a board at the page of site/try", () => {
  it("comes to newtons in few actions, from lines of a mat whose circuit nobody knows", async () => {
    await withBoard(Buffer.alloc(0), 0, async (page) => {
      let actions = 0;
      const does = async (action) => {
        actions += 1;
        await action;
      };
      await page.evaluate(playMat);
      await does(connect(page));
      await says(page, "Connected");
      assert.equal(await fieldOf(page, "array-rows"), "12");
      assert.equal(await fieldOf(page, "array-cols"), "10");
      await does(page.getByRole("button", { name: "Show it" }).click());
      await does(part(page, "calibrate").click());
      await does(part(page, "weights").fill("5, 20"));
      await does(part(page, "hold").fill("0.1"));
      await does(part(page, "start").click());
      await part(page, "walk").waitFor();
      await obey(page);
      await page.locator(`[data-role=walk][data-stage='${DONE}']`).waitFor();
      await does(part(page, "save").click());
      await page.locator("[data-role=instruction]", { hasText: "in use" }).waitFor();
      await does(page.locator("[data-tab=array]").click());
      await page.evaluate((taxel) => Object.assign(board, { pressed: { [taxel]: 8 } }), taxelOf(4, 4));
      await page.locator("[data-role=highest-taxel]", { hasText: /^(6\.[5-9]|7|8|9\.[0-4])[\d.]* N +r4c4$/ }).waitFor();
      assert.ok(actions <= MOST_ACTIONS, `${actions} actions`);
    });
  });

  it("is looked at, described, and its counts are live", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await connect(page);
      await says(page, "Connected: USB 2341:0043");
      await part(page, "array-setup").waitFor();
      assert.deepEqual(await page.evaluate(() => board.bauds), [115200]);
      assert.deepEqual(await page.evaluate(() => board.signals), { dataTerminalReady: true, requestToSend: true });
      await page.locator("#array-rows").fill("12");
      await page.locator("#array-cols").fill("10");
      await describeArray(page);
      await isLive(page);
    });
  });

  it("is described where its protocol says its shape", async () => {
    await withBoard(emulated("dermis", "sim:idle?rows=6&cols=5"), 40_000, async (page) => {
      await connect(page);
      await part(page, "found").filter({ hasText: "dermis, 6x5" }).waitFor();
      assert.equal(await fieldOf(page, "array-rows"), "6");
      assert.equal(await fieldOf(page, "array-cols"), "5");
    });
  });

  it("of unknown packets is read by a layout that the page proposes, which a link then holds", async () => {
    await withBoard(packets(), 60_000, async (page) => {
      await connect(page);
      await page.locator("#array-rows").fill("12");
      await page.locator("#array-cols").fill("10");
      await page.locator('[data-role=layout-map][width="10"][height="12"]').waitFor(); // of these rows and columns
      await part(page, "use-layout").click();
      await describeArray(page);
      await page.evaluate(() => {
        navigator.clipboard.writeText = async (text) => {
          globalThis.copied = text;
        };
      });
      await part(page, "copy-link").click();
      const link = await page.evaluate(() => globalThis.copied);
      assert.match(link, /#layout=[\w-]+&baud=115200$/);
    });
  });

  it("is read by the layout of a link, which is shown first", async () => {
    const context = await site.browser.newContext();
    await context.addInitScript(standInForSerial);
    const page = await openPage(context, `${site.url}#toml=${encodeURIComponent(LAYOUT)}&baud=2000000`);
    await becomes(page, "live");
    await page.getByLabel("The layout", { exact: true }).filter({ hasText: "A5 5A C3" }).waitFor();
    await part(page, "use-link").click();
    await play(page, packets(), 60_000);
    await connect(page);
    await says(page, "Connected");
    assert.deepEqual(await page.evaluate(() => board.bauds), [2000000]);
    assert.equal(await fieldOf(page, "array-rows"), "12");
    await describeArray(page);
    await isLive(page);
    assertUnhurt(page);
    await context.close();
  });

  it("is read without a loss at 2 Mbaud", async () => {
    const context = await site.browser.newContext({ viewport: { width: 1280, height: 800 } });
    await context.addInitScript(standInForSerial);
    const layout = '[layout]\nrows = 32\ncols = 32\npacket = ["A5 5A C3", "frame u32le", "values u16le"]\n';
    const page = await openPage(context, `${site.url}#toml=${encodeURIComponent(layout)}&baud=2000000`);
    await becomes(page, "live");
    await page.evaluate(() => {
      let frame = 0;
      board.says = () => {
        const packet = new DataView(new ArrayBuffer(7 + 2048));
        [0xa5, 0x5a, 0xc3].forEach((byte, at) => packet.setUint8(at, byte));
        packet.setUint32(3, frame++, true);
        for (let taxel = 0; taxel < 1024; ++taxel) packet.setUint16(7 + 2 * taxel, 600 + ((taxel + frame) % 7), true);
        return new Uint8Array(packet.buffer);
      };
    });
    await part(page, "use-link").click();
    await connect(page);
    await says(page, "Connected");
    await describeArray(page);
    await page.locator("[data-tab=health]").click();
    const fieldsOf = () =>
      page.evaluate(() =>
        Object.fromEntries(
          [...document.querySelectorAll("[data-array] [data-field]")].map(({ dataset, textContent }) => [
            dataset.field,
            Number(textContent.replaceAll(/[^0-9.-]/g, "")),
          ]),
        ),
      );
    await eventually(page, () => document.querySelector("[data-array] [data-field=frames]")?.textContent.length > 2);
    const before = await fieldsOf();
    const seconds = Number(process.env.DERMIS_BOARD_SECONDS ?? 10);
    await page.waitForTimeout(1000 * seconds);
    const { frames, lost, damaged, skipped } = await fieldsOf();
    assert.deepEqual({ lost, damaged, skipped }, { lost: 0, damaged: 0, skipped: 0 });
    console.log(`${frames - before.frames} frames of 2055 bytes in ${seconds} s, none lost`);
    assertUnhurt(page);
    await context.close();
  });

  it("goes on when it is plugged in again, without another permission", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await connect(page);
      await page.locator("#array-rows").fill("12");
      await page.locator("#array-cols").fill("10");
      await describeArray(page);
      await page.evaluate(() => board.unplug());
      await says(page, "The board is unplugged");
      await page.waitForTimeout(1500);
      await page.evaluate(() => board.plugIn());
      await says(page, "The board is back");
      await isLive(page);
    });
  });

  it("goes on when it is chosen again, where its permission was lost with it", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await connect(page);
      await page.locator("#array-rows").fill("12");
      await page.locator("#array-cols").fill("10");
      await describeArray(page);
      await page.evaluate(() => board.unplug());
      await says(page, "The board is unplugged");
      await page.evaluate(() => board.plugIn({ isKnown: false }));
      await connect(page);
      await says(page, "The board is back");
      await isLive(page);
    });
  });

  it("that is away for too long is told, and served again from what was written of it", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await connect(page);
      await page.locator("#array-rows").fill("12");
      await page.locator("#array-cols").fill("10");
      await describeArray(page);
      await page.evaluate(() => board.unplug());
      await part(page, "notice").filter({ hasText: "did not come back within 10 s" }).waitFor();
      await page.evaluate(() => board.plugIn());
      await says(page, "was away for more than 10 s");
      await connect(page);
      await says(page, "Connected");
      await page.locator("[data-role=array-setup] [data-known='mat/array.toml']").click();
      await isLive(page);
    });
  });

  it("goes on after a buffer that was full, and says so", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await connect(page);
      await page.locator("#array-rows").fill("12");
      await page.locator("#array-cols").fill("10");
      await describeArray(page);
      await page.evaluate(() => board.port.receive(new Uint8Array(board.port.bufferSize + 1)));
      await says(page, "bytes came faster than the browser took them");
      await isLive(page);
    });
  });

  it("that another program has is told, and connected once it is free", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await page.evaluate(() => (board.isHeld = true));
      await connect(page);
      await says(page, "another program has it");
      await page.evaluate(() => (board.isHeld = false));
      await connect(page);
      await says(page, "Connected");
    });
  });

  it("that is not chosen changes nothing", async () => {
    await withBoard(mat(), 60_000, async (page) => {
      await page.evaluate(() => (chooses = false));
      await connect(page);
      await says(page, "No board was chosen");
      await becomes(page, "live");
    });
  });

  it("is heard by Bluetooth, and again when it is back in reach", async () => {
    await withRadio(async (page) => {
      await part(page, "connect-bluetooth").click();
      await describeRadio(page);
      await page.evaluate(() => {
        radio.isInReach = false;
        radio.cut();
      });
      await says(page, "The board is unplugged");
      await page.evaluate(() => (radio.isInReach = true));
      await says(page, "The board is back");
      await isLive(page);
    });
  });

  it("is heard by the characteristic that the user chooses, where several notify", async () => {
    await withRadio(async (page) => {
      await page.evaluate(() => radio.addSilent());
      await part(page, "connect-bluetooth").click();
      await page.getByLabel("Characteristic").selectOption("6e400003-b5a3-f393-e0a9-e50e24dcca9e");
      await describeRadio(page);
      await isLive(page);
    });
  });

  it("is read at USB without a driver, and again when it is chosen again", async () => {
    const context = await site.browser.newContext();
    await context.addInitScript(standInForUsb);
    const page = await openPage(context, site.url);
    await becomes(page, "live");
    await page.evaluate((text) => {
      usbPort.bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    }, mat(20).toString("base64"));
    await page.getByText("Other ways").click();
    await part(page, "connect-usb").click();
    await says(page, "Connected: Pico");
    assert.equal(await page.evaluate(() => usbPort.baud), 115200);
    await page.locator("#array-rows").fill("12");
    await page.locator("#array-cols").fill("10");
    await describeArray(page);
    await page.evaluate(() => {
      usbPort.isPlugged = false;
    });
    await says(page, "The board is unplugged");
    await page.evaluate(() => {
      usbPort.isPlugged = true;
    });
    await part(page, "connect-usb").click();
    await says(page, "The board is back");
    await isLive(page);
    assertUnhurt(page);
    await context.close();
  });

  it("needs another browser where this one has no serial ports, and the page says which", async () => {
    const context = await site.browser.newContext();
    await context.addInitScript(() => Object.defineProperty(Navigator.prototype, "serial", { get: () => undefined }));
    const page = await openPage(context, site.url);
    await becomes(page, "live");
    await part(page, "no-serial").filter({ hasText: "Chrome, Edge and Opera" }).waitFor();
    assertUnhurt(page);
    await context.close();
  });
});
