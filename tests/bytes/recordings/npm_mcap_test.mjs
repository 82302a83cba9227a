// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Recordings against the reader and the writer of npm's @mcap/core and the decoder of @foxglove/rosmsg2-serialization.
// Usage: node npm_mcap_test.mjs MCAP_SAMPLE
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";

import * as npm from "./npm_mcap.mjs";

const sample = process.env.MCAP_SAMPLE ?? process.argv[2];
const folder = mkdtempSync(join(tmpdir(), "dermis_npm_mcap_"));
after(() => rmSync(folder, { recursive: true }));
execFileSync(sample, ["write", folder]);
const expected = JSON.parse(readFileSync(join(folder, "expected.json"), "utf8"));

const lines = (...command) =>
  execFileSync(sample, command, { encoding: "utf8", maxBuffer: 1 << 28, stdio: "pipe" })
    .split("\n")
    .filter(Boolean)
    .map(JSON.parse);

const nanos = (stamp) => BigInt(stamp.sec) * 1_000_000_000n + BigInt(stamp.nanosec);

/** What a message of ours says, as in expected.json. */
const decoded = {
  "sensor_msgs/msg/Image": (message, frame) => {
    assert.equal(message.height, 7);
    assert.equal(message.width, 9);
    assert.equal(message.header.frame_id, "left_hand");
    assert.equal(message.is_bigendian, 0);
    const words = message.encoding === "16UC1";
    assert.ok(words || message.encoding === "32FC1");
    assert.equal(message.step, 9 * (words ? 2 : 4));
    const buffer = message.data.slice().buffer;
    const bits = words ? new Uint32Array(Float32Array.from(new Uint16Array(buffer)).buffer) : new Uint32Array(buffer);
    assert.deepEqual(Array.from(bits), frame.counts);
    assert.equal(String(nanos(message.header.stamp)), frame.time);
  },
  "sensor_msgs/msg/Temperature": (message, frame) => {
    assert.equal(message.temperature, frame.temperature);
    assert.equal(String(nanos(message.header.stamp)), frame.time);
  },
  "dermis_msgs/msg/Acquisition": (message, frame) => {
    assert.equal(String(message.time_ns), frame.time);
    assert.equal(message.has_sequence_number ? String(message.sequence_number) : null, frame.sequence);
    assert.equal(message.has_device_time ? String(message.device_time_ns) : null, frame.device_time);
    assert.equal(String(message.arrival_steady_ns), frame.arrival_steady);
    assert.equal(String(message.arrival_utc_ns), frame.arrival_utc);
    assert.equal(message.lost_before, frame.lost_before);
    assert.equal(message.held_taxels, frame.held_taxels);
    assert.equal(message.has_supply_v ? message.supply_v : null, frame.supply);
  },
  "foxglove_msgs/msg/Grid": (message, frame) => {
    assert.equal(message.column_count, 9);
    assert.deepEqual({ ...message.cell_size }, { x: 0.005, y: 0.004 });
    assert.deepEqual({ ...message.pose.orientation }, { x: 0, y: 0, z: 0, w: 1 });
    assert.equal(message.row_stride, 9 * message.cell_stride);
    assert.deepEqual(
      message.fields.map((field) => [field.name, field.type]),
      [
        ["newtons", 7],
        ["sigma_newtons", 7],
        ["status", 1],
      ],
    );
    const view = new DataView(message.data.buffer, message.data.byteOffset, message.data.byteLength);
    const cells = Array.from({ length: 63 }, (_, i) => i * message.cell_stride);
    const [newtons, sigma, status] = message.fields.map((field) => field.offset);
    assert.deepEqual(
      cells.map((cell) => view.getUint32(cell + newtons, true)),
      frame.newtons,
    );
    assert.deepEqual(
      cells.map((cell) => view.getUint32(cell + sigma, true)),
      frame.sigma_newtons,
    );
    assert.deepEqual(
      cells.map((cell) => view.getUint8(cell + status)),
      frame.status,
    );
  },
  "dermis_msgs/msg/FrameStatus": (message, frame) => {
    assert.equal(message.status, frame.force_status);
    assert.equal(String(message.time_ns), frame.time);
  },
};

