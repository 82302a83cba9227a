// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// The page of site/try, built and given out as a web server does it.
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { after, before } from "node:test";
import { gunzipSync, gzipSync } from "node:zlib";
import { openBrowser } from "./harness.mjs";

const CONTENT_TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
};

/** Filled in before the tests. */
export const site = { folder: "", url: "", browser: undefined, isOnline: true, packed: new Map() };

function pack(folder) {
  const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
  return new Map(
    files.map(({ parentPath, path = parentPath, name }) => {
      const file = join(path, name);
      return [file.slice(folder.length), gzipSync(readFileSync(file), { level: 9 })];
    }),
  );
}

function answer(request, response) {
  const { pathname } = new URL(request.url, site.url);
  const path = pathname === "/" ? "/index.html" : pathname;
  const file = site.isOnline ? site.packed.get(path) : undefined;
  if (file === undefined) return response.writeHead(404).end();
  const type = CONTENT_TYPES[extname(path)] ?? "application/octet-stream";
  response.writeHead(200, { "Content-Type": type, "Content-Encoding": "gzip" }).end(file);
}

/** A file of the page is another from now on. */
export function change(path, text, by) {
  site.packed.set(path, gzipSync(gunzipSync(site.packed.get(path)).toString().replace(text, by)));
}

export function skipWithoutCompiler() {
  if (!existsSync("/usr/bin/wasm-ld-16") || !existsSync("/usr/include/wasm32-wasi/c++/v1")) {
    console.log("skipped: there is no compiler for WebAssembly (scripts/setup browser)");
    process.exit(0);
  }
}

/** Call it first. Skips where there is no compiler. */
export function useSite() {
  skipWithoutCompiler();
  let server;
  before(async () => {
    site.folder = mkdtempSync(join(tmpdir(), "dermis-try-"));
    execFileSync(new URL("../../scripts/try_page", import.meta.url).pathname, [site.folder], {
      stdio: ["ignore", "ignore", "inherit"],
    });
    site.packed = pack(site.folder);
    server = createServer(answer);
    await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
    site.url = `http://127.0.0.1:${server.address().port}/`;
    site.browser = await openBrowser();
  });
  after(async () => {
    await site.browser?.close();
    server?.close();
    if (site.folder) rmSync(site.folder, { recursive: true, force: true });
  });
}

/** The place of a copy of what the browser saves. */
export async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  const place = join(site.folder, download.suggestedFilename());
  copyFileSync(await download.path(), place);
  return place;
}
