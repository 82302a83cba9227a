// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { type Content, FAILURE, File, Files, MemoryContent, Refused } from "./files";

/** A FileSystemSyncAccessHandle, which workers have. */
interface Handle {
  getSize(): number;
  read(into: Uint8Array, options: { at: number }): number;
  write(from: Uint8Array, options: { at: number }): number;
  truncate(size: number): void;
  flush(): void;
  close(): void;
}

type FileOfBrowser = globalThis.File;
type Opener = FileSystemFileHandle & { createSyncAccessHandle(): Promise<Handle> };

/** Before the bytes of a file stands its path: "dermis 1", the generation, the length of the path, the path. */
const HEAD_BYTES = 4096;
const MAGIC = "dermis 1";
const GENERATION = 8;
const LENGTH = 16;
const PATH = 20;
const FREE_AT_LEAST = 8;
const FOLDER = "dermis";
const LOCK = "dermis files";

/** A file that the browser keeps, of which a handle is open as long as the page. */
class KeptContent implements Content {
  readonly #handle: Handle;
  readonly #opener: Opener;
  readonly #free: (content: KeptContent) => void;
  readonly #nextGeneration: () => number;

  constructor(handle: Handle, opener: Opener, free: (content: KeptContent) => void, nextGeneration: () => number) {
    this.#handle = handle;
    this.#opener = opener;
    this.#free = free;
    this.#nextGeneration = nextGeneration;
  }

