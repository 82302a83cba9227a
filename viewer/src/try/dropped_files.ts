// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { FAILURE, type Files, FOLDER_OF_RECORDINGS, Folder, Refused } from "./files";

const PIECE_BYTES = 1 << 20;

function textOf(error: unknown): string {
  return error instanceof Refused && error.number === FAILURE.noSpace
    ? "there is no room left for it: free the disk, or remove this site's data in the browser's settings"
    : String(error instanceof Error ? error.message : error);
}

/** That name, or "mat-2.mcap" where it is taken: what is there stays. */
function freePath(files: Files, name: string): string {
  const dot = name.lastIndexOf(".");
  const [stem, ending] = dot > 0 ? [name.slice(0, dot), name.slice(dot)] : [name, ""];
  let path = `${FOLDER_OF_RECORDINGS}/${name}`;
  for (let number = 2; files.find(path) !== undefined; ++number)
    path = `${FOLDER_OF_RECORDINGS}/${stem}-${number}${ending}`;
  return path;
}

/** Puts a file of the user into the folder of the page, piece by piece. Returns its path. */
export async function keepDropped(files: Files, dropped: File): Promise<string> {
  if (!(files.find(FOLDER_OF_RECORDINGS) instanceof Folder)) files.createFolder(FOLDER_OF_RECORDINGS);
  const unfinished = freePath(files, `${dropped.name}.dropped`);
  const kept = files.create(unfinished);
  try {
    for (let at = 0; at < dropped.size; at += PIECE_BYTES) {
      const piece = await dropped.slice(at, at + PIECE_BYTES).arrayBuffer();
      kept.content.write(new Uint8Array(piece), at);
    }
    const path = freePath(files, dropped.name);
    files.rename(unfinished, path);
    return path;
  } catch (error) {
    files.remove(unfinished);
    throw new Error(`${dropped.name}: ${textOf(error)}`);
  }
}
