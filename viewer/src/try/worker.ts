// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { errorText } from "../format";
import { keepDropped } from "./dropped_files";
import { File as PageFile } from "./files";
import { Fits } from "./fits";
import { blobOf, openFiles, type PageFiles } from "./kept_files";
import { Module } from "./module";
import { type Answer, type BoardNews, FILE_LIST, type Question, SERVER_HAS_CHANGED } from "./module_endpoint";

const WORK_MS = 5;
/** Nobody calls for so long: the page was asleep, or its machine. */
const SLEEP_MS = 2000;
const SETTLE_MS = 200;

let client: MessagePort | undefined;
let resolveBegun: (module: Promise<Module>) => void;
const begun = new Promise<Module>((resolve) => {
  resolveBegun = resolve;
});
let pageFiles: PageFiles;

async function begin(code: WebAssembly.Module, model: ArrayBuffer, isRehearsal: boolean): Promise<Module> {
  const opened = await openFiles();
  pageFiles = opened;
  if (opened.lost !== undefined) tell({ note: opened.lost });
  const made = await Module.load(code, opened.files, new Fits());
  made.beginSimulation(new Uint8Array(model), isRehearsal);
  let workedMs = performance.now();
  setInterval(() => {
    const sleptMs = performance.now() - workedMs;
    if (sleptMs > SLEEP_MS) postMessage({ slept: sleptMs / 1000 });
    const hasChanged = made.work();
    send(made);
    for (let request = made.boardRequest(); request !== undefined; request = made.boardRequest()) postMessage(request);
    if (hasChanged && client !== undefined) leaveClient(client, opened.lost ?? "");
    workedMs = performance.now();
  }, WORK_MS);
  void keepSettled();
  return made;
}

/** The server is another one: the client connects anew. */
function leaveClient(port: MessagePort, note: string): void {
  tell({ note });
  port.postMessage(SERVER_HAS_CHANGED);
  client = undefined;
}

function hear(module: Module, news: BoardNews): void {
  if ("bytes" in news) module.bytes(news.bytes);
  else if ("board" in news) module.boardIsOpen(news.board, news.baud);
  else if ("lost" in news) module.boardIsLost();
  else module.beginSetup();
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
  const module = await begun;
  client = port;
  port.onmessage = ({ data }: MessageEvent<string | Uint8Array>) => {
    module.receive(data);
    send(module);
  };
  module.connect();
  send(module);
}

function fileList(): string {
  const files = pageFiles.files.all().map(({ path, content }) => [path, content.size()]);
  return JSON.stringify(files.sort());
}

async function documentOf(encoded: string): Promise<string | Blob | undefined> {
  const module = await begun;
  const path = decodeURIComponent(encoded);
  if (path === `/${FILE_LIST}`) return fileList();
  return module.document(path) ?? (await blobOf(pageFiles.files, module.file(path) ?? path));
}

/** As long as nothing has it open. */
async function remove(path: string): Promise<undefined> {
  await begun;
  const file = pageFiles.files.find(path);
  if (file instanceof PageFile && file.opened > 0) throw new Error(`${path.slice(1)} is in use.`);
  pageFiles.files.remove(path);
}

async function answer(id: number, document: Promise<string | Blob | undefined>): Promise<void> {
  let answered: Answer;
  try {
    answered = { id, document: await document };
  } catch (error) {
    answered = { id, failure: errorText(error) };
  }
  tell(answered);
}

async function open(file: File): Promise<void> {
  try {
    const module = await begun;
    module.open(await keepDropped(pageFiles.files, file));
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    tell({ note: errorText(error) });
  }
}

/** One after the other: a model may be for the table behind it. */
let opening = Promise.resolve();

/** A module that has ended cannot go on: the page is told why. */
addEventListener("unhandledrejection", ({ reason }) => {
  setTimeout(() => {
    throw reason;
  });
});

addEventListener("message", ({ data }: MessageEvent<Question>) => {
  if ("module" in data) resolveBegun(begin(data.module, data.model, data.isRehearsal));
  else if ("port" in data)
    connect(data.port).catch(() => undefined); // the question for suit.json tells why
  else if ("remove" in data) void answer(data.id, remove(data.remove));
  else if ("id" in data) void answer(data.id, documentOf(data.path));
  else if ("opened" in data) opening = opening.then(() => open(data.opened));
  else if ("goLive" in data) void begun.then((module) => module.goLive());
  else void begun.then((module) => hear(module, data));
});
