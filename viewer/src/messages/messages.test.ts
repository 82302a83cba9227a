// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { describe, expect, it } from "vitest";
import { CalibrationHint, CalibrationStage, readCalibrationState } from "./calibration_state";
import { CdrReader } from "./cdr_reader";
import { readClassification } from "./classification";
import { ContactPhase, ContactsFrame, readContacts, readContactsArray } from "./contacts";
import { emptyGrid, type PointsFrame, readCounts, readGrid, readPoints, TaxelStatus } from "./grids";
import { readMark } from "./mark";
import { DiagnosticLevel, readHealth, readStatistics } from "./statistics";
import { constants, type Definition, definitions, full, sample, simpleFields, written } from "./test_messages";
import { readThreat, ThreatState } from "./threat";

const header = { stamp: { sec: 1234, nanosec: 500000000 }, frame_id: "suit" };
const zero = { x: 0, y: 0, z: 0 };

function contact(id: number): Record<string, unknown> {
  return { ...sample("dermis_msgs/msg/Contact"), id };
}

function contacts(array: string, ids: number[]): DataView {
  return written("dermis_msgs/msg/Contacts", {
    header,
    array,
    total_force_n: 25,
    sigma_total_n: 0.5,
    has_centre_of_pressure: true,
    centre_of_pressure: { x: 1, y: 2, z: 3 },
    touches: ids.map(contact),
    sum_n: -0.25,
    sigma_sum_n: 0.125,
  });
}

describe("contacts", () => {
  it("come with all of their fields", () => {
    const frame = new ContactsFrame();
    readContacts(contacts("left_arm", [7, 9]), frame);
    expect(frame).toMatchObject({
      stampS: 1234.5,
      totalForceN: 25,
      sigmaTotalN: 0.5,
      hasCentreOfPressure: true,
      count: 2,
      sumN: -0.25,
      sigmaSumN: 0.125,
    });
    expect([...frame.centreOfPressure]).toEqual([1, 2, 3]);
    const [, second] = frame.contacts;
    const { position, normal, onset_time: onset, velocity: _, ...rest } = contact(9);
    expect(second).toMatchObject(simpleFields(rest));
    expect(second!.onsetS).toBe((onset as { sec: number }).sec + 0.25);
    expect([...second!.position]).toEqual(Object.values(position as object));
    expect([...second!.normal]).toEqual(Object.values(normal as object));
  });

  it("are told apart by array without reading the rest", () => {
    expect(readContactsArray(contacts("palm", []), ["palm_2", "chest", "palm"])).toBe(2);
    expect(readContactsArray(contacts("back", []), ["palm"])).toBe(-1);
  });

  it("use the same objects again", () => {
    const frame = new ContactsFrame();
    readContacts(contacts("a", [1, 2, 3]), frame);
    const first = frame.contacts[0];
    readContacts(contacts("a", [4]), frame);
    expect(frame.count).toBe(1);
    expect(frame.contacts[0]).toBe(first);
    expect(first!.id).toBe(4);
  });
});

describe("grids", () => {
  const cells = new Uint8Array(2 * 3 * 9);
  const view = new DataView(cells.buffer);
  for (let taxel = 0; taxel < 6; ++taxel) {
    view.setFloat32(9 * taxel, 1.5 * taxel, true);
    view.setFloat32(9 * taxel + 4, 0.25 * taxel, true);
    view.setUint8(9 * taxel + 8, taxel);
  }
  const grid = {
    timestamp: header.stamp,
    frame_id: "palm",
    pose: { position: zero, orientation: { ...zero, w: 1 } },
    column_count: 3,
    cell_size: { x: 0.01, y: 0.02 },
    row_stride: 27,
    cell_stride: 9,
    fields: [
      { name: "newtons", offset: 0, type: 7 },
      { name: "sigma_newtons", offset: 4, type: 7 },
      { name: "status", offset: 8, type: 1 },
    ],
    data: cells,
  };

  it("give value, sigma and status of each taxel", () => {
    const frame = emptyGrid();
    readGrid(written("foxglove_msgs/msg/Grid", grid), frame);
    expect(frame).toMatchObject({ stampS: 1234.5, rows: 2, cols: 3 });
    expect([...frame.values]).toEqual([0, 1.5, 3, 4.5, 6, 7.5]);
    expect([...frame.sigmas]).toEqual([0, 0.25, 0.5, 0.75, 1, 1.25]);
    expect([...frame.statuses]).toEqual([0, 1, 2, 3, 4, 5]);
  });

  it("that say more than they hold throw", () => {
    const message = written("foxglove_msgs/msg/Grid", grid);
    const cut = new DataView(message.buffer, message.byteOffset, message.byteLength - 20);
    expect(() => readGrid(cut, emptyGrid())).toThrow(RangeError);
  });
});

