// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// navigator.serial for a page that is tested, as https://wicg.github.io/serial has it: a port has a state, its stream gives
// what has come in parts of any size, a buffer that is full loses bytes and the stream, and one that is unplugged is gone.

/** To be run in the page before its scripts: `addInitScript(standInForSerial)`. The test plays the boards by `boards`. */
export function standInForSerial() {
  const failure = (name, message) => new DOMException(message, name);
  let seed = 1;
  const random = () => {
    seed = (seed * 48271) % 2147483647;
    return seed / 2147483647;
  };

  const serial = new EventTarget();
  const tell = (type, port) => {
    const event = new Event(type);
    Object.defineProperty(event, "target", { value: port });
    serial.dispatchEvent(event);
  };

  class Port extends EventTarget {
    constructor(board) {
      super();
      this.board = board;
      this.state = "closed";
    }
    getInfo() {
      const { usbVendorId, usbProductId } = this.board;
      return { usbVendorId, usbProductId };
    }
    async open({ baudRate, bufferSize = 255 }) {
      if (this.state !== "closed") throw failure("InvalidStateError", "The port is already open.");
      if (!(baudRate > 0)) throw new TypeError("baudRate must be above 0");
      if (!(bufferSize > 0)) throw new TypeError("bufferSize must be above 0");
      this.state = "opening";
      await new Promise((soon) => setTimeout(soon, 5));
      if (!this.board.isPlugged || this.board.isHeld) {
        this.state = "closed";
        throw failure("NetworkError", "Failed to open serial port.");
      }
      this.state = "open";
      this.baudRate = baudRate;
      this.bufferSize = bufferSize;
      this.buffered = [];
      this.bufferedBytes = 0;
      this.isGone = false;
      this.board.port = this;
      this.board.opened(baudRate);
    }
    get readable() {
      if (this.state !== "open" || this.isGone) return null;
      this.stream ??= new ReadableStream(
        {
          pull: (controller) => this.pull(controller),
          cancel: () => {
            this.stream = undefined;
            this.waiting = undefined;
            this.buffered = [];
            this.bufferedBytes = 0;
          },
        },
        { highWaterMark: 0 },
      );
      return this.stream;
    }
    get writable() {
      if (this.state !== "open" || this.isGone) return null;
      this.sink ??= new WritableStream({ write: (bytes) => this.board.written(bytes) });
      return this.sink;
    }
    async setSignals(signals) {
      if (this.state !== "open") throw failure("InvalidStateError", "The port is closed.");
      this.board.signals = signals;
    }
    async close() {
      if (this.state !== "open") throw failure("InvalidStateError", "The port is already closed.");
      if (this.stream?.locked || this.sink?.locked) throw new TypeError("Cannot cancel a locked stream");
      this.stream = this.sink = this.waiting = undefined;
      this.state = "closed";
      this.board.port = undefined;
    }

    pull(controller) {
      return new Promise((served) => {
        this.waiting = { controller, served };
        this.serve();
      });
    }
    /** A part of what has come, which may end anywhere. */
    serve() {
      if (this.waiting === undefined || this.bufferedBytes === 0) return;
      const { controller, served } = this.waiting;
      this.waiting = undefined;
      const all = new Uint8Array(this.bufferedBytes);
      let end = 0;
      for (const bytes of this.buffered) {
        all.set(bytes, end);
        end += bytes.length;
      }
      const part = Math.max(1, Math.ceil(random() * all.length));
      this.buffered = part < all.length ? [all.slice(part)] : [];
      this.bufferedBytes = all.length - part;
      controller.enqueue(all.slice(0, part));
      served();
    }
    receive(bytes) {
      if (this.state !== "open" || this.isGone) return;
      if (this.bufferedBytes + bytes.length > this.bufferSize) {
        this.bufferedBytes = 0;
        this.buffered = [];
        this.fail(failure("BufferOverrunError", "Buffer overrun"));
        return;
      }
      this.buffered.push(bytes);
      this.bufferedBytes += bytes.length;
      this.serve();
    }
    /** The stream ends with this error; the port has another one then, unless it is gone. */
    fail(error) {
      const { waiting } = this;
      this.stream = this.waiting = undefined;
      waiting?.controller.error(error);
      waiting?.served();
    }
    lose() {
      this.isGone = true;
      this.sink = undefined;
      this.fail(failure("NetworkError", "The device has been lost."));
      tell("disconnect", this);
    }
  }

  /** What the test plays. `bytes` are sent over and over, so many a second, while the port is open; or what it says(), every
   *  10 ms. */
  class PlayedBoard {
    isPlugged = true;
    isHeld = false;
    usbVendorId = 0x2341;
    usbProductId = 0x0043;
    bytes = new Uint8Array();
    bytesPerSecond = 0;
    bauds = [];
    heard = "";
    sent = 0;
    known = new Port(this);

    constructor() {
      let last = performance.now();
      setInterval(() => {
        const now = performance.now();
        const due = Math.round(((now - last) * this.bytesPerSecond) / 1000);
        last = now;
        if (this.port !== undefined) this.send(due);
      }, 4);
      setInterval(() => {
        if (this.says === undefined || this.port === undefined) return;
        const said = this.says();
        this.port.receive(typeof said === "string" ? new TextEncoder().encode(said) : said);
      }, 10);
    }
    send(count) {
      if (this.bytes.length === 0) return;
      const part = new Uint8Array(count);
      for (let k = 0; k < count; ++k) part[k] = this.bytes[(this.sent + k) % this.bytes.length];
      this.sent += count;
      this.port.receive(part);
    }
    opened(baud) {
      this.bauds.push(baud);
    }
    written(bytes) {
      this.heard += new TextDecoder().decode(bytes);
    }
    unplug() {
      this.isPlugged = false;
      const { port } = this;
      this.port = undefined;
      port?.lose();
    }
    /** The port is another object, as in Chromium. `isKnown`: its permission lasts. */
    plugIn({ isKnown = true } = {}) {
      this.isPlugged = true;
      this.known = new Port(this);
      if (isKnown) tell("connect", this.known);
    }
  }

  globalThis.board = new PlayedBoard();
  globalThis.chooses = true; // in the list of the browser
  serial.getPorts = async () => [globalThis.board.known];
  serial.requestPort = async () => {
    if (!navigator.userActivation.isActive) throw failure("SecurityError", "Must be handling a user gesture.");
    if (!globalThis.chooses) throw failure("NotFoundError", "No port selected by the user.");
    return globalThis.board.known;
  };
  Object.defineProperty(Navigator.prototype, "serial", { configurable: true, get: () => serial });
}

