// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { DisplayStatistics } from "./display_statistics";
import type { LiveData } from "./live/live_data";
import type { Signal } from "./signal";
import type { Stream } from "./stream/stream";
import type { Suit } from "./suit";
import type { Theme } from "./theme";

/** The objects that a view works with. */
export interface ViewContext {
  readonly stream: Stream;
  readonly suit: Suit;
  readonly live: LiveData;
  readonly theme: Theme;
  readonly display: DisplayStatistics;
  /** The user has stopped the picture; data go on. */
  readonly paused: Signal<boolean>;
  /** Goes to another view. */
  open(view: string, array?: string): void;
}

/** One page of the viewer. It is made once; what it follows only while it is shown it begins in show() and ends in hide(). */
export interface View {
  /** In the address: #/<name>/<array>. */
  readonly name: string;
  /** On its tab. */
  readonly title: string;
  readonly element: HTMLElement;
  /** It is in the page now and visible. */
  show(): void;
  hide(): void;
  /** Once per frame of the screen while it is shown: draws what has changed since the last time, and nothing else. */
  draw?(nowMs: number): void;
  /** True: the key is taken. */
  key?(event: KeyboardEvent): boolean;
}

export type ViewFactory = (context: ViewContext) => View;
