// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { Endpoint, Socket } from "../stream/endpoint";

/** The page asks its worker to begin with these files, to take a client, or for a document. */
export type Question =
  | { module: string; model: string; isRehearsal: boolean }
  | { port: MessagePort }
  | { id: number; path: string };
export type Answer = { id: number; document?: string | Uint8Array<ArrayBuffer> | undefined; failure?: string };

/** dermis in a worker of the page, in the place of a server. */
export class ModuleEndpoint implements Endpoint {
  readonly token = "";
  readonly #worker: Worker;
  readonly #failed: (why: string) => void;
  readonly #asked = new Map<number, (answer: Answer) => void>();
  #lastId = 0;

  /**
   * `module` and `model`: addresses of the files to begin with. `isRehearsal`: with a hand that obeys the guide of a
   * calibration. `failed` is told why that could not be.
   */
  constructor(worker: Worker, module: string, model: string, isRehearsal: boolean, failed: (why: string) => void) {
    this.#worker = worker;
    this.#failed = failed;
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      this.#asked.get(data.id)?.(data);
      this.#asked.delete(data.id);
    };
    worker.onerror = ({ message }) => failed(message);
    this.#ask({ module, model, isRehearsal });
  }

  async fetch(path: string): Promise<Response> {
    const id = ++this.#lastId;
    const { document, failure } = await new Promise<Answer>((resolve) => {
      this.#asked.set(id, resolve);
      this.#ask({ id, path: `/${path}` });
    });
    if (failure !== undefined) {
      this.#failed(failure);
      throw new Error(failure);
    }
    return document === undefined ? new Response(null, { status: 404 }) : new Response(document);
  }

  open(): Socket {
    const { port1, port2 } = new MessageChannel();
    this.#ask({ port: port2 }, [port2]);
    return {
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
  }

  #ask(question: Question, handedOver: Transferable[] = []): void {
    this.#worker.postMessage(question, handedOver);
  }
}
