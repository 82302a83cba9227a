// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A client of `dermis serve` that is not ours, for scripts/suit_campaign: subscribes to every channel, counts what comes,
// and reads /statistics. Prints one JSON object when the time is over.
//
// usage: node suit_viewer.mjs ws://127.0.0.1:8080/ SECONDS
import { createRequire } from "node:module";

const require = createRequire(new URL("../tests/npm/package.json", import.meta.url));
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const { WebSocket } = require("ws");

const [url, seconds] = process.argv.slice(2);
const client = new FoxgloveClient({ ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const topics = new Map();
const statistics = [];
const failures = [];

client.on("error", (error) => failures.push(String(error)));
client.on("status", ({ level, message }) => level > 0 && failures.push(message));
client.on("advertise", (channels) => {
  for (const channel of channels) {
    const reads =
      channel.topic === "/statistics" ? new MessageReader(parse(channel.schema, { ros2: true })) : undefined;
    topics.set(client.subscribe(channel.id), { topic: channel.topic, messages: 0, bytes: 0, reads });
  }
});
client.on("message", ({ subscriptionId, data }) => {
  const topic = topics.get(subscriptionId);
  topic.messages += 1;
  topic.bytes += data.byteLength;
  if (topic.reads) statistics.push(topic.reads.readMessage(data));
});

setTimeout(() => {
  const counted = [...topics.values()].map(({ topic, messages, bytes }) => ({ topic, messages, bytes }));
  const big = (_, value) => (typeof value === "bigint" ? Number(value) : value);
  process.stdout.write(JSON.stringify({ topics: counted, statistics, failures }, big), () => process.exit(0));
}, 1000 * Number(seconds));
