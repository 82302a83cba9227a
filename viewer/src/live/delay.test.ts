// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { Delay } from "./delay";

describe("Delay", () => {
  it("is that beside the quickest message, whatever the clocks say", () => {
    const delay = new Delay();
    delay.add(1000, 50);
    expect(delay.lateS).toBeCloseTo(0);
    delay.add(1001, 5050);
    expect(delay.lateS).toBeCloseTo(4);
    delay.add(1006, 6050);
    expect(delay.lateS).toBeCloseTo(0);
  });

  it("tells for how long nothing has come", () => {
    const delay = new Delay();
    expect(delay.silenceS(1000)).toBeNaN();
    delay.add(7, 1000);
    expect(delay.silenceS(4500)).toBeCloseTo(3.5);
    delay.restart();
    expect(delay.silenceS(4500)).toBeNaN();
  });

  it("begins anew where the log goes back", () => {
    const delay = new Delay();
    delay.add(100, 0);
    delay.add(0, 1000);
    expect(delay.lateS).toBeCloseTo(0);
  });
});
