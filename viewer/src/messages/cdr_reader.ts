// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

const HEADER_BYTES = 4;
const utf8 = new TextDecoder();

/**
 * Reads a message in CDR, little-endian, field by field. A field beyond the end throws a RangeError. One reader serves any
 * number of messages: reading numbers makes no garbage.
 */
export class CdrReader {
  #message: DataView = new DataView(new ArrayBuffer(HEADER_BYTES));
  #offset = HEADER_BYTES;

  begin(message: DataView): this {
    if (message.byteLength < HEADER_BYTES || message.getUint8(1) !== 1)
      throw new RangeError("not CDR in little-endian");
    this.#message = message;
    this.#offset = HEADER_BYTES;
    return this;
  }

  #advance(bytes: number, alignment: number): number {
    const misaligned = (this.#offset - HEADER_BYTES) % alignment;
    const begin = misaligned === 0 ? this.#offset : this.#offset + alignment - misaligned;
    this.#offset = begin + bytes;
    return begin;
  }

  bool(): boolean {
    return this.uint8() !== 0;
  }

  uint8(): number {
    return this.#message.getUint8(this.#advance(1, 1));
  }

  int8(): number {
    return this.#message.getInt8(this.#advance(1, 1));
  }

  int32(): number {
    return this.#message.getInt32(this.#advance(4, 4), true);
  }

  uint32(): number {
    return this.#message.getUint32(this.#advance(4, 4), true);
  }

  /** Exact below 2^53. */
  uint64(): number {
    const begin = this.#advance(8, 8);
    return this.#message.getUint32(begin, true) + 4294967296 * this.#message.getUint32(begin + 4, true);
  }

  float64(): number {
    return this.#message.getFloat64(this.#advance(8, 8), true);
  }

  text(): string {
    const length = this.uint32();
    const begin = this.#advance(length, 1);
    const { buffer, byteOffset, byteLength } = this.#message;
    if (begin + length > byteLength) throw new RangeError("a text ends beyond the message");
    return length === 0 ? "" : utf8.decode(new Uint8Array(buffer, byteOffset + begin, length - 1));
  }

  skipText(): void {
    const length = this.uint32();
    this.#advance(length, 1);
  }

  /** Reads a text and compares it (ASCII) without making one. */
  textIs(expected: string): boolean {
    const length = this.uint32();
    const begin = this.#advance(length, 1);
    if (length !== expected.length + 1) return false;
    for (let i = 0; i < expected.length; ++i) {
      if (this.#message.getUint8(begin + i) !== expected.charCodeAt(i)) return false;
    }
    return true;
  }

  /** Leaves out `count` numbers of `bytes` bytes. */
  skip(count: number, bytes: number): void {
    if (count > 0) this.#advance(count * bytes, bytes);
  }

  /** Where the next field begins, but for its alignment. */
  get position(): number {
    return this.#offset;
  }

  rewind(position: number): this {
    this.#offset = position;
    return this;
  }

  /** Where the bytes of a sequence are in the message. */
  bytes(): { begin: number; length: number } {
    const length = this.uint32();
    const begin = this.#advance(length, 1);
    if (begin + length > this.#message.byteLength) throw new RangeError("a sequence ends beyond the message");
    return { begin, length };
  }

  /** builtin_interfaces/Time in seconds. */
  time(): number {
    const seconds = this.int32();
    return seconds + 1e-9 * this.uint32();
  }

  /** std_msgs/Header: its stamp in seconds. */
  header(): number {
    const stamp = this.time();
    this.skipText();
    return stamp;
  }
}
