// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { Signal } from "../signal";
import type { SuitDescription } from "../suit";
import { Backoff } from "./backoff";
import type { Endpoint, Socket } from "./endpoint";
import * as protocol from "./protocol";
import { ServiceCalls } from "./service_calls";

export type Connection =
  | { kind: "connecting" }
  | { kind: "live" }
  /** It was live before, or never came up; the next attempt is at that time of performance.now(). */
  | { kind: "retrying"; wasLive: boolean; atMs: number }
  | { kind: "wrong token" };

export interface Notice {
  level: number;
  message: string;
}

/** Gets a message in CDR; log time in seconds. The bytes may be kept. */
export type MessageHandler = (message: DataView, logTimeS: number) => void;

interface Topic {
  readonly name: string;
  readonly subscriptionId: number;
  readonly handlers: Set<MessageHandler>;
  channelId: number | undefined;
  /** The newest message, while somebody follows the topic. */
  latest: DataView | undefined;
}

const LIVE_BEFORE_BACKOFF_RESETS_MS = 2000;
const SILENCE_MS = 10000;
const SILENCE_OF_A_CALL_MS = 60000; // it may look for a layout for a while, and says nothing else meanwhile
/** The server hears so often what has come, and sends no more than that. */
const TAKEN_MS = 50;

/**
 * The connection to the other end: comes back by itself with back-off, and subscribes to the same topics again. Nothing is
 * asked of the server that nobody follows.
 */
export class Stream {
  readonly connection = new Signal<Connection>({ kind: "connecting" });
  readonly serverInfo = new Signal<protocol.ServerInfo | undefined>(undefined);
  readonly parameters = new Signal<ReadonlyMap<string, protocol.ParameterValue>>(new Map());
  readonly services = new Signal<ReadonlyMap<string, number>>(new Map());
  readonly playback = new Signal<protocol.PlaybackState | undefined>(undefined);
  readonly notice = new Signal<Notice | undefined>(undefined);
  /** Since the page was opened. */
  messages = 0;
  bytes = 0;
  reconnects = -1;
  /** Log time of the newest message [s]; undefined: none has come yet. */
  latestTimeS: number | undefined;

  readonly #endpoint: Endpoint;
  readonly #onSuit: (suit: SuitDescription) => void;
  readonly #backoff = new Backoff();
  readonly #topics = new Map<string, Topic>();
  readonly #subscriptions: Topic[] = [];
  readonly #channels = new Map<string, number>();
  readonly #calls = new ServiceCalls();
  #token: string;
  #socket: Socket | undefined;
  #timer = 0;
  #attempts = 0;
  #liveSinceMs = 0;
  #lastMessageMs = 0;
  /** Bytes of binary messages on this connection. */
  #taken = 0;
  #takenTimer = 0;

  constructor(endpoint: Endpoint, onSuit: (suit: SuitDescription) => void) {
    this.#endpoint = endpoint;
    this.#onSuit = onSuit;
    this.#token = endpoint.token;
  }

