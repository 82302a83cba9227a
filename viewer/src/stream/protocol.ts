// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** The parts of the Foxglove WebSocket protocol that are used here. */
export const SUBPROTOCOLS = ["foxglove.sdk.v1"];

export const ServerOpcode = { messageData: 1, time: 2, serviceCallResponse: 3, playbackState: 5 } as const;
const ClientOpcode = { serviceCallRequest: 2, playbackControl: 3 } as const;

/** Payload of messageData begins here: opcode, u32 subscription, u64 log time. */
export const MESSAGE_DATA_BYTES = 13;

export interface ProtocolTime {
  sec: number;
  nsec: number;
}

export interface Channel {
  id: number;
  topic: string;
  schemaName: string;
}

export interface Service {
  id: number;
  name: string;
}

export type ParameterValue = boolean | number | string | number[] | undefined;

export interface Parameter {
  name: string;
  value?: ParameterValue;
}

export interface ServerInfo {
  op: "serverInfo";
  name: string;
  capabilities: string[];
  sessionId?: string;
  dataStartTime?: ProtocolTime;
  dataEndTime?: ProtocolTime;
}

export type ServerText =
  | ServerInfo
  | { op: "advertise"; channels: Channel[] }
  | { op: "unadvertise"; channelIds: number[] }
  | { op: "advertiseServices"; services: Service[] }
  | { op: "unadvertiseServices"; serviceIds: number[] }
  | { op: "parameterValues"; parameters: Parameter[]; id?: string }
  | { op: "serviceCallFailure"; serviceId: number; callId: number; message: string }
  | { op: "status"; level: number; message: string; id?: string }
  | { op: "removeStatus"; statusIds: string[] };

export const PlaybackStatus = { playing: 0, paused: 1, buffering: 2, ended: 3 } as const;

export interface PlaybackState {
  status: number;
  nowS: number;
  speed: number;
  didSeek: boolean;
}

const utf8 = new TextEncoder();

export function secondsOf(time: ProtocolTime): number {
  return time.sec + 1e-9 * time.nsec;
}

/** Little-endian u64 nanoseconds as seconds. */
export function readNanos(view: DataView, offset: number): number {
  return 1e-9 * (view.getUint32(offset, true) + 4294967296 * view.getUint32(offset + 4, true));
}

export function serviceCallRequest(serviceId: number, callId: number, request: string): Uint8Array<ArrayBuffer> {
  const encoding = utf8.encode("json");
  const payload = utf8.encode(request);
  const bytes = new Uint8Array(13 + encoding.length + payload.length);
  const view = new DataView(bytes.buffer);
  view.setUint8(0, ClientOpcode.serviceCallRequest);
  view.setUint32(1, serviceId, true);
  view.setUint32(5, callId, true);
  view.setUint32(9, encoding.length, true);
  bytes.set(encoding, 13);
  bytes.set(payload, 13 + encoding.length);
  return bytes;
}

export function readServiceCallResponse(message: DataView): { callId: number; response: string } {
  const payload = 13 + message.getUint32(9, true);
  const bytes = new Uint8Array(message.buffer, message.byteOffset + payload);
  return { callId: message.getUint32(5, true), response: new TextDecoder().decode(bytes) };
}

export function playbackControl(play: boolean, speed: number, seekS?: number): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(19);
  const view = new DataView(bytes.buffer);
  view.setUint8(0, ClientOpcode.playbackControl);
  view.setUint8(1, play ? 0 : 1);
  view.setFloat32(2, speed, true);
  view.setUint8(6, seekS === undefined ? 0 : 1);
  view.setBigUint64(7, BigInt(Math.round((seekS ?? 0) * 1e6)) * 1000n, true);
  return bytes;
}

export function readPlaybackState(message: DataView): PlaybackState {
  return {
    status: message.getUint8(1),
    nowS: readNanos(message, 2),
    speed: message.getFloat32(10, true),
    didSeek: message.getUint8(14) !== 0,
  };
}
