// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Opens a page once somebody serves it, and prints the newtons on the array as soon as it shows more than half a newton.
// Usage: node newtons.mjs ADDRESS
import { assertUnhurt, eventually, openBrowser, openPage } from "./harness.mjs";

const [address] = process.argv.slice(2);
const browser = await openBrowser();
try {
  while (!(await fetch(address).catch(() => null))?.ok) await new Promise((wake) => setTimeout(wake, 50));
  const page = await openPage(browser, address);
  await eventually(page, () => parseFloat(document.querySelector("[data-role=total-force]")?.textContent) > 0.5);
  console.log(`${await page.locator("[data-role=total-force]").textContent()} N`);
  assertUnhurt(page);
} finally {
  await browser.close();
}
