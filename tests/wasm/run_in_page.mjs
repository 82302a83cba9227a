// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Runs a WebAssembly program over the files of the page (viewer/src/try), which begin as those of a folder and are put back
// there. Usage: node run_in_page.mjs PROGRAM FOLDER
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [program, folder] = process.argv.slice(2);
const viewer = new URL("../../viewer/", import.meta.url);
const { build } = await import(new URL("node_modules/esbuild/lib/main.js", viewer));
const { outputFiles } = await build({
  stdin: {
    contents: 'export * from "./files"; export * from "./system";',
    resolveDir: new URL("src/try", viewer).pathname,
  },
  bundle: true,
  format: "esm",
  write: false,
});
const { Files, Folder, systemOf } = await import(
  `data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`
);

const files = new Files();
for (const name of readdirSync(folder)) files.create(`/${name}`).content.write(readFileSync(join(folder, name)), 0);

const system = systemOf(files);
const instance = await WebAssembly.instantiate(await WebAssembly.compile(readFileSync(program)), system.imports);
system.memory = instance.exports.memory;
instance.exports._start();

function putBack(within) {
  for (const name of files.list(within)) {
    const path = join(within, name);
    const isFolder = files.find(path) instanceof Folder;
    if (isFolder) mkdirSync(join(folder, path), { recursive: true });
    if (isFolder) putBack(path);
    else writeFileSync(join(folder, path), files.bytes(path));
  }
}
putBack("/");
