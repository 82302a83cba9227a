// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { adviceOn, type Board, type BoardEvents } from "./board";

/** The part of WebUSB that is used (https://wicg.github.io/webusb). */
interface Endpoint {
  readonly endpointNumber: number;
  readonly direction: "in" | "out";
  readonly type: "bulk" | "interrupt" | "isochronous";
}
interface Interface {
  readonly interfaceNumber: number;
  readonly alternate: { readonly interfaceClass: number; readonly endpoints: readonly Endpoint[] };
}
interface Device {
  readonly productName?: string;
  readonly configuration: { readonly interfaces: readonly Interface[] } | null;
  open(): Promise<void>;
  close(): Promise<void>;
  selectConfiguration(value: number): Promise<void>;
  claimInterface(number: number): Promise<void>;
  controlTransferOut(setup: object, data?: Uint8Array<ArrayBuffer>): Promise<unknown>;
  transferIn(endpoint: number, length: number): Promise<{ status?: string; data?: DataView<ArrayBuffer> }>;
  transferOut(endpoint: number, data: Uint8Array<ArrayBuffer>): Promise<unknown>;
  clearHalt(direction: "in", endpoint: number): Promise<void>;
}
interface Usb {
  requestDevice(options: { filters: object[] }): Promise<Device>;
}

const CONTROL_CLASS = 2; // of CDC
const DATA_CLASS = 10; // of CDC
const VENDOR_CLASS = 255;
const SET_LINE_CODING = 0x20;
const SET_CONTROL_LINE_STATE = 0x22;
const DTR_AND_RTS = 3;
const TRANSFER_BYTES = 16384;

export function usbOf(navigator: Navigator): Usb | undefined {
  return (navigator as { usb?: Usb }).usb;
}

/** A board at USB without a driver of the system: CDC-ACM, or a vendor's own class that sends by bulk transfers. */
export class UsbBoard implements Board {
  readonly #device: Device;
  readonly #events: BoardEvents;
  #in = 0;
  #out: number | undefined;
  #isWanted = false;

  private constructor(device: Device, events: BoardEvents) {
    this.#device = device;
    this.#events = events;
  }

  static async choose(usb: Usb, events: BoardEvents): Promise<UsbBoard> {
    return new UsbBoard(await usb.requestDevice({ filters: [] }), events);
  }

  get name(): string {
    return this.#device.productName ?? "USB";
  }

  async open(baud: number): Promise<void> {
    try {
      if (!this.#isWanted) await this.#claim();
      await this.#setLine(baud);
    } catch (error) {
      throw new Error(adviceOn(error, this.name), { cause: error });
    }
    if (this.#isWanted) return;
    this.#isWanted = true;
    void this.#read();
  }

  async write(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
    if (this.#out !== undefined) await this.#device.transferOut(this.#out, bytes);
  }

  async close(): Promise<void> {
    this.#isWanted = false;
    await this.#device.close().catch(() => undefined); // it may be gone
  }

  #interface(...classes: number[]): Interface | undefined {
    return this.#device.configuration?.interfaces.find(({ alternate }) => classes.includes(alternate.interfaceClass));
  }

  async #claim(): Promise<void> {
    await this.#device.open();
    if (this.#device.configuration === null) await this.#device.selectConfiguration(1);
    const data = this.#interface(DATA_CLASS) ?? this.#interface(VENDOR_CLASS);
    const bulk = data?.alternate.endpoints.filter(({ type }) => type === "bulk");
    const source = bulk?.find(({ direction }) => direction === "in");
    if (data === undefined || source === undefined) throw new Error("it has no endpoint that sends bytes");
    await this.#device.claimInterface(data.interfaceNumber);
    this.#in = source.endpointNumber;
    this.#out = bulk?.find(({ direction }) => direction === "out")?.endpointNumber;
  }

  /** As a driver of CDC-ACM does; other classes have no line. */
  async #setLine(baud: number): Promise<void> {
    const control = this.#interface(CONTROL_CLASS);
    if (control === undefined) return;
    await this.#device.claimInterface(control.interfaceNumber);
    const to = (request: number, value: number): object => ({
      requestType: "class",
      recipient: "interface",
      request,
      value,
      index: control.interfaceNumber,
    });
    const coding = new DataView(new ArrayBuffer(7)); // 8N1
    coding.setUint32(0, baud, true);
    coding.setUint8(6, 8);
    await this.#device.controlTransferOut(to(SET_LINE_CODING, 0), new Uint8Array(coding.buffer));
    await this.#device.controlTransferOut(to(SET_CONTROL_LINE_STATE, DTR_AND_RTS));
  }

  async #read(): Promise<void> {
    while (this.#isWanted) {
      try {
        const { status, data } = await this.#device.transferIn(this.#in, TRANSFER_BYTES);
        if (status === "stall") await this.#device.clearHalt("in", this.#in);
        if (status === "babble") this.#events.trouble("The board sent more than was asked for: some bytes are lost.");
        if (data !== undefined && data.byteLength > 0)
          this.#events.bytes(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
      } catch {
        if (this.#isWanted) this.#events.lost();
        this.#isWanted = false;
      }
    }
  }
}
