// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** The document /fleet.json of `dermis fleet page`. */
export interface FleetDocument {
  readonly hub: string;
  readonly error: string;
  /** That the hub's disk is full; "": it is not. */
  readonly full: string;
  readonly robots: readonly RobotState[];
}

/** The document /history.json: the changes of a day, the newest last. */
export interface HistoryDocument {
  readonly events: readonly RobotEvent[];
}

export interface RobotEvent {
  readonly time_ms: number;
  readonly robot: string;
  readonly text: string;
}

export interface RobotState {
  readonly name: string;
  readonly state: string;
  readonly since_s: number | null;
  readonly reasons: readonly string[];
  readonly messages: number;
  readonly bytes: number;
  readonly age_s: number | null;
  readonly lag: number;
  readonly health_age_s: number | null;
  readonly silent: boolean;
  /** Its last words may not be true any more. */
  readonly stale: boolean;
  readonly live: string;
  readonly arrays: readonly ArrayState[];
}

export interface ArrayState {
  readonly name: string;
  readonly rows: number;
  readonly cols: number;
  readonly model: string;
  readonly level: string;
  readonly message: string;
  readonly rate_hz: number;
  readonly lost: number;
  readonly left_out: number;
  readonly masked_taxels: number;
  readonly gain_change?: number;
  readonly wants_calibration: boolean;
  readonly wanted_model: number;
  readonly used_model: number;
  readonly refusal: string;
}

/** From the worst to the best. */
export const STATES = ["silent", "unreadable", "error", "behind", "warning", "no health", "well"] as const;
export type StateName = (typeof STATES)[number];
export type Level = "good" | "warn" | "bad";

export const LEVELS: Readonly<Record<StateName, Level>> = {
  silent: "bad",
  unreadable: "bad",
  error: "bad",
  behind: "warn",
  warning: "warn",
  "no health": "warn",
  well: "good",
};

/** The level of an array in the words of the page. */
const ARRAY_STATES: Readonly<Record<string, StateName>> = { good: "well", warning: "warning", ended: "warning" };

export function stateOfArray(array: ArrayState): StateName {
  const state = ARRAY_STATES[array.level] ?? "error";
  return state === "well" && (array.wants_calibration || array.refusal !== "") ? "warning" : state;
}

export function stateOf(robot: RobotState): StateName {
  return STATES.find((state) => state === robot.state) ?? "unreadable";
}

/** "model 2 wanted, 1 in use, refused": the model of an array, and the one that the fleet wants of it. */
export function modelOf(array: ArrayState): string {
  const name = array.model.replace(/\.safetensors$/, "");
  if (array.wanted_model === 0 || array.wanted_model === array.used_model)
    return array.used_model > 0 ? `${name} (${array.used_model})` : name;
  const used = array.used_model > 0 ? `${array.used_model}` : "its own";
  return `model ${array.wanted_model} ${array.refusal === "" ? "wanted" : "refused"}, ${used} in use`;
}

/** A robot with what the table shows and sorts. */
export interface Robot {
  readonly state: RobotState;
  readonly word: StateName;
  readonly severity: number;
  /** NaN: not known, as that of a robot of which nothing comes. */
  readonly rateHz: number;
  readonly lost: number;
  readonly leftOut: number;
  readonly masked: number;
  /** NaN: not known. */
  readonly drift: number;
  readonly toCalibrate: readonly string[];
  readonly remarks: string;
}

export function robotOf(state: RobotState): Robot {
  const { arrays } = state;
  const word = stateOf(state);
  const sum = (value: (array: ArrayState) => number): number => arrays.reduce((all, array) => all + value(array), 0);
  const drifts = arrays.flatMap(({ gain_change: change }) => (change === undefined ? [] : [change]));
  return {
    state,
    word,
    severity: STATES.indexOf(word),
    rateHz: state.silent || state.stale ? NaN : sum(({ rate_hz }) => rate_hz),
    lost: sum(({ lost }) => lost),
    leftOut: sum(({ left_out }) => left_out),
    masked: sum(({ masked_taxels }) => masked_taxels),
    drift: drifts.length > 0 ? Math.max(...drifts) : NaN,
    toCalibrate: arrays.filter(({ wants_calibration }) => wants_calibration).map(({ name }) => name),
    remarks: state.reasons.join("; "),
  };
}

const STALE_AFTER_S = 5;
const SILENT_AFTER_S = 10;

