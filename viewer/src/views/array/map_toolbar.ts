// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../../dom";
import { setting } from "../../settings";
import { Signal } from "../../signal";
import { TIME_SHARES, type TimeShare } from "./held_values";
import { FORCE, PRESSURE, QUANTITIES } from "./quantities";

const SHARE_WORDS: Readonly<Record<TimeShare, string>> = {
  now: "now",
  highest: "highest since reset",
  average: "average of 1 s",
};

/** How the maps are shown, as the user has it. */
export class MapChoices {
  readonly interpolated = setting<boolean>("interpolated", false, () => true);
  readonly contacts = setting<boolean>("contacts", true, () => true);
  readonly centre = setting<boolean>("centre", false, () => true);
  readonly pressure = setting<boolean>("pressure", false, () => true);
  /** The one that a narrow page shows: a place in QUANTITIES; FORCE is the pressure where that is chosen. */
  readonly narrowMap = setting<number>("map", FORCE, (value) => value in QUANTITIES && value !== PRESSURE);
  readonly share = new Signal<TimeShare>("now");
  /** The next two corners on a map are those of a region. */
  readonly drawing = new Signal(false);

  /** Forces, or their pressures. */
  get load(): typeof FORCE | typeof PRESSURE {
    return this.pressure.value ? PRESSURE : FORCE;
  }
}

export interface MapActions {
  /** Highest values and averages begin anew. */
  reset(): void;
  clearRegion(): void;
  readonly hasRegion: Signal<boolean>;
}

/** Not there for an array without a model. */
const NEEDS_FORCE = "needs-force";

function check(label: string, signal: Signal<boolean>, role: string, group = ""): HTMLElement {
  const box = element("input", { type: "checkbox", "data-role": role, onchange: () => (signal.value = box.checked) });
  signal.follow((value) => (box.checked = value));
  return element("label", { class: `check ${group}` }, box, label);
}

function makeMapChoice({ narrowMap }: MapChoices): HTMLElement {
  const chosen = element(
    "select",
    {
      class: "field map-choice",
      "aria-label": "Map",
      "data-role": "map",
      onchange: () => (narrowMap.value = Number(chosen.value)),
    },
    ...QUANTITIES.flatMap(({ title }, index) =>
      index === PRESSURE ? [] : [element("option", { value: index }, title)],
    ),
  );
  narrowMap.follow((value) => (chosen.value = String(value)));
  return chosen;
}

function makeShare({ share }: MapChoices, actions: MapActions): HTMLElement {
  const select = element(
    "select",
    { class: "field compact", "data-role": "share", onchange: () => (share.value = select.value as TimeShare) },
    ...TIME_SHARES.map((name) => element("option", { value: name }, SHARE_WORDS[name])),
  );
  const reset = button("Reset", () => actions.reset(), { class: "compact", "data-role": "reset-share" });
  share.follow((value) => setHidden(reset, value !== "highest"));
  return element("span", { class: "group" }, element("label", { class: "check" }, "Show", select), reset);
}

function makeRegion({ drawing }: MapChoices, { hasRegion, clearRegion }: MapActions): HTMLElement {
  const draw = button(
    "",
    () => {
      if (hasRegion.value) clearRegion();
      else drawing.value = !drawing.value;
    },
    {
      class: `compact ${NEEDS_FORCE}`,
      "data-role": "draw-region",
      title: "The force on a part of the map, here and over time: draw from corner to corner, or set both with Enter",
    },
  );
  const describe = (): void => {
    draw.setAttribute("aria-pressed", String(drawing.value));
    setText(draw, drawing.value ? "From corner to corner \u2026" : hasRegion.value ? "Remove region" : "Draw a region");
  };
  drawing.follow(describe);
  hasRegion.follow(describe);
  return draw;
}

function makeMarks(): HTMLElement {
  const mark = (name: string, words: string): HTMLElement =>
    element("span", { class: "group" }, element("span", { class: `mark-${name}` }), words);
  return element(
    "p",
    { class: "marks dim" },
    mark("fault", "faulty"),
    mark("saturated", "saturated or above range"),
    mark("beyond", "beyond the scale"),
  );
}

/** The line above the maps. */
export function makeMapToolbar(choices: MapChoices, actions: MapActions): HTMLElement {
  return element(
    "div",
    { class: "toolbar" },
    makeMapChoice(choices),
    makeShare(choices, actions),
    check("Pressure in kPa", choices.pressure, "show-pressure", NEEDS_FORCE),
    check("Interpolate", choices.interpolated, "interpolate"),
    check("Contacts", choices.contacts, "show-contacts", NEEDS_FORCE),
    check("Centre of pressure", choices.centre, "show-centre", NEEDS_FORCE),
    makeRegion(choices, actions),
    makeMarks(),
  );
}
