// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

const MOST_CLASSES = 4096;
const UNKNOWN = "unknown";
const reader = new CdrReader();

export interface ClassShare {
  name: string;
  probability: number;
}

/** vision_msgs/Classification.msg as docs/stream.md has it; `reason` is empty where the answer is a class. */
export interface Classification {
  stampS: number;
  answer: string;
  reason: string;
  /** By probability, falling. */
  classes: ClassShare[];
}

export function readClassification(message: DataView): Classification {
  const stampS = reader.begin(message).header();
  const count = reader.uint32();
  if (count > MOST_CLASSES) throw new RangeError(`${count} classes`);
  const results = Array.from({ length: count }, () => ({ name: reader.text(), probability: reader.float64() }));
  const answer = results[0]?.name ?? UNKNOWN;
  if (answer !== UNKNOWN) return { stampS, answer, reason: "", classes: results };
  return { stampS, answer, reason: results[1]?.name ?? "", classes: results.slice(2) };
}
