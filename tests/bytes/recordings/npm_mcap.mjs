// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What the tests need of the npm packages in tests/npm, which scripts/setup installs.
import { open } from "node:fs/promises";
import { createRequire } from "node:module";

const require = createRequire(new URL("../../npm/package.json", import.meta.url));
export const core = require("@mcap/core");
export const { crc32 } = require("@foxglove/crc");
export const { parse: parseDefinition } = require("@foxglove/rosmsg");
export const { ros2jazzy: rosDefinitions } = require("@foxglove/rosmsg-msgs-common");
export const { MessageReader } = require("@foxglove/rosmsg2-serialization");
export const foxglove = require("@foxglove/schemas/internal");
export const zstd = require("@foxglove/wasm-zstd");
export const lz4 = require("lz4js");
export const decompressHandlers = await require("@mcap/support").loadDecompressHandlers();
await zstd.isLoaded;

/** All messages of a file by the index; all CRCs of the summary, the chunks and the attachments are verified. */
export async function readIndexed(path) {
  const file = await open(path);
  try {
    const readable = {
      size: async () => BigInt((await file.stat()).size),
      read: async (offset, length) => {
        const bytes = new Uint8Array(Number(length));
        const { bytesRead } = await file.read(bytes, 0, bytes.length, Number(offset));
        if (bytesRead !== bytes.length) throw new Error(`${path}: ends too early`);
        return bytes;
      },
    };
    const reader = await core.McapIndexedReader.Initialize({ readable, decompressHandlers });
    const result = { reader, messages: [], attachments: [], metadata: [] };
    for await (const message of reader.readMessages({ validateCrcs: true })) {
      result.messages.push({ ...message, data: message.data.slice() });
    }
    for await (const attachment of reader.readAttachments({ validateCrcs: true })) result.attachments.push(attachment);
    for await (const metadata of reader.readMetadata()) result.metadata.push(metadata);
    return result;
  } finally {
    await file.close();
  }
}

/** All messages of the bytes of a file, from its beginning on, as far as it goes; CRCs are verified. */
export function readStreamed(bytes) {
  const reader = new core.McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(bytes);
  const messages = [];
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    if (record.type === "Message") messages.push({ ...record, data: record.data.slice() });
    // The reader leaves this one to us: of all bytes before the record, which has 9 + 4 bytes.
    if (record.type === "DataEnd") messages.dataCrc = record.dataSectionCrc;
  }
  messages.complete = reader.done();
  return messages;
}