/** To be run in the page: its board is a mat of conductive rubber, 12x10, whose columns are read over 200 ohm while the other
 *  rows are grounded. It sends lines, and nobody has told its circuit. `board.pressed`: newtons by taxel. */
export function playMat() {
  const [ROWS, COLS] = [12, 10];
  const begin = performance.now();
  board.pressed = {};
  board.says = () => {
    const siemens = Array.from(
      { length: ROWS * COLS },
      (_, taxel) => 5e-6 + 1.1e-3 * ((board.pressed[taxel] ?? 0) / 10) ** 0.9,
    );
    const sums = Array.from({ length: COLS }, (_, col) =>
      siemens.reduce((sum, one, taxel) => (taxel % COLS === col ? sum + one : sum), 1 / 200),
    );
    const counts = siemens.map((one, taxel) => Math.round((4095 * one) / sums[taxel % COLS] + Math.random() - 0.5));
    return `${Math.round(1000 + performance.now() - begin)},${counts.join(",")}\r\n`;
  };
}

/** navigator.bluetooth, as https://webbluetoothcg.github.io/web-bluetooth has it: a device with one service, which notifies. */
export function standInForBluetooth() {
  const failure = (name, message) => new DOMException(message, name);
  const SERVICE = "6e400001-b5a3-f393-e0a9-e50e24dcca9e";
  const MOST_NOTIFIED = 244;

  class Characteristic extends EventTarget {
    value = undefined;
    isNotifying = false;
    constructor(uuid, notify) {
      super();
      this.uuid = uuid;
      this.properties = { notify, indicate: false };
    }
    async startNotifications() {
      this.isNotifying = true;
      return this;
    }
    async writeValueWithoutResponse(bytes) {
      radio.heard += new TextDecoder().decode(bytes);
    }
  }
  const notify = new Characteristic("6e400003-b5a3-f393-e0a9-e50e24dcca9e", true);
  const characteristics = [notify, new Characteristic("6e400002-b5a3-f393-e0a9-e50e24dcca9e", false)];
  const found = (all, uuid, what) => {
    const one = all.find((candidate) => candidate.uuid === uuid);
    if (one === undefined) throw failure("NotFoundError", `No ${what} matching UUID ${uuid} found.`);
    return one;
  };
  const service = {
    uuid: SERVICE,
    getCharacteristic: async (uuid) => found(characteristics, uuid, "Characteristics"),
    getCharacteristics: async () => characteristics,
  };
  const device = new EventTarget();
  device.name = "Mat";
  device.gatt = {
    connected: false,
    async connect() {
      if (!radio.isInReach) throw failure("NetworkError", "Bluetooth Device is no longer in range.");
      device.gatt.connected = true;
      return device.gatt;
    },
    disconnect: () => radio.cut(),
    getPrimaryService: async (uuid) => found([service], uuid, "Services"),
  };
  const radio = {
    isInReach: true,
    heard: "",
    bytes: new Uint8Array(),
    sent: 0,
    /** Before that of the bytes the service has a characteristic that never notifies. */
    addSilent: () => characteristics.unshift(new Characteristic("0000ffe1-0000-1000-8000-00805f9b34fb", true)),
    /** It is out of reach, or was let go. */
    cut() {
      if (!device.gatt.connected) return;
      device.gatt.connected = notify.isNotifying = false;
      device.dispatchEvent(new Event("gattserverdisconnected"));
    },
  };
  setInterval(() => {
    if (!notify.isNotifying || radio.bytes.length === 0) return;
    const begin = radio.sent % radio.bytes.length;
    const part = radio.bytes.slice(begin, begin + MOST_NOTIFIED);
    radio.sent += part.length;
    notify.value = new DataView(part.buffer);
    notify.dispatchEvent(new Event("characteristicvaluechanged"));
  }, 7);
  globalThis.radio = radio;
  const bluetooth = {
    async requestDevice({ filters }) {
      if (!navigator.userActivation.isActive) throw failure("SecurityError", "Must be handling a user gesture.");
      if (!filters.some(({ services }) => services.includes(SERVICE)))
        throw failure("NotFoundError", "User cancelled the requestDevice() chooser.");
      return device;
    },
  };
  Object.defineProperty(Navigator.prototype, "bluetooth", { configurable: true, get: () => bluetooth });
}

