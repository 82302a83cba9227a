// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { errorText } from "../format";
import { BAUDS, USUAL_BAUD } from "../setup/source_choice";
import type { Stream } from "../stream/stream";
import type { Suit } from "../suit";
import { bluetoothOf } from "./bluetooth_board";
import { makeBluetoothWay } from "./bluetooth_way";
import { type Board, type BoardEvents, isNoChoice } from "./board";
import { type BoardLink, checksumOf, hashOf } from "./board_link";
import { makeLinkPanel } from "./link_panel";
import type { BoardRequest, ModuleEndpoint } from "./module_endpoint";
import { SerialBoard, serialOf } from "./serial_board";
import { UsbBoard, usbOf } from "./usb_board";

/** As long as the module does: reconnect_s of docs/devices.md. */
const AWAITED_MS = 10_000;
const NO_SERIAL =
  "This browser cannot open a serial port: Chrome, Edge and Opera can, on Windows, macOS, Linux and ChromeOS. The rest of this page works here, too.";

/** The user connects a board; its bytes go to the module, whose requests come back. */
export class Boards {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #endpoint: ModuleEndpoint;
  readonly #words = element("span", { role: "status", "data-role": "board-words" });
  readonly #baud = element(
    "select",
    { id: "board-baud", class: "field" },
    ...BAUDS.map((value) => element("option", { value, selected: value === USUAL_BAUD }, String(value))),
  );
  readonly #copy = button("Copy a link for this board", () => void this.#copyLink(), {
    "data-role": "copy-link",
    hidden: true,
  });
  /** By which the board is read; empty: it says itself what it sends. */
  #layout = "";
  /** That of a link, which the user wants. */
  #wanted = "";
  #board: Board | undefined;
  /** When it was unplugged, by performance.now(). */
  #lostMs = -Infinity;
  #lostName = "";
  #writing: Promise<void> = Promise.resolve();

  /** `link`: the page was opened by it. */
  constructor(stream: Stream, suit: Suit, endpoint: ModuleEndpoint, link: BoardLink | undefined) {
    this.#stream = stream;
    this.#endpoint = endpoint;
    endpoint.onRequest = (request) => this.#request(request);
    this.element = element(
      "div",
      { class: "boards" },
      ...this.#bySerial(),
      ...this.#byOtherWays(),
      this.#words,
      this.#copy,
    );
    if (link !== undefined) this.element.append(makeLinkPanel(link, () => this.#want(link)));
    suit.description.follow(({ setup }) => {
      if (setup === undefined) return; // of the array that was described
      this.#layout = setup.layout;
      setHidden(this.#copy, this.#layout === "");
    });
  }

  #want({ layout, baud }: BoardLink): void {
    this.#wanted = layout;
    if (baud !== undefined) this.#setBaud(baud);
    setText(this.#words, "The layout of the link is used for the board that you connect.");
  }

  #setBaud(baud: number): void {
    if (![...this.#baud.options].some(({ value }) => Number(value) === baud))
      this.#baud.append(element("option", { value: baud }, String(baud)));
    this.#baud.value = String(baud);
  }

  async #copyLink(): Promise<void> {
    const hash = await hashOf({ layout: this.#layout, baud: Number(this.#baud.value) });
    const link = new URL(hash, document.baseURI).href;
    const isCopied = await navigator.clipboard.writeText(link).then(
      () => true,
      () => false,
    );
    setText(this.#words, isCopied ? "The link is copied: it holds the layout and the baud." : link);
  }

  #bySerial(): HTMLElement[] {
    const serial = serialOf(navigator);
    if (serial === undefined) return [element("span", { class: "dim", "data-role": "no-serial" }, NO_SERIAL)];
    const choose = (events: BoardEvents): Promise<Board> => SerialBoard.choose(serial, events);
    return [
      button("Connect a board", () => void this.#connect(choose), { class: "primary", "data-role": "connect-board" }),
      element("label", { for: this.#baud.id }, "Baud"),
      this.#baud,
    ];
  }

  #byOtherWays(): HTMLElement[] {
    const [bluetooth, usb] = [bluetoothOf(navigator), usbOf(navigator)];
    const ways: HTMLElement[] = [];
    if (bluetooth !== undefined) ways.push(...makeBluetoothWay(bluetooth, (choose) => this.#connect(choose)));
    if (usb !== undefined) {
      const choose = (events: BoardEvents): Promise<Board> => UsbBoard.choose(usb, events);
      ways.push(button("By USB, without a driver", () => void this.#connect(choose), { "data-role": "connect-usb" }));
    }
    if (ways.length === 0) return [];
    return [
      element("details", {}, element("summary", {}, "Other ways"), element("div", { class: "setup-row" }, ...ways)),
    ];
  }

  async #connect(choose: (events: BoardEvents) => Promise<Board>): Promise<void> {
    if (this.#stream.parameters.value.get("/recording") === true && !this.#isAwaited())
      return setText(this.#words, "A recording is going on: end it first.");
    try {
      const baud = Number(this.#baud.value);
      const board = await choose(this.#events(() => this.#board === board));
      await this.#letGo();
      this.#board = board;
      await board.open(baud);
      this.#endpoint.tell({ board: board.name, baud });
      if (this.#isAwaited() && board.name === this.#lostName) return this.#tellReturn();
      this.#lostMs = -Infinity;
      setText(this.#words, "Listening to the board, for 8 s at most \u2026");
      await this.#lookAtIt(baud);
      setText(this.#words, `Connected: ${board.name}.`);
    } catch (error) {
      setText(this.#words, isNoChoice(error) ? "No board was chosen." : errorText(error));
    }
  }

  async #letGo(): Promise<void> {
    if (this.#board === undefined) return;
    this.#endpoint.tell({ lost: true });
    await this.#board.close();
    this.#writing = Promise.resolve();
  }

  /** It was unplugged, and the module waits for it to come back. */
  #isAwaited(): boolean {
    return performance.now() - this.#lostMs < AWAITED_MS;
  }

  #tellReturn(): void {
    const words = this.#isAwaited()
      ? "The board is back."
      : "The board is back, but was away for more than 10 s: press Connect a board to go on.";
    this.#lostMs = -Infinity;
    setText(this.#words, words);
  }

  /** As if the user had chosen it among the ports of the machine of a server. */
  async #lookAtIt(baud: number): Promise<void> {
    if (!this.#stream.services.value.has("/source/open")) this.#endpoint.tell({ setup: true });
    await this.#offered("/source/open");
    await this.#stream.callService("/source/open", { port: "board", baud });
    if (this.#wanted !== "")
      await this.#stream.callService("/layout/use", {
        name: `link-${checksumOf(this.#wanted)}`,
        layout: this.#wanted.split("\n"),
      });
    this.#wanted = ""; // it is for one board
    await this.#stream.refresh();
  }

  #offered(service: string): Promise<void> {
    return new Promise((resolve) => {
      const end = this.#stream.services.follow((services) => {
        if (!services.has(service)) return;
        resolve();
        queueMicrotask(() => end());
      });
    });
  }

  #events(isOurs: () => boolean): BoardEvents {
    return {
      bytes: (bytes) => {
        if (isOurs()) this.#endpoint.tell({ bytes });
      },
      lost: () => {
        if (!isOurs()) return;
        this.#lostMs = performance.now();
        this.#lostName = this.#board?.name ?? "";
        this.#endpoint.tell({ lost: true });
        setText(this.#words, "The board is unplugged: this page waits for it for 10 s.");
      },
      back: () => {
        if (!isOurs() || this.#board === undefined) return;
        this.#endpoint.tell({ board: this.#board.name, baud: Number(this.#baud.value) });
        this.#tellReturn();
      },
      trouble: (line) => {
        if (isOurs()) setText(this.#words, line);
      },
    };
  }

  #request(request: BoardRequest): void {
    const board = this.#board;
    if (board === undefined) return;
    if ("write" in request) this.#then(() => board.write(request.write));
    else if ("open" in request) this.#then(() => this.#reopen(board, request.open));
    else
      setText(
        this.#words,
        `This page slept for ${Math.round(request.slept)} s: what the board sent meanwhile may be lost.`,
      );
  }

  async #reopen(board: Board, baud: number): Promise<void> {
    this.#setBaud(baud);
    await board.open(baud);
  }

  /** One after the other. A request that cannot be written is asked for again, where the board is still there. */
  #then(act: () => Promise<void>): void {
    this.#writing = this.#writing.then(act).catch((error: unknown) => setText(this.#words, errorText(error)));
  }
}