  size(): number {
    return Math.max(0, this.#handle.getSize() - HEAD_BYTES);
  }

  read(into: Uint8Array, at: number): number {
    return this.#handle.read(into, { at: HEAD_BYTES + at });
  }

  write(from: Uint8Array, at: number): void {
    this.#put(from, HEAD_BYTES + at);
  }

  resize(size: number): void {
    this.#handle.truncate(HEAD_BYTES + size);
  }

  flush(): void {
    this.#handle.flush();
  }

  keepAs(path: string | undefined): void {
    this.#writeHead(path ?? "");
    if (path !== undefined) return;
    this.#handle.truncate(HEAD_BYTES);
    this.#free(this);
  }

  /** The path that is in the file, and its generation; undefined: it is free. */
  head(): { path: string; generation: number } | undefined {
    const head = new Uint8Array(HEAD_BYTES);
    if (this.#handle.read(head, { at: 0 }) < HEAD_BYTES) return undefined;
    const view = new DataView(head.buffer);
    const length = view.getUint32(LENGTH, true);
    const isOurs = new TextDecoder().decode(head.subarray(0, MAGIC.length)) === MAGIC;
    if (!isOurs || length === 0 || PATH + length > HEAD_BYTES) return undefined;
    const path = new TextDecoder().decode(head.subarray(PATH, PATH + length));
    return { path, generation: view.getFloat64(GENERATION, true) };
  }

  /** Its bytes, without reading them. */
  async blob(): Promise<Blob> {
    return (await this.file()).slice(HEAD_BYTES);
  }

  file(): Promise<FileOfBrowser> {
    return this.#opener.getFile();
  }

  #writeHead(path: string): void {
    const head = new Uint8Array(HEAD_BYTES);
    const text = new TextEncoder().encode(path);
    if (PATH + text.length > HEAD_BYTES) throw new Refused(FAILURE.invalid);
    const view = new DataView(head.buffer);
    head.set(new TextEncoder().encode(MAGIC));
    view.setFloat64(GENERATION, this.#nextGeneration(), true);
    view.setUint32(LENGTH, text.length, true);
    head.set(text, PATH);
    this.#put(head, 0);
    this.#handle.flush();
  }

  /** Chromium tells a full disk by an exception, or by a number beyond that of the bytes. */
  #put(bytes: Uint8Array, at: number): void {
    if (this.#handle.write(bytes, { at }) !== bytes.length) throw new Refused(FAILURE.noSpace);
  }
}

/** Files that the browser keeps when the page is closed: in its origin private file system. */
class Keeper {
  readonly #folder: FileSystemDirectoryHandle;
  readonly #free: KeptContent[] = [];
  #lastName = 0;
  #generation = 0;

  constructor(folder: FileSystemDirectoryHandle) {
    this.#folder = folder;
  }

  take(): Content {
    return this.#free.pop() ?? new MemoryContent();
  }

  /** Opens all that is kept, and gives it its paths. */
  async open(files: Files): Promise<void> {
    const kept = [];
    for await (const [name, opener] of this.#folder as unknown as AsyncIterable<[string, Opener]>) {
      this.#lastName = Math.max(this.#lastName, Number(name));
      const content = await this.#content(opener);
      const head = content.head();
      if (head === undefined) content.keepAs(undefined);
      else kept.push({ ...head, content, modifiedMs: (await content.file()).lastModified });
    }
    kept.sort((one, other) => other.generation - one.generation);
    this.#generation = kept[0]?.generation ?? 0;
    for (const { path, content, modifiedMs } of kept) {
      if (files.find(path) !== undefined) content.keepAs(undefined);
      else addWithFolders(files, path, content).modifiedMs = modifiedMs;
    }
  }

  /** Has files ready for those that the module will make, which cannot wait, and brings there what is in memory. */
  async settle(files: Files): Promise<void> {
    const inMemory = files.all().filter(({ content }) => content instanceof MemoryContent);
    while (this.#free.length < FREE_AT_LEAST + inMemory.length) {
      const opener = await this.#folder.getFileHandle(String(++this.#lastName), { create: true });
      this.#free.push(await this.#content(opener as Opener));
    }
    for (const file of inMemory) this.#move(file);
  }

  #move(file: File): void {
    if (file.path === undefined) return;
    const bytes = new Uint8Array(file.content.size());
    file.content.read(bytes, 0);
    const content = this.take();
    try {
      content.write(bytes, 0);
      content.keepAs(file.path);
    } catch (error) {
      content.keepAs(undefined);
      throw error;
    }
    file.content = content;
  }

  async #content(opener: Opener): Promise<KeptContent> {
    const handle = await opener.createSyncAccessHandle();
    const free = (content: KeptContent): void => {
      this.#free.push(content);
    };
    return new KeptContent(handle, opener, free, () => ++this.#generation);
  }
}

function addWithFolders(files: Files, path: string, content: Content): File {
  for (let end = path.indexOf("/", 1); end > 0; end = path.indexOf("/", end + 1)) {
    const folder = path.slice(0, end);
    if (files.find(folder) === undefined) files.createFolder(folder);
  }
  return files.add(path, content);
}

/** Holds the lock as long as the page is open. */
function takeLock(): Promise<boolean> {
  return new Promise((answer, refused) => {
    const held = navigator.locks.request(LOCK, { ifAvailable: true }, (lock) => {
      answer(lock !== null);
      return lock === null ? undefined : new Promise(() => undefined);
    });
    held.catch(refused);
  });
}

export interface PageFiles {
  readonly files: Files;
  /** Why they are gone with the page; undefined: they are kept. */
  readonly lost: string | undefined;
  /** Call it now and then. */
  settle(): Promise<void>;
}

function inMemory(lost: string): PageFiles {
  return { files: new Files(), lost, settle: () => Promise.resolve() };
}

/** The files of the page, as they were when it was open last. */
export async function openFiles(): Promise<PageFiles> {
  try {
    const isOurs = await takeLock();
    if (!isOurs) {
      return inMemory(
        "Another tab of this page has its files. What is recorded or saved here is gone with this tab: close the other one, and load this one again.",
      );
    }
    const root = await navigator.storage.getDirectory();
    const keeper = new Keeper(await root.getDirectoryHandle(FOLDER, { create: true }));
    const files = new Files(() => keeper.take());
    await keeper.open(files);
    await keeper.settle(files);
    return { files, lost: undefined, settle: () => keeper.settle(files) };
  } catch {
    return inMemory(
      "This browser keeps no files for this page. What is recorded or saved here is gone with this tab: save it before.",
    );
  }
}

/** The bytes of a file, which need not be in memory; undefined: there is none. */
export async function blobOf(files: Files, path: string): Promise<Blob | undefined> {
  const file = files.find(path);
  if (!(file instanceof File)) return undefined;
  return file.content instanceof KeptContent ? file.content.blob() : new Blob([files.bytes(path)!]);
}
