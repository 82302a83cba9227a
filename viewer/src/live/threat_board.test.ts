// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { type Threat, ThreatState } from "../messages/threat";
import { ThreatBoard } from "./threat_board";

function threat(name: string, state: number, changed = false, array = "chest"): Threat {
  const place = { stampS: 1, crossedS: 1, zone: "", quantity: "contact_force", unit: "N", x: 0, y: 0 };
  return { ...place, name, array, state, changed, value: 1, sigma: 0, worst: 1, limit: 1 };
}

const { clear, active, latched } = ThreatState;

describe("the board of threats", () => {
  it("knows what stands, of each limit and array", () => {
    const board = new ThreatBoard();
    board.add(threat("a", active, true));
    board.add(threat("a", clear, false, "back"));
    board.add(threat("b", latched));
    expect(board.limits.value.length).toBe(3);
    expect(board.standing.map(({ name }) => name)).toEqual(["a", "b"]);
    board.add(threat("a", clear, true));
    expect(board.standing.map(({ name }) => name)).toEqual(["b"]);
  });

  it("logs what begins and ends, the newest first, and not how it goes on", () => {
    const board = new ThreatBoard();
    board.add(threat("a", active, true));
    for (let again = 0; again < 5; ++again) board.add(threat("a", active));
    board.add(threat("a", clear, true));
    expect(board.log.value.map(({ state }) => state)).toEqual([clear, active]);
    for (let again = 0; again < 500; ++again) board.add(threat("a", again % 2 === 0 ? active : clear, true));
    expect(board.log.value.length).toBe(200);
  });

  it("begins its log with what stands, and says that once", () => {
    const board = new ThreatBoard();
    board.add(threat("a", active));
    board.add(threat("b", clear));
    board.add(threat("a", active));
    expect(board.log.value.map(({ name, state }) => [name, state])).toEqual([["a", active]]);
    board.restart();
    board.add(threat("a", active));
    expect(board.log.value.length).toBe(1);
  });

  it("logs an end whose message was lost, and forgets at another connection what stood", () => {
    const board = new ThreatBoard();
    board.add(threat("a", active, true));
    board.add(threat("a", clear));
    expect(board.log.value.length).toBe(2);
    board.add(threat("a", active, true));
    board.restart();
    expect(board.standing).toEqual([]);
    expect(board.log.value.length).toBe(3);
  });
});