  /** Begins to connect; also at once where it waits for the next attempt. */
  connect(): void {
    window.clearTimeout(this.#timer);
    this.#drop();
    this.connection.value = { kind: "connecting" };
    void this.#attempt();
  }

  get token(): string {
    return this.#token;
  }

  connectWith(token: string): void {
    this.#token = token;
    this.#backoff.reset();
    this.connect();
  }

  subscribe(name: string, handler: MessageHandler): () => void {
    const topic = this.#topic(name);
    topic.handlers.add(handler);
    if (topic.handlers.size === 1) this.#begin(topic);
    return () => {
      if (topic.handlers.delete(handler) && topic.handlers.size === 0) this.#end(topic);
    };
  }

  /** The newest message of a topic that somebody follows. */
  latest(name: string): DataView | undefined {
    return this.#topics.get(name)?.latest;
  }

  /** Answers what the service answers; fails with the server's message. */
  async callService(name: string, request: object): Promise<unknown> {
    const id = this.services.value.get(name);
    if (id === undefined || this.#socket === undefined) throw new Error(`${name}: the server does not offer it now`);
    const { callId, answer } = this.#calls.begin();
    this.#socket.send(protocol.serviceCallRequest(id, callId, JSON.stringify(request)));
    return answer;
  }

  setParameter(name: string, value: boolean | number | string): void {
    this.#send({ op: "setParameters", parameters: [{ name, value }], id: "set" });
  }

  /** Returns whether the server was asked. */
  control(play: boolean, speed: number, seekS?: number): boolean {
    if (this.connection.value.kind !== "live" || this.#socket === undefined) return false;
    this.#socket.send(protocol.playbackControl(play, speed, seekS));
    return true;
  }

  has(capability: string): boolean {
    return this.serverInfo.value?.capabilities.includes(capability) ?? false;
  }

  /** Reads the description of the suit again: a calibration has changed it. */
  async refresh(): Promise<void> {
    const attempt = this.#attempts;
    const response = await this.#fetchSuit().catch(() => undefined);
    if (response?.ok === true && attempt === this.#attempts) this.#onSuit((await response.json()) as SuitDescription);
  }

  /** A file that /suit.json names. */
  async fetchFile(path: string): Promise<ArrayBuffer> {
    const response = await this.#endpoint.fetch(path, this.#token);
    if (!response.ok) throw new Error(`the server answers ${response.status}`);
    return response.arrayBuffer();
  }

  /** Has the browser save a file of the other end under a name. */
  save(path: string, name: string): Promise<void> {
    return this.#endpoint.save(path, this.#token, name);
  }

  #fetchSuit(): Promise<Response> {
    return this.#endpoint.fetch("suit.json", this.#token, { signal: AbortSignal.timeout(5000), cache: "no-store" });
  }

  async #attempt(): Promise<void> {
    const attempt = ++this.#attempts;
    try {
      const listen = this.#open();
      const response = await this.#fetchSuit();
      if (attempt !== this.#attempts) return;
      if (response.status === 401 || response.status === 403) {
        this.#drop();
        this.connection.value = { kind: "wrong token" };
        return;
      }
      if (!response.ok) throw new Error(`suit.json: ${response.status}`);
      const suit = (await response.json()) as SuitDescription;
      if (attempt !== this.#attempts) return;
      this.#onSuit(suit);
      listen();
    } catch {
      if (attempt === this.#attempts) this.#retry();
    }
  }

  /** While the description of the suit is on its way. Messages wait for the call of the answer. */
  #open(): () => void {
    const socket = this.#endpoint.open(this.#token);
    const early: (string | ArrayBuffer)[] = [];
    socket.onmessage = (event) => early.push(event.data);
    this.#socket = socket;
    return () => {
      if (socket.readyState >= WebSocket.CLOSING) throw new Error("the connection was closed");
      socket.onmessage = (event) => this.#receive(event.data);
      socket.onclose = () => this.#retry();
      this.#lastMessageMs = performance.now();
      this.#watch();
      for (const data of early) this.#receive(data);
    };
  }

  /** A server whose machine is gone closes nothing: silence is an end, too. */
  #watch(): void {
    this.#timer = window.setTimeout(() => {
      const most = this.#calls.areWaiting ? SILENCE_OF_A_CALL_MS : SILENCE_MS;
      if (performance.now() - this.#lastMessageMs > most) this.#retry();
      else this.#watch();
    }, 1000);
  }

  #drop(): void {
    if (this.#socket !== undefined) {
      this.#socket.onmessage = null;
      this.#socket.onclose = null;
      this.#socket.close();
      this.#socket = undefined;
    }
    window.clearTimeout(this.#takenTimer);
    this.#takenTimer = this.#taken = 0;
    this.#channels.clear();
    for (const topic of this.#topics.values()) topic.channelId = undefined;
    this.#calls.failAll("the connection was lost");
    this.services.value = new Map();
  }

  #retry(): void {
    const wasLive = this.connection.value.kind === "live";
    if (wasLive && performance.now() - this.#liveSinceMs > LIVE_BEFORE_BACKOFF_RESETS_MS) this.#backoff.reset();
    this.#drop();
    window.clearTimeout(this.#timer);
    const waitMs = this.#backoff.nextMs();
    this.connection.value = { kind: "retrying", wasLive: this.reconnects >= 0, atMs: performance.now() + waitMs };
    this.#timer = window.setTimeout(() => this.connect(), waitMs);
  }

  #receive(data: string | ArrayBuffer): void {
    this.#lastMessageMs = performance.now();
    this.messages += 1;
    if (typeof data === "string") {
      this.#receiveText(JSON.parse(data) as protocol.ServerText);
      return;
    }
    this.bytes += data.byteLength;
    this.#taken += data.byteLength;
    if (this.#takenTimer === 0) this.#takenTimer = window.setTimeout(() => this.#tellTaken(), TAKEN_MS);
    const message = new DataView(data);
    switch (message.getUint8(0)) {
      case protocol.ServerOpcode.messageData: {
        const topic = this.#subscriptions[message.getUint32(1, true)];
        if (topic === undefined) return;
        const payload = new DataView(data, protocol.MESSAGE_DATA_BYTES);
        const logTimeS = protocol.readNanos(message, 5);
        topic.latest = payload;
        this.latestTimeS = logTimeS;
        for (const handler of topic.handlers) handler(payload, logTimeS);
        return;
      }
      case protocol.ServerOpcode.serviceCallResponse:
        this.#calls.answer(protocol.readServiceCallResponse(message));
        return;
      case protocol.ServerOpcode.playbackState:
        this.playback.value = protocol.readPlaybackState(message);
        return;
    }
  }

  #receiveText(text: protocol.ServerText): void {
    switch (text.op) {
      case "serverInfo":
        this.#begun(text);
        return;
      case "advertise":
        this.#advertised(text.channels);
        return;
      case "unadvertise":
        this.#unadvertised(text.channelIds);
        return;
      case "advertiseServices":
        this.services.value = new Map([
          ...this.services.value,
          ...text.services.map(({ name, id }) => [name, id] as const),
        ]);
        return;
      case "unadvertiseServices":
        this.services.value = new Map([...this.services.value].filter(([, id]) => !text.serviceIds.includes(id)));
        return;
      case "parameterValues":
        this.#parametersCame(text.parameters, text.id);
        return;
      case "serviceCallFailure":
        this.#calls.fail(text.callId, text.message);
        return;
      case "status":
        this.notice.value = { level: text.level, message: text.message };
        return;
      case "removeStatus":
        this.notice.value = undefined;
        return;
    }
  }

  #tellTaken(): void {
    this.#takenTimer = 0;
    this.#send({ op: "taken", bytes: this.#taken });
  }

  #begun(info: protocol.ServerInfo): void {
    this.#tellTaken();
    this.reconnects += 1;
    this.#liveSinceMs = performance.now();
    this.playback.value = undefined;
    this.parameters.value = new Map();
    this.serverInfo.value = info;
    this.connection.value = { kind: "live" };
    if (this.has("parameters")) this.#send({ op: "getParameters", parameterNames: [], id: "all" });
  }

  #parametersCame(parameters: protocol.Parameter[], id?: string): void {
    const all = new Map(this.parameters.value);
    for (const { name, value } of parameters) all.set(name, value);
    this.parameters.value = all;
    if (id !== "all" || !this.has("parametersSubscribe")) return;
    this.#send({ op: "subscribeParameterUpdates", parameterNames: parameters.map(({ name }) => name) });
  }

