// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { saveFrom } from "../take/save_file";
import { SUBPROTOCOLS } from "./protocol";

/** The part of a WebSocket that the stream uses. */
export interface Socket {
  onmessage: ((event: MessageEvent<string | ArrayBuffer>) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  readonly readyState: number;
  send(message: string | Uint8Array<ArrayBuffer>): void;
  close(): void;
}

/** The other end of the stream: a server, or the module of the page. */
export interface Endpoint {
  /** The token of its address; empty: it needs none. */
  readonly token: string;
  /** A document or a file, such as "suit.json". */
  fetch(path: string, token: string, options?: RequestInit): Promise<Response>;
  /** Has the browser save a file under a name. */
  save(path: string, token: string, name: string): Promise<void>;
  open(token: string): Socket;
}

export class ServerEndpoint implements Endpoint {
  readonly token: string;
  readonly #base: URL;

  constructor(base: URL) {
    this.#base = base;
    this.token = base.searchParams.get("token") ?? "";
  }

  fetch(path: string, token: string, options?: RequestInit): Promise<Response> {
    return fetch(this.#address(path, token), options);
  }

  async save(path: string, token: string, name: string): Promise<void> {
    saveFrom(this.#address(path, token).href, name);
  }

  open(token: string): Socket {
    const address = this.#address("./", token);
    address.protocol = address.protocol.replace("http", "ws");
    const socket = new WebSocket(address, SUBPROTOCOLS);
    socket.binaryType = "arraybuffer";
    return socket;
  }

  #address(path: string, token: string): URL {
    const address = new URL(path, this.#base);
    address.search = token === "" ? "" : `?${new URLSearchParams({ token })}`;
    address.hash = "";
    return address;
  }
}
