// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { cssGradient } from "./render/color_map";
import type { Rgb } from "./render/heat_maps";
import { setting } from "./settings";
import { Signal } from "./signal";

export type ThemeName = "light" | "dark";

/** Light or dark: as the system has it until the user chooses. */
export class Theme {
  readonly shown: Signal<ThemeName>;
  readonly #choice = setting<"auto" | ThemeName>("theme", "auto", (value) => ["auto", "light", "dark"].includes(value));
  readonly #system = window.matchMedia("(prefers-color-scheme: dark)");

  constructor() {
    this.shown = new Signal(this.#resolve());
    this.shown.follow((name) => {
      document.documentElement.dataset.theme = name;
      document.documentElement.style.setProperty("--color-scale", cssGradient(name === "light"));
    });
    this.#choice.follow(() => (this.shown.value = this.#resolve()));
    this.#system.addEventListener("change", () => (this.shown.value = this.#resolve()));
  }

  toggle(): void {
    this.#choice.value = this.shown.value === "dark" ? "light" : "dark";
  }

  #resolve(): ThemeName {
    const choice = this.#choice.value;
    if (choice !== "auto") return choice;
    return this.#system.matches ? "dark" : "light";
  }
}

/** The value of a CSS variable: "--line". */
export function cssColor(variable: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(variable).trim();
}

/** The colour of a CSS variable that holds #rrggbb, in 0 ... 1. */
export function rgbColor(variable: string): Rgb {
  const bits = Number.parseInt(cssColor(variable).slice(1), 16);
  return [((bits >> 16) & 255) / 255, ((bits >> 8) & 255) / 255, (bits & 255) / 255];
}
