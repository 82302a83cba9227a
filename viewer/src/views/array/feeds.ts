// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { COUNTED_SIGMAS } from "../../live/region_force";
import { emptyGrid, type GridFrame, readCounts, readGrid, stampOf, TaxelStatus } from "../../messages/grids";
import type { Stream } from "../../stream/stream";
import type { ArrayDescription } from "../../suit";
import { HeldValues, type TimeShare } from "./held_values";
import { STALE_S } from "./picture";
import { CONDUCTANCE, FORCE, PRESSURE, QUANTITIES, RAW, taxelAreaM2 } from "./quantities";

/** One topic: its newest messages, decoded when they are drawn, and what is held of all that came. */
interface Feed {
  readonly frame: GridFrame;
  readonly heard: GridFrame;
  readonly held: HeldValues;
  /** Messages, oldest first, that may be decoded: all but the last wait for the contacts of their time. */
  readonly waiting: { stampS: number; message: DataView }[];
  /** While the picture stands: it has the frame at which it stands. */
  isHeld: boolean;
}

const MOST_WAITING = 16;

const TOPICS = QUANTITIES.filter(({ name }) => name !== "pressure");

/** The frames of one array, quantity by quantity; pressures are its forces over the area of a taxel. */
export class Feeds {
  /** The newest shown frame of each quantity. */
  readonly frames: readonly GridFrame[];
  readonly #feeds: readonly Feed[] = TOPICS.map(() => ({
    frame: emptyGrid(),
    heard: emptyGrid(),
    held: new HeldValues(),
    waiting: [],
    isHeld: false,
  }));
  readonly #pressure = emptyGrid();
  readonly #ends: (() => void)[] = [];
  #share: TimeShare = "now";
  #isStanding = false;

  constructor() {
    this.frames = [...this.#feeds.map(({ frame }) => frame), this.#pressure];
  }

  follow(stream: Stream, array: ArrayDescription): void {
    this.end();
    TOPICS.forEach(({ name }, index) => {
      if (!this.#feeds[index]!.isHeld) this.#feeds[index]!.waiting.length = 0;
      this.#ends.push(stream.subscribe(`/${array.name}/${name}`, (message) => this.#hear(index, message)));
    });
  }

  end(): void {
    for (const end of this.#ends.splice(0)) end();
  }

  /** The picture stands at its present frame; where it `has` none, at the first that comes. */
  stand(isStanding: boolean, has: boolean): void {
    this.#isStanding = isStanding;
    for (const feed of this.#feeds) feed.isHeld = has && feed.frame.rows > 0;
  }

  /** Another array: nothing is known of it. */
  forget(): void {
    for (const feed of this.#feeds) feed.isHeld = false;
    for (const { values, statuses } of this.frames) {
      values.fill(NaN);
      statuses.fill(0);
    }
    this.reset();
  }

  hold(share: TimeShare): void {
    this.#share = share;
    this.reset();
  }

  /** The highest values and averages begin anew. */
  reset(): void {
    for (const { held } of this.#feeds) held.reset();
  }

  /** Decodes what has come; the quantities that are new. A frame of forces waits until `hasContacts` of its time. */
  decode(array: ArrayDescription, hasContacts: (stampS: number) => boolean): number[] {
    const fresh: number[] = [];
    this.#feeds.forEach((feed, index) => {
      const message = next(feed, index === FORCE ? hasContacts : () => true);
      if (message === undefined) return;
      read(index, message, feed.frame);
      if (feed.frame.rows !== array.rows || feed.frame.cols !== array.cols) return;
      if (this.#share !== "now" && feed.held.values.length === feed.frame.values.length)
        feed.frame.values.set(feed.held.values);
      if (this.#share !== "now") feed.frame.sigmas.fill(NaN);
      fresh.push(index);
    });
    if (fresh.includes(FORCE)) fresh.push(this.#press(array));
    return fresh;
  }

  #hear(index: number, message: DataView): void {
    const feed = this.#feeds[index]!;
    if (this.#share !== "now") {
      read(index, message, feed.heard);
      feed.held.add(feed.heard, this.#share);
    }
    if (this.#isStanding && feed.isHeld) return;
    feed.isHeld = this.#isStanding;
    const stampS = stampOf(message);
    if (stampS < (feed.waiting.at(-1)?.stampS ?? stampS)) feed.waiting.length = 0;
    feed.waiting.push({ stampS, message });
    if (feed.waiting.length > MOST_WAITING) feed.waiting.shift();
  }

  #press(array: ArrayDescription): number {
    const force = this.frames[FORCE]!;
    const pressure = this.#pressure;
    const area = taxelAreaM2(array);
    if (pressure.values.length !== force.values.length) pressure.values = new Float32Array(force.values.length);
    if (pressure.sigmas.length !== force.values.length) pressure.sigmas = new Float32Array(force.values.length);
    Object.assign(pressure, { stampS: force.stampS, rows: force.rows, cols: force.cols, statuses: force.statuses });
    force.values.forEach((newtons, taxel) => (pressure.values[taxel] = newtons / area));
    force.sigmas.forEach((newtons, taxel) => (pressure.sigmas[taxel] = newtons / area));
    return PRESSURE;
  }
}

/** The newest message that may be decoded. Where none may for long, the newest one is, all the same. */
function next({ waiting, frame }: Feed, mayBe: (stampS: number) => boolean): DataView | undefined {
  const newest = waiting.at(-1);
  if (newest === undefined) return undefined;
  const isLate = frame.rows === 0 || Math.abs(newest.stampS - frame.stampS) > STALE_S;
  const place = waiting.findLastIndex(({ stampS }) => mayBe(stampS));
  if (place < 0 && !isLate) return undefined;
  return waiting.splice(0, place < 0 ? waiting.length : place + 1).at(-1)!.message;
}

function read(index: number, message: DataView, frame: GridFrame): void {
  (index === RAW ? readCounts : readGrid)(message, frame);
}

/** Idle readings have so much of the range of the ADC. */
const IDLE_SHARE = 1 / 256;

/** The values as a map shows them: 0 where there is no more than noise. A conductance is at rest where the
 *  force is noise. */
export function shownOf(index: number, frame: GridFrame, array: ArrayDescription, force = frame): Float32Array {
  const leastCounts = array.full_scale_counts * IDLE_SHARE;
  const isNoise = ({ values, sigmas }: GridFrame, taxel: number): boolean =>
    values[taxel]! < COUNTED_SIGMAS * sigmas[taxel]! && sigmas[taxel] !== Infinity;
  const ruling = index === CONDUCTANCE ? force : frame;
  return frame.values.map((value, taxel) =>
    (index === RAW ? value < leastCounts : isNoise(ruling, taxel)) ? 0 : value,
  );
}

/** The highest value of the taxels with a reading; 0 where there are none. */
export function highestOf({ values, statuses }: GridFrame): number {
  let highest = 0;
  values.forEach((value, taxel) => {
    if (value > highest && (statuses[taxel] ?? 0) < TaxelStatus.dead) highest = value;
  });
  return highest;
}
