// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";
import "../styles/tokens.css";
import "../styles/page.css";
import "../styles/controls.css";
import "./try.css";
import { App } from "../app";
import { errorText } from "../format";
import { type BoardLink, boardLinkOf } from "./board_link";
import { Boards } from "./boards";
import { makeFileList } from "./file_list";
import { ModuleEndpoint } from "./module_endpoint";
import { OpenControls } from "./open_controls";

declare global {
  /** The module and the model of the sheet, from try.html. */
  var dermisFiles: Promise<[WebAssembly.Module, ArrayBuffer]>;
}

function showInstead(text: string): void {
  document.body.replaceChildren(element("p", { role: "alert" }, text));
}

const ABOUT =
  "It begins with a simulated sheet. dermis runs in this page: no byte leaves this machine, and once it was shown it needs no network.";

/** Not before the page is at work. Nor where it may not be kept: then it needs its network. */
function keepForOffline(): void {
  navigator.serviceWorker?.register("offline.js").catch(() => undefined);
}

/** Taken out of the address: views have theirs there. A text: why there is none. */
async function takeLink(): Promise<BoardLink | string | undefined> {
  const { hash, pathname, search } = window.location;
  const link = await boardLinkOf(hash).catch(errorText);
  if (link !== undefined) window.history.replaceState(null, "", pathname + search);
  return link;
}

try {
  const taken = await takeLink();
  const link = typeof taken === "string" ? undefined : taken;
  const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  const isRehearsal = new URLSearchParams(location.search).has("rehearsal");
  const note = element("p", { role: "status", "data-role": "files-note" }, typeof taken === "string" ? taken : "");
  const endpoint = new ModuleEndpoint(worker, globalThis.dermisFiles, isRehearsal, showInstead, (words) =>
    setText(note, words),
  );
  const app = new App(endpoint);
  const isRecording = (): boolean => app.stream.parameters.value.get("/recording") === true;
  app.stream.parameters.follow(() => {
    if (isRecording()) void navigator.storage?.persist?.().catch(() => undefined);
  });
  const controls = new OpenControls(
    (file) => {
      if (isRecording()) setText(note, "A recording is going on: end it first.");
      else endpoint.openFile(file);
    },
    () => endpoint.goLive(),
  );
  app.stream.playback.follow((playback) => controls.showPlayed(playback !== undefined));
  document.body.append(
    element(
      "aside",
      { class: "about", "aria-label": "About this page", "data-role": "about" },
      element("p", {}, ABOUT),
      element(
        "div",
        { class: "about-acts" },
        new Boards(app.stream, app.suit, endpoint, link).element,
        controls.element,
        makeFileList(endpoint, (line) => setText(note, line)),
      ),
      note,
    ),
  );
  app.begin();
  app.stream.connection.follow(({ kind }) => {
    if (kind === "live") keepForOffline();
  });
} catch (error) {
  showInstead(errorText(error));
  throw error;
}
