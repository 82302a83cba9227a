// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node suit_test.mjs path/to/dermis
// The suit view with a body of a URDF and of meshes, and without one: its labels, its scale, and joints that a client of the
// stream moves.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { it } from "node:test";
import { becomes, bench, eventually, shown, useBench, WAIT_MS } from "./harness.mjs";

const require = createRequire(new URL("../npm/package.json", import.meta.url));
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { WebSocket } = require("ws");

useBench(() => {
  writeFileSync(bench.path("hand.stl"), binaryStl());
  writeFileSync(bench.path("head.glb"), glb());
  writeFileSync(bench.path("broken.glb"), "no mesh");
});

/** A triangle of 10 cm. */
function binaryStl() {
  const bytes = Buffer.alloc(84 + 50);
  bytes.writeUInt32LE(1, 80);
  [0, 0, 1, 0, 0, 0, 0.1, 0, 0, 0, 0.1, 0].forEach((value, index) => bytes.writeFloatLE(value, 84 + 4 * index));
  return bytes;
}

/** The same as glTF in one file. */
function glb() {
  const positions = Buffer.alloc(36);
  [0, 0, 0, 0.1, 0, 0, 0, 0.1, 0].forEach((value, index) => positions.writeFloatLE(value, 4 * index));
  let json = JSON.stringify({
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: "VEC3", min: [0, 0, 0], max: [0.1, 0.1, 0] }],
    bufferViews: [{ buffer: 0, byteLength: 36 }],
    buffers: [{ byteLength: 36 }],
  });
  json = json.padEnd(4 * Math.ceil(json.length / 4));
  const word = (value) => {
    const bytes = Buffer.alloc(4);
    bytes.writeUInt32LE(value);
    return bytes;
  };
  const total = 12 + 8 + json.length + 8 + positions.length;
  return Buffer.concat([
    Buffer.from("glTF"),
    word(2),
    word(total),
    word(json.length),
    Buffer.from("JSON"),
    Buffer.from(json),
    word(36),
    Buffer.from("BIN\0"),
    positions,
  ]);
}

function urdf(mesh) {
  return `<robot name="arm">
  <link name="trunk"><visual><origin xyz="0.02 0.015 -0.04"/><geometry><box size="0.1 0.1 0.06"/></geometry></visual></link>
  <link name="forearm">
    <visual><origin xyz="0.02 0.015 -0.03"/><geometry><cylinder radius="0.02" length="0.05"/></geometry></visual>
    <visual><geometry><mesh filename="hand.stl"/></geometry></visual>
    <visual><geometry><mesh filename="package://arm/${mesh}"/></geometry></visual>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="trunk"/><child link="forearm"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="0.1"/>
  </joint>
</robot>
`;
}

/** A suit of two arrays, with what `suit` says of its body. */
function writeSuit(suit, links) {
  const array = (name, seed, link, x) => `[[array]]
name = "${name}"
from = "sim:contacts?rate=100&seed=${seed}"
model = "model.safetensors"
${links ? `link = "${link}"\n` : ""}base_from_array = {translation_mm = [${links ? 0 : x}, 0, 0]}
`;
  writeFileSync(
    bench.path("suit.toml"),
    `[suit]\n${suit}\n${array("chest", 1, "trunk", 0)}${array("arm", 2, "forearm", 200)}`,
  );
}

const showSuit = (test) =>
  shown(["--suit", "suit.toml"], "suit", async (page, server) => {
    await eventually(page, () => document.querySelectorAll(".array-label:not([hidden])").length === 2);
    await test(page, server);
  });

/** In the page: labels that lie over one another or out of the picture, a line each. */
function faultsOfLabels() {
  const room = document.querySelector(".suit-room").getBoundingClientRect();
  const labels = [...document.querySelectorAll(".array-label:not([hidden]), .force-label:not([hidden])")];
  const boxes = labels.map((label) => ({ words: label.textContent, box: label.getBoundingClientRect() }));
  const faults = [];
  boxes.forEach(({ words, box }, index) => {
    if (box.left < room.left || box.right > room.right || box.top < room.top || box.bottom > room.bottom)
      faults.push(`${words} is cut`);
    for (const other of boxes.slice(index + 1)) {
      const width = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left);
      const height = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
      if (width > 0 && height > 0) faults.push(`${words} lies over ${other.words}`);
    }
  });
  return faults;
}

async function labelsAreApart(page) {
  await page.waitForFunction(() => document.querySelectorAll(".force-label:not([hidden])").length >= 2, undefined, {
    timeout: WAIT_MS,
  });
  for (let look = 0; look < 20; ++look) {
    assert.deepEqual(await page.evaluate(faultsOfLabels), []);
    await page.waitForTimeout(50);
  }
}

