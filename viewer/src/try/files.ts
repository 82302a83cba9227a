// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** Numbers of WASI for what can go wrong. */
export const FAILURE = {
  alreadyThere: 20,
  badDescriptor: 8,
  invalid: 28,
  inputOrOutput: 29,
  isFolder: 31,
  notThere: 44,
  noSpace: 51,
  notKnown: 52,
  noFolder: 54,
  notEmpty: 55,
  wouldWait: 6,
} as const;

/** A call of the system that fails, with one of FAILURE. */
export class Refused extends Error {
  constructor(readonly number: number) {
    super(`error ${number} of the files`);
  }
}

/** The bytes of a file. Reading and writing are those of a FileSystemSyncAccessHandle. */
export interface Content {
  size(): number;
  read(into: Uint8Array, at: number): number;
  write(from: Uint8Array, at: number): void;
  resize(size: number): void;
  flush(): void;
  /** It is the file of this path from now on; undefined: of none, and its room is free. */
  keepAs(path: string | undefined): void;
}

export const FOLDER_OF_RECORDINGS = "/recordings";

export class MemoryContent implements Content {
  #bytes = new Uint8Array(0);
  #size = 0;

  size(): number {
    return this.#size;
  }

  read(into: Uint8Array, at: number): number {
    const part = this.#bytes.subarray(at, Math.min(this.#size, at + into.length));
    into.set(part);
    return part.length;
  }

  write(from: Uint8Array, at: number): void {
    this.resize(Math.max(this.#size, at + from.length));
    this.#bytes.set(from, at);
  }

  resize(size: number): void {
    if (size > this.#bytes.length) {
      const bytes = new Uint8Array(Math.max(size, 2 * this.#bytes.length));
      bytes.set(this.#bytes.subarray(0, this.#size));
      this.#bytes = bytes;
    }
    if (size < this.#size) this.#bytes.fill(0, size, this.#size);
    this.#size = size;
  }

  flush(): void {}

  keepAs(path: string | undefined): void {
    if (path === undefined) this.#bytes = new Uint8Array(0);
  }
}

export class File {
  /** How often it is open. */
  opened = 0;
  modifiedMs = Date.now();
  /** The descriptors that have locked it. */
  readonly lockedBy = new Set<object>();
  isLockedAlone = false;

  constructor(
    readonly id: number,
    public content: Content,
    public path: string | undefined,
  ) {}

  close(): void {
    --this.opened;
    this.releaseUnused();
  }

  keepAs(path: string | undefined): void {
    this.path = path;
    if (path !== undefined) this.content.keepAs(path);
    this.releaseUnused();
  }

  private releaseUnused(): void {
    if (this.path === undefined && this.opened === 0) this.content.keepAs(undefined);
  }
}

export class Folder {
  constructor(readonly id: number) {}
}

export type Entry = File | Folder;

/** The files of the page. Paths are absolute: "/recordings/a.mcap". */
export class Files {
  readonly #entries = new Map<string, Entry>([["/", new Folder(1)]]);
  readonly #content: () => Content;
  #lastId = 1;

  constructor(content: () => Content = () => new MemoryContent()) {
    this.#content = content;
  }

  find(path: string): Entry | undefined {
    return this.#entries.get(path);
  }

  /** An empty file, in a folder that is there. */
  create(path: string): File {
    const content = this.#content();
    content.keepAs(path);
    return this.add(path, content);
  }

  add(path: string, content: Content): File {
    this.#needPlaceFor(path);
    const file = new File(++this.#lastId, content, path);
    this.#entries.set(path, file);
    return file;
  }

  createFolder(path: string): void {
    this.#needPlaceFor(path);
    this.#entries.set(path, new Folder(++this.#lastId));
  }

  remove(path: string): void {
    const file = this.#need(path);
    if (file instanceof Folder) throw new Refused(FAILURE.isFolder);
    this.#entries.delete(path);
    file.keepAs(undefined);
  }

  removeFolder(path: string): void {
    if (!(this.#need(path) instanceof Folder)) throw new Refused(FAILURE.noFolder);
    if (this.list(path).length > 0) throw new Refused(FAILURE.notEmpty);
    this.#entries.delete(path);
  }

  rename(from: string, to: string): void {
    const entry = this.#need(from);
    const replaced = this.#entries.get(to);
    if (entry === replaced) return;
    if (replaced instanceof Folder && this.list(to).length > 0) throw new Refused(FAILURE.notEmpty);
    if (replaced !== undefined && replaced.constructor !== entry.constructor) {
      throw new Refused(replaced instanceof Folder ? FAILURE.isFolder : FAILURE.noFolder);
    }
    if (replaced === undefined) this.#needPlaceFor(to);
    const within = entry instanceof Folder ? [...this.#entries].filter(([path]) => path.startsWith(`${from}/`)) : [];
    for (const [path, moved] of [[from, entry] as const, ...within]) {
      const place = to + path.slice(from.length);
      this.#entries.delete(path);
      this.#entries.set(place, moved);
      if (moved instanceof File) moved.keepAs(place);
    }
    if (replaced instanceof File) replaced.keepAs(undefined);
  }

  /** The names in a folder. */
  list(folder: string): string[] {
    const begin = folder === "/" ? "/" : `${folder}/`;
    return [...this.#entries.keys()]
      .filter((path) => path.length > begin.length && path.startsWith(begin) && !path.includes("/", begin.length))
      .map((path) => path.slice(begin.length));
  }

  all(): File[] {
    return [...this.#entries.values()].filter((entry) => entry instanceof File);
  }

  /** The bytes of a file; undefined: there is none. */
  bytes(path: string): Uint8Array<ArrayBuffer> | undefined {
    const file = this.find(path);
    if (!(file instanceof File)) return undefined;
    const bytes = new Uint8Array(file.content.size());
    file.content.read(bytes, 0);
    return bytes;
  }

  #need(path: string): Entry {
    const entry = this.#entries.get(path);
    if (entry === undefined) throw new Refused(FAILURE.notThere);
    return entry;
  }

  #needPlaceFor(path: string): void {
    if (this.#entries.has(path)) throw new Refused(FAILURE.alreadyThere);
    const parent = this.#need(path.slice(0, path.lastIndexOf("/")) || "/");
    if (!(parent instanceof Folder)) throw new Refused(FAILURE.noFolder);
  }
}
