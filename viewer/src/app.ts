// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { DisplayStatistics } from "./display_statistics";
import { element, setHidden, setText } from "./dom";
import { errorText } from "./format";
import { LiveData } from "./live/live_data";
import { DiagnosticLevel, type HealthStatus } from "./messages/statistics";
import { makeArraySetup } from "./setup/array_setup";
import { Signal } from "./signal";
import type { Endpoint } from "./stream/endpoint";
import { Stream } from "./stream/stream";
import { Suit } from "./suit";
import { TakeDialog } from "./take/take_dialog";
import { Theme } from "./theme";
import { Bar } from "./ui/bar";
import { makeHelp } from "./ui/help";
import { isOfRefusedTare, makeTareBanner } from "./ui/tare_banner";
import { makeThreatBanner } from "./ui/threat_banner";
import { makeThresholds } from "./ui/thresholds";
import { makeTokenForm } from "./ui/token_form";
import { Transport } from "./ui/transport";
import type { View, ViewContext } from "./view";
import { VIEWS } from "./views";

const NOTICE_MS = 8000;
const LEVELS = ["good", "warn", "bad"] as const;

/** The whole page: its parts, its address, its keys, and the one loop that draws. */
export class App implements ViewContext {
  readonly suit = new Suit();
  readonly stream: Stream;
  readonly paused = new Signal(false);
  readonly live: LiveData;
  readonly theme = new Theme();
  readonly display = new DisplayStatistics();
  readonly #views: readonly View[];
  readonly #bar: Bar;
  readonly #transport: Transport;
  readonly #help = makeHelp();
  readonly #thresholds: HTMLDialogElement;
  readonly #take: TakeDialog;
  readonly #room = element("main");
  readonly #notice = element("p", {
    class: "notice message",
    role: "status",
    "data-role": "notice",
    title: "Click to put it away",
    hidden: true,
    onclick: () => setHidden(this.#notice, true),
  });
  #shown: View | undefined;
  readonly #drawNext = (nowMs: number): void => this.#draw(nowMs);
  #noticeTimer = 0;

  constructor(endpoint: Endpoint) {
    this.stream = new Stream(endpoint, (suit) => this.#described(suit));
    this.live = new LiveData(this.stream, this.suit, this.paused);
    this.stream.connect(); // the server answers while the views are made
    this.#transport = new Transport(this.stream, this.live.marks);
    this.#thresholds = makeThresholds(this.stream);
    this.#take = new TakeDialog(this);
    this.#views = VIEWS.map((create) => create(this));
    this.#bar = new Bar(this, this.#views, {
      toggleRecording: () => this.#toggle("/recording"),
      togglePause: () => this.togglePause(),
      tare: () => this.#toggle("/tare"),
      showTake: () => this.#take.show(),
      showThresholds: () => this.#thresholds.showModal(),
      showHelp: () => this.#help.showModal(),
    });
    this.live.health.follow((health) => this.#refreshWhereCalibrated(health));
    this.stream.notice.follow((notice) => this.#showNotice(notice?.level ?? 0, notice?.message ?? ""));
  }

  /** Somebody may have calibrated an array, here or on another page. */
  #refreshWhereCalibrated(health: readonly HealthStatus[]): void {
    const isNews = this.suit.description.value.arrays.some(
      ({ name, calibrated }) =>
        !calibrated &&
        health.some(
          ({ name: of, level, message }) =>
            of === name && level <= DiagnosticLevel.warn && !message.startsWith("not calibrated"),
        ),
    );
    if (isNews) void this.stream.refresh();
  }

  begin(): void {
    document.body.append(
      this.#bar.element,
      makeTokenForm(this.stream),
      ...makeArraySetup(this.stream, this.suit, this.theme),
      this.#room,
      this.#transport.marks.element,
      this.#transport.element,
      element(
        "div",
        { class: "messages" },
        makeThreatBanner(this.live.threats, this.stream),
        makeTareBanner(this.stream),
        this.#notice,
      ),
      this.#help,
      this.#thresholds,
      this.#take.element,
    );
    window.addEventListener("hashchange", () => this.#route());
    window.addEventListener("keydown", (event) => this.#key(event));
    this.suit.selected.follow(
      (array) => array !== undefined && this.#shown !== undefined && this.open(this.#shown.name),
    );
    this.#route();
    requestAnimationFrame(this.#drawNext);
  }

  /** A recording that is played has one pause, the server's. */
  togglePause(): void {
    if (this.#transport.isThere) this.#transport.toggle();
    else this.paused.value = !this.paused.value;
  }

  open(view: string, array = this.suit.selected.value?.name): void {
    if (array !== undefined) this.suit.select(array);
    const hash = array === undefined ? `#/${view}` : `#/${view}/${encodeURIComponent(array)}`;
    if (hash !== window.location.hash) window.location.hash = hash;
    else this.#route();
  }

  #described(suit: Parameters<Suit["replace"]>[0]): void {
    this.suit.replace(suit);
    document.title = `${suit.name} \u2013 dermis`;
    const [, array] = this.#address();
    if (array !== "") this.suit.select(array);
  }

  #address(): [string, string] {
    const [view = "", array = ""] = window.location.hash.slice(2).split("/");
    return [view, decodeURIComponent(array)];
  }

  #route(): void {
    const [name, array] = this.#address();
    if (array !== "" && this.suit.indexOf(array) >= 0 && this.suit.selected.value?.name !== array)
      this.suit.select(array);
    const view = this.#views.find((candidate) => candidate.name === name) ?? this.#views[0];
    if (view === undefined || view === this.#shown) return;
    this.#shown?.hide();
    this.#shown = view;
    this.#room.replaceChildren(view.element);
    this.#bar.showTab(view.name);
    view.show();
  }

  #draw(nowMs: number): void {
    requestAnimationFrame(this.#drawNext);
    this.display.presented((performance.timeOrigin + nowMs) / 1000);
    this.#bar.draw(nowMs);
    this.#transport.draw(nowMs);
    this.#shown?.draw?.(nowMs);
  }

  #toggle(parameter: string): void {
    const value = this.stream.parameters.value.get(parameter);
    if (typeof value === "boolean") this.stream.setParameter(parameter, !value);
  }

  #showNotice(level: number, message: string): void {
    if (isOfRefusedTare(message)) return; // the page says it at length
    window.clearTimeout(this.#noticeTimer);
    setText(this.#notice, message);
    setHidden(this.#notice, message === "");
    this.#notice.dataset.level = LEVELS[level] ?? "bad";
    this.#noticeTimer = window.setTimeout(() => setHidden(this.#notice, true), NOTICE_MS);
  }

  #key(event: KeyboardEvent): void {
    const target = event.target as Element;
    const isTyping =
      target.closest("input:not([type=checkbox]):not([type=radio]):not([type=range]), select, textarea, dialog") !==
      null;
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping || event.defaultPrevented) return;
    if (this.#shown?.key?.(event) === true || this.#act(event)) event.preventDefault();
  }

  #act(event: KeyboardEvent): boolean {
    const view = this.#views[Number(event.key) - 1];
    if (view !== undefined) this.open(view.name);
    else if (event.key === " " && !(event.target instanceof HTMLButtonElement)) this.togglePause();
    else if (event.key === "[") this.#step(-1);
    else if (event.key === "]") this.#step(1);
    else if (event.key === "t") this.#toggle("/tare");
    else if (event.key === "r") this.#toggle("/recording");
    else if (event.key === "s") this.#take.show();
    else if (event.key === "d") this.theme.toggle();
    else if (event.key === "?") this.#help.showModal();
    else if (event.key === "k") this.#transport.toggle();
    else if (event.key === "j") this.#transport.step(-1);
    else if (event.key === "l") this.#transport.step(1);
    else if (event.key === "m") this.#markMoment();
    else return false;
    return true;
  }

  #markMoment(): void {
    if (this.#transport.isThere) this.#transport.mark();
    else {
      const tell = (error: unknown): void => this.#showNotice(LEVELS.indexOf("bad"), errorText(error));
      this.live.marks.add(this.live.latestS).catch(tell);
    }
  }

  #step(by: number): void {
    const { arrays } = this.suit.description.value;
    const index = this.suit.indexOf(this.suit.selected.value?.name ?? "");
    if (arrays.length > 0) this.suit.select(arrays[(index + by + arrays.length) % arrays.length]!.name);
  }
}
