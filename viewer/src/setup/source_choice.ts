// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { errorText } from "../format";
import type { Stream } from "../stream/stream";
import type { KnownArray, KnownArrays } from "./known_arrays";
import "./setup.css";

export const BAUDS = [9600, 57600, 115200, 230400, 250000, 460800, 921600, 1000000, 2000000];
export const USUAL_BAUD = 115200;
const SCENES: Readonly<Record<string, string>> = {
  contacts: "Contacts that wander",
  rehearsal: "A hand that obeys the guide",
};

/** The answer of /source/list. */
interface Choices {
  ports: { device: string; path: string; product: string }[];
  recordings: string[];
  simulations: string[];
}

/** Where the array may be, as the server's machine has it. Nothing is opened that the user has not chosen. */
export function makeSourceChoice(stream: Stream, known: KnownArrays): HTMLElement {
  const words = element("p", { role: "status", "data-role": "source-words" });
  const ports = element("div", { class: "port-list", "data-role": "ports" });
  const noPort = element(
    "p",
    { class: "dim", "data-role": "no-port", hidden: true },
    "None is there. Is the board plugged in, with a cable that has data lines?",
  );
  const baud = element(
    "select",
    { id: "port-baud", class: "field" },
    ...BAUDS.map((value) => element("option", { value, selected: value === USUAL_BAUD }, String(value))),
  );
  const address = element("input", {
    id: "address",
    class: "field",
    placeholder: "192.168.4.1:3333",
    required: true,
    autocomplete: "off",
    "aria-label": "Address",
  });
  const recordings = element("div", { class: "port-list", "data-role": "source-recordings" });
  const simulations = element("div", { class: "port-list", "data-role": "simulations" });

  async function open(request: object, name: string): Promise<void> {
    const buttons = section.querySelectorAll("button");
    setText(words, `Listening to ${name}, for 8 s at most ...`);
    for (const button of buttons) button.disabled = true;
    try {
      await stream.callService("/source/open", request);
      await stream.refresh();
      setText(words, "");
    } catch (error) {
      setText(words, errorText(error));
    }
    for (const button of buttons) button.disabled = false;
  }

  /** Its place is known, or it is asked for. */
  async function useKnown(one: KnownArray): Promise<void> {
    if (one.from === "") {
      known.chosen.value = known.chosen.value === one ? undefined : one;
      return;
    }
    setText(words, `Looking for ${one.name} ...`);
    try {
      await stream.callService("/array/use", { file: one.file });
    } catch (error) {
      known.chosen.value = one;
      setText(words, `${errorText(error)}. Where is ${one.name} now?`);
    }
  }

  const choice = (name: string, title: string, data: string, request: () => object): HTMLElement =>
    button(name, () => void open(request(), name), { title, "data-source": data });

  async function look(): Promise<void> {
    const choices = (await stream.callService("/source/list", {})) as Choices;
    setHidden(noPort, choices.ports.length > 0);
    ports.replaceChildren(
      ...choices.ports.map(({ device, path, product }) =>
        choice(product === "" ? device : `${product}, ${device}`, path, device, () => ({
          port: path,
          baud: Number(baud.value),
        })),
      ),
    );
    recordings.replaceChildren(
      ...choices.recordings.map((name) => choice(name, name, name, () => ({ recording: name }))),
    );
    setHidden(recordingPart, choices.recordings.length === 0);
    simulations.replaceChildren(
      ...choices.simulations.map((scene) =>
        choice(SCENES[scene] ?? scene, `sim:${scene}`, scene, () => ({ simulation: scene })),
      ),
    );
  }

  const recordingPart = part("A recording of this folder", recordings);
  const connect = element("button", { class: "button", type: "submit" }, "Connect");
  const network = element("form", { class: "setup-row", "data-role": "network" }, address, connect);
  network.addEventListener("submit", (event) => {
    event.preventDefault();
    void open({ address: address.value.trim() }, address.value.trim());
  });
  const section = element(
    "section",
    { class: "panel array-setup", "data-role": "source-setup", "aria-label": "The source", hidden: true },
    element("h2", {}, "Where is the array?"),
    words,
    known.makeList((one) => void useKnown(one)),
    part(
      "At a USB port of this machine",
      noPort,
      ports,
      element(
        "div",
        { class: "setup-row" },
        element("label", { for: baud.id }, "Baud (boards with USB of their own take any)"),
        baud,
        button("Look again", () => void look(), { "data-role": "look-again" }),
      ),
    ),
    part("On the network", network),
    recordingPart,
    part("In the simulator", simulations),
  );
  stream.services.follow((services) => {
    connect.disabled = !services.has("/source/open");
    if (services.has("/source/list")) void look();
  });
  known.chosen.follow((chosen) => setText(words, chosen === undefined ? "" : `Where is ${chosen.name} now?`));
  return section;
}

function part(title: string, ...children: HTMLElement[]): HTMLElement {
  return element("div", { class: "setup-part" }, element("h3", {}, title), ...children);
}
