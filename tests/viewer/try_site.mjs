// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// The page of site/try, built into a temporary folder and given out as a web server would. DERMIS_TRY_PAGE names a folder
// where it is built already.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { after, before } from "node:test";
import { gzipSync } from "node:zlib";
import { openBrowser } from "./harness.mjs";

const CONTENT_TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
};

export let browser;
/** Its address. */
export let url;
/** Its files by their paths, compressed. */
export let packed;
export const network = { isOn: true };

/** The tests of this file share the page and a browser. */
export function useSite() {
  if (!existsSync("/usr/bin/wasm-ld-16") || !existsSync("/usr/include/wasm32-wasi/c++/v1")) {
    console.log("skipped: there is no compiler for WebAssembly (scripts/setup browser)");
    process.exit(0);
  }
  let folder;
  let server;
  before(async () => {
    const built = process.env.DERMIS_TRY_PAGE;
    folder = built ?? mkdtempSync(join(tmpdir(), "dermis-try-"));
    const build = new URL("../../scripts/try_page", import.meta.url).pathname;
    if (built === undefined) execFileSync(build, [folder], { stdio: ["ignore", "ignore", "inherit"] });
    const files = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
    packed = new Map(
      files.map(({ parentPath, path = parentPath, name }) => {
        const file = join(path, name);
        return [file.slice(folder.length), gzipSync(readFileSync(file), { level: 9 })];
      }),
    );
    server = createServer((request, response) => {
      const { pathname } = new URL(request.url, "http://localhost");
      const path = pathname === "/" ? "/index.html" : pathname;
      const file = network.isOn ? packed.get(path) : undefined;
      if (file === undefined) return response.writeHead(404).end();
      const type = CONTENT_TYPES[extname(path)] ?? "application/octet-stream";
      response.writeHead(200, { "Content-Type": type, "Content-Encoding": "gzip" }).end(file);
    });
    await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
    url = `http://127.0.0.1:${server.address().port}/`;
    browser = await openBrowser();
  });
  after(async () => {
    await browser?.close();
    server?.close();
    if (folder && folder !== process.env.DERMIS_TRY_PAGE) rmSync(folder, { recursive: true, force: true });
  });
}
