// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";
import type { Stream } from "../stream/stream";

const BAUDS = [9600, 57600, 115200, 230400, 250000, 460800, 921600, 1000000, 2000000];
const USUAL_BAUD = 115200;

/** A serial port, as /ports/list tells it. */
interface Port {
  device: string;
  path: string;
  product: string;
}

/** The serial ports of the server's machine. One is opened where the user chooses it, and none before. */
export function makePortList(stream: Stream): HTMLElement {
  const words = element("p", { role: "status", "data-role": "port-words" });
  const list = element("div", { class: "port-list", "data-role": "ports" });
  const baud = element("select", { id: "port-baud", class: "field" }, ...BAUDS.map((value) => element("option", { value, selected: value === USUAL_BAUD }, String(value))));

  const tell = (error: unknown): void => setText(words, error instanceof Error ? error.message : String(error));

  async function open(port: Port): Promise<void> {
    setText(words, `Listening to ${port.device}, for 8 s at most ...`);
    for (const button of list.querySelectorAll("button")) button.disabled = true;
    try {
      await stream.callService("/ports/open", { path: port.path, baud: Number(baud.value) });
      await stream.refresh();
    } catch (error) {
      tell(error);
    }
    for (const button of list.querySelectorAll("button")) button.disabled = false;
  }

  async function look(): Promise<void> {
    try {
      const { ports } = (await stream.callService("/ports/list", {})) as { ports: Port[] };
      setText(words, ports.length === 0 ? "No USB serial port is there. Is the board plugged in, with a cable that has data lines?" : "Choose the port of the array.");
      list.replaceChildren(...ports.map((port) => makePort(port, () => void open(port))));
    } catch (error) {
      tell(error);
    }
  }

  stream.services.follow((services) => {
    if (services.has("/ports/list") && list.childElementCount === 0) void look();
  });
  return element(
    "section",
    { class: "panel array-setup", "data-role": "port-setup", "aria-label": "Serial ports", hidden: true },
    element("h2", {}, "Where is the array?"),
    words,
    list,
    element("label", { for: baud.id }, "Baud (boards with USB of their own take any)"),
    baud,
    element("button", { class: "button", type: "button", "data-role": "look-again", onclick: () => void look() }, "Look again"),
    element("p", { class: "dim" }, "Devices on a network are named in the command: dermis serve --from tcp://HOST:PORT"),
  );
}

function makePort({ device, path, product }: Port, open: () => void): HTMLElement {
  const name = product === "" ? device : `${product}, ${device}`;
  return element("button", { class: "button large-button", type: "button", title: path, "data-port": device, onclick: open }, name);
}
