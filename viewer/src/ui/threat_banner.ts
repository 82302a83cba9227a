// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { errorText, withUnit } from "../format";
import type { ThreatBoard } from "../live/threat_board";
import { type Threat, ThreatState } from "../messages/threat";
import type { Stream } from "../stream/stream";
import "./banners.css";

const MOST_ROWS = 3;

/** The present threats, above every view. */
export function makeThreatBanner(board: ThreatBoard, stream: Stream): HTMLElement {
  const rows = Array.from({ length: MOST_ROWS }, () => element("li", { "data-role": "threat" }));
  const more = element("li", { class: "dim" });
  const reset = button("Reset", () => void resetThreats(stream), { "data-role": "reset-threats" });
  const banner = element(
    "section",
    {
      class: "threat-banner message",
      role: "alert",
      "aria-label": "Threats",
      "data-role": "threat-banner",
      hidden: true,
    },
    element("ul", {}, ...rows, more),
    reset,
  );
  board.limits.follow(() => {
    const { standing } = board;
    setHidden(banner, standing.length === 0);
    rows.forEach((row, index) => {
      const threat = standing[index];
      setHidden(row, threat === undefined);
      if (threat !== undefined) setText(row, words(threat));
    });
    setHidden(more, standing.length <= MOST_ROWS);
    setText(more, `and ${standing.length - MOST_ROWS} more`);
    setHidden(reset, !standing.some(({ state }) => state === ThreatState.latched));
  });
  return banner;
}

function words({ name, array, zone, quantity, state, value, worst, limit, unit }: Threat): string {
  const place = zone === "" ? array : `${array}, ${zone}`;
  const what = quantity.replaceAll("_", " ");
  const now = state === ThreatState.latched ? `was ${withUnit(worst, unit)}` : withUnit(value, unit);
  const isHeld = state === ThreatState.active && value < limit;
  return `${name} (${place}): ${what} ${now}, ${isHeld ? "was above" : "limit"} ${withUnit(limit, unit)}`;
}

async function resetThreats(stream: Stream): Promise<void> {
  try {
    await stream.callService("/threats/reset", {});
  } catch (error) {
    stream.notice.value = { level: 2, message: errorText(error) };
  }
}
