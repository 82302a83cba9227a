// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { Contact, ContactPhase, ContactsFrame } from "../messages/contacts";
import type { ArrayDescription } from "../suit";
import { ContactSlots, SLOTS } from "./contact_slots";
import { EventLog } from "./event_log";
import { BIN_S, BINS, binOf, ForceHistory } from "./force_history";
import { regionBetween, regionName } from "./region_force";

function frame(stampS: number, ids: number[]): ContactsFrame {
  const result = new ContactsFrame();
  result.stampS = stampS;
  result.count = ids.length;
  ids.forEach((id) => result.contacts.push(Object.assign(new Contact(), { id, forceN: id, x: stampS, y: id })));
  return result;
}

function points(history: ForceHistory, endS: number, count: number, binsPerPoint = 1): number[] {
  const result = new Float64Array(count);
  history.copy(binOf(endS), binsPerPoint, result);
  return [...result];
}

describe("the history of a force", () => {
  it("holds the last value between frames that are half a second apart, and leaves longer gaps", () => {
    const history = new ForceHistory();
    history.add(100.001, 3);
    history.add(100.001 + 3 * BIN_S, 5);
    expect(points(history, 100.001 + 4 * BIN_S, 6)).toEqual([NaN, 3, 3, 3, 5, 5]);
    history.add(110, 7);
    expect(points(history, 110, 3)).toEqual([NaN, NaN, 7]);
    expect(history.at(binOf(110) + 100)).toBeNaN();
  });

  it("shows the highest of the steps that share a point", () => {
    const history = new ForceHistory();
    [1, 9, 2, 4].forEach((force, step) => history.add(100.001 + step * BIN_S, force));
    expect(points(history, 100.001 + 3 * BIN_S, 2, 2)).toEqual([9, 4]);
  });

  it("begins anew when the recording is rewound, and forgets what is older than it holds", () => {
    const history = new ForceHistory();
    history.add(100, 1);
    history.add(50, 2);
    expect(history.at(binOf(50))).toBe(2);
    expect(history.at(binOf(50) - 1)).toBeNaN();
    history.add(50 + (BINS - 1) * BIN_S, 4);
    history.add(50 + (BINS + 5) * BIN_S, 4);
    expect(history.at(binOf(50))).toBeNaN();
  });
});

describe("the log of events", () => {
  it("forgets at a rewind what the recording will bring again, and keeps the marks, which it knows", () => {
    const log = new EventLog();
    log.add("contact", 1, "contact 1");
    log.marks = [{ kind: "mark", atS: 8, words: "grasp", array: "" }];
    log.add("contact", 9, "contact 2");
    log.rewind(5);
    expect(log.events.map(({ words }) => words)).toEqual(["contact 1"]);
    expect(log.marks.map(({ words }) => words)).toEqual(["grasp"]);
  });
});

describe("a region", () => {
  it("lies between two taxels, in whatever order they were drawn", () => {
    const array = { name: "a", rows: 4, cols: 5 } as ArrayDescription;
    expect(regionBetween(array, 13, 6)).toEqual({ array: "a", rows: [1, 2], cols: [1, 3] });
    expect(regionName(regionBetween(array, 8, 11))).toBe("r1c1 \u2013 r2c3");
  });
});

describe("the slots of contacts", () => {
  it("stay with a contact for as long as it lasts", () => {
    const slots = new ContactSlots();
    slots.add(frame(1, [5, 6]));
    expect([slots.indexOf(5), slots.indexOf(6)]).toEqual([0, 1]);
    slots.add(frame(1.1, [6]));
    expect(slots.indexOf(5)).toBe(-1);
    slots.add(frame(1.2, [6, 7]));
    expect([slots.indexOf(7), slots.indexOf(6)]).toEqual([0, 1]);
  });

  it("keep a trail, which begins anew with the next contact", () => {
    const slots = new ContactSlots();
    slots.add(frame(1, [5]));
    slots.add(frame(1.001, [5]));
    slots.add(frame(1.1, [5]));
    const { trail } = slots.slots[0]!;
    expect(trail.length).toBe(2);
    expect([trail.x(0), trail.x(1)]).toEqual([1, Math.fround(1.1)]);
    slots.add(frame(1.2, []));
    expect(trail.length).toBe(0);
  });

  it("tell which contacts began, and not those that were there before", () => {
    const slots = new ContactSlots();
    const first = frame(1, [5, 6]);
    first.contacts[1]!.phase = ContactPhase.held;
    expect(slots.add(first)).toEqual([5]);
    expect(slots.add(frame(1.1, [5, 6, 7]))).toEqual([7]);
  });

  it("are given to so many and no more", () => {
    const slots = new ContactSlots();
    slots.add(
      frame(
        1,
        Array.from({ length: SLOTS + 3 }, (_, index) => index + 1),
      ),
    );
    expect(slots.indexOf(SLOTS)).toBe(SLOTS - 1);
    expect(slots.indexOf(SLOTS + 1)).toBe(-1);
  });
});
