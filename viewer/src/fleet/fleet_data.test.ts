// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import {
  type ArrayState,
  aged,
  isOfKind,
  isWanted,
  type Kind,
  modelOf,
  type RobotState,
  recordCommand,
  robotOf,
  sorted,
  span,
  stateOf,
  stateOfArray,
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
  wanted_model: 0,
  used_model: 0,
  refusal: "",
  ...of,
});

const robot = (of: Partial<RobotState> = {}): RobotState => ({
  name: "anna",
  messages: 7,
  bytes: 1000,
  age_s: 0.1,
  lag: 0,
  health_age_s: 0.5,
  state: "well",
  since_s: null,
  reasons: [],
  silent: false,
  stale: false,
  live: "http://anna:8080/",
  arrays: [array()],
  ...of,
});

describe("the state of a robot", () => {
  it("is the word of the hub, and of its arrays that of the worst that they say", () => {
    expect(stateOf(robot())).toBe("well");
    expect(stateOf(robot({ state: "behind" }))).toBe("behind");
    expect(stateOf(robot({ state: "\u202ewell" }))).toBe("unreadable");
    expect(stateOfArray(array({ level: "\u202ewell" }))).toBe("error");
    expect(stateOfArray(array({ refusal: "it is of another pitch" }))).toBe("warning");
  });

  it("shows no rate of a robot of which nothing comes", () => {
    expect(robotOf(robot()).rateHz).toBe(100);
    expect(robotOf(robot({ state: "silent", silent: true })).rateHz).toBeNaN();
    expect(robotOf(robot({ stale: true })).rateHz).toBeNaN();
  });

  it("ages while nobody tells more", () => {
    const told = robot({ age_s: 1, health_age_s: 1 });
    expect(aged(told, 2)).toEqual({ ...told, age_s: 3, health_age_s: 3 });
    expect(robotOf(aged(told, 6)).rateHz).toBeNaN();
    expect(stateOf(aged(told, 6))).toBe("well");
    expect(stateOf(aged(told, 11))).toBe("silent");
    expect(aged(told, 11).reasons).toEqual(["no message for 12 s"]);
  });
});

describe("the model of an array", () => {
  it("is told with the one that the fleet wants", () => {
    const of = (wanted: number, used: number, refusal = ""): string =>
      modelOf(array({ wanted_model: wanted, used_model: used, refusal }));
    expect(of(0, 0)).toBe("chest");
    expect(of(2, 2)).toBe("chest (2)");
    expect(of(2, 1, "no")).toBe("model 2 refused, 1 in use");
    expect(of(1, 0)).toBe("model 1 wanted, its own in use");
  });
});

describe("a recording", () => {
  it("is got from the hub by a command that holds nothing but names", () => {
    const command = recordCommand("nats://hub", "an'na", "a'; rm b");
    expect(command).toBe(
      "dermis record --from 'nats://hub?robot=an?na&array=a???rm?b&from=1&to=last' --out an?na-a???rm?b.mcap",
    );
  });
});

describe("robots", () => {
  it("are found by words and by kind", () => {
    const one = robotOf(robot({ state: "warning", reasons: ["chest: 2 faults"] }));
    const found = (words: string, kind: Kind = "all"): boolean => isWanted(one, { words, kind });
    expect([found(""), found("AN"), found("chest 2"), found("bob")]).toEqual([true, true, true, false]);
    expect([found("", "attention"), found("", "silent"), found("", "to calibrate")]).toEqual([true, false, false]);
    expect(isOfKind(robotOf(robot({ arrays: [array({ wants_calibration: true })] })), "to calibrate")).toBe(true);
  });

  it("are sorted, those of which nothing is known last", () => {
    const robots = [
      robotOf(robot({ name: "r10", arrays: [array({ gain_change: 0.1 })] })),
      robotOf(robot({ name: "r9" })),
      robotOf(robot({ name: "r2", state: "silent", silent: true, arrays: [array({ gain_change: 0.2 })] })),
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
