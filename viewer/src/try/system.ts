// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { CallMemory } from "./call_memory";
import { type Entry, FAILURE, File, type Files, Folder, Refused } from "./files";

const OK = 0;
const REALTIME = 0;
const FIRST_OF_FILES = 4;
const ROOT = 3;
const KIND = { terminal: 2, folder: 3, file: 4 } as const;
const OPEN = { create: 1, folder: 2, onlyNew: 4, empty: 8 } as const;
const APPEND = 1;
const FROM = { begin: 0, here: 1, end: 2 } as const;
const SET_MODIFIED = 4;
const LOCK = { shared: 1, alone: 2, release: 8 } as const;
const DIRENT_BYTES = 24;
const utf8 = new TextEncoder();

/** The system below the module: files, clocks, random numbers. */
export interface System {
  readonly imports: WebAssembly.Imports;
  /** The memory of the module; not before it is there. */
  memory: WebAssembly.Memory | undefined;
}

/** An open file; those that share it are at the same place. */
interface Opened {
  readonly file: File;
  readonly isAppended: boolean;
  at: number;
  holders: number;
}

type Descriptor = Opened | { readonly path: string; readonly folder: Folder };

/** `/a/./b/../c` as `/a/c`. */
function plain(path: string): string {
  const parts: string[] = [];
  for (const part of path.split("/")) {
    if (part === "..") parts.pop();
    else if (part !== "" && part !== ".") parts.push(part);
  }
  return `/${parts.join("/")}`;
}

class Calls {
  readonly #files: Files;
  readonly #memory: CallMemory;
  readonly #descriptors = new Map<number, Descriptor>();

  constructor(files: Files, memory: CallMemory) {
    this.#files = files;
    this.#memory = memory;
    this.#descriptors.set(ROOT, this.#open("/", files.find("/")!, 0, 0));
  }

  clock_time_get(clock: number, _precision: bigint, place: number): void {
    const sinceMs = clock === REALTIME ? performance.timeOrigin + performance.now() : performance.now();
    this.#memory.put64(place, BigInt(Math.round(sinceMs * 1e6)));
  }