const topics = {
  "/left_hand/raw": "sensor_msgs/msg/Image",
  "/left_hand/temperature": "sensor_msgs/msg/Temperature",
  "/left_hand/acquisition": "dermis_msgs/msg/Acquisition",
  "/left_hand/force": "foxglove_msgs/msg/Grid",
  "/left_hand/force_status": "dermis_msgs/msg/FrameStatus",
};

for (const compression of ["none", "lz4", "zstd"]) {
  test(`our file, ${compression}: every message by the index`, async () => {
    const { reader, messages, attachments, metadata } = await npm.readIndexed(join(folder, `${compression}.mcap`));
    assert.equal(reader.header.profile, "ros2");
    assert.match(reader.header.library, /^dermis \d/);
    assert.equal(Number(reader.statistics.messageCount), messages.length);
    assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
    assert.ok(reader.chunkIndexes.every((chunk) => chunk.compression === (compression === "none" ? "" : compression)));
    const decoders = new Map();
    const seen = {};
    for (const [id, channel] of reader.channelsById) {
      const schema = reader.schemasById.get(channel.schemaId);
      assert.equal(channel.messageEncoding, "cdr");
      assert.equal(schema.encoding, "ros2msg");
      assert.equal(schema.name, topics[channel.topic]);
      const definition = npm.parseDefinition(new TextDecoder().decode(schema.data), { ros2: true });
      decoders.set(id, [schema.name, new npm.MessageReader(definition)]);
    }
    for (const message of messages) {
      const [name, decoder] = decoders.get(message.channelId);
      const frame = expected[message.sequence];
      assert.equal(String(message.logTime), frame.time);
      decoded[name](decoder.readMessage(message.data), frame);
      seen[name] = (seen[name] ?? 0) + 1;
    }
    assert.deepEqual(seen, {
      "sensor_msgs/msg/Image": 300,
      "sensor_msgs/msg/Temperature": expected.filter((frame) => frame.temperature !== null).length,
      "dermis_msgs/msg/Acquisition": 300,
      "foxglove_msgs/msg/Grid": 100,
      "dermis_msgs/msg/FrameStatus": 100,
    });
    assert.equal(attachments.length, 1);
    assert.equal(attachments[0].name, "array.toml");
    assert.equal(new TextDecoder().decode(attachments[0].data), '[array]\nname = "left hand"\n');
    const values = Object.fromEntries(metadata.map((record) => [record.name, Object.fromEntries(record.metadata)]));
    assert.equal(values.dermis.name, "left hand");
    assert.equal(values.dermis.model_hash, "fnv1a64:0123456789abcdef");
    assert.equal(values["dermis.totals"].frames, "300");
  });

  test(`our file, ${compression}: from its beginning on, and the CRC of its data`, async () => {
    const path = join(folder, `${compression}.mcap`);
    const bytes = readFileSync(path);
    const streamed = npm.readStreamed(bytes);
    const { reader, messages } = await npm.readIndexed(path);
    assert.ok(streamed.complete);
    assert.deepEqual(
      streamed.map((message) => message.data),
      messages.map((message) => message.data),
    );
    const dataEnd = Number(reader.footer.summaryStart) - 13;
    assert.equal(bytes[dataEnd], 0x0f);
    assert.notEqual(streamed.dataCrc, 0);
    assert.equal(streamed.dataCrc, npm.crc32(bytes.subarray(0, dataEnd)));
  });

  test(`our file, ${compression}: cut anywhere, recovered, read by the index`, async () => {
    const bytes = readFileSync(join(folder, `${compression}.mcap`));
    const { reader } = await npm.readIndexed(join(folder, `${compression}.mcap`));
    const all = lines("frames", join(folder, `${compression}.mcap`));
    for (let k = 1; k <= 20; ++k) {
      const cut = join(folder, "cut.mcap");
      const whole = join(folder, "recovered.mcap");
      const size = Math.floor((bytes.length * k) / 21);
      writeFileSync(cut, bytes.subarray(0, size));
      const endsBefore = (chunk) => Number(chunk.chunkStartOffset + chunk.chunkLength) <= size;
      const lastTime = reader.chunkIndexes.filter(endsBefore).at(-1)?.messageEndTime;
      if (lastTime === undefined) {
        assert.throws(() => lines("recover", cut, whole), /nothing can be recovered/);
        continue;
      }
      const [recovery] = lines("recover", cut, whole);
      const { messages } = await npm.readIndexed(whole);
      assert.equal(messages.length, recovery.messages);
      const frames = all.filter((frame) => BigInt(frame.time) <= lastTime).length;
      assert.equal(recovery.frames, frames);
      assert.deepEqual(lines("frames", whole), all.slice(0, recovery.frames));
      assert.deepEqual(lines("frames", cut), all.slice(0, recovery.frames));
    }
  });
}

