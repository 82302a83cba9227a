// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

const reader = new CdrReader();

/** A moment with a name. */
export interface Mark {
  readonly atS: number;
  /** Empty: the label before it ends. */
  readonly label: string;
  /** Empty: of a person; "tare": of the server. */
  readonly event: string;
}

/** dermis_msgs/Mark.msg. */
export function readMark(message: DataView): Mark {
  const atS = reader.begin(message).header();
  const label = reader.text();
  reader.text(); // who
  return { atS, label, event: reader.text() };
}
