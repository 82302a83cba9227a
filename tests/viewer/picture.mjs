// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node picture.mjs path/to/dermis array|suit OUT.png ARGUMENTS_OF_SERVE...
// No test: a view with several contacts, as a picture for the documents (scripts/pictures).
import { Bench, becomes, openBrowser, openPage } from "./harness.mjs";

const CONTACTS = 4;
const MARKS = { array: "[data-contact]", suit: ".force-label:not([hidden])" };

const [binary, view, out, ...command] = process.argv.slice(2);
const bench = new Bench(binary);
const server = await bench.serve("--port", "0", ...command);
const browser = await openBrowser();
try {
  const page = await openPage(browser, `${server.url}#/${view}`);
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.emulateMedia({ colorScheme: "dark" });
  await becomes(page, "live");
  await page.waitForFunction(
    ([marks, contacts]) => document.querySelectorAll(marks).length >= contacts,
    [MARKS[view], CONTACTS],
  );
  await page.screenshot({ path: out });
} finally {
  await browser.close();
  await server.stop();
  bench.close();
}
