// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";

/** Messages for the tests, written by a library that is not ours from the .msg files that the server is built from. */

export type Definition = ReturnType<typeof parse>[number];

const FOLDER = fileURLToPath(new URL("../../../src/bytes/ros_messages/msg/", import.meta.url));

/** By "package/msg/Type". */
export const definitions = new Map<string, Definition>(
  (readdirSync(FOLDER, { recursive: true }) as string[])
    .filter((file) => file.endsWith(".msg"))
    .map((file) => {
      const name = full(file.slice(0, -".msg".length));
      return [name, { ...parse(readFileSync(FOLDER + file, "utf8"), { ros2: true, skipTypeFixup: true })[0]!, name }];
    }),
);

export function full(name: string): string {
  const [module, type] = [name.split("/")[0]!, name.split("/").at(-1)!];
  return `${module}/msg/${type}`;
}

export function camelCase(name: string): string {
  return name.toLowerCase().replace(/_([a-z])/g, (_, letter: string) => letter.toUpperCase());
}

/** The constants of a type as an object of TypeScript has them. */
export function constants(name: string): Record<string, unknown> {
  const constant = definitions.get(name)!.definitions.filter((field) => field.isConstant === true);
  return Object.fromEntries(constant.map((field) => [camelCase(field.name), field.value]));
}

/** The definition of a type and of all that it is made of, the type itself first. */
function closure(name: string, found = new Map<string, Definition>()): Definition[] {
  const definition = definitions.get(name);
  if (definition === undefined) throw new Error(`no definition of ${name}`);
  const complete = definition.definitions.map((field) =>
    field.isComplex === true ? { ...field, type: full(field.type) } : field,
  );
  found.set(name, { ...definition, definitions: complete });
  for (const field of complete) if (field.isComplex === true && !found.has(field.type)) closure(field.type, found);
  return [...found.values()];
}

export function written(name: string, message: object): DataView {
  const [root, ...others] = closure(name);
  const { name: _, ...unnamed } = root!;
  const bytes = new MessageWriter([unnamed, ...others]).writeMessage(message);
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}

/** A message whose numbers and texts all differ; one of each sequence. */
export function sample(name: string, next = { value: 1 }): Record<string, unknown> {
  const one = (field: Definition["definitions"][number]): unknown => {
    if (field.isComplex === true) return sample(full(field.type), next);
    if (field.type === "bool") return true;
    const value = ++next.value;
    if (field.type === "time") return { sec: value, nanosec: 250000000 };
    if (field.type === "string") return `text ${value}`;
    return field.type === "uint64" ? BigInt(value) : value;
  };
  const sequence = (field: Definition["definitions"][number]): unknown =>
    field.type === "uint8" ? new Uint8Array([++next.value]) : [one(field)];
  const fields = definitions.get(name)!.definitions.filter((field) => field.isConstant !== true);
  return Object.fromEntries(fields.map((field) => [field.name, field.isArray === true ? sequence(field) : one(field)]));
}

/** The numbers, flags and texts of a message as an object of TypeScript has them. */
export function simpleFields(message: Record<string, unknown>): Record<string, unknown> {
  const simple = Object.entries(message).filter(([, value]) => typeof value !== "object");
  return Object.fromEntries(
    simple.map(([name, value]) => [camelCase(name), typeof value === "bigint" ? Number(value) : value]),
  );
}