  random_get(place: number, size: number): void {
    const most = 65536;
    for (let at = 0; at < size; at += most) {
      crypto.getRandomValues(this.#memory.bytes(place + at, Math.min(most, size - at)));
    }
  }

  environ_sizes_get(count: number, size: number): void {
    this.#memory.put32(count, 0);
    this.#memory.put32(size, 0);
  }

  environ_get(): void {}

  args_sizes_get(count: number, size: number): void {
    this.environ_sizes_get(count, size);
  }

  args_get(): void {}

  proc_exit(status: number): never {
    throw new Error(`dermis has ended with ${status}`);
  }

  fd_prestat_get(descriptor: number, place: number): void {
    if (descriptor !== ROOT) throw new Refused(FAILURE.badDescriptor);
    this.#memory.put32(place, 0);
    this.#memory.put32(place + 4, 1);
  }

  fd_prestat_dir_name(_descriptor: number, place: number, _size: number): void {
    this.#memory.bytes(place, 1).set(utf8.encode("/"));
  }

  fd_fdstat_get(descriptor: number, place: number): void {
    const all = 0xffff_ffff_ffff_ffffn;
    this.#memory.bytes(place, 24).fill(0);
    this.#memory.bytes(place, 1)[0] = this.#kind(descriptor);
    this.#memory.put64(place + 8, all);
    this.#memory.put64(place + 16, all);
  }

  fd_fdstat_set_flags(): void {}

  path_open(
    folder: number,
    _lookup: number,
    path: number,
    pathSize: number,
    flags: number,
    _rights: bigint,
    _inherited: bigint,
    status: number,
    place: number,
  ): void {
    const name = this.#path(folder, path, pathSize);
    let entry = this.#files.find(name);
    if (entry !== undefined && (flags & OPEN.onlyNew) !== 0) throw new Refused(FAILURE.alreadyThere);
    if (entry === undefined && (flags & OPEN.create) !== 0) entry = this.#files.create(name);
    if (entry === undefined) throw new Refused(FAILURE.notThere);
    if (entry instanceof File && (flags & OPEN.folder) !== 0) throw new Refused(FAILURE.noFolder);
    this.#memory.put32(place, this.#add(this.#open(name, entry, flags, status)));
  }

  fd_close(descriptor: number): void {
    const closed = this.#descriptors.get(descriptor);
    if (!closed) throw new Refused(FAILURE.badDescriptor);
    this.#descriptors.delete(descriptor);
    if ("folder" in closed || --closed.holders > 0) return;
    this.#unlock(closed);
    closed.file.close();
  }

  fd_read(descriptor: number, parts: number, count: number, place: number): void {
    const opened = this.#opened(descriptor);
    const read = this.#read(opened.file, parts, count, opened.at);
    opened.at += read;
    this.#memory.put32(place, read);
  }

  fd_pread(descriptor: number, parts: number, count: number, at: bigint, place: number): void {
    this.#memory.put32(place, this.#read(this.#opened(descriptor).file, parts, count, Number(at)));
  }

  fd_write(descriptor: number, parts: number, count: number, place: number): void {
    this.#memory.put32(place, descriptor < ROOT ? this.#print(parts, count) : this.#append(descriptor, parts, count));
  }

  fd_pwrite(descriptor: number, parts: number, count: number, at: bigint, place: number): void {
    this.#memory.put32(place, this.#write(this.#opened(descriptor).file, parts, count, Number(at)));
  }

  fd_seek(descriptor: number, offset: bigint, from: number, place: number): void {
    const opened = this.#opened(descriptor);
    const begin = from === FROM.begin ? 0 : from === FROM.here ? opened.at : opened.file.content.size();
    const at = begin + Number(offset);
    if (at < 0) throw new Refused(FAILURE.invalid);
    opened.at = at;
    this.#memory.put64(place, BigInt(at));
  }

  fd_tell(descriptor: number, place: number): void {
    this.#memory.put64(place, BigInt(this.#opened(descriptor).at));
  }

  fd_sync(descriptor: number): void {
    const descriptors = this.#descriptors.get(descriptor);
    if (descriptors && "file" in descriptors) descriptors.file.content.flush();
  }

  fd_datasync(descriptor: number): void {
    this.fd_sync(descriptor);
  }

  fd_filestat_get(descriptor: number, place: number): void {
    const described = this.#descriptors.get(descriptor);
    if (!described) throw new Refused(FAILURE.badDescriptor);
    this.#putStatus(place, "folder" in described ? described.folder : described.file);
  }

  fd_filestat_set_size(descriptor: number, size: bigint): void {
    this.#opened(descriptor).file.content.resize(Number(size));
  }

  fd_filestat_set_times(descriptor: number, _accessed: bigint, modified: bigint, flags: number): void {
    setModified(this.#opened(descriptor).file, modified, flags);
  }

  path_filestat_get(folder: number, _lookup: number, path: number, pathSize: number, place: number): void {
    this.#putStatus(place, this.#entry(folder, path, pathSize));
  }

  path_filestat_set_times(
    folder: number,
    _lookup: number,
    path: number,
    pathSize: number,
    _accessed: bigint,
    modified: bigint,
    flags: number,
  ): void {
    const entry = this.#entry(folder, path, pathSize);
    if (entry instanceof File) setModified(entry, modified, flags);
  }

  path_create_directory(folder: number, path: number, pathSize: number): void {
    this.#files.createFolder(this.#path(folder, path, pathSize));
  }

  path_remove_directory(folder: number, path: number, pathSize: number): void {
    this.#files.removeFolder(this.#path(folder, path, pathSize));
  }

  path_unlink_file(folder: number, path: number, pathSize: number): void {
    this.#files.remove(this.#path(folder, path, pathSize));
  }

  path_rename(folder: number, path: number, pathSize: number, folderTo: number, to: number, toSize: number): void {
    this.#files.rename(this.#path(folder, path, pathSize), this.#path(folderTo, to, toSize));
  }

  fd_readdir(descriptor: number, place: number, size: number, cookie: bigint, used: number): void {
    const described = this.#descriptors.get(descriptor);
    if (!described || !("folder" in described)) throw new Refused(FAILURE.noFolder);
    const { path } = described;
    const into = this.#memory.bytes(place, size);
    let at = 0;
    for (const [index, name] of this.#files.list(path).entries()) {
      if (index < Number(cookie)) continue;
      const entry = direntOf(name, index + 1, this.#files.find(plain(`${path}/${name}`))!);
      into.set(entry.subarray(0, Math.min(entry.length, size - at)), at);
      at = Math.min(size, at + entry.length);
      if (at === size) break;
    }
    this.#memory.put32(used, at);
  }

  /** dup() of POSIX. Returns the descriptor; below 0: the error. */
  duplicate(descriptor: number): number {
    const opened = this.#descriptors.get(descriptor);
    if (!opened) return -FAILURE.badDescriptor;
    if ("file" in opened) ++opened.holders;
    return this.#add(opened);
  }

  /** flock() of POSIX, which never waits. Returns 0, or the error. */
  lock(descriptor: number, how: number): number {
    const opened = this.#descriptors.get(descriptor);
    if (!opened) return FAILURE.badDescriptor;
    if ("folder" in opened) return OK;
    const { file } = opened;
    this.#unlock(opened);
    if ((how & LOCK.release) !== 0) return OK;
    const isAlone = (how & LOCK.alone) !== 0;
    if (file.lockedBy.size > 0 && (isAlone || file.isLockedAlone)) return FAILURE.wouldWait;
    file.lockedBy.add(opened);
    file.isLockedAlone = isAlone;
    return OK;
  }

  #unlock(opened: Opened): void {
    if (opened.file.lockedBy.delete(opened)) opened.file.isLockedAlone = false;
  }

  #open(path: string, entry: Entry, flags: number, status: number): Descriptor {
    if (entry instanceof Folder) return { path, folder: entry };
    if ((flags & OPEN.empty) !== 0) entry.content.resize(0);
    ++entry.opened;
    return { file: entry, isAppended: (status & APPEND) !== 0, at: 0, holders: 1 };
  }

  #add(descriptor: Descriptor): number {
    let free = FIRST_OF_FILES;
    while (this.#descriptors.has(free)) ++free;
    this.#descriptors.set(free, descriptor);
    return free;
  }

  #opened(descriptor: number): Opened {
    const opened = this.#descriptors.get(descriptor);
    if (!opened) throw new Refused(FAILURE.badDescriptor);
    if ("folder" in opened) throw new Refused(FAILURE.isFolder);
    return opened;
  }

