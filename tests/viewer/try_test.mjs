// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node try_test.mjs
// The page of site/try in a real browser: dermis in a worker, in the place of a server.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { faultsOfBoxes, findings, SIZES } from "./faults.mjs";
import { assertUnhurt, becomes, eventually, openPage, part, tareAnyway } from "./harness.mjs";
import { change, site, useSite } from "./try_page.mjs";

const MOST_BYTES = 3_000_000;

useSite();

/** Waits until the page is kept for offline. */
async function kept(page) {
  await page.evaluate(async () => {
    const { active } = await navigator.serviceWorker.ready;
    while (active.state !== "activated")
      await new Promise((changed) => active.addEventListener("statechange", changed));
  });
}

describe("the page of site/try", () => {
  it("shows newtons and contacts of a simulated sheet, and asks for nothing but its own files", async () => {
    const page = await openPage(site.browser, "about:blank");
    const asked = [];
    page.on("request", (request) => asked.push(request.url()));
    const begin = performance.now();
    await page.goto(`${site.url}#/array`);
    await becomes(page, "live");
    await eventually(page, () => document.querySelector("[data-view=array]").dataset.stamp !== undefined);
    const firstMapMs = performance.now() - begin;
    await page.locator("[data-contact]").first().waitFor();
    const stampOf = () => document.querySelector("[data-view=array]").dataset.stamp;
    const stamp = await page.evaluate(stampOf);
    await eventually(page, (before) => document.querySelector("[data-view=array]").dataset.stamp !== before, stamp);
    assert.deepEqual(
      asked.filter((address) => !address.startsWith(site.url)),
      [],
    );
    const bytes = [...site.packed.values()].reduce((sum, { length }) => sum + length, 0);
    assert.ok(bytes < MOST_BYTES, `${bytes} bytes`);
    assertUnhurt(page);
    console.log(`first map after ${Math.round(firstMapMs)} ms, ${bytes} bytes compressed`);
    await page.close();
  });

  it("tares, and answers as a server does", async () => {
    const page = await openPage(site.browser, `${site.url}#/array`);
    await becomes(page, "live");
    await part(page, "show-thresholds").click();
    const rate = page.locator('[data-parameter="/stream/rate_hz"]');
    await rate.fill("5000");
    await rate.press("Tab");
    await part(page, "notice").filter({ hasText: "/stream/rate_hz: must be 1 to 1000" }).waitFor();
    await page.keyboard.press("Escape");
    await tareAnyway(page);
    assertUnhurt(page);
    await page.close();
  });

  it("has panels of its own in which axe-core finds nothing serious and that lie over nothing", async () => {
    const page = await openPage(site.browser, `${site.url}#/array`);
    await becomes(page, "live");
    await page.locator("[data-contact]").first().waitFor();
    for (const part of await page.locator("[data-role=about] summary").all()) await part.click();
    const found = {};
    for (const size of SIZES) {
      await page.setViewportSize(size);
      await page.waitForTimeout(400);
      const lines = [...(await findings(page)), ...(await page.evaluate(faultsOfBoxes))];
      if (lines.length > 0) found[size.width] = lines;
    }
    assert.deepEqual(found, {});
    assertUnhurt(page);
    await page.close();
  });

  it("needs no network once it was shown", async () => {
    const page = await openPage(site.browser, `${site.url}#/array`);
    await becomes(page, "live");
    await kept(page);
    site.isOnline = false;
    await page.reload();
    await becomes(page, "live");
    await page.locator("[data-contact]").first().waitFor();
    site.isOnline = true;
    assertUnhurt(page);
    await page.close();
  });

  it("has all files of one version, and the next one when no page is open", async () => {
    const context = await site.browser.newContext();
    const page = await openPage(context, site.url);
    await becomes(page, "live");
    await kept(page);
    await page.reload(); // now it is of the version that is kept
    await becomes(page, "live");
    change("/index.html", "</head>", '<meta name="next"></head>');
    change("/offline.js", "dermis-try-", "dermis-try-next-");
    await page.evaluate(async () => (await navigator.serviceWorker.ready).update());
    await eventually(page, async () => (await navigator.serviceWorker.ready).waiting !== null);
    await page.reload();
    await becomes(page, "live");
    const next = page.locator("meta[name=next]");
    assert.equal(await next.count(), 0);
    for (let found = 0; found === 0; found = await next.count()) {
      await page.goto("about:blank");
      await page.waitForTimeout(200);
      await page.goto(site.url);
    }
    await becomes(page, "live");
    assertUnhurt(page);
    await context.close();
  });

  it("says in one line why it cannot begin", async () => {
    const page = await openPage(site.browser, "about:blank");
    await page.route("**/sheet.model", (route) => route.fulfill({ body: "no model" }));
    await page.goto(site.url);
    await page.getByRole("alert").filter({ hasText: "the model" }).waitFor();
    await page.close();
  });
});
