// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CdrReader } from "./cdr_reader";

/** Where a frame is in its parent: rotation as x, y, z, w. */
export interface Transform {
  child: string;
  position: [number, number, number];
  rotation: [number, number, number, number];
}

const MOST_TRANSFORMS = 4096;
const reader = new CdrReader();

/** tf2_msgs/msg/TFMessage. */
export function readTransforms(message: DataView): Transform[] {
  const count = reader.begin(message).uint32();
  if (count > MOST_TRANSFORMS) throw new RangeError(`${count} transforms`);
  const transforms: Transform[] = [];
  for (let left = count; left > 0; --left) {
    reader.header();
    const child = reader.text();
    const [x, y, z] = [reader.float64(), reader.float64(), reader.float64()];
    transforms.push({
      child,
      position: [x, y, z],
      rotation: [reader.float64(), reader.float64(), reader.float64(), reader.float64()],
    });
  }
  return transforms;
}