describe("counts", () => {
  it("are read from 16UC1 and 32FC1, with rows that are longer than their taxels", () => {
    const words = new Uint8Array(new Uint16Array([1, 2, 999, 4095, 5, 999]).buffer);
    const image = { header, height: 2, width: 2, encoding: "16UC1", is_bigendian: 0, step: 6, data: words };
    const frame = emptyGrid();
    readCounts(written("sensor_msgs/msg/Image", image), frame);
    expect([...frame.values]).toEqual([1, 2, 4095, 5]);
    const floats = new Uint8Array(new Float32Array([1.5, 2.5, 3.5, 4.5]).buffer);
    readCounts(written("sensor_msgs/msg/Image", { ...image, encoding: "32FC1", step: 8, data: floats }), frame);
    expect([...frame.values]).toEqual([1.5, 2.5, 3.5, 4.5]);
  });
});

describe("points", () => {
  it("give force and status wherever these fields are", () => {
    const data = new Uint8Array(2 * 20);
    const view = new DataView(data.buffer);
    view.setFloat32(12, 3.5, true);
    view.setFloat32(32, 7.25, true);
    view.setUint8(36, 4);
    const field = (name: string, offset: number, datatype: number): object => ({ name, offset, datatype, count: 1 });
    const message = written("sensor_msgs/msg/PointCloud2", {
      header,
      height: 1,
      width: 2,
      fields: [field("x", 0, 7), field("y", 4, 7), field("z", 8, 7), field("newtons", 12, 7), field("status", 16, 2)],
      is_bigendian: false,
      point_step: 20,
      row_step: 40,
      data,
      is_dense: false,
    });
    const frame: PointsFrame = { stampS: 0, newtons: new Float32Array(0), statuses: new Uint8Array(0) };
    readPoints(message, frame);
    expect(frame.stampS).toBe(1234.5);
    expect([...frame.newtons]).toEqual([3.5, 7.25]);
    expect([...frame.statuses]).toEqual([0, 4]);
  });
});

describe("what was recognised", () => {
  const told = (...results: [string, number][]): DataView =>
    written("vision_msgs/msg/Classification", {
      header,
      results: results.map(([class_id, score]) => ({ class_id, score })),
    });

  it("is the likeliest class with the probabilities of all", () => {
    const classes = [
      { name: "tap", probability: 0.75 },
      { name: "hug", probability: 0.25 },
    ];
    expect(readClassification(told(["tap", 0.75], ["hug", 0.25]))).toEqual({
      stampS: 1234.5,
      answer: "tap",
      reason: "",
      classes,
    });
  });

  it("or unknown, with the reason", () => {
    const answer = readClassification(told(["unknown", 1], ["between classes", 0], ["tap", 0.5], ["hug", 0.5]));
    expect(answer).toMatchObject({ answer: "unknown", reason: "between classes" });
    expect(answer.classes.map(({ name }) => name)).toEqual(["tap", "hug"]);
  });
});

describe("threats", () => {
  it("read as they were written", () => {
    const threat = sample("dermis_msgs/msg/Threat");
    const { sec } = threat.crossed_time as { sec: number };
    expect(readThreat(written("dermis_msgs/msg/Threat", { ...threat, header }))).toEqual({
      ...simpleFields(threat),
      stampS: 1234.5,
      crossedS: sec + 0.25,
    });
  });
});

