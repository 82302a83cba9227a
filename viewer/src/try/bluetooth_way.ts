// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden } from "../dom";
import { type Bluetooth, BluetoothBoard, NORDIC_UART, uuidOf } from "./bluetooth_board";
import type { Board, BoardEvents } from "./board";

type Choose<Chosen extends Board> = (events: BoardEvents) => Promise<Chosen>;

/** Controls for a board by Bluetooth. Where more than one characteristic of it notifies, the user can choose which is heard. */
export function makeBluetoothWay(
  bluetooth: Bluetooth,
  connect: (choose: Choose<Board>) => Promise<void>,
): HTMLElement[] {
  const service = element("input", {
    id: "bluetooth-service",
    class: "field uuid",
    value: NORDIC_UART,
    autocomplete: "off",
    spellcheck: "false",
  });
  const characteristic = element("select", { id: "bluetooth-characteristic", class: "field uuid" });
  const characteristics = element(
    "span",
    { class: "setup-row", "data-role": "characteristics", hidden: true },
    element("label", { for: characteristic.id }, "Characteristic"),
    characteristic,
  );
  let board: BluetoothBoard | undefined;
  const connectTo = async (choose: Choose<BluetoothBoard>, heard?: string): Promise<void> => {
    await connect(async (events) => (board = await choose(events)));
    const uuids = board?.notifying ?? [];
    setHidden(characteristics, uuids.length < 2);
    characteristic.replaceChildren(...uuids.map((value) => element("option", { value }, value)));
    characteristic.value = heard ?? uuids[0] ?? "";
  };
  characteristic.addEventListener("change", () => {
    const [last, chosen] = [board, characteristic.value];
    if (last !== undefined) void connectTo((events) => Promise.resolve(last.hearing(chosen, events)), chosen);
  });
  const choose: Choose<BluetoothBoard> = (events) => BluetoothBoard.choose(bluetooth, uuidOf(service.value), events);
  return [
    button("By Bluetooth", () => void connectTo(choose), { "data-role": "connect-bluetooth" }),
    element("label", { for: service.id }, "Service"),
    service,
    characteristics,
  ];
}
