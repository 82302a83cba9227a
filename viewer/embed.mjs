// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// Usage: node embed.mjs FOLDER FILE.cpp
// Writes all files of a folder, compressed, as the C++ source of viewer_assets.hpp.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { extname, join, relative } from "node:path";
import { gzipSync } from "node:zlib";

const CONTENT_TYPES = {
  ".css": "text/css; charset=utf-8",
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".svg": "image/svg+xml",
  ".txt": "text/plain; charset=utf-8",
  ".woff2": "font/woff2",
};

function filesOf(folder) {
  return readdirSync(folder, { withFileTypes: true })
    .sort((a, b) => (a.name < b.name ? -1 : 1))
    .flatMap((entry) => (entry.isDirectory() ? filesOf(join(folder, entry.name)) : [join(folder, entry.name)]));
}

function contentType(file) {
  const type = CONTENT_TYPES[extname(file)];
  if (type === undefined) throw new Error(`${file}: of what content type is it? Name it in embed.mjs`);
  return type;
}

function arrayOf(bytes, index) {
  const lines = [];
  for (let begin = 0; begin < bytes.length; begin += 32)
    lines.push(`    ${bytes.subarray(begin, begin + 32).join(",")},`);
  return `constexpr std::array<std::uint8_t, ${bytes.length}> kFile${index}{\n${lines.join("\n")}\n};\n`;
}

const [folder, output] = process.argv.slice(2);
const files = filesOf(folder).map((file) => ({
  path: `/${relative(folder, file)}`,
  type: contentType(file),
  bytes: gzipSync(readFileSync(file), { level: 9 }),
}));
const arrays = files.map((file, index) => arrayOf(file.bytes, index));
const table = files.map((file, index) => `    {"${file.path}", "${file.type}", true, kFile${index}},`);
writeFileSync(
  output,
  `// Written by viewer/embed.mjs.
#include "viewer/viewer_assets.hpp"

#include <array>
#include <cstdint>

namespace {

${arrays.join("\n")}
constexpr std::array<dermis::out::websocket::Asset, ${files.length}> kAssets{{
${table.join("\n")}
}};

}  // namespace

std::span<const dermis::out::websocket::Asset> dermis::viewer::assets() { return kAssets; }
`,
);
