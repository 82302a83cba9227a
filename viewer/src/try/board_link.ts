// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** A link to a board: its layout (docs/layouts.md) and its baud. */
export interface BoardLink {
  layout: string;
  baud: number | undefined;
}

export const MOST_LAYOUT_BYTES = 16384;
const MOST_BAUD = 20_000_000;

/** The part behind the "#", which browsers do not send to a server. */
export async function hashOf({ layout, baud }: BoardLink): Promise<string> {
  const packed = await packedBy(new CompressionStream("deflate-raw"), new TextEncoder().encode(layout), Infinity);
  const text = btoa(String.fromCharCode(...packed))
    .replaceAll("+", "-")
    .replaceAll("/", "_")
    .replaceAll("=", "");
  return `#layout=${text}${baud === undefined ? "" : `&baud=${baud}`}`;
}

/** undefined: the hash is no such link. `toml` has the layout as it is, percent-encoded, in the place of `layout`. Fails with a
 *  line where it is a link and cannot be read. */
export async function boardLinkOf(hash: string): Promise<BoardLink | undefined> {
  const fields = new URLSearchParams(hash.slice(1));
  const [packed, toml] = [fields.get("layout"), fields.get("toml")];
  if (packed === null && toml === null) return undefined;
  const layout = packed === null ? toml! : await unpacked(packed);
  if (new TextEncoder().encode(layout).length > MOST_LAYOUT_BYTES) throw new Error(TOO_LONG);
  return { layout, baud: baudOf(fields.get("baud")) };
}

const TOO_LONG = `The link: its layout has more than ${MOST_LAYOUT_BYTES} bytes.`;

function baudOf(text: string | null): number | undefined {
  const baud = Number(text ?? "");
  if (text === null) return undefined;
  if (!Number.isInteger(baud) || baud < 50 || baud > MOST_BAUD)
    throw new Error(`The link: baud must be 50 to ${MOST_BAUD}.`);
  return baud;
}

async function unpacked(text: string): Promise<string> {
  try {
    const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) =>
      letter.charCodeAt(0),
    );
    const layout = await packedBy(new DecompressionStream("deflate-raw"), bytes, MOST_LAYOUT_BYTES);
    return new TextDecoder("utf-8", { fatal: true }).decode(layout);
  } catch (error) {
    throw new Error(error instanceof RangeError ? TOO_LONG : "The link: its layout cannot be read; was it cut off?", {
      cause: error,
    });
  }
}

/** A RangeError: it becomes more bytes than that. */
async function packedBy(
  stream: CompressionStream | DecompressionStream,
  bytes: Uint8Array<ArrayBuffer>,
  most: number,
): Promise<Uint8Array> {
  const writer = stream.writable.getWriter();
  const written = writer.write(bytes).then(() => writer.close());
  written.catch(() => undefined); // the reader fails, too
  const parts: number[] = [];
  const reader = stream.readable.getReader();
  for (let read = await reader.read(); !read.done; read = await reader.read()) {
    const part = read.value as Uint8Array;
    if (parts.length + part.length > most) {
      void reader.cancel();
      throw new RangeError("too long");
    }
    for (const byte of part) parts.push(byte);
  }
  return Uint8Array.from(parts);
}

/** FNV-1a of a text: layouts of other links have other names. */
export function checksumOf(text: string): string {
  let hash = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) hash = Math.imul(hash ^ byte, 0x01000193);
  return (hash >>> 0).toString(16).padStart(8, "0");
}
