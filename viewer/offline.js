// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// The page of site/try without a network: all of its files, of one version. scripts/try_page writes which. A new version
// waits until no page has the old one.
const OURS = "dermis-try-";
const VERSION = `${OURS}@VERSION@`;
const FILES = "@FILES@".split(" ");

async function keep() {
  const cache = await caches.open(VERSION);
  await cache.addAll(FILES.map((file) => new Request(file, { cache: "no-cache" })));
}

async function removeOthers() {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith(OURS) && name !== VERSION).map((name) => caches.delete(name)));
}

async function answer(request) {
  const cache = await caches.open(VERSION);
  return (await cache.match(request.mode === "navigate" ? "./" : request)) ?? fetch(request);
}

addEventListener("install", (event) => event.waitUntil(keep()));
addEventListener("activate", (event) => event.waitUntil(removeOthers()));
addEventListener("fetch", (event) => event.respondWith(answer(event.request)));
