// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setData, setText } from "../dom";
import type { LiveData } from "../live/live_data";
import { PlaybackStatus } from "../stream/protocol";
import type { Stream } from "../stream/stream";

const PERIOD_MS = 200;
const QUIET_MS = 2000;

/** How the connection is, in words. */
export class ConnectionPill {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #live: LiveData;
  readonly #words = element("span");
  #drawnMs = 0;
  #version = -1;
  #newsMs = 0;

  constructor(stream: Stream, live: LiveData) {
    this.#stream = stream;
    this.#live = live;
    this.element = element(
      "button",
      { class: "pill connection", "data-role": "connection", title: "Connect now", onclick: () => stream.connect() },
      element("span", { class: "lamp" }),
      this.#words,
    );
    stream.connection.follow(() => this.#show(performance.now()));
  }

  draw(nowMs: number): void {
    if (nowMs - this.#drawnMs >= PERIOD_MS) this.#show(nowMs);
  }

  #show(nowMs: number): void {
    this.#drawnMs = nowMs;
    const connection = this.#stream.connection.value;
    setData(document.documentElement, "connection", connection.kind);
    if (this.#live.version !== this.#version) {
      this.#version = this.#live.version;
      this.#newsMs = nowMs;
    }
    switch (connection.kind) {
      case "connecting":
        return this.#set("warn", "Connecting");
      case "live":
        if (this.#stream.playback.value?.status === PlaybackStatus.paused) return this.#set("good", "Paused");
        if (this.#stream.playback.value?.status === PlaybackStatus.ended) return this.#set("good", "At its end");
        if (nowMs - this.#newsMs > QUIET_MS) return this.#set("warn", "Live, no frames");
        return this.#set("good", "Live");
      case "retrying": {
        const seconds = Math.max(0, Math.ceil((connection.atMs - nowMs) / 1000));
        return this.#set("bad", `${connection.wasLive ? "Lost" : "No server"}, again in ${seconds} s`);
      }
      case "wrong token":
        return this.#set("bad", "Wrong token");
    }
  }

  #set(level: string, words: string): void {
    setData(this.element, "level", level);
    setText(this.#words, words);
  }
}
