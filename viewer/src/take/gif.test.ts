// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { encodeGif } from "./gif";

/** The frames of a GIF by its specification, written from that alone. */
function decodeGif(file: Uint8Array): { width: number; height: number; delaysCs: number[]; frames: number[][] } {
  const u16 = (at: number): number => file[at]! | (file[at + 1]! << 8);
  const width = u16(6);
  const height = u16(8);
  let at = 13 + 3 * (2 << (file[10]! & 7));
  const delaysCs: number[] = [];
  const frames: number[][] = [];
  for (;;) {
    const kind = file[at++];
    if (kind === 0x3b) return { width, height, delaysCs, frames };
    if (kind === 0x21) {
      if (file[at] === 0xf9) delaysCs.push(u16(at + 3));
      at += 1;
    } else {
      at += 9;
    }
    const codeBits = kind === 0x2c ? file[at++]! : 0;
    const data: number[] = [];
    for (let length = file[at++]!; length > 0; length = file[at++]!) {
      data.push(...file.subarray(at, at + length));
      at += length;
    }
    if (kind === 0x2c) frames.push(unpack(data, codeBits));
  }
}

function unpack(data: number[], codeBits: number): number[] {
  const clear = 1 << codeBits;
  let table: number[][] = [];
  let bits = codeBits + 1;
  let last: number[] | undefined;
  const pixels: number[] = [];
  for (let at = 0; ; ) {
    let code = 0;
    for (let bit = 0; bit < bits; ++bit, ++at) code |= ((data[at >> 3]! >> (at & 7)) & 1) << bit;
    if (code === clear) {
      table = Array.from({ length: clear + 2 }, (_, index) => [index]);
      bits = codeBits + 1;
      last = undefined;
      continue;
    }
    if (code === clear + 1) return pixels;
    const word: number[] = table[code] ?? [...last!, last![0]!];
    pixels.push(...word);
    if (last !== undefined && table.length < 4096) table.push([...last, word[0]!]);
    if (table.length === 1 << bits && bits < 12) bits += 1;
    last = word;
  }
}

function film(width: number, height: number, pixel: (frame: number, place: number) => number, frames = 1): Uint8Array {
  const pixels = Array.from({ length: frames }, (_, frame) =>
    Uint8Array.from({ length: width * height }, (_none, place) => pixel(frame, place)),
  );
  return encodeGif({ width, height, palette: new Uint8Array(768), frames: pixels, delayCs: 10 });
}

describe("a GIF", () => {
  it("reads back as it was drawn", () => {
    const pixel = (frame: number, place: number): number => (place * place + 31 * frame) % 251;
    const decoded = decodeGif(film(37, 23, pixel, 3));
    expect([decoded.width, decoded.height]).toEqual([37, 23]);
    expect(decoded.delaysCs).toEqual([10, 10, 10]);
    decoded.frames.forEach((frame, number) =>
      expect(frame).toEqual(Array.from({ length: 37 * 23 }, (_, place) => pixel(number, place))),
    );
  });

  it("reads back where its table of codes is full many times", () => {
    let state = 7;
    const noise = Array.from({ length: 200 * 200 }, () => {
      state = (1103515245 * state + 12345) % 2147483648;
      return (state >> 16) & 255;
    });
    expect(decodeGif(film(200, 200, (_, place) => noise[place]!)).frames[0]).toEqual(noise);
  });

  it("of one colour is small", () => {
    const file = film(400, 400, () => 5);
    expect(file.length).toBeLessThan(4000);
    expect(decodeGif(file).frames[0]!.every((pixel) => pixel === 5)).toBe(true);
  });

  it("of one pixel is whole", () => {
    expect(decodeGif(film(1, 1, () => 9)).frames).toEqual([[9]]);
  });
});
