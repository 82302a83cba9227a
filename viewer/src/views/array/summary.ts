// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setData, setText } from "../../dom";
import { fixed, measured, statusWord } from "../../format";
import type { Trail } from "../../live/contact_slots";
import { type RegionForce, regionName } from "../../live/region_force";
import { type GridFrame, TaxelStatus } from "../../messages/grids";
import type { ArrayDescription } from "../../suit";
import { taxelName } from "./geometry";
import type { Picture } from "./picture";

/** Words and data-role. */
const FIGURES = [
  ["Contacts", "contacts"],
  ["Highest", "highest-taxel"],
  ["Whole array", "sum-of-taxels"],
  ["Faulty", "faulty-taxels"],
  ["Centre", "centre"],
  ["Region", "region"],
] as const;

/** The figures of the whole array. */
export class Summary {
  readonly element: HTMLElement;
  readonly #total = element("span", { class: "large figure", "data-role": "total-force" });
  readonly #sigma = element("span", { class: "dim figure" });
  readonly #values = FIGURES.map(([, role]) => element("dd", { class: "figure", "data-role": role }));

  constructor() {
    const pairs = FIGURES.flatMap(([words], index) => [element("dt", {}, words), this.#values[index]!]);
    this.element = panel(
      "Force of contacts",
      { class: "summary", "aria-label": "Total" },
      element("p", { class: "total" }, this.#total, element("span", { class: "total-unit" }, "N"), this.#sigma),
      element("dl", { class: "pairs" }, ...pairs),
    );
  }

  /** `shown`: the forces, or the counts of an array without a model. */
  show(array: ArrayDescription, { contacts, touching }: Picture, centre: Trail, shown: GridFrame): void {
    const { highest, faulty, worst } = survey(shown);
    if (!array.calibrated) {
      this.#showCounts(array, shown, highest);
      return;
    }
    const [total, sigma] = measured(contacts.totalForceN, contacts.sigmaTotalN);
    const [sum, sigmaSum] = measured(contacts.sumN, contacts.sigmaSumN);
    setText(this.#total, total);
    setText(this.#sigma, `\u00b1 ${sigma}`);
    setText(this.#values[0]!, String(touching.length));
    setText(
      this.#values[1]!,
      highest < 0 ? fixed(NaN, 0) : `${fixed(shown.values[highest]!, 2)} N  ${taxelName(highest, array)}`,
    );
    setText(this.#values[2]!, `${sum} \u00b1 ${sigmaSum} N`);
    setText(this.#values[3]!, faulty === 0 ? "none" : `${faulty}, ${statusWord(worst)}`);
    const last = centre.length - 1;
    setText(
      this.#values[4]!,
      last < 0 ? fixed(NaN, 0) : `${fixed(1e3 * centre.x(last), 1)}, ${fixed(1e3 * centre.y(last), 1)} mm`,
    );
  }

  showRegion(force: RegionForce | undefined): void {
    const region = force?.region.value;
    setData(this.element, "region", region === undefined ? "" : regionName(region));
    setText(this.#values[5]!, force === undefined ? "none drawn" : `${fixed(force.newtons, 2)} N`);
  }

  #showCounts(array: ArrayDescription, { values }: GridFrame, highest: number): void {
    setText(this.#total, fixed(NaN, 2));
    setText(this.#sigma, "not calibrated");
    for (const value of this.#values) setText(value, fixed(NaN, 0));
    if (highest >= 0) setText(this.#values[1]!, `${fixed(values[highest]!, 0)}  ${taxelName(highest, array)}`);
  }
}

function survey({ values, statuses }: GridFrame): { highest: number; faulty: number; worst: number } {
  const found = { highest: -1, faulty: 0, worst: 0 };
  for (let taxel = 0; taxel < values.length; ++taxel) {
    if (statuses[taxel]! >= TaxelStatus.dead) {
      found.faulty += 1;
      found.worst = Math.max(found.worst, statuses[taxel]!);
      continue;
    }
    if (found.highest < 0 || values[taxel]! > values[found.highest]!) found.highest = taxel;
  }
  return found;
}