/** Calls a service as a robot does, by a client that is not ours. */
function call(server, name, request) {
  const client = new FoxgloveClient({
    ws: new WebSocket(`ws://127.0.0.1:${server.port}/`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
  });
  return new Promise((resolve, reject) => {
    client.on("error", reject);
    client.on("serviceCallFailure", ({ message }) => reject(new Error(message)));
    client.on("serviceCallResponse", ({ data }) =>
      resolve(JSON.parse(Buffer.from(data.buffer, data.byteOffset, data.byteLength).toString())),
    );
    client.on("advertiseServices", (services) => {
      const service = services.find((one) => one.name === name);
      if (service === undefined) return;
      const data = new Uint8Array(Buffer.from(JSON.stringify(request)));
      client.sendServiceCallRequest({
        serviceId: service.id,
        callId: 1,
        encoding: "json",
        data: new DataView(data.buffer),
      });
    });
  }).finally(() => client.close());
}

/** Where the line from its label ends. */
const leftOf = (page, name) =>
  page.locator(`.array-label[data-array=${name}]`).evaluate((label) => Number(label.dataset.at.split(" ")[0]));

it("shows a body, and its labels are apart", async () => {
  writeSuit('body = "arm.urdf"', true);
  writeFileSync(bench.path("arm.urdf"), urdf("head.glb"));
  await showSuit(async (page) => {
    const files = [];
    page.on("response", (response) => /\/body\//.test(response.url()) && files.push(response.status()));
    await page.reload();
    await becomes(page, "live");
    await labelsAreApart(page);
    assert.deepEqual(files, [200, 200]);
    assert.doesNotMatch(await page.locator("[data-role=notice]").textContent(), /\.glb|\.stl/);
    assert.equal(await page.locator(".arrow-scale").innerText(), "10 N");
    const before = await page.locator(".arrow-length").evaluate((line) => line.offsetWidth);
    assert.ok(before > 20, String(before));
    await page.selectOption("[aria-label='End of the force scale']", "2");
    assert.equal(await page.locator(".arrow-scale").innerText(), "2 N");
    assert.deepEqual(
      await page
        .locator(".orientation text")
        .allTextContents()
        .then((letters) => letters.sort()),
      ["x", "y", "z"],
    );
  });
});

it("moves a link and its array as a client of the stream says", async () => {
  writeSuit('body = "arm.urdf"', true);
  writeFileSync(bench.path("arm.urdf"), urdf("head.glb"));
  await showSuit(async (page, server) => {
    await page.locator("[data-role=suit]").press("ArrowLeft"); // from now on it does not turn by itself
    await page.waitForTimeout(300);
    const [arm, chest] = [await leftOf(page, "arm"), await leftOf(page, "chest")];
    assert.deepEqual(await call(server, "/body/joints", { name: ["slide"], position: [0.1] }), {});
    await page.waitForFunction(
      ([name, from]) =>
        Math.abs(Number(document.querySelector(`.array-label[data-array=${name}]`).dataset.at.split(" ")[0]) - from) >
        20,
      ["arm", arm],
      { timeout: WAIT_MS },
    );
    assert.ok(Math.abs((await leftOf(page, "chest")) - chest) < 3);
    await assert.rejects(call(server, "/body/joints", { name: ["knee"], position: [1] }), /no such joint/);
  });
});

it("says which mesh of a body cannot be shown", async () => {
  writeSuit('body = "arm.urdf"', true);
  writeFileSync(bench.path("arm.urdf"), urdf("broken.glb"));
  await showSuit(async (page) => {
    await page.locator("[data-role=notice]", { hasText: "broken.glb" }).waitFor();
  });
});

/** In the page: the picture of the suit as the browser shows it, its border and the share that differs from its corner. */
async function lookAtPicture(page) {
  const shot = await page.locator(".suit-room > canvas").screenshot();
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    const ink = canvas.getContext("2d");
    ink.drawImage(image, 0, 0);
    const { data: pixels, width, height } = ink.getImageData(0, 0, canvas.width, canvas.height);
    const isDrawn = (x, y) =>
      [0, 1, 2].some(
        (channel) => Math.abs(pixels[4 * (y * width + x) + channel] - pixels[4 * (3 * width + 3) + channel]) > 12,
      );
    let [inside, atBorder] = [0, 0];
    for (let y = 2; y < height - 2; ++y) {
      for (let x = 2; x < width - 2; ++x) {
        if (!isDrawn(x, y)) continue;
        inside += 1;
        if (y === 2 || y === height - 3 || x === 2 || x === width - 3) atBorder += 1;
      }
    }
    return { inside: inside / (width * height), atBorder };
  }, shot.toString("base64"));
}

it("has the whole body in view when it is opened", async () => {
  writeSuit('body = "tall.urdf"', true);
  writeFileSync(
    bench.path("tall.urdf"),
    urdf("head.glb").replace('<box size="0.1 0.1 0.06"/>', '<box size="0.2 0.3 1.8"/>'),
  );
  await showSuit(async (page) => {
    const end = Date.now() + WAIT_MS;
    let seen;
    do seen = await lookAtPicture(page);
    while ((seen.inside <= 0.02 || seen.atBorder > 0) && Date.now() < end); // its meshes come one by one
    assert.ok(seen.inside > 0.02, String(seen.inside));
    assert.equal(seen.atBorder, 0);
  });
});

it("shows the frame of the pause where it is opened later", async () => {
  await shown(["--from", "sim:contacts?rate=100", ...bench.model], "array", async (page) => {
    await page.locator("[data-role=highest-taxel]", { hasText: / N / }).waitFor();
    await page.locator("[data-role=pause]").click();
    await page.locator("[data-tab=suit]").click();
    await eventually(page, () => Number(document.querySelector("[data-view=suit]")?.dataset.stamp) > 0);
    const stamp = () => page.locator("[data-view=suit]").getAttribute("data-stamp");
    const first = await stamp();
    await page.waitForTimeout(300);
    assert.equal(await stamp(), first);
    await page.locator("[data-role=pause]").click();
    await eventually(page, (before) => document.querySelector("[data-view=suit]").dataset.stamp !== before, first);
  });
});

it("shows the array that is opened during a pause, too", async () => {
  await shown(["--from", "sim:contacts?rate=100", ...bench.model], "time", async (page) => {
    await page.locator("[data-role=pause]").click();
    await page.locator("[data-tab=array]").click();
    await page.locator("[data-role=highest-taxel]", { hasText: / N / }).waitFor();
  });
});

it("shows a mannequin where nothing is known of the body", async () => {
  writeSuit("", false);
  await showSuit(labelsAreApart);
});
