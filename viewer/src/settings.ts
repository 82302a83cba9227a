// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { Signal } from "./signal";

function read(key: string): unknown {
  try {
    return JSON.parse(localStorage.getItem(key) ?? "null");
  } catch {
    return null;
  }
}

/** A choice of the user that the browser remembers; one that it may not remember lasts as long as the page. */
export function setting<T extends string | number | boolean>(
  name: string,
  first: T,
  allowed: (value: T) => boolean,
): Signal<T> {
  const key = `dermis.${name}`;
  const remembered = read(key);
  const usable = typeof remembered === typeof first && allowed(remembered as T);
  const signal = new Signal<T>(usable ? (remembered as T) : first);
  signal.follow((value) => {
    try {
      localStorage.setItem(key, JSON.stringify(value));
    } catch {
      // Storage is forbidden or full.
    }
  });
  return signal;
}
