// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

export const ThreatState = { clear: 0, crossed: 1, active: 2, latched: 3 } as const;

const reader = new CdrReader();

/** dermis_msgs/Threat.msg. */
export function readThreat(message: DataView) {
  return {
    stampS: reader.begin(message).header(),
    name: reader.text(),
    array: reader.text(),
    zone: reader.text(),
    quantity: reader.text(),
    state: reader.uint8(),
    changed: reader.bool(),
    crossedS: reader.time(),
    value: reader.float64(),
    sigma: reader.float64(),
    worst: reader.float64(),
    limit: reader.float64(),
    unit: reader.text(),
    x: reader.float64(),
    y: reader.float64(),
  };
}

export type Threat = ReturnType<typeof readThreat>;

/** A threat stands, whether its force is still there or not. */
export function stands({ state }: Threat): boolean {
  return state === ThreatState.active || state === ThreatState.latched;
}
