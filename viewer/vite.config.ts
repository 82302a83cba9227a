// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { defineConfig } from "vitest/config";

/** `--mode try` builds the page of the site, with the module in a worker; else the pages of the command. */
export default defineConfig(({ mode }) => ({
  base: "./",
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1000,
    rollupOptions: { input: mode === "try" ? ["try.html"] : ["index.html", "fleet.html"] },
  },
  test: { include: ["src/**/*.test.ts"], cache: false },
}));
