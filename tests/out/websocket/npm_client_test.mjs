// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: node npm_client_test.mjs DERMIS: what a client that is not ours (@foxglove/ws-protocol, @foxglove/rosmsg) gets of
// `dermis serve` equals the CSV files of the same frames, on every channel.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";

const require = createRequire(new URL("../../npm/package.json", import.meta.url));
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const WebSocket = require("ws");

const PATIENCE_MS = 120_000;
const FRAMES_WANTED = 100;
const TAXELS = 20;
const MARKS = "/marks"; // the only topic that nothing is sent to unless somebody does something
const ARRAY = `[array]
name = "small"
rows = 4
cols = 5
taxel_area_mm2 = 38.48
[readout]
circuit = "divider"
drive_ohm = 20.0
load_ohm = 200.0
adc_bits = 12
adc_reference_v = 5.0
supply_v = 5.0
`;

const [dermis] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "dermis-client-"));
const path = (name) => join(folder, name);
const run = (...options) => execFileSync(dermis, options, { stdio: ["ignore", "pipe", "pipe"] });

/** Rows of a table of taxels by the time in nanoseconds. */
function table(name) {
  const [head, ...lines] = readFileSync(path(name), "utf8").trim().split("\n");
  const first = head.split(",").indexOf("r0c0");
  const rows = lines.map((line) => line.split(","));
  return { rows: rows.map((row) => row.slice(first).map(Number)), times: rows.map((row) => Number(row[0])) };
}

function prepare() {
  writeFileSync(path("array.toml"), ARRAY);
  run("simulate", "--array", path("array.toml"), "--scene", "calibration", "--out", path("cal"));
  run(
    "calibrate",
    "--array",
    path("array.toml"),
    "--frames",
    path("cal/frames.csv"),
    "--loads",
    path("cal/loads.csv"),
    "--out",
    path("model.safetensors"),
  );
  run("simulate", "--array", path("array.toml"), "--scene", "contacts", "--frames", "6000", "--out", path("in"));
  run("convert", path("in/frames.csv"), path("rec.mcap"), "--array", path("array.toml"));
  run("run", "--model", path("model.safetensors"), "--in", path("rec.mcap"), "--out", path("forces.csv"));
}

/** The server and the port that it says. */
async function serve(from) {
  const server = spawn(dermis, ["serve", "--from", from, "--model", path("model.safetensors"), "--port", "0"], {
    stdio: ["ignore", "ignore", "pipe"],
    cwd: folder,
  });
  let said = "";
  for await (const chunk of server.stderr) {
    said += chunk;
    const found = /http:\/\/127\.0\.0\.1:(\d+)\//.exec(said);
    if (found) return { server, port: Number(found[1]) };
  }
  throw new Error(`the server did not start: ${said}`);
}

