// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

export const CalibrationStage = { none: 0, unloaded: 1, pressing: 2, fitting: 3, done: 4, failed: 5 } as const;

/** The advice to the person besides the wanted press. */
export const CalibrationHint = {
  none: 0,
  press: 1,
  hold: 2,
  release: 3,
  otherTaxel: 4,
  unsteady: 5,
  tooShort: 6,
  several: 7,
  oneOfTwo: 8,
} as const;

const NO_TAXEL = 4294967295;

const reader = new CdrReader();

/** dermis_msgs/CalibrationState.msg; a taxel is -1 where there is none. */
export function readCalibrationState(message: DataView) {
  return {
    stampS: reader.begin(message).header(),
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
    taxelPresses: readBytes(message),
    hint: reader.uint8(),
    pressedTaxel: readTaxel(),
    unpressedRelativeError: reader.float64(),
    togetherWith: readTaxel(),
    togetherReading: reader.float64(),
    missingTaxel: readTaxel(),
  };
}

export type CalibrationState = ReturnType<typeof readCalibrationState>;

function readBytes(message: DataView): Uint8Array {
  const { begin, length } = reader.bytes();
  return new Uint8Array(message.buffer, message.byteOffset + begin, length);
}

function readTaxel(): number {
  const taxel = reader.uint32();
  return taxel === NO_TAXEL ? -1 : taxel;
}
