// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

import type { Endpoint, Socket } from "../stream/endpoint";
import { saveBlob } from "../take/save_file";

/** The page asks its worker to begin with these files, to take a client, or for a document. */
export type Question =
  | { module: string; model: string }
  | { port: MessagePort }
  | { id: number; path: string }
  | { opened: File }
  | { goLive: true };
export type Answer = { id: number; document?: string | Blob | undefined; failure?: string } | Change;
/** A line for the user, and whether another server has begun. */
export interface Change {
  note: string;
  isAnother?: boolean;
}
type Document = Exclude<Answer, Change>;

/** dermis in a worker of the page, in the place of a server. */
export class ModuleEndpoint implements Endpoint {
  readonly token = "";
  readonly #worker: Worker;
  readonly #failed: (why: string) => void;
  readonly #asked = new Map<number, (answer: Document) => void>();
  #lastId = 0;
  #socket: Socket | undefined;

  /**
   * `module` and `model`: addresses of the files to begin with. `failed` is told why that could not be, `told` what the
   * user should know of the files of the page.
   */
  constructor(
    worker: Worker,
    module: string,
    model: string,
    failed: (why: string) => void,
    told: (note: string) => void,
  ) {
    this.#worker = worker;
    this.#failed = failed;
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      if ("note" in data) {
        told(data.note);
        if (data.isAnother === true) this.#socket?.onclose?.(new CloseEvent("close"));
        return;
      }
      this.#asked.get(data.id)?.(data);
      this.#asked.delete(data.id);
    };
    worker.onerror = ({ message }) => failed(message);
    this.#ask({ module, model });
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
    this.#socket = {
      get onmessage() {
        return port1.onmessage;
      },
      set onmessage(handler: Socket["onmessage"]) {
        port1.onmessage = handler;
      },
      onclose: null,
      readyState: WebSocket.OPEN,
      send: (message) => port1.postMessage(message),
      close: () => port1.close(),
    };
    return this.#socket;
  }

  async #document(path: string): Promise<string | Blob | undefined> {
    const id = ++this.#lastId;
    const { document, failure } = await new Promise<Document>((resolve) => {
      this.#asked.set(id, resolve);
      this.#ask({ id, path: `/${path}` });
    });
    if (failure === undefined) return document;
    this.#failed(failure);
    throw new Error(failure);
  }

  #ask(question: Question, handedOver: Transferable[] = []): void {
    this.#worker.postMessage(question, handedOver);
  }
}
