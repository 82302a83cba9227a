// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { adviceOn, type Board, type BoardEvents } from "./board";

/** The part of Web Bluetooth that is used (https://webbluetoothcg.github.io/web-bluetooth). */
interface Characteristic extends EventTarget {
  readonly uuid: string;
  readonly properties: { readonly notify: boolean; readonly indicate: boolean };
  readonly value: DataView<ArrayBuffer> | undefined;
  startNotifications(): Promise<unknown>;
  writeValueWithoutResponse(bytes: Uint8Array<ArrayBuffer>): Promise<void>;
}
interface Service {
  getCharacteristic(uuid: string): Promise<Characteristic>;
  getCharacteristics(): Promise<Characteristic[]>;
}
interface Server {
  connect(): Promise<Server>;
  disconnect(): void;
  getPrimaryService(uuid: string): Promise<Service>;
}
interface Device extends EventTarget {
  readonly name?: string;
  readonly gatt?: Server;
}
export interface Bluetooth {
  requestDevice(options: { filters: { services: string[] }[] }): Promise<Device>;
}

/** The UART service of Nordic, which most firmware has, and its characteristic that takes bytes. */
export const NORDIC_UART = "6e400001-b5a3-f393-e0a9-e50e24dcca9e";
const NORDIC_WRITE = "6e400002-b5a3-f393-e0a9-e50e24dcca9e";

const MOST_WRITTEN = 20; // bytes at once, of every device
const AGAIN_MS = 500;

export function bluetoothOf(navigator: Navigator): Bluetooth | undefined {
  return (navigator as { bluetooth?: Bluetooth }).bluetooth;
}

/** "ffe0" and "0xFFE0" are short for a UUID. */
export function uuidOf(text: string): string {
  const word = text.trim().toLowerCase();
  const short = /^(?:0x)?([0-9a-f]{4})$/.exec(word)?.[1];
  return short === undefined ? word : `0000${short}-0000-1000-8000-00805f9b34fb`;
}

/** A board that notifies its bytes by Bluetooth; only one with NORDIC_UART can be asked for them. One that is out of reach is connected again when it is back. */
export class BluetoothBoard implements Board {
  readonly #device: Device;
  readonly #service: string;
  readonly #events: BoardEvents;
  #notify: string;
  /** Characteristics that notify, once it is open. */
  notifying: string[] = [];
  #asks: Characteristic | undefined;
  /** Until it is closed by this page. */
  #isWanted = false;
  readonly #heard = (event: Event): void => {
    const value = (event.target as Characteristic).value;
    if (value !== undefined) this.#events.bytes(new Uint8Array(value.buffer, value.byteOffset, value.byteLength));
  };

  /** `notify` empty: the first that there is. */
  private constructor(device: Device, service: string, notify: string, events: BoardEvents) {
    this.#device = device;
    this.#service = service;
    this.#notify = notify;
    this.#events = events;
    device.addEventListener("gattserverdisconnected", () => void this.#lose());
  }

  /** Lets the user choose a device that has the service. */
  static async choose(bluetooth: Bluetooth, service: string, events: BoardEvents): Promise<BluetoothBoard> {
    const device = await bluetooth.requestDevice({ filters: [{ services: [service] }] });
    return new BluetoothBoard(device, service, "", events);
  }

  /** The same device, not open, of which another characteristic is heard. */
  hearing(notify: string, events: BoardEvents): BluetoothBoard {
    return new BluetoothBoard(this.#device, this.#service, notify, events);
  }

  get name(): string {
    return this.#device.name ?? "Bluetooth";
  }

  async open(): Promise<void> {
    if (this.#isWanted) return; // it has no baud
    try {
      await this.#begin();
    } catch (error) {
      throw new Error(adviceOn(error, this.name), { cause: error });
    }
    this.#isWanted = true;
  }

  async write(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
    for (let at = 0; at < bytes.length; at += MOST_WRITTEN)
      await this.#asks?.writeValueWithoutResponse(bytes.slice(at, at + MOST_WRITTEN));
  }

  async close(): Promise<void> {
    this.#isWanted = false;
    this.#device.gatt?.disconnect();
    return Promise.resolve();
  }

  async #begin(): Promise<void> {
    const server = await this.#device.gatt!.connect();
    const service = await server.getPrimaryService(this.#service);
    this.#asks = this.#service === NORDIC_UART ? await service.getCharacteristic(NORDIC_WRITE) : undefined;
    const found = await service.getCharacteristics();
    const telling = found.filter(({ properties }) => properties.notify || properties.indicate);
    this.notifying = telling.map(({ uuid }) => uuid);
    const tells = telling.find(({ uuid }) => uuid === this.#notify) ?? telling[0];
    if (tells === undefined) throw new Error("no characteristic of this service notifies");
    this.#notify = tells.uuid;
    tells.addEventListener("characteristicvaluechanged", this.#heard);
    await tells.startNotifications();
  }

  async #lose(): Promise<void> {
    if (!this.#isWanted) return;
    this.#events.lost();
    while (this.#isWanted) {
      await new Promise((later) => window.setTimeout(later, AGAIN_MS));
      const isBack = await this.#begin().then(
        () => true,
        () => false,
      );
      if (isBack) return this.#events.back();
    }
  }
}