  #topic(name: string): Topic {
    let topic = this.#topics.get(name);
    if (topic === undefined) {
      const subscriptionId = this.#subscriptions.length;
      topic = { name, subscriptionId, handlers: new Set(), channelId: this.#channels.get(name), latest: undefined };
      this.#topics.set(name, topic);
      this.#subscriptions.push(topic);
    }
    return topic;
  }

  #advertised(channels: protocol.Channel[]): void {
    for (const { id, topic: name } of channels) {
      this.#channels.set(name, id);
      const topic = this.#topics.get(name);
      if (topic === undefined) continue;
      topic.channelId = id;
      if (topic.handlers.size > 0) this.#begin(topic);
    }
  }

  #unadvertised(channelIds: number[]): void {
    for (const [name, id] of [...this.#channels]) if (channelIds.includes(id)) this.#channels.delete(name);
    for (const topic of this.#topics.values()) {
      if (topic.channelId !== undefined && channelIds.includes(topic.channelId)) topic.channelId = undefined;
    }
  }

  #begin({ subscriptionId, channelId }: Topic): void {
    if (channelId !== undefined) this.#send({ op: "subscribe", subscriptions: [{ id: subscriptionId, channelId }] });
  }

  #end(topic: Topic): void {
    const { subscriptionId, channelId } = topic;
    topic.latest = undefined;
    if (channelId !== undefined) this.#send({ op: "unsubscribe", subscriptionIds: [subscriptionId] });
  }

  #send(request: object): void {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(request));
  }
}
