// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node picture.mjs path/to/dermis MODEL OUT.png
// No test: the page of a simulated array with several contacts, as a picture for the documents (scripts/pictures).
import { resolve } from "node:path";
import { becomes, Bench, openBrowser, openPage } from "./harness.mjs";

const CONTACTS = 4;

const [binary, model, out] = process.argv.slice(2);
const bench = new Bench(binary);
const server = await bench.serve("--port", "0", "--from", "sim:contacts?rate=100&seed=1", "--model", resolve(model));
const browser = await openBrowser();
try {
  const page = await openPage(browser, `${server.url}#/array`);
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.emulateMedia({ colorScheme: "dark" });
  await becomes(page, "live");
  await page.waitForFunction((contacts) => document.querySelectorAll("[data-contact]").length >= contacts, CONTACTS);
  await page.screenshot({ path: out });
} finally {
  await browser.close();
  await server.stop();
  bench.close();
}