/** navigator.usb, as https://wicg.github.io/webusb has it: a board of CDC-ACM that no driver of the system has. */
export function standInForUsb() {
  const failure = (name, message) => new DOMException(message, name);
  const [CONTROL, DATA, IN, OUT] = [0, 1, 2, 3];
  const claimed = new Set();
  const bulk = (direction, endpointNumber) => ({ type: "bulk", direction, endpointNumber });
  const port = { bytes: new Uint8Array(), sent: 0, heard: "", baud: 0, isPlugged: true };
  const interfaces = [
    { interfaceNumber: CONTROL, alternate: { interfaceClass: 2, endpoints: [] } },
    { interfaceNumber: DATA, alternate: { interfaceClass: 10, endpoints: [bulk("in", IN), bulk("out", OUT)] } },
  ];
  const device = {
    productName: "Pico",
    configuration: null,
    async open() {
      if (!port.isPlugged) throw failure("NotFoundError", "The device was disconnected.");
      claimed.clear();
    },
    async close() {
      claimed.clear();
    },
    async selectConfiguration() {
      device.configuration = { interfaces };
    },
    async claimInterface(number) {
      claimed.add(number);
    },
    async controlTransferOut({ request, index }, data) {
      if (!claimed.has(index)) throw failure("InvalidStateError", "The specified interface has not been claimed.");
      if (request === 0x20) port.baud = new DataView(data.buffer).getUint32(0, true);
    },
    async transferIn(endpoint, length) {
      if (endpoint !== IN || !claimed.has(DATA)) throw failure("NotFoundError", "The endpoint is not there.");
      await new Promise((soon) => setTimeout(soon, 5));
      if (!port.isPlugged) throw failure("NetworkError", "A transfer error has occurred.");
      const begin = port.sent % port.bytes.length;
      const part = port.bytes.slice(begin, begin + Math.min(length, 512));
      port.sent += part.length;
      return { status: "ok", data: new DataView(part.buffer) };
    },
    async transferOut(endpoint, bytes) {
      if (endpoint !== OUT || !claimed.has(DATA)) throw failure("NotFoundError", "The endpoint is not there.");
      port.heard += new TextDecoder().decode(bytes);
      return { status: "ok", bytesWritten: bytes.length };
    },
  };
  globalThis.usbPort = port;
  const usb = {
    async requestDevice({ filters }) {
      if (!Array.isArray(filters)) throw new TypeError("filters must be given");
      if (!navigator.userActivation.isActive) throw failure("SecurityError", "Must be handling a user gesture.");
      return device;
    },
  };
  Object.defineProperty(Navigator.prototype, "usb", { configurable: true, get: () => usb });
}
