// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Backoff } from "./backoff";
import { ServerEndpoint } from "./endpoint";
import { Stream } from "./stream";

class FakeSocket {
  static readonly OPEN = 1;
  static made: FakeSocket[] = [];
  readyState = 1;
  binaryType = "";
  onmessage: ((event: { data: string | ArrayBuffer }) => void) | null = null;
  onclose: (() => void) | null = null;
  readonly sent: unknown[] = [];
  isClosed = false;

  constructor(
    readonly address: URL,
    readonly protocols: string[],
  ) {
    FakeSocket.made.push(this);
  }

  send(data: string | Uint8Array): void {
    this.sent.push(typeof data === "string" ? JSON.parse(data) : data);
  }

  close(): void {
    this.isClosed = true;
  }

  say(text: object): void {
    this.onmessage?.({ data: JSON.stringify(text) });
  }

  data(subscription: number, logTimeNs: bigint, payload: number[]): void {
    const bytes = new Uint8Array(13 + payload.length);
    const view = new DataView(bytes.buffer);
    view.setUint8(0, 1);
    view.setUint32(1, subscription, true);
    view.setBigUint64(5, logTimeNs, true);
    bytes.set(payload, 13);
    this.onmessage?.({ data: bytes.buffer });
  }

  begin(channels: Record<string, number>): void {
    this.say({ op: "serverInfo", name: "test", capabilities: ["parameters", "parametersSubscribe", "services"] });
    this.say({
      op: "advertise",
      channels: Object.entries(channels).map(([topic, id]) => ({ id, topic, schemaName: "" })),
    });
  }
}

const suit = { name: "suit", arrays: [] };
let status = 200;

function last(): FakeSocket {
  return FakeSocket.made.at(-1)!;
}

async function connected(address = "http://host:8080/?token=secret#/array"): Promise<Stream> {
  const stream = new Stream(new ServerEndpoint(new URL(address)), () => undefined);
  stream.connect();
  await vi.advanceTimersByTimeAsync(1);
  return stream;
}

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.made = [];
  status = 200;
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal(
    "fetch",
    vi.fn(async () => ({ ok: status === 200, status, json: async () => suit })),
  );
});

afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