/** The bytes of a file that npm's writer makes of `messages`, each [topic, log time, data]. */
async function written(messages, options) {
  const parts = [];
  let size = 0n;
  const writable = {
    write: async (bytes) => {
      parts.push(bytes.slice());
      size += BigInt(bytes.length);
    },
    position: () => size,
  };
  const writer = new npm.core.McapWriter({ writable, ...options });
  await writer.start({ profile: "ros2", library: "npm" });
  const definition = "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n";
  const schemaId = await writer.registerSchema({
    name: "sensor_msgs/msg/Image",
    encoding: "ros2msg",
    data: new TextEncoder().encode(definition),
  });
  const channels = new Map();
  for (const topic of new Set(messages.map(([name]) => name))) {
    channels.set(
      topic,
      await writer.registerChannel({
        schemaId,
        topic,
        messageEncoding: "cdr",
        metadata: new Map([["offered_qos_profiles", ""]]),
      }),
    );
  }
  await writer.addAttachment({
    name: "note.txt",
    mediaType: "text/plain",
    logTime: 1n,
    createTime: 2n,
    data: new TextEncoder().encode("note"),
  });
  for (const [sequence, [topic, logTime, data]] of messages.entries()) {
    await writer.addMessage({ channelId: channels.get(topic), sequence, logTime, publishTime: logTime + 1n, data });
  }
  await writer.addMetadata({ name: "note", metadata: new Map([["key", "value"]]) });
  await writer.end();
  return Buffer.concat(parts);
}

/** A mono16 image of 2x3 pixels with a frame_id of a letter. */
function image(number) {
  const words = Uint16Array.from([number, number + 1, 65535, 0, 300, 2 * number]);
  const bytes = new Uint8Array(4 + 16 + 8 + 12 + 4 + 4 + 4 + 12);
  const view = new DataView(bytes.buffer);
  bytes.set([0, 1, 0, 0]);
  view.setUint32(4, 5, true); // stamp
  view.setUint32(12, 2, true);
  bytes.set(new TextEncoder().encode("f"), 16);
  view.setUint32(20, 2, true); // height
  view.setUint32(24, 3, true);
  view.setUint32(28, 7, true);
  bytes.set(new TextEncoder().encode("mono16"), 32);
  view.setUint32(40, 6, true); // step, after is_bigendian at 39
  view.setUint32(44, 12, true);
  bytes.set(new Uint8Array(words.buffer), 48);
  return [bytes.subarray(0, 60), Array.from(new Uint32Array(Float32Array.from(words).buffer))];
}

const compressors = {
  none: undefined,
  lz4: (data) => ({ compression: "lz4", compressedData: Uint8Array.from(npm.lz4.compress(data)) }),
  zstd: (data) => ({ compression: "zstd", compressedData: Uint8Array.from(npm.zstd.compress(data, 3)) }),
};

const layouts = { "with summary": {}, "without chunks": { useChunks: false } };
layouts["without summary"] = {
  useStatistics: false,
  useSummaryOffsets: false,
  repeatSchemas: false,
  repeatChannels: false,
  useAttachmentIndex: false,
  useMetadataIndex: false,
  useMessageIndex: false,
  useChunkIndex: false,
};

