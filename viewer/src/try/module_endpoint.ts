// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

import { errorText } from "../format";
import type { Endpoint, Socket } from "../stream/endpoint";
import { saveBlob } from "../take/save_file";

/** The page asks its worker to begin with these files, to take a client, for a document, or to remove a file. */
export type Question =
  | { module: WebAssembly.Module; model: ArrayBuffer; isRehearsal: boolean }
  | { port: MessagePort }
  | { id: number; path: string }
  | { id: number; remove: string }
  | { opened: File }
  | { goLive: true }
  | BoardNews;
/** A note: what the user should know of the files. */
export type Answer = { id: number; document?: string | Blob | undefined; failure?: string } | { note: string };
type Document = Exclude<Answer, { note: string }>;

/** News of the board for the worker: it is open, or lost; its bytes. Or that somebody will describe its array. */
export type BoardNews =
  | { board: string; baud: number }
  | { lost: true }
  | { bytes: Uint8Array<ArrayBuffer> }
  | { setup: true };
/** Requests of the worker to the page: how to open the board, what to write to it, how long the worker was asleep [s]. */
export type BoardRequest = { open: number } | { write: Uint8Array<ArrayBuffer> } | { slept: number };
/** The document that lists the files of the page: [path, bytes] of each. */
export const FILE_LIST = "files-of-this-page.json";
/** In the place of a message of the server: it is another one from now on. */
export const SERVER_HAS_CHANGED = null;

/** dermis in a worker of the page, in the place of a server. */
export class ModuleEndpoint implements Endpoint {
  readonly token = "";
  readonly #worker: Worker;
  readonly #failed: (why: string) => void;
  readonly #asked = new Map<number, (answer: Document) => void>();
  #lastId = 0;
  /** Is asked for what only the page can do with a board. */
  onRequest: (request: BoardRequest) => void = () => undefined;

  /**
   * `files`: the module and the model of a sheet. `isRehearsal`: with a hand that obeys the guide of a
   * calibration. `failed` is told why that could not be, `told` what the user should know of the files of the page.
   */
  constructor(
    worker: Worker,
    files: Promise<[WebAssembly.Module, ArrayBuffer]>,
    isRehearsal: boolean,
    failed: (why: string) => void,
    told: (note: string) => void,
  ) {
    this.#worker = worker;
    this.#failed = failed;
    worker.onmessage = ({ data }: MessageEvent<Answer | BoardRequest>) => {
      if ("note" in data) return told(data.note);
      if (!("id" in data)) return this.onRequest(data);
      this.#asked.get(data.id)?.(data);
      this.#asked.delete(data.id);
    };
    worker.onerror = ({ message }) => failed(message);
    files.then(
      ([module, model]) => this.#ask({ module, model, isRehearsal }),
      (error) => failed(errorText(error)),
    );
  }

  async fetch(path: string): Promise<Response> {
    const document = await this.#document(path);
    return document === undefined ? new Response(null, { status: 404 }) : new Response(document);
  }

  async save(path: string, _token: string, name: string): Promise<void> {
    const document = await this.#document(path);
    if (document === undefined) throw new Error(`${name} is not there.`);
    saveBlob(new Blob([document]), name);
  }

  /** From the files of the page. Fails where it is in use. */
  async remove(path: string): Promise<void> {
    const { failure } = await this.#answer((id) => ({ id, remove: path }));
    if (failure !== undefined) throw new Error(failure);
  }

  /** Puts a file into the folder of the page, and plays or uses it. */
  openFile(opened: File): void {
    this.#ask({ opened });
  }

  /** The sheet in the place of a recording. */
  goLive(): void {
    this.#ask({ goLive: true });
  }

  open(): Socket {
    const { port1, port2 } = new MessageChannel();
    this.#ask({ port: port2 }, [port2]);
    return new ModuleSocket(port1);
  }

  tell(news: BoardNews): void {
    this.#ask(news);
  }

  async #document(path: string): Promise<string | Blob | undefined> {
    const { document, failure } = await this.#answer((id) => ({ id, path: `/${path}` }));
    if (failure === undefined) return document;
    if (path === "suit.json") this.#failed(failure);
    throw new Error(failure);
  }

  #answer(question: (id: number) => Question): Promise<Document> {
    const id = ++this.#lastId;
    return new Promise((resolve) => {
      this.#asked.set(id, resolve);
      this.#ask(question(id));
    });
  }

  #ask(question: Question, handedOver: Transferable[] = []): void {
    this.#worker.postMessage(question, handedOver);
  }
}

class ModuleSocket implements Socket {
  onmessage: Socket["onmessage"] = null;
  onclose: Socket["onclose"] = null;
  readyState: number = WebSocket.OPEN;

  constructor(private readonly port: MessagePort) {
    port.onmessage = (event: MessageEvent<string | ArrayBuffer | typeof SERVER_HAS_CHANGED>) => {
      if (event.data !== SERVER_HAS_CHANGED) return this.onmessage?.(event as MessageEvent<string | ArrayBuffer>);
      this.close();
      this.onclose?.(new CloseEvent("close"));
    };
  }

  send(message: string | Uint8Array<ArrayBuffer>): void {
    this.port.postMessage(message);
  }

  close(): void {
    this.readyState = WebSocket.CLOSED;
    this.port.close();
  }
}
