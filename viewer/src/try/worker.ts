// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { errorText } from "../format";
import { keepDropped } from "./dropped_files";
import { blobOf, openFiles, type PageFiles } from "./kept_files";
import { Module } from "./module";
import type { Answer, Question } from "./module_endpoint";

const WORK_MS = 5;
const SETTLE_MS = 200;

let client: MessagePort | undefined;
let begun: Promise<Module> | undefined;
let pageFiles: PageFiles;
let simulate: (made: Module) => void;

async function bytesOf(address: string): Promise<ArrayBuffer> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status}`);
  return response.arrayBuffer();
}

async function begin(module: string, model: string): Promise<Module> {
  const [code, modelFile, opened] = await Promise.all([bytesOf(module), bytesOf(model), openFiles()]);
  pageFiles = opened;
  if (opened.lost !== undefined) tell({ note: opened.lost });
  const made = await Module.load(await WebAssembly.compile(code), opened.files);
  simulate = (module) => module.beginSimulation(new Uint8Array(modelFile));
  simulate(made);
  setInterval(() => {
    const changed = made.work();
    if (changed !== undefined) tell({ note: changed || (opened.lost ?? ""), isAnother: true });
    send(made);
  }, WORK_MS);
  void keepSettled();
  return made;
}

async function keepSettled(): Promise<void> {
  await pageFiles.settle().catch(() => undefined); // full: what comes stays in memory
  setTimeout(() => void keepSettled(), SETTLE_MS);
}

function tell(answer: Answer): void {
  postMessage(answer);
}

function send(module: Module): void {
  for (let message = module.next(); message !== undefined; message = module.next()) {
    client?.postMessage(message, typeof message === "string" ? [] : [message]);
  }
}

async function connect(port: MessagePort): Promise<void> {
  const module = await begun!;
  client = port;
  port.onmessage = ({ data }: MessageEvent<string | Uint8Array>) => {
    module.receive(data);
    send(module);
  };
  module.connect();
  send(module);
}

async function answer(id: number, path: string): Promise<void> {
  let answered: Answer;
  try {
    const module = await begun!;
    const file = module.file(path);
    answered = { id, document: file === undefined ? module.document(path) : await blobOf(pageFiles.files, file) };
  } catch (error) {
    answered = { id, failure: errorText(error) };
  }
  tell(answered);
}

async function open(file: File): Promise<void> {
  try {
    const module = await begun!;
    module.open(await keepDropped(pageFiles.files, file));
  } catch (error) {
    tell({ note: errorText(error) });
  }
}

async function goLive(): Promise<void> {
  simulate(await begun!);
  tell({ note: pageFiles.lost ?? "", isAnother: true });
}

addEventListener("message", ({ data }: MessageEvent<Question>) => {
  if ("module" in data) begun = begin(data.module, data.model);
  else if ("port" in data)
    connect(data.port).catch(() => undefined); // the question for suit.json tells why
  else if ("opened" in data) void open(data.opened);
  else if ("goLive" in data) void goLive();
  else void answer(data.id, data.path);
});
