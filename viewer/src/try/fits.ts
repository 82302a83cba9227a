// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { errorText } from "../format";
import type { News } from "./fit_worker";
import type { Fitter, Module } from "./module";

/** Each fit in a worker of its own, which ends with it: so the map stays live meanwhile, and a fit can be left off. */
export class Fits implements Fitter {
  #worker: Worker | undefined;

  begin(module: Module): void {
    this.end();
    const worker = new Worker(new URL("./fit_worker.ts", import.meta.url), { type: "module" });
    this.#worker = worker;
    const hear = (news: News): void => {
      if (this.#worker !== worker) return;
      if ("share" in news) {
        module.fitShare(news.share);
        return;
      }
      this.end();
      if ("outcome" in news) module.fitDone(news.outcome);
      else module.fitFailed(`its worker ended (${news.failure}); perhaps this page has too little memory`);
    };
    worker.onmessage = ({ data }: MessageEvent<News>) => hear(data);
    worker.onerror = (error) => {
      error.preventDefault(); // it is none of the page
      hear({ failure: error.message });
    };
    try {
      const copy = module.copy();
      worker.postMessage(copy, [copy.memory]);
    } catch (error) {
      queueMicrotask(() => hear({ failure: errorText(error) })); // the module waits for this call to return
    }
  }

  end(): void {
    this.#worker?.terminate();
    this.#worker = undefined;
  }
}
