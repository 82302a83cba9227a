// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** The memory of the module, as calls of WASI see it. It may have moved with each call. */
export class CallMemory {
  readonly #memory: () => WebAssembly.Memory;

  constructor(memory: () => WebAssembly.Memory) {
    this.#memory = memory;
  }

  bytes(place: number, size: number): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.#memory().buffer as ArrayBuffer, place >>> 0, size >>> 0);
  }

  text(place: number, size: number): string {
    return new TextDecoder().decode(this.bytes(place, size));
  }

  put32(place: number, value: number): void {
    this.#view().setUint32(place, value, true);
  }

  put64(place: number, value: bigint): void {
    this.#view().setBigUint64(place, value, true);
  }

  /** The pieces that a list of places and sizes names. */
  pieces(list: number, count: number): Uint8Array[] {
    const view = this.#view();
    return Array.from({ length: count }, (_, index) =>
      this.bytes(view.getUint32(list + 8 * index, true), view.getUint32(list + 8 * index + 4, true)),
    );
  }

  #view(): DataView {
    return new DataView(this.#memory().buffer);
  }
}
