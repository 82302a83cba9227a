// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { adviceOn, type Board, type BoardEvents } from "./board";

/** The part of Web Bluetooth that is used (https://webbluetoothcg.github.io/web-bluetooth). */
interface Characteristic extends EventTarget {
  readonly value: DataView<ArrayBuffer> | undefined;
  startNotifications(): Promise<unknown>;
  writeValueWithoutResponse(bytes: Uint8Array<ArrayBuffer>): Promise<void>;
}
interface Service {
  getCharacteristic(uuid: string): Promise<Characteristic>;
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
interface Bluetooth {
  requestDevice(options: { filters: { services: string[] }[] }): Promise<Device>;
}

/** Where the bytes are; `write` empty: it cannot be asked. */
export interface Place {
  service: string;
  notify: string;
  write: string;
}

/** The UART service of Nordic, which most firmware has. */
export const NORDIC_UART: Place = {
  service: "6e400001-b5a3-f393-e0a9-e50e24dcca9e",
  notify: "6e400003-b5a3-f393-e0a9-e50e24dcca9e",
  write: "6e400002-b5a3-f393-e0a9-e50e24dcca9e",
};

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

/** A board that notifies its bytes by Bluetooth. One that is out of reach is connected again when it is back. */
export class BluetoothBoard implements Board {
  readonly #device: Device;
  readonly #place: Place;
  readonly #events: BoardEvents;
  #asks: Characteristic | undefined;
  /** Until it is closed by this page. */
  #isWanted = false;
  readonly #heard = (event: Event): void => {
    const value = (event.target as Characteristic).value;
    if (value !== undefined) this.#events.bytes(new Uint8Array(value.buffer, value.byteOffset, value.byteLength));
  };

  private constructor(device: Device, place: Place, events: BoardEvents) {
    this.#device = device;
    this.#place = place;
    this.#events = events;
    device.addEventListener("gattserverdisconnected", () => void this.#lose());
  }

  /** Lets the user choose a device that has the service. */
  static async choose(bluetooth: Bluetooth, place: Place, events: BoardEvents): Promise<BluetoothBoard> {
    const device = await bluetooth.requestDevice({ filters: [{ services: [place.service] }] });
    return new BluetoothBoard(device, place, events);
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
    const service = await server.getPrimaryService(this.#place.service);
    this.#asks = this.#place.write === "" ? undefined : await service.getCharacteristic(this.#place.write);
    const tells = await service.getCharacteristic(this.#place.notify);
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