function connect(port) {
  const client = new FoxgloveClient({
    ws: new WebSocket(`ws://127.0.0.1:${port}/`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
  });
  const channels = new Map();
  const services = new Map();
  client.on("advertise", (some) => some.forEach((channel) => channels.set(channel.topic, channel)));
  client.on("advertiseServices", (some) => some.forEach((service) => services.set(service.name, service)));
  return { client, channels, services };
}

/** The messages of these channels from now on, by topic. */
function listen({ client }, channels) {
  const seen = new Map();
  const readers = new Map();
  for (const channel of channels) {
    assert.deepEqual([channel.encoding, channel.schemaEncoding], ["cdr", "ros2msg"], channel.topic);
    seen.set(channel.topic, []);
    readers.set(client.subscribe(channel.id), {
      topic: channel.topic,
      reader: new MessageReader(parse(channel.schema, { ros2: true })),
    });
  }
  client.on("message", ({ subscriptionId, data }) => {
    const { topic, reader } = readers.get(subscriptionId);
    seen.get(topic).push(reader.readMessage(data));
  });
  return seen;
}

async function until(what, condition) {
  const end = Date.now() + PATIENCE_MS;
  while (!condition()) {
    if (Date.now() > end) throw new Error(`waited in vain for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

const nanos = ({ sec, nanosec }) => sec * 1e9 + nanosec;

function gridFields(grid) {
  const view = new DataView(grid.data.buffer, grid.data.byteOffset, grid.data.byteLength);
  return Object.fromEntries(
    grid.fields.map(({ name, offset, type }) => [
      name,
      Array.from({ length: TAXELS }, (_, taxel) => {
        const place = taxel * grid.cell_stride + offset;
        return type === 7 ? view.getFloat32(place, true) : view.getUint8(place);
      }),
    ]),
  );
}

async function call({ client, services }, name, request) {
  const service = services.get(name);
  const answer = new Promise((resolve, reject) => {
    client.on("serviceCallResponse", (response) =>
      resolve(JSON.parse(Buffer.from(response.data.buffer, response.data.byteOffset, response.data.byteLength))),
    );
    client.on("serviceCallFailure", ({ message }) => reject(new Error(message)));
  });
  client.sendServiceCallRequest({
    serviceId: service.id,
    callId: 1,
    encoding: "json",
    data: new Uint8Array(Buffer.from(JSON.stringify(request))),
  });
  return answer;
}

/** All parameters as the server tells them after these were set. */
async function setParameters({ client }, parameters) {
  const answer = new Promise((resolve) =>
    client.on("parameterValues", ({ parameters: values, id }) => {
      if (id === "told") resolve(new Map(values.map(({ name, value }) => [name, value])));
    }),
  );
  client.setParameters(parameters);
  client.getParameters([], "told");
  return answer;
}

function checkImages(seen, frames, forces, suit) {
  const rowAt = new Map(forces.times.map((time, row) => [Math.round(time * 1e4), row]));
  const rowOf = (message) =>
    rowAt.get(Math.round(nanos(message.header?.stamp ?? message.timestamp ?? message.stamp) / 1e5));
  for (const image of seen.get("/small/raw")) {
    const counts = new Uint16Array(image.data.slice().buffer);
    assert.deepEqual(Array.from(counts), frames.rows[rowOf(image)], "counts");
    assert.deepEqual([image.height, image.width, image.encoding], [4, 5, "16UC1"]);
  }
  for (const grid of seen.get("/small/force")) {
    assert.deepEqual(gridFields(grid).newtons, forces.rows[rowOf(grid)].map(Math.fround), "newtons");
  }
  for (const grid of seen.get("/small/conductance")) {
    const { siemens, sigma_siemens, status } = gridFields(grid);
    assert.ok(siemens.every((value) => value >= 0 && value < 0.1) && sigma_siemens.every((value) => value > 0));
    assert.ok(status.every((value) => value === 0));
  }
  for (const cloud of seen.get("/suit/points")) {
    const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
    for (let taxel = 0; taxel < TAXELS; ++taxel) {
      const at = (offset) => view.getFloat32(taxel * cloud.point_step + offset, true);
      assert.deepEqual([at(0), at(4), at(8)], suit.arrays[0].positions[taxel].map(Math.fround));
    }
  }
  for (const message of seen.get("/contacts")) {
    const onTaxels = forces.rows[rowOf(message)].reduce((sum, value) => sum + value, 0);
    assert.ok(message.total_force_n <= onTaxels * 1.001 + 1e-3, "contacts have no more than the taxels");
    const sum = message.touches.reduce((total, { force_n }) => total + force_n, 0);
    assert.ok(Math.abs(sum - message.total_force_n) < 1e-6);
  }
}

/** A recording that is begun and ended by a parameter holds the frames between, with the values of the CSV. */
async function checkRecording(connection, frames) {
  assert.equal((await setParameters(connection, [{ name: "/recording", value: true }])).get("/recording"), true);
  await new Promise((resolve) => setTimeout(resolve, 500));
  const after = await setParameters(connection, [{ name: "/recording", value: false }]);
  assert.equal(after.get("/recording"), false);
  const file = after.get("/recording/file");
  const recordings = readdirSync(folder).filter((name) => name.endsWith(".mcap") && name !== "rec.mcap");
  assert.deepEqual(recordings.map(path), [file], "it lies in the folder of the array");
  await until("the end of the recording", () => JSON.parse(run("info", "--json", file)).complete);
  run("convert", file, path("recorded.csv"));
  const recorded = table("recorded.csv");
  assert.ok(recorded.rows.length > 10, `${recorded.rows.length} frames in half a second`);
  recorded.times.forEach((time, row) => assert.deepEqual(recorded.rows[row], frames.rows[Math.round(time * 100) - 1]));
}

/** What cannot be is told, and changes nothing. */
async function checkRefusals(connection) {
  const lines = [];
  connection.client.on("status", ({ message }) => lines.push(message));
  const values = await setParameters(connection, [
    { name: "/contacts/onset_sigma", value: -1 },
    { name: "/stream/rate_hz", value: 0 },
    { name: "/nothing", value: 1 },
    { name: "/recording/file", value: "elsewhere.mcap" },
  ]);
  assert.deepEqual(
    [values.get("/contacts/onset_sigma"), values.get("/stream/rate_hz"), values.has("/nothing")],
    [5, 1000, false],
  );
  await until("the reasons", () => lines.length >= 4);
  assert.match(lines.join("\n"), /onset_sigma.*\n.*rate_hz.*\n.*nothing/);
}

/** A mark comes when it is set, which can be done while frames are live. */
async function checkMark() {
  const { server, port } = await serve("sim:contacts?rows=4&cols=5&rate=100");
  try {
    const connection = connect(port);
    const { client, channels, services } = connection;
    await until("the topic and the service of marks", () => channels.has(MARKS) && services.has("/marks/add"));
    const seen = listen(connection, [channels.get(MARKS)]);
    assert.deepEqual(await call(connection, "/marks/add", { label: "grasp", by: "anna" }), {});
    await until("the mark", () => seen.get(MARKS).length > 0);
    const [{ label, by }] = seen.get(MARKS);
    assert.deepEqual([label, by], ["grasp", "anna"]);
    client.close();
  } finally {
    server.kill("SIGINT");
  }
}

async function test() {
  prepare();
  await checkMark();
  const { server, port } = await serve(path("rec.mcap"));
  try {
    const suit = await (await fetch(`http://127.0.0.1:${port}/suit.json`)).json();
    assert.deepEqual([suit.arrays[0].name, suit.arrays[0].rows, suit.arrays[0].cols], ["small", 4, 5]);
    const connection = connect(port);
    const { client, channels } = connection;
    await until("channels", () => channels.size >= 9 && connection.services.size >= 6);
    const values = await setParameters(connection, [
      { name: "/drift/track", value: false },
      { name: "/tare", value: false },
      { name: "/stream/rate_hz", value: 1000 },
    ]);
    assert.deepEqual(
      [values.get("/drift/track"), values.get("/stream/rate_hz"), values.get("/recording")],
      [false, 1000, false],
    );
    await new Promise((resolve) => setTimeout(resolve, 200)); // the frame under way may have the old ones

    const seen = listen(
      connection,
      [...channels.values()].filter(({ topic }) => topic !== MARKS),
    );
    assert.deepEqual(await call(connection, "/calibration/start", { array: "small", weights_n: [1, 5] }), {});
    await until("messages", () =>
      [...seen].every(
        ([topic, messages]) =>
          messages.length >= (topic.startsWith("/small") || topic === "/contacts" ? FRAMES_WANTED : 2),
      ),
    );
    assert.deepEqual(await call(connection, "/calibration/cancel", {}), {});
    await assert.rejects(call(connection, "/calibration/skip", {}), /no calibration/);
    const frames = table("in/frames.csv");
    await checkRefusals(connection);
    await checkRecording(connection, frames);
    client.close();

    checkImages(seen, frames, table("forces.csv"), suit);
    assert.equal(seen.get("/statistics")[0].arrays[0].name, "small");
    assert.equal(seen.get("/health")[0].status[0].message, "healthy");
    assert.equal(seen.get("/tf")[0].transforms[0].child_frame_id, "small");
    const [begun] = seen.get("/calibration");
    assert.deepEqual([begun.array, begun.stage, begun.taxel_presses.length], ["small", 1, TAXELS]);
    console.log([...seen].map(([topic, messages]) => `${topic} ${messages.length}`).join(", "));
  } finally {
    server.kill("SIGINT");
  }
}

try {
  await test();
} finally {
  rmSync(folder, { recursive: true });
}
