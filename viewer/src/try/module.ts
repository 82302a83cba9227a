// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { Files } from "./files";
import type { BoardRequest } from "./module_endpoint";
import { systemOf } from "./system";

/** The functions of the module (bindings/browser/module.cpp). */
interface Exports {
  readonly memory: WebAssembly.Memory;
  _initialize(): void;
  dermis_room(size: number): number;
  dermis_answer(): number;
  dermis_answer_size(): number;
  dermis_begin_simulation(size: number, isRehearsal: number): number;
  dermis_begin_setup(): void;
  dermis_board(size: number, baud: number): void;
  dermis_board_lost(): void;
  dermis_bytes(size: number): void;
  dermis_board_request(): number;
  dermis_connect(): void;
  dermis_receive(size: number, isText: number): number;
  dermis_work(): number;
  dermis_open(size: number): number;
  dermis_go_live(): void;
  dermis_next(): number;
  dermis_document(size: number): number;
  dermis_file(size: number): number;
  dermis_fit(): void;
  dermis_fit_done(size: number): void;
  dermis_fit_share(share: number): void;
  dermis_fit_failed(size: number): void;
}

/** Does the fits of a module, each in a copy of it. */
export interface Fitter {
  begin(module: Module): void;
  /** The fit is not wanted any more. */
  end(): void;
}

/** A module as it stands, for another worker to go on with. */
export interface Copy {
  code: WebAssembly.Module;
  memory: ArrayBuffer;
}

const NEXT_IS_TEXT = 1;
const REQUEST_TO_OPEN = 1;
const PAGE_BYTES = 65536;
const utf8 = new TextEncoder();

/** dermis in this thread: the server of `dermis serve` for one client. Not for the page's own thread, which it holds up. */
export class Module {
  readonly #code: WebAssembly.Module;
  readonly #exports: Exports;

  private constructor(code: WebAssembly.Module, instance: WebAssembly.Instance) {
    this.#code = code;
    this.#exports = instance.exports as unknown as Exports;
  }

  static async load(code: WebAssembly.Module, files: Files, fitter: Fitter): Promise<Module> {
    const module: Module = await Module.#make(code, files, {
      begin: () => fitter.begin(module),
      end: () => fitter.end(),
      tell_share: () => undefined,
    });
    module.#exports._initialize();
    return module;
  }

  /** The fit that the module asks for, whose copy it is. Returns its outcome; fails where the module does. */
  static async fit({ code, memory }: Copy, tellShare: (share: number) => void): Promise<Uint8Array<ArrayBuffer>> {
    const nothing = (): void => undefined;
    const module = await Module.#make(code, new Files(), { begin: nothing, end: nothing, tell_share: tellShare });
    module.#resume(memory);
    module.#exports.dermis_fit();
    return module.#answer().slice();
  }

  static async #make(code: WebAssembly.Module, files: Files, fits: WebAssembly.ModuleImports): Promise<Module> {
    const system = systemOf(files);
    const module = new Module(code, await WebAssembly.instantiate(code, { ...system.imports, fits }));
    system.memory = module.#exports.memory;
    return module;
  }

  /** Goes on where the module stood that had this memory. */
  #resume(from: ArrayBuffer): void {
    const { memory } = this.#exports;
    memory.grow((from.byteLength - memory.buffer.byteLength) / PAGE_BYTES);
    new Uint8Array(memory.buffer).set(new Uint8Array(from));
  }

  copy(): Copy {
    return { code: this.#code, memory: this.#exports.memory.buffer.slice(0) as ArrayBuffer };
  }

  /** Fails with the line of the module. */
  beginSimulation(model: Uint8Array, isRehearsal: boolean): void {
    const begun = this.#exports.dermis_begin_simulation(this.#put(model), isRehearsal ? 1 : 0);
    if (begun === 0) throw new Error(this.#text());
  }

  /** Somebody chooses where the array is, and describes it. */
  beginSetup(): void {
    this.#exports.dermis_begin_setup();
  }

  boardIsOpen(name: string, baud: number): void {
    this.#exports.dermis_board(this.#put(utf8.encode(name)), baud);
  }

  boardIsLost(): void {
    this.#exports.dermis_board_lost();
  }

  bytes(bytes: Uint8Array): void {
    this.#exports.dermis_bytes(this.#put(bytes));
  }

  /** The next thing that the page is to do with the board. */
  boardRequest(): BoardRequest | undefined {
    const kind = this.#exports.dermis_board_request();
    if (kind === 0) return undefined;
    return kind === REQUEST_TO_OPEN ? { open: Number(this.#text()) } : { write: this.#answer().slice() };
  }

  connect(): void {
    this.#exports.dermis_connect();
  }

  receive(message: string | Uint8Array): void {
    const isText = typeof message === "string";
    const bytes = isText ? utf8.encode(message) : message;
    if (this.#exports.dermis_receive(this.#put(bytes), isText ? 1 : 0) === 0) throw new Error(this.#text());
  }

  /** Whether the server is another one now, to which the client has to connect. */
  work(): boolean {
    return this.#exports.dermis_work() !== 0;
  }

  /** Opens a file of the page: a recording, a model, an array.toml. Fails with the line of the module. */
  open(path: string): void {
    if (this.#exports.dermis_open(this.#put(utf8.encode(path))) === 0) throw new Error(this.#text());
  }

  /** The board or the sheet in the place of a recording. */
  goLive(): void {
    this.#exports.dermis_go_live();
  }

  /** The next message for the client. */
  next(): string | ArrayBuffer | undefined {
    const kind = this.#exports.dermis_next();
    if (kind === 0) return undefined;
    return kind === NEXT_IS_TEXT ? this.#text() : this.#answer().slice().buffer;
  }

  /** A document of the server. */
  document(path: string): string | undefined {
    return this.#exports.dermis_document(this.#put(utf8.encode(path))) === 0 ? undefined : this.#text();
  }

  fitDone(outcome: Uint8Array): void {
    this.#exports.dermis_fit_done(this.#put(outcome));
  }

  fitShare(share: number): void {
    this.#exports.dermis_fit_share(share);
  }

  fitFailed(why: string): void {
    this.#exports.dermis_fit_failed(this.#put(utf8.encode(why)));
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
