// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element } from "../dom";
import { errorText } from "../format";
import { sizeText } from "../take/save_file";
import { FILE_LIST, type ModuleEndpoint } from "./module_endpoint";

/** The files of the page, each of which can be saved and removed: models, array.toml, recordings. Read when it is opened. */
export function makeFileList(kept: ModuleEndpoint, tell: (line: string) => void): HTMLElement {
  const list = element("ul", { class: "file-list" });
  const entry = (path: string, bytes: number): HTMLElement => {
    const name = path.slice(path.lastIndexOf("/") + 1);
    const save = (): void =>
      void kept.save(encodeURIComponent(path.slice(1)), "", name).catch((error) => tell(errorText(error)));
    const remove = (): void => {
      if (!window.confirm(`Remove ${name} for good?`)) return;
      kept.remove(path).then(read, (error) => tell(errorText(error)));
    };
    return element(
      "li",
      { "data-file": path },
      `${path.slice(1)}, ${sizeText(bytes)} `,
      button("Save", save, { "aria-label": `Save ${name}` }),
      " ",
      button("Remove", remove, { "aria-label": `Remove ${name}` }),
    );
  };
  const read = async (): Promise<void> => {
    const files: [string, number][] = await (await kept.fetch(FILE_LIST)).json();
    const entries = files.map(([path, bytes]) => entry(path, bytes));
    list.replaceChildren(...(entries.length > 0 ? entries : [element("li", {}, "There is none yet.")]));
  };
  const details = element(
    "details",
    { class: "files", "data-role": "files" },
    element("summary", {}, "Files of this page"),
    list,
  );
  details.addEventListener("toggle", () => {
    if (details.open) read().catch((error) => tell(errorText(error)));
  });
  return details;
}
