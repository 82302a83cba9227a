// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element } from "../../dom";
import { withUnit } from "../../format";
import type { Area } from "../../render/heat_maps";
import type { ArrayDescription, Limit, Zone } from "../../suit";
import { boxOf } from "./geometry";

/** The zones of an array, each with the limits that hold there. */
export function limitedZones(array: ArrayDescription): Map<Zone, Limit[]> {
  const byName = new Map<string, [Zone, Limit[]]>();
  for (const limit of array.limits ?? []) {
    if (limit.zone === null) continue;
    const known = byName.get(limit.zone.name);
    if (known === undefined) byName.set(limit.zone.name, [limit.zone, [limit]]);
    else known[1].push(limit);
  }
  return new Map(byName.values());
}

/** Frames round the zones, over a map. */
export function drawZones(layer: HTMLElement, area: Area | undefined, array: ArrayDescription): void {
  layer.replaceChildren();
  if (area === undefined || area.width === 0) return;
  for (const [{ name, rows, cols }, limits] of limitedZones(array)) {
    const style = Object.entries(boxOf(area, array, rows, cols))
      .map(([side, pixels]) => `${side}: ${pixels.toFixed(1)}px`)
      .join("; ");
    const label = limits.map(({ limit, unit }) => withUnit(limit, unit)).join(", ");
    layer.append(element("div", { class: "zone", "data-zone": name, style }, element("span", {}, `${name}  ${label}`)));
  }
}