describe("marks", () => {
  it("read as they were written", () => {
    const mark = { header, label: "grasp", by: "anna", event: "tare" };
    expect(readMark(written("dermis_msgs/msg/Mark", mark))).toEqual({ atS: 1234.5, label: "grasp", event: "tare" });
  });
});

describe("statistics, health and calibration", () => {
  it("read as they were written", () => {
    const statistics = sample("dermis_msgs/msg/Statistics");
    const [array] = statistics.arrays as [Record<string, unknown>];
    expect(readStatistics(written("dermis_msgs/msg/Statistics", { ...statistics, header }))).toEqual({
      ...simpleFields(statistics),
      stampS: 1234.5,
      arrays: [simpleFields(array)],
    });
  });

  it("tell faults in words", () => {
    const status = {
      level: 1,
      name: "chest",
      message: "column 3 is open",
      hardware_id: "",
      values: [{ key: "column 3", value: "open line" }],
    };
    expect(readHealth(written("diagnostic_msgs/msg/DiagnosticArray", { header, status: [status] }))).toEqual([
      { level: 1, name: "chest", message: "column 3 is open", values: [{ key: "column 3", value: "open line" }] },
    ]);
  });

  it("guide a calibration", () => {
    const state = sample("dermis_msgs/msg/CalibrationState");
    expect(readCalibrationState(written("dermis_msgs/msg/CalibrationState", { ...state, header }))).toEqual({
      ...simpleFields(state),
      stampS: 1234.5,
      taxelPresses: state.taxel_presses,
    });
    const none = 4294967295;
    const alone = { ...state, header, pressed_taxel: none, together_with: none, missing_taxel: none };
    expect(readCalibrationState(written("dermis_msgs/msg/CalibrationState", alone))).toMatchObject({
      pressedTaxel: -1,
      togetherWith: -1,
      missingTaxel: -1,
    });
  });
});

describe("the .msg files", () => {
  it("number what the viewer tells apart", () => {
    expect(CalibrationStage).toEqual(constants("dermis_msgs/msg/CalibrationState"));
    expect(CalibrationHint).toEqual(constants("dermis_msgs/msg/CalibrationHint"));
    expect(ContactPhase).toEqual(constants("dermis_msgs/msg/Contact"));
    expect(DiagnosticLevel).toEqual(constants("diagnostic_msgs/msg/DiagnosticStatus"));
    expect(TaxelStatus).toEqual(constants("dermis_msgs/msg/TaxelStatus"));
    expect(ThreatState).toEqual(constants("dermis_msgs/msg/Threat"));
  });

  it("of ROS are those of ROS", () => {
    const fields = ({ definitions: all }: Definition): string[] =>
      all.map(({ name, type, isArray }) => `${type} ${name} ${isArray === true}`);
    const ros = Object.entries(ros2humble as Record<string, Definition>).filter(([name]) =>
      definitions.has(full(name)),
    );
    expect(ros.length).toBeGreaterThan(10);
    for (const [name, theirs] of ros) {
      const ours = fields(definitions.get(full(name))!).map((field) => field.replace(/^byte /, "uint8 "));
      expect(ours, name).toEqual(
        fields(theirs).map((field) => field.replace("/msg/", "/").replace(/^byte /, "uint8 ")),
      );
    }
  });
});

describe("the CDR reader", () => {
  it("refuses what is no CDR in little-endian, and texts that end beyond the message", () => {
    expect(() => new CdrReader().begin(new DataView(new ArrayBuffer(8)))).toThrow(RangeError);
    const short = new DataView(new Uint8Array([0, 1, 0, 0, 255, 0, 0, 0, 65]).buffer);
    expect(() => new CdrReader().begin(short).text()).toThrow(RangeError);
    expect(() => new CdrReader().begin(short).textIs("A".repeat(254))).toThrow(RangeError);
  });
});
