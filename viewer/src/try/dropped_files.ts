// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { FAILURE, type Files, FOLDER_OF_RECORDINGS, Folder, Refused } from "./files";

const PIECE_BYTES = 1 << 20;

function textOf(error: unknown): string {
  return error instanceof Refused && error.number === FAILURE.noSpace
    ? "there is no room left for it; remove files of this page, or free the disk"
    : String(error instanceof Error ? error.message : error);
}

/** Puts a file of the user into the folder of the page, piece by piece. Returns its path. */
export async function keepDropped(files: Files, dropped: File): Promise<string> {
  const path = `${FOLDER_OF_RECORDINGS}/${dropped.name}`;
  const unfinished = `${path}.dropped`;
  if (!(files.find(FOLDER_OF_RECORDINGS) instanceof Folder)) files.createFolder(FOLDER_OF_RECORDINGS);
  if (files.find(unfinished) !== undefined) files.remove(unfinished);
  const { content } = files.create(unfinished);
  try {
    for (let at = 0; at < dropped.size; at += PIECE_BYTES) {
      const piece = await dropped.slice(at, at + PIECE_BYTES).arrayBuffer();
      content.write(new Uint8Array(piece), at);
    }
    files.rename(unfinished, path);
  } catch (error) {
    files.remove(unfinished);
    throw new Error(`${dropped.name}: ${textOf(error)}`);
  }
  return path;
}
