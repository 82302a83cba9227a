// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import {
  type ArrayState,
  isOfKind,
  isWanted,
  type Kind,
  type RobotState,
  robotOf,
  sorted,
  span,
  stateOf,
  wayTo,
} from "./fleet_data";

const array = (of: Partial<ArrayState> = {}): ArrayState => ({
  name: "chest",
  rows: 4,
  cols: 5,
  model: "chest.safetensors",
  level: "good",
  message: "healthy",
  rate_hz: 100,
  lost: 0,
  left_out: 0,
  masked_taxels: 0,
  wants_calibration: false,
  ...of,
});

const robot = (of: Partial<RobotState> = {}): RobotState => ({
  name: "anna",
  messages: 7,
  bytes: 1000,
  age_s: 0.1,
  lag: 0,
  health_age_s: 0.5,
  health_error: "",
  silent: false,
  live: "http://anna:8080/",
  arrays: [array()],
  ...of,
});

describe("the state of a robot", () => {
  it("is that of its worst array", () => {
    expect(stateOf(robot())).toBe("well");
    expect(stateOf(robot({ arrays: [array(), array({ level: "warning" })] }))).toBe("warning");
    expect(stateOf(robot({ arrays: [array({ level: "warning" }), array({ level: "error" })] }))).toBe("error");
    expect(stateOf(robot({ arrays: [array({ level: "\u202ewell" })] }))).toBe("error");
    expect(stateOf(robot({ arrays: [array({ wants_calibration: true })] }))).toBe("warning");
  });

  it("is silence, whatever it said before", () => {
    expect(stateOf(robot({ silent: true }))).toBe("silent");
    expect(stateOf(robot({ messages: 0, health_age_s: null, silent: true }))).toBe("silent");
    expect(stateOf(robot({ health_age_s: null, silent: true }))).toBe("no health");
    expect(stateOf(robot({ health_error: "health: is too large" }))).toBe("unreadable");
  });
});

describe("robots", () => {
  it("are found by words and by kind", () => {
    const one = robotOf(robot({ arrays: [array({ level: "warning", message: "2 faults" })] }));
    const found = (words: string, kind: Kind = "all"): boolean => isWanted(one, { words, kind });
    expect([found(""), found("AN"), found("chest 2"), found("bob")]).toEqual([true, true, true, false]);
    expect([found("", "attention"), found("", "silent"), found("", "to calibrate")]).toEqual([true, false, false]);
    expect(isOfKind(robotOf(robot({ arrays: [array({ wants_calibration: true })] })), "to calibrate")).toBe(true);
  });

  it("are sorted, those of which nothing is known last", () => {
    const robots = [
      robotOf(robot({ name: "r10", arrays: [array({ gain_change: 0.1 })] })),
      robotOf(robot({ name: "r9" })),
      robotOf(robot({ name: "r2", silent: true, arrays: [array({ gain_change: 0.2 })] })),
    ];
    const names = (key: "state" | "robot" | "drift", descends: boolean): string[] =>
      sorted(robots, { key, descends }).map(({ state }) => state.name);
    expect(names("robot", false)).toEqual(["r2", "r9", "r10"]);
    expect(names("robot", true)).toEqual(["r10", "r9", "r2"]);
    expect(names("state", false)).toEqual(["r2", "r9", "r10"]);
    expect(names("drift", true)).toEqual(["r2", "r10", "r9"]);
    expect(names("drift", false)).toEqual(["r10", "r2", "r9"]);
  });
});

describe("times", () => {
  it("have one figure and its unit", () => {
    expect([null, -0.3, 0.44, 12.3, 119, 121, 7300, 3e5].map(span)).toEqual([
      "\u2013",
      "0.0 s",
      "0.4 s",
      "12 s",
      "119 s",
      "2 min",
      "2 h",
      "3 d",
    ]);
    expect(span(-20)).toBe("20 s ahead");
  });
});

describe("the way to a robot's page", () => {
  it("is one of the web, and of a machine that this browser reaches", () => {
    expect(wayTo("http://anna:8080/", "hub")).toEqual({ url: "http://anna:8080/" });
    expect(wayTo("http://127.0.0.1:8080/", "127.0.0.1").url).toBe("http://127.0.0.1:8080/");
    expect(wayTo("http://127.0.0.1:8080/", "hub").url).toBeUndefined();
    expect(wayTo("javascript:alert(1)", "hub").url).toBeUndefined();
    expect(wayTo("no address", "hub").url).toBeUndefined();
    expect(wayTo("", "hub").url).toBeUndefined();
  });
});
