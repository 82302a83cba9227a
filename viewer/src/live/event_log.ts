// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
export const EVENT_KINDS = ["threat", "contact", "tare", "mark"] as const;
export type EventKind = (typeof EVENT_KINDS)[number];

/** Something that happened at a moment of the stream. */
export interface TimedEvent {
  readonly kind: EventKind;
  readonly atS: number;
  readonly words: string;
  /** Empty: of the whole suit. */
  readonly array: string;
}

const MOST_EVENTS = 1000;

/** The events, the oldest first, but for marks: those of a recording are known before their moment. */
export class EventLog {
  readonly events: TimedEvent[] = [];
  marks: readonly TimedEvent[] = [];

  add(kind: EventKind, atS: number, words: string, array = ""): void {
    this.events.push({ kind, atS, words, array });
    if (this.events.length > MOST_EVENTS) this.events.shift();
  }

  /** A recording is played from this time on anew: what it holds comes again. */
  rewind(toS: number): void {
    const kept = this.events.filter(({ atS }) => atS < toS);
    this.events.splice(0, this.events.length, ...kept);
  }
}
