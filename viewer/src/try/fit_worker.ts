// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { errorText } from "../format";
import { type Copy, Module } from "./module";

/** The course of a fit: the share done so far; at last its outcome, or why there is none. */
export type News = { share: number } | { outcome: Uint8Array<ArrayBuffer> } | { failure: string };

function tell(news: News): void {
  postMessage(news);
}

async function fit(copy: Copy): Promise<void> {
  try {
    tell({ outcome: await Module.fit(copy, (share) => tell({ share })) });
  } catch (error) {
    tell({ failure: errorText(error) });
  }
}

addEventListener("message", ({ data }: MessageEvent<Copy>) => void fit(data));
