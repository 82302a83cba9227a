// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// What is wrong with a page: for axe-core, and by its boxes.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const AXE = readFileSync(
  createRequire(new URL("../npm/package.json", import.meta.url)).resolve("axe-core/axe.min.js"),
  "utf8",
);
/** Of windows, from a telephone to a desk. */
export const SIZES = [
  { width: 390, height: 844 },
  { width: 768, height: 1024 },
  { width: 1280, height: 720 },
  { width: 1440, height: 900 },
  { width: 1920, height: 1080 },
];

/** What axe-core finds serious or critical in the light theme, and of the colours of the dark one, a line each. */
export async function findings(page) {
  const look = async (colorScheme, options) => {
    await page.emulateMedia({ colorScheme });
    await page.locator(`html[data-theme=${colorScheme}]`).waitFor();
    return page.evaluate(run, options);
  };
  await page.evaluate(AXE);
  return [...(await look("light", {})), ...(await look("dark", { runOnly: ["color-contrast"] }))];
}

async function run(options) {
  const { violations } = await globalThis.axe.run(document, { resultTypes: ["violations"], ...options });
  const grave = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  return grave.flatMap(({ id, nodes }) =>
    nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")}: ${failureSummary.split("\n")[1]?.trim()}`),
  );
}

/** In the page: what is wrong with its boxes, a line each. */
export function faultsOfBoxes() {
  const SLACK = 1.5;
  const style = (target) => getComputedStyle(target);
  const ancestors = (target) => {
    const found = [];
    for (let one = target; one !== null && one !== document.documentElement; one = one.parentElement) found.push(one);
    return found;
  };
  const faults = [];
  const boxes = [];
  const words = (target) =>
    `<${target.tagName.toLowerCase()} ${target.className}> ${(target.value ?? target.textContent).trim().slice(0, 30)}`;
  /** What is seen of a box; undefined where it is scrolled away. */
  const seen = (box, owner) => {
    let { left, top, right, bottom } = box;
    for (const ancestor of ancestors(owner)) {
      const { overflowX, overflowY } = style(ancestor);
      if (overflowX === "visible" && overflowY === "visible") continue;
      const room = ancestor.getBoundingClientRect();
      const isCut = right > room.right + SLACK || left < room.left - SLACK;
      const scrolls = overflowX === "auto" || overflowX === "scroll";
      const isShortened = ancestors(owner).some((one) => style(one).textOverflow === "ellipsis");
      if (isCut && !scrolls && !isShortened && ancestor !== document.body) faults.push(`cut: ${words(owner)}`);
      [left, right] = [Math.max(left, room.left), Math.min(right, room.right)];
      [top, bottom] = [Math.max(top, room.top), Math.min(bottom, room.bottom)];
    }
    return right - left > SLACK && bottom - top > SLACK ? { left, top, right, bottom } : undefined;
  };
  const add = (box, owner) => {
    if (box.width === 0 || box.height === 0) return;
    const part = seen(box, owner);
    if (part === undefined) return;
    if (part.right > innerWidth + SLACK || part.left < -SLACK) faults.push(`beyond the page: ${words(owner)}`);
    boxes.push({ ...part, owner });
  };
  const isLeftOut = (target) =>
    target.closest(".only-spoken, .messages, .suit-room, .uplot, dialog, option, [hidden]") !== null ||
    style(target).visibility === "hidden";
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let text = texts.nextNode(); text !== null; text = texts.nextNode()) {
    const owner = text.parentElement;
    if (text.data.trim() === "" || isLeftOut(owner)) continue;
    const range = document.createRange();
    range.selectNodeContents(text);
    for (const box of range.getClientRects()) add(box, owner);
  }
  for (const control of document.querySelectorAll("input, select, button"))
    if (!isLeftOut(control)) add(control.getBoundingClientRect(), control);
  boxes.forEach((one, index) => {
    for (const other of boxes.slice(index + 1)) {
      if (one.owner.contains(other.owner) || other.owner.contains(one.owner)) continue;
      const width = Math.min(one.right, other.right) - Math.max(one.left, other.left);
      const height = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
      if (width > SLACK && height > SLACK) faults.push(`${words(one.owner)} lies over ${words(other.owner)}`);
    }
  });
  const map = document.querySelector(".map-panel:not([hidden]) .map-plot, .calibration-picture");
  if (map !== null && Math.min(map.clientWidth, map.clientHeight) < 150)
    faults.push(`the map has ${map.clientWidth}x${map.clientHeight} px`);
  const { scrollHeight } = document.documentElement;
  if (innerWidth > 1000 && scrollHeight > innerHeight) faults.push(`the page is ${scrollHeight} px high`);
  if (document.documentElement.scrollWidth > innerWidth)
    faults.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  return [...new Set(faults)];
}
