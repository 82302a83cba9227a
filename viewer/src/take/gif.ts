// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** Frames of 8 bits a pixel with one palette of 256 colours (768 bytes: red, green, blue), repeated for ever. */
export interface Film {
  width: number;
  height: number;
  palette: Uint8Array;
  frames: readonly Uint8Array[];
  /** Between two frames, whole hundredths of a second. */
  delayCs: number;
}

const PALETTE_BITS = 8;
const MOST_CODES = 4096;
const CLEAR = 1 << PALETTE_BITS;
const END = CLEAR + 1;

class Bytes {
  #bytes = new Uint8Array(1 << 16);
  #length = 0;

  push(...values: number[]): void {
    if (this.#length + values.length > this.#bytes.length) {
      const longer = new Uint8Array(2 * this.#bytes.length);
      longer.set(this.#bytes);
      this.#bytes = longer;
    }
    for (const value of values) this.#bytes[this.#length++] = value;
  }

  u16(value: number): void {
    this.push(value & 255, value >> 8);
  }

  text(text: string): void {
    for (let i = 0; i < text.length; ++i) this.push(text.charCodeAt(i));
  }

  get all(): Uint8Array<ArrayBuffer> {
    return this.#bytes.slice(0, this.#length);
  }
}

/** Codes of growing length into blocks of at most 255 bytes. */
class CodeWriter {
  readonly #bytes: Bytes;
  readonly #block: number[] = [];
  #bits = 0;
  #count = 0;

  constructor(bytes: Bytes) {
    this.#bytes = bytes;
  }

  write(code: number, bits: number): void {
    this.#bits |= code << this.#count;
    this.#count += bits;
    while (this.#count >= 8) this.#byte();
  }

  finish(): void {
    if (this.#count > 0) this.#byte();
    this.#flush();
    this.#bytes.push(0);
  }

  #byte(): void {
    this.#block.push(this.#bits & 255);
    this.#bits >>>= 8;
    this.#count = Math.max(0, this.#count - 8);
    if (this.#block.length === 255) this.#flush();
  }

  #flush(): void {
    if (this.#block.length > 0) this.#bytes.push(this.#block.length, ...this.#block);
    this.#block.length = 0;
  }
}

/** Lempel-Ziv-Welch, as GIF has it. */
function writePixels(bytes: Bytes, pixels: Uint8Array): void {
  bytes.push(PALETTE_BITS);
  const writer = new CodeWriter(bytes);
  const codes = new Map<number, number>();
  let next = END + 1;
  let bits = PALETTE_BITS + 1;
  writer.write(CLEAR, bits);
  let prefix = pixels[0] ?? 0;
  for (let i = 1; i < pixels.length; ++i) {
    const pixel = pixels[i]!;
    const key = (prefix << PALETTE_BITS) | pixel;
    const known = codes.get(key);
    if (known !== undefined) {
      prefix = known;
      continue;
    }
    writer.write(prefix, bits);
    prefix = pixel;
    if (next < MOST_CODES) {
      codes.set(key, next);
      if (next === 1 << bits) bits += 1;
      next += 1;
    } else {
      writer.write(CLEAR, bits);
      codes.clear();
      next = END + 1;
      bits = PALETTE_BITS + 1;
    }
  }
  writer.write(prefix, bits);
  writer.write(END, bits);
  writer.finish();
}

/** A file of the GIF format, version 89a. */
export function encodeGif({ width, height, palette, frames, delayCs }: Film): Uint8Array<ArrayBuffer> {
  const bytes = new Bytes();
  bytes.text("GIF89a");
  bytes.u16(width);
  bytes.u16(height);
  bytes.push(0xf7, 0, 0);
  bytes.push(...palette);
  bytes.push(0x21, 0xff, 11);
  bytes.text("NETSCAPE2.0");
  bytes.push(3, 1, 0, 0, 0);
  for (const frame of frames) {
    bytes.push(0x21, 0xf9, 4, 0);
    bytes.u16(delayCs);
    bytes.push(0, 0, 0x2c, 0, 0, 0, 0);
    bytes.u16(width);
    bytes.u16(height);
    bytes.push(0);
    writePixels(bytes, frame);
  }
  bytes.push(0x3b);
  return bytes.all;
}
