// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { Files } from "./files";
import { systemOf } from "./system";

/** The functions of the module (bindings/browser/module.cpp). */
interface Exports {
  readonly memory: WebAssembly.Memory;
  _initialize(): void;
  dermis_room(size: number): number;
  dermis_answer(): number;
  dermis_answer_size(): number;
  dermis_begin_simulation(size: number): number;
  dermis_connect(): void;
  dermis_receive(size: number, isText: number): number;
  dermis_work(): number;
  dermis_open(size: number): number;
  dermis_next(): number;
  dermis_document(size: number): number;
  dermis_file(size: number): number;
}

const NEXT_IS_TEXT = 1;
const utf8 = new TextEncoder();

/** dermis in this thread: the server of `dermis serve` for one client. Not for the page's own thread, which it holds up. */
export class Module {
  readonly #exports: Exports;

  private constructor(instance: WebAssembly.Instance) {
    this.#exports = instance.exports as unknown as Exports;
  }

  static async load(source: WebAssembly.Module, files: Files): Promise<Module> {
    const system = systemOf(files);
    const module = new Module(await WebAssembly.instantiate(source, system.imports));
    system.memory = module.#exports.memory;
    module.#exports._initialize();
    return module;
  }

  /** Fails with the line of the module. */
  beginSimulation(model: Uint8Array): void {
    if (this.#exports.dermis_begin_simulation(this.#put(model)) === 0) throw new Error(this.#text());
  }

  connect(): void {
    this.#exports.dermis_connect();
  }

  receive(message: string | Uint8Array): void {
    const isText = typeof message === "string";
    const bytes = isText ? utf8.encode(message) : message;
    if (this.#exports.dermis_receive(this.#put(bytes), isText ? 1 : 0) === 0) throw new Error(this.#text());
  }

  /** Undefined: the client goes on. Else another server has begun, or, with a text, could not. */
  work(): string | undefined {
    return this.#exports.dermis_work() === 0 ? undefined : this.#text();
  }

  /** Opens a file of the page: a recording, a model, an array.toml. Fails with the line of the module. */
  open(path: string): void {
    if (this.#exports.dermis_open(this.#put(utf8.encode(path))) === 0) throw new Error(this.#text());
  }

  /** The next message for the client. */
  next(): string | ArrayBuffer | undefined {
    const kind = this.#exports.dermis_next();
    if (kind === 0) return undefined;
    return kind === NEXT_IS_TEXT ? this.#text() : this.#answer().slice().buffer;
  }

  document(path: string): string | undefined {
    return this.#exports.dermis_document(this.#put(utf8.encode(path))) === 0 ? undefined : this.#text();
  }

  /** Where the file is that a client may save at this path. */
  file(path: string): string | undefined {
    return this.#exports.dermis_file(this.#put(utf8.encode(path))) === 0 ? undefined : this.#text();
  }

  #put(bytes: Uint8Array): number {
    const place = this.#exports.dermis_room(bytes.length);
    new Uint8Array(this.#exports.memory.buffer, place, bytes.length).set(bytes);
    return bytes.length;
  }

  #answer(): Uint8Array<ArrayBuffer> {
    const { memory, dermis_answer, dermis_answer_size } = this.#exports;
    return new Uint8Array(memory.buffer as ArrayBuffer, dermis_answer(), dermis_answer_size());
  }

  #text(): string {
    return new TextDecoder().decode(this.#answer());
  }
}
