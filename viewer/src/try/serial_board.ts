// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { adviceOn, type Board, type BoardEvents } from "./board";

/** The part of Web Serial that is used (https://wicg.github.io/serial). */
interface PortInfo {
  usbVendorId?: number;
  usbProductId?: number;
}
interface Port extends EventTarget {
  readonly readable: ReadableStream<Uint8Array<ArrayBuffer>> | null;
  readonly writable: WritableStream<Uint8Array<ArrayBuffer>> | null;
  getInfo(): PortInfo;
  open(options: { baudRate: number; bufferSize: number }): Promise<void>;
  close(): Promise<void>;
  setSignals(signals: { dataTerminalReady: boolean; requestToSend: boolean }): Promise<void>;
}
interface Serial extends EventTarget {
  requestPort(): Promise<Port>;
}

/** 4 s at 2 Mbaud, in which this thread may be busy with something else. */
const BUFFER_BYTES = 1 << 20;

const TROUBLES: Readonly<Record<string, string>> = {
  BufferOverrunError: "bytes came faster than the browser took them: some are lost",
  FramingError: "a byte had no right end: is this the baud of the board?",
  ParityError: "a byte had a wrong parity: the page reads 8N1",
  BreakError: "the line was held low: some bytes are lost",
};

export function serialOf(navigator: Navigator): Serial | undefined {
  return (navigator as { serial?: Serial }).serial;
}

/** A board at a serial port. One that is unplugged is opened again when it is back. */
export class SerialBoard implements Board {
  readonly #serial: Serial;
  readonly #events: BoardEvents;
  #port: Port;
  #baud = 0;
  /** Until it is closed by this page. */
  #isWanted = false;
  #reader: ReadableStreamDefaultReader<Uint8Array<ArrayBuffer>> | undefined;
  #writer: WritableStreamDefaultWriter<Uint8Array<ArrayBuffer>> | undefined;
  #reading: Promise<void> = Promise.resolve();
  readonly #plugged = (event: Event): void => void this.#come(event.target as Port);

  private constructor(serial: Serial, port: Port, events: BoardEvents) {
    this.#serial = serial;
    this.#port = port;
    this.#events = events;
    serial.addEventListener("connect", this.#plugged);
  }

  /** Lets the user choose a port. */
  static async choose(serial: Serial, events: BoardEvents): Promise<SerialBoard> {
    return new SerialBoard(serial, await serial.requestPort(), events);
  }

  get name(): string {
    const { usbVendorId, usbProductId } = this.#port.getInfo();
    return usbVendorId === undefined ? "serial port" : `USB ${hex(usbVendorId)}:${hex(usbProductId ?? 0)}`;
  }

  async open(baud: number): Promise<void> {
    if (this.#isWanted) await this.#shut();
    this.#isWanted = true;
    this.#baud = baud;
    try {
      await this.#begin();
    } catch (error) {
      this.#isWanted = false;
      throw new Error(adviceOn(error, "The board"), { cause: error });
    }
  }

  async write(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
    const writer = this.#port.writable?.getWriter();
    this.#writer = writer;
    try {
      await writer?.write(bytes);
    } finally {
      writer?.releaseLock();
      this.#writer = undefined;
    }
  }

  async close(): Promise<void> {
    this.#serial.removeEventListener("connect", this.#plugged);
    await this.#shut();
  }

  async #begin(): Promise<void> {
    await this.#port.open({ baudRate: this.#baud, bufferSize: BUFFER_BYTES });
    // Boards with USB of their own send nothing before somebody is there.
    await this.#port.setSignals({ dataTerminalReady: true, requestToSend: true }).catch(() => undefined);
    this.#reading = this.#read();
  }

  async #shut(): Promise<void> {
    this.#isWanted = false;
    void this.#writer?.abort().catch(() => undefined); // one that waits for the board holds the port
    await this.#reader?.cancel().catch(() => undefined);
    await this.#reading;
    await this.#port.close().catch(() => undefined); // it may be gone
  }

  /** A port that has lost bytes has another stream then; one that is gone has none. */
  async #read(): Promise<void> {
    while (this.#isWanted && this.#port.readable !== null) {
      const reader = this.#port.readable.getReader();
      this.#reader = reader;
      try {
        for (let read = await reader.read(); !read.done; read = await reader.read()) this.#events.bytes(read.value);
      } catch (error) {
        const trouble = TROUBLES[(error as Error).name];
        if (trouble !== undefined) this.#events.trouble(`The board: ${trouble}.`);
      } finally {
        this.#reader = undefined;
        reader.releaseLock();
      }
    }
    if (this.#isWanted) await this.#lose();
  }

  async #lose(): Promise<void> {
    await this.#port.close().catch(() => undefined);
    this.#events.lost();
  }

  /** Its permission lasts; the browser may have another object for it. */
  async #come(port: Port): Promise<void> {
    if (!this.#isWanted || this.#port.readable !== null || !isSame(port, this.#port)) return;
    await this.#reading;
    this.#port = port;
    try {
      await this.#begin();
      this.#events.back();
    } catch (error) {
      this.#events.trouble(adviceOn(error, "The board"));
    }
  }
}

function isSame(one: Port, other: Port): boolean {
  if (one === other) return true;
  const [a, b] = [one.getInfo(), other.getInfo()];
  return a.usbVendorId !== undefined && a.usbVendorId === b.usbVendorId && a.usbProductId === b.usbProductId;
}

function hex(id: number): string {
  return id.toString(16).padStart(4, "0");
}