describe("the stream", () => {
  it("hands the token on, and speaks the subprotocol of Foxglove", async () => {
    await connected();
    expect(String(vi.mocked(fetch).mock.calls[0]![0])).toBe("http://host:8080/suit.json?token=secret");
    expect(String(last().address)).toBe("ws://host:8080/?token=secret");
    expect(last().protocols).toEqual(["foxglove.sdk.v1"]);
  });

  it("subscribes when a topic is there and followed, and hands over its messages", async () => {
    const stream = await connected();
    const got: [number[], number][] = [];
    const end = stream.subscribe("/contacts", (message, logTimeS) =>
      got.push([[message.getUint8(0), message.getUint8(1)], logTimeS]),
    );
    last().begin({ "/contacts": 7, "/other": 8 });
    expect(last().sent).toContainEqual({ op: "subscribe", subscriptions: [{ id: 0, channelId: 7 }] });
    last().data(0, 1500000000n, [5, 6]);
    expect(got).toEqual([[[5, 6], 1.5]]);
    end();
    expect(last().sent).toContainEqual({ op: "unsubscribe", subscriptionIds: [0] });
    last().data(0, 1500000000n, [5, 6]);
    expect(got).toHaveLength(1);
  });

  it("comes back after a loss and subscribes by topic, whatever the channel is called then", async () => {
    const stream = await connected();
    stream.subscribe("/contacts", () => undefined);
    last().begin({ "/contacts": 7 });
    expect(stream.connection.value.kind).toBe("live");
    last().onclose?.();
    expect(stream.connection.value).toMatchObject({ kind: "retrying", wasLive: true });
    await vi.advanceTimersByTimeAsync(1000);
    expect(FakeSocket.made).toHaveLength(2);
    last().begin({ "/contacts": 70 });
    expect(last().sent).toContainEqual({ op: "subscribe", subscriptions: [{ id: 0, channelId: 70 }] });
    expect(stream.reconnects).toBe(1);
  });

  it("survives 100 losses with one socket, one timer and no more listeners", async () => {
    const stream = await connected();
    stream.subscribe("/contacts", () => undefined);
    const listeners = stream.connection.listenerCount;
    for (let loss = 0; loss < 100; ++loss) {
      last().begin({ "/contacts": 7 });
      last().onclose?.();
      await vi.advanceTimersByTimeAsync(7000);
    }
    expect(FakeSocket.made).toHaveLength(101);
    expect(FakeSocket.made.slice(0, -1).every((socket) => socket.isClosed && socket.onmessage === null)).toBe(true);
    expect(stream.connection.listenerCount).toBe(listeners);
    expect(vi.getTimerCount()).toBe(1);
  });

  it("says that the token is wrong, does not try on, and takes another", async () => {
    status = 401;
    const stream = await connected();
    expect(stream.connection.value.kind).toBe("wrong token");
    await vi.advanceTimersByTimeAsync(60000);
    expect(fetch).toHaveBeenCalledTimes(1);
    status = 200;
    stream.connectWith("right");
    await vi.advanceTimersByTimeAsync(1);
    expect(String(last().address)).toBe("ws://host:8080/?token=right");
  });

  it("takes a server that says nothing for lost", async () => {
    const stream = await connected();
    last().begin({});
    await vi.advanceTimersByTimeAsync(12000);
    expect(last().isClosed || FakeSocket.made.length > 1).toBe(true);
    expect(stream.connection.value.kind).not.toBe("live");
  });

  it("waits for the answer of a server that says nothing while it answers", async () => {
    const stream = await connected();
    last().begin({});
    last().say({ op: "advertiseServices", services: [{ id: 3, name: "/layout/propose" }] });
    const proposed = stream.callService("/layout/propose", {});
    const failed = expect(proposed).rejects.toThrow("the connection was lost");
    await vi.advanceTimersByTimeAsync(50000);
    expect(stream.connection.value.kind).toBe("live");
    await vi.advanceTimersByTimeAsync(12000);
    expect(stream.connection.value.kind).not.toBe("live");
    await failed;
  });

  it("knows the parameters, follows and sets them", async () => {
    const stream = await connected();
    last().begin({});
    expect(last().sent).toContainEqual({ op: "getParameters", parameterNames: [], id: "all" });
    last().say({ op: "parameterValues", parameters: [{ name: "/tare", value: false }], id: "all" });
    expect(last().sent).toContainEqual({ op: "subscribeParameterUpdates", parameterNames: ["/tare"] });
    stream.setParameter("/tare", true);
    expect(last().sent).toContainEqual({
      op: "setParameters",
      parameters: [{ name: "/tare", value: true }],
      id: "set",
    });
    last().say({ op: "parameterValues", parameters: [{ name: "/tare", value: true }] });
    expect(stream.parameters.value.get("/tare")).toBe(true);
  });

  it("calls services and fails with the server's words, or when the connection is lost", async () => {
    const stream = await connected();
    last().begin({});
    last().say({ op: "advertiseServices", services: [{ id: 3, name: "/calibration/save" }] });
    const saved = stream.callService("/calibration/save", {});
    const request = last().sent.at(-1) as Uint8Array;
    expect(request[0]).toBe(2);
    expect(new DataView(request.buffer).getUint32(1, true)).toBe(3);
    const answer = new TextEncoder().encode('{"file":"a"}');
    const response = new Uint8Array(17 + answer.length);
    const view = new DataView(response.buffer);
    view.setUint8(0, 3);
    view.setUint32(1, 3, true);
    view.setUint32(5, 1, true);
    view.setUint32(9, 4, true);
    response.set(new TextEncoder().encode("json"), 13);
    response.set(answer, 17);
    last().onmessage?.({ data: response.buffer });
    await expect(saved).resolves.toEqual({ file: "a" });
    const refused = stream.callService("/calibration/save", {});
    last().say({ op: "serviceCallFailure", serviceId: 3, callId: 2, message: "nothing was pressed" });
    await expect(refused).rejects.toThrow("nothing was pressed");
    const cut = stream.callService("/calibration/save", {});
    last().onclose?.();
    await expect(cut).rejects.toThrow("lost");
    await expect(stream.callService("/none", {})).rejects.toThrow("/none");
  });
});

describe("the back-off", () => {
  it("grows to five seconds, scattered by a fifth, and begins anew after a reset", () => {
    for (const random of [0, 0.5, 1]) {
      const backoff = new Backoff(() => random);
      const waits = Array.from({ length: 12 }, () => backoff.nextMs());
      expect(waits[0]).toBe(Math.round(250 * (0.8 + 0.4 * random)));
      for (let attempt = 1; attempt < 12; ++attempt) expect(waits[attempt]).toBeGreaterThanOrEqual(waits[attempt - 1]!);
      expect(waits[11]).toBe(Math.round(5000 * (0.8 + 0.4 * random)));
      backoff.reset();
      expect(backoff.nextMs()).toBe(waits[0]);
    }
  });
});
