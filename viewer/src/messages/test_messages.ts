// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { readFileSync } from "node:fs";
import { parse } from "@foxglove/rosmsg";
import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";

/** Messages for the tests, written by a library that is not ours from the definitions of docs/stream.md. */

type Definition = ReturnType<typeof parse>[number];

const GRID: Definition[] = parse(
  `builtin_interfaces/Time timestamp
string frame_id
geometry_msgs/Pose pose
uint32 column_count
foxglove_msgs/Vector2 cell_size
uint32 row_stride
uint32 cell_stride
foxglove_msgs/PackedElementField[] fields
uint8[] data
${"=".repeat(80)}
MSG: foxglove_msgs/Vector2
float64 x
float64 y
${"=".repeat(80)}
MSG: foxglove_msgs/PackedElementField
string name
uint32 offset
uint8 type`,
  { ros2: true, skipTypeFixup: true },
).map((definition) => (definition.name === undefined ? { ...definition, name: "foxglove_msgs/msg/Grid" } : definition));

function documented(): Definition[] {
  const page = readFileSync(new URL("../../../docs/stream.md", import.meta.url), "utf8");
  const block = page.split("```").find((part) => part.includes("# dermis_msgs/msg/Contacts"))!;
  return block
    .split(/^# (?=dermis_msgs\/msg\/)/m)
    .slice(1)
    .map((text) => {
      const [name, ...lines] = text.split("\n");
      return { ...parse(lines.join("\n"), { ros2: true, skipTypeFixup: true })[0]!, name: name!.trim() };
    });
}

const definitions = new Map<string, Definition>();
for (const [name, definition] of Object.entries(ros2humble)) definitions.set(full(name), definition as Definition);
for (const definition of [...GRID, ...documented()]) definitions.set(full(definition.name!), definition);

function full(name: string): string {
  const [module, type] = [name.split("/")[0]!, name.split("/").at(-1)!];
  return `${module}/msg/${type}`;
}

/** The definition of a type and of all that it is made of, the type itself first. */
function closure(name: string, found = new Map<string, Definition>()): Definition[] {
  const definition = definitions.get(name);
  if (definition === undefined) throw new Error(`no definition of ${name}`);
  const complete = definition.definitions.map((field) => (field.isComplex === true ? { ...field, type: full(field.type) } : field));
  found.set(name, { ...definition, name, definitions: complete });
  for (const field of complete) if (field.isComplex === true && !found.has(field.type)) closure(field.type, found);
  return [...found.values()];
}

export function written(name: string, message: object): DataView {
  const [root, ...others] = closure(name);
  const { name: _, ...unnamed } = root!;
  const bytes = new MessageWriter([unnamed, ...others]).writeMessage(message);
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}