for (const [layout, options] of Object.entries(layouts)) {
  for (const [compression, compressChunk] of Object.entries(compressors)) {
    test(`npm's file, ${compression}, ${layout}: read by ours`, async () => {
      const messages = [];
      for (let i = 0; i < 400; ++i) {
        messages.push([i % 4 === 3 ? "/other" : "/camera", 1_000_000_000n + BigInt(i) * 1000n, image(i)[0]]);
      }
      const path = join(folder, "npm.mcap");
      writeFileSync(path, await written(messages, { chunkSize: 3000, compressChunk, ...options }));
      const ours = lines("messages", path);
      assert.equal(ours.length, messages.length);
      for (const [sequence, [topic, logTime, data]] of messages.entries()) {
        assert.deepEqual(ours[sequence], {
          topic,
          schema: "sensor_msgs/msg/Image",
          sequence,
          log_time: String(logTime),
          publish_time: String(logTime + 1n),
          data: Array.from(data),
        });
      }
      assert.throws(() => lines("frames", path), /holds 2 arrays; name one/);
      const frames = lines("frames", `${path}#/camera`);
      const camera = messages.map((message, i) => [message, i]).filter(([[topic]]) => topic === "/camera");
      assert.deepEqual(
        frames.map((frame) => frame.counts),
        camera.map(([, i]) => image(i)[1]),
      );
      assert.deepEqual(
        frames.map((frame) => frame.time),
        camera.map(([message]) => String(message[1])),
      );
      const [recovery] = lines("recover", path, join(folder, "again.mcap"));
      assert.equal(recovery.messages, messages.length);
      assert.equal(recovery.lost_bytes, 0);
      const again = await npm.readIndexed(join(folder, "again.mcap"));
      assert.equal(again.messages.length, messages.length);
      assert.equal(again.attachments.length, 1);
      assert.equal(again.metadata.length, 1);
    });
  }
}

test("npm's file whose chunks stand in another order than their times: read by time", async () => {
  const messages = [3, 1, 2, 0].flatMap((block) =>
    Array.from({ length: 10 }, (_, i) => ["/camera", BigInt(1000 * block + i), image(10 * block + i)[0]]),
  );
  const path = join(folder, "unordered.mcap");
  writeFileSync(path, await written(messages, { chunkSize: 1 }));
  const times = lines("messages", path).map((message) => Number(message.log_time));
  assert.deepEqual(
    times,
    times.slice().sort((a, b) => a - b),
  );
  assert.equal(times.length, 40);
});

test("our definitions have the fields of those of ROS 2 and Foxglove", async () => {
  const { reader } = await npm.readIndexed(join(folder, "lz4.mcap"));
  const own = (name) => {
    const schema = [...reader.schemasById.values()].find((candidate) => candidate.name === name);
    return npm.parseDefinition(new TextDecoder().decode(schema.data), { ros2: true });
  };
  const fields = (definition) =>
    definition.definitions
      .filter((field) => !field.isConstant)
      .map((field) => [field.name, field.type.replace("/msg/", "/"), field.isArray ?? false]);
  const named = (definitions, name) =>
    definitions.find((definition) => definition.name?.replace("/msg/", "/") === name);
  for (const name of ["Image", "Temperature"]) {
    const ours = own(`sensor_msgs/msg/${name}`);
    assert.deepEqual(fields(ours[0]), fields(npm.rosDefinitions[`sensor_msgs/${name}`]));
    assert.deepEqual(fields(named(ours, "std_msgs/Header")), fields(npm.rosDefinitions["std_msgs/Header"]));
  }
  const grid = own("foxglove_msgs/msg/Grid");
  const theirs = npm.parseDefinition(
    npm.foxglove.generateRosMsgMergedSchema(npm.foxglove.foxgloveMessageSchemas.Grid, { rosVersion: 2 }),
    { ros2: true },
  );
  assert.deepEqual(fields(grid[0]), fields(theirs[0]));
  for (const definition of theirs.slice(1)) {
    assert.deepEqual(fields(named(grid, definition.name)), fields(definition), definition.name);
  }
});
