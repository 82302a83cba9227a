// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node views.mjs path/to/dermis FOLDER [VIEW...] -- ARGUMENTS_OF_SERVE...
// No test: every view at five widths, light and dark, as FOLDER/VIEW-WIDTH-THEME.webp (scripts/pictures).
import { mkdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { Bench, becomes, openBrowser, openPage, part, VIEWS } from "./harness.mjs";

const SIZES = [
  [390, 844],
  [768, 1024],
  [1280, 720],
  [1440, 900],
  [1920, 1080],
];
const QUALITY = 0.8;
const SETTLES_MS = 1500;

const [binary, out, ...rest] = process.argv.slice(2);
const folder = resolve(out);
const chosen = rest.slice(0, rest.indexOf("--"));
const views = chosen.length > 0 ? chosen : VIEWS;
const bench = new Bench(binary);
const server = await bench.serve("--port", "0", ...rest.slice(rest.indexOf("--") + 1));
const browser = await openBrowser();
mkdirSync(folder, { recursive: true });

/** In a page: a PNG as WebP. */
async function asWebp([data, quality]) {
  const image = new Image();
  image.src = `data:image/png;base64,${data}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  canvas.getContext("2d").drawImage(image, 0, 0);
  return canvas.toDataURL("image/webp", quality).split(",")[1];
}

/** What makes a view worth a look. */
const prepare = {
  array: async (page) => {
    await page.locator("[data-contact]").first().waitFor();
    await part(page, "maps").focus();
    for (const key of ["ArrowDown", "ArrowRight", "ArrowRight", "Enter"]) await page.keyboard.press(key);
  },
  time: (page) => page.waitForTimeout(4000),
};

try {
  const page = await openPage(browser, server.url);
  const press = await openPage(browser, "about:blank");
  await becomes(page, "live");
  await page.addStyleTag({ content: ".messages { display: none }" }); // a busy machine tells of itself
  for (const view of views) {
    await page.setViewportSize({ width: SIZES[4][0], height: SIZES[4][1] });
    await page.locator(`[data-tab=${view}]`).click();
    await prepare[view]?.(page);
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      for (const theme of ["light", "dark"]) {
        await page.emulateMedia({ colorScheme: theme });
        await page.waitForTimeout(SETTLES_MS);
        const shot = await page.screenshot();
        const picture = await press.evaluate(asWebp, [shot.toString("base64"), QUALITY]);
        writeFileSync(join(folder, `${view}-${width}-${theme}.webp`), Buffer.from(picture, "base64"));
        if (process.env.DERMIS_PNG) writeFileSync(join(process.env.DERMIS_PNG, `${view}-${width}-${theme}.png`), shot);
      }
    }
  }
} finally {
  await browser.close();
  await server.stop();
  bench.close();
}
