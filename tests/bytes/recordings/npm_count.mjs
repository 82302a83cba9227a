// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Usage: node npm_count.mjs FILE: reads all messages by the index, verifies the CRCs, and counts them by their types.
import { readIndexed } from "./npm_mcap.mjs";

const { reader, messages } = await readIndexed(process.argv[2]);
const counts = new Map();
for (const message of messages) {
  const name = reader.schemasById.get(reader.channelsById.get(message.channelId).schemaId).name;
  counts.set(name, (counts.get(name) ?? 0) + 1);
}
for (const [name, count] of counts) console.log(`${name} ${count}`);
