// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

export const CalibrationStage = { none: 0, unloaded: 1, pressing: 2, fitting: 3, done: 4, failed: 5 } as const;

/** What the person has to know besides the press that is asked for. */
export const CalibrationHint = { none: 0, press: 1, hold: 2, release: 3, otherTaxel: 4, unsteady: 5, tooShort: 6, several: 7 } as const;

const NO_TAXEL = 4294967295;

/** dermis_msgs/msg/CalibrationState; docs/stream.md tells what the fields mean. */
export interface CalibrationState {
  stampS: number;
  array: string;
  stage: number;
  message: string;
  taxel: number;
  weightN: number;
  reading: number;
  holdShare: number;
  pressesDone: number;
  pressesTotal: number;
  medianRelativeError: number;
  taxelPresses: Uint8Array;
  hint: number;
  /** -1: none. */
  pressedTaxel: number;
  unpressedRelativeError: number;
}

const reader = new CdrReader();

export function readCalibrationState(message: DataView): CalibrationState {
  reader.begin(message);
  const state = {
    stampS: reader.header(),
    array: reader.text(),
    stage: reader.uint8(),
    message: reader.text(),
    taxel: reader.uint32(),
    weightN: reader.float64(),
    reading: reader.float64(),
    holdShare: reader.float64(),
    pressesDone: reader.uint32(),
    pressesTotal: reader.uint32(),
    medianRelativeError: reader.float64(),
  };
  const { begin, length } = reader.bytes();
  const taxelPresses = new Uint8Array(message.buffer, message.byteOffset + begin, length);
  const hint = reader.uint8();
  const pressedTaxel = reader.uint32();
  return {
    ...state,
    taxelPresses,
    hint,
    pressedTaxel: pressedTaxel === NO_TAXEL ? -1 : pressedTaxel,
    unpressedRelativeError: reader.float64(),
  };
}