/** A robot as it was told so many seconds ago, while nobody tells more. */
export function aged(state: RobotState, seconds: number): RobotState {
  const older = (age: number | null): number | null => (age === null ? null : age + seconds);
  const age = { age_s: older(state.age_s), health_age_s: older(state.health_age_s), since_s: older(state.since_s) };
  if (seconds < STALE_AFTER_S) return { ...state, ...age };
  if (seconds < SILENT_AFTER_S || state.silent) return { ...state, ...age, stale: true };
  const reasons = [`no message for ${Math.round(age.health_age_s ?? seconds)} s`];
  return { ...state, ...age, stale: true, silent: true, state: "silent", since_s: age.health_age_s, reasons };
}

/** The command that gets the frames of an array from the hub. Only letters that names may have are taken. */
export function recordCommand(hub: string, robot: string, array: string): string {
  const [from, of] = [robot, array].map((name) => name.replace(/[^A-Za-z0-9_-]/g, "?"));
  return `dermis record --from '${hub}?robot=${from}&array=${of}&from=1&to=last' --out ${from}-${of}.mcap`;
}

/** The robots that a user looks for: words in names and remarks, and one kind of robots. */
export interface Wanted {
  readonly words: string;
  readonly kind: Kind;
}

export const KINDS = ["all", "attention", "silent", "to calibrate"] as const;
export type Kind = (typeof KINDS)[number];

export function isOfKind(robot: Robot, kind: Kind): boolean {
  if (kind === "attention") return robot.word !== "well";
  if (kind === "silent") return robot.word === "silent";
  return kind === "all" || robot.toCalibrate.length > 0;
}

export function isWanted(robot: Robot, { words, kind }: Wanted): boolean {
  const text = [robot.state.name, robot.word, robot.remarks, ...robot.state.arrays.map(({ name }) => name)]
    .join("\n")
    .toLowerCase();
  const isNamed = words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
  return isNamed && isOfKind(robot, kind);
}

export type SortKey = "state" | "robot" | "arrays" | "rate" | "lost" | "lag" | "faults" | "drift" | "calibration";
export interface Order {
  readonly key: SortKey;
  readonly descends: boolean;
}

/** Known values come before unknown ones, whichever way the order is. */
const VALUES: Readonly<Record<SortKey, (robot: Robot) => number>> = {
  state: ({ severity }) => severity,
  robot: () => 0,
  arrays: ({ state }) => state.arrays.length,
  rate: ({ rateHz }) => rateHz,
  lost: ({ lost, leftOut }) => lost + leftOut,
  lag: ({ state }) => state.age_s ?? NaN,
  faults: ({ masked }) => masked,
  drift: ({ drift }) => drift,
  calibration: ({ toCalibrate }) => toCalibrate.length,
};

const byName = new Intl.Collator("en", { numeric: true }).compare;

export function sorted(robots: readonly Robot[], { key, descends }: Order): Robot[] {
  const sign = descends ? -1 : 1;
  const value = VALUES[key];
  return [...robots].sort((a, b) => {
    const name = byName(a.state.name, b.state.name);
    if (key === "robot") return sign * name;
    const [left, right] = [value(a), value(b)];
    if (Number.isNaN(left) || Number.isNaN(right))
      return Number(Number.isNaN(left)) - Number(Number.isNaN(right)) || name;
    return sign * (left - right) || name;
  });
}

const SPANS: readonly (readonly [number, string])[] = [
  [86400, "d"],
  [3600, "h"],
  [60, "min"],
  [1, "s"],
];

/** "0.4 s", "12 s", "3 min"; below 0 a clock is ahead. */
export function span(seconds: number | null): string {
  if (seconds === null) return "\u2013";
  if (seconds < 0) return seconds > -1 ? "0.0 s" : `${span(-seconds)} ahead`;
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  const [unit, name] = SPANS.find(([limit]) => seconds >= 2 * limit) ?? [1, "s"];
  return `${Math.floor(seconds / unit)} ${name}`;
}

/** The address of a robot's own page, where this browser can reach it; otherwise the reason. */
export function wayTo(live: string, from: string): { readonly url?: string; readonly reason?: string } {
  if (live === "") return { reason: "It has told no address of its page" };
  let url: URL;
  try {
    url = new URL(live);
  } catch {
    return { reason: "Its address cannot be read" };
  }
  if (url.protocol !== "http:" && url.protocol !== "https:") return { reason: "Its address is none of a page" };
  if (isLoopback(url.hostname) && !isLoopback(from)) return { reason: `Only the robot itself can open ${url.href}` };
  return { url: url.href };
}

function isLoopback(host: string): boolean {
  return host === "localhost" || host === "[::1]" || host.startsWith("127.");
}
