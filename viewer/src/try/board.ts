// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** Messages of a board to the page. */
export interface BoardEvents {
  /** The array is the receiver's to keep. */
  bytes(bytes: Uint8Array<ArrayBuffer>): void;
  /** It was unplugged, or is out of reach. */
  lost(): void;
  /** It is open again, at the same baud. */
  back(): void;
  /** A fault, in one line; it goes on. */
  trouble(line: string): void;
}

/** A board that the user has chosen: bytes to and from it, by any way that the browser has. */
export interface Board {
  /** For people: "USB 2341:0043". */
  readonly name: string;
  /** Opens it, also anew at another baud. Fails with a line that says what to do. */
  open(baud: number): Promise<void>;
  write(bytes: Uint8Array<ArrayBuffer>): Promise<void>;
  close(): Promise<void>;
}

/** Advice on an error of the browser, in one line. `what`: "the board". */
export function adviceOn(error: unknown, what: string): string {
  const name = error instanceof Error ? error.name : "";
  const words = error instanceof Error ? error.message : String(error);
  switch (name) {
    case "InvalidStateError":
      return `This page has ${what} open already, or another page is about to: close it there, and connect again.`;
    case "NetworkError":
      return `${what} cannot be opened: another program has it (a serial monitor, another tab), or it was unplugged. Close that program, and connect again.`;
    case "SecurityError":
    case "NotAllowedError":
      return `The browser does not let this page use ${what}: its permission was refused.`;
    default:
      return `${what}: ${words}`;
  }
}

/** The user has closed the browser's list without a choice. */
export function isNoChoice(error: unknown): boolean {
  return error instanceof Error && (error.name === "NotFoundError" || error.name === "AbortError");
}