  #entry(folder: number, path: number, pathSize: number): Entry {
    const entry = this.#files.find(this.#path(folder, path, pathSize));
    if (entry === undefined) throw new Refused(FAILURE.notThere);
    return entry;
  }

  #path(folder: number, place: number, size: number): string {
    const within = this.#descriptors.get(folder);
    if (!within || !("folder" in within)) throw new Refused(FAILURE.noFolder);
    return plain(`${within.path}/${this.#memory.text(place, size)}`);
  }

  #kind(descriptor: number): number {
    if (descriptor < ROOT) return KIND.terminal;
    const described = this.#descriptors.get(descriptor);
    if (!described) throw new Refused(FAILURE.badDescriptor);
    return "folder" in described ? KIND.folder : KIND.file;
  }

  #read(file: File, parts: number, count: number, at: number): number {
    let read = 0;
    for (const piece of this.#memory.pieces(parts, count)) {
      const got = file.content.read(piece, at + read);
      read += got;
      if (got < piece.length) break;
    }
    return read;
  }

  /** Writes where the descriptor is. */
  #append(descriptor: number, parts: number, count: number): number {
    const opened = this.#opened(descriptor);
    if (opened.isAppended) opened.at = opened.file.content.size();
    const written = this.#write(opened.file, parts, count, opened.at);
    opened.at += written;
    return written;
  }

  #write(file: File, parts: number, count: number, at: number): number {
    let written = 0;
    for (const piece of this.#memory.pieces(parts, count)) {
      file.content.write(piece, at + written);
      written += piece.length;
    }
    file.modifiedMs = Date.now();
    return written;
  }

  #print(parts: number, count: number): number {
    const pieces = this.#memory.pieces(parts, count);
    console.warn(pieces.map((piece) => new TextDecoder().decode(piece)).join(""));
    return pieces.reduce((sum, { length }) => sum + length, 0);
  }

  #putStatus(place: number, entry: Entry): void {
    const isFile = entry instanceof File;
    this.#memory.bytes(place, 64).fill(0);
    this.#memory.put64(place + 8, BigInt(entry.id));
    this.#memory.bytes(place + 16, 1)[0] = isFile ? KIND.file : KIND.folder;
    this.#memory.put64(place + 24, 1n);
    this.#memory.put64(place + 32, BigInt(isFile ? entry.content.size() : 0));
    const modified = BigInt(Math.round(isFile ? entry.modifiedMs * 1e6 : 0));
    for (const time of [40, 48, 56]) this.#memory.put64(place + time, modified);
  }
}

function setModified(file: File, modified: bigint, flags: number): void {
  file.modifiedMs = (flags & SET_MODIFIED) !== 0 ? Number(modified) / 1e6 : Date.now();
}

function direntOf(name: string, next: number, entry: Entry): Uint8Array {
  const text = utf8.encode(name);
  const dirent = new Uint8Array(DIRENT_BYTES + text.length);
  const view = new DataView(dirent.buffer);
  view.setBigUint64(0, BigInt(next), true);
  view.setBigUint64(8, BigInt(entry.id), true);
  view.setUint32(16, text.length, true);
  view.setUint8(20, entry instanceof Folder ? KIND.folder : KIND.file);
  dirent.set(text, DIRENT_BYTES);
  return dirent;
}

function numberOf(error: unknown): number {
  if (error instanceof Refused) return error.number;
  const isFull = error instanceof RangeError || (error as Error).name === "QuotaExceededError"; // memory, or disk
  if (isFull) return FAILURE.noSpace;
  if (error instanceof DOMException) return FAILURE.inputOrOutput;
  throw error;
}

/** The functions of WASI that the module calls, over the files of the page, and two of POSIX that WASI lacks. */
export function systemOf(files: Files): System {
  const system: System = { imports: {}, memory: undefined };
  const calls = new Calls(files, new CallMemory(() => system.memory!));
  const known = calls as unknown as Record<string, (...numbers: never[]) => void>;
  const answer =
    (name: string) =>
    (...numbers: never[]): number => {
      if (!known[name]) return FAILURE.notKnown;
      try {
        known[name](...numbers);
        return OK;
      } catch (error) {
        return numberOf(error);
      }
    };
  const wasi = new Proxy({}, { get: (_, name: string) => answer(name) });
  const posix = {
    duplicate: (descriptor: number) => calls.duplicate(descriptor),
    lock: (descriptor: number, how: number) => calls.lock(descriptor, how),
  };
  Object.assign(system, { imports: { wasi_snapshot_preview1: wasi, dermis: posix } });
  return system;
}
