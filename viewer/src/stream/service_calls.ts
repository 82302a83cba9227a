// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

interface Waiting {
  resolve: (answer: unknown) => void;
  reject: (error: Error) => void;
}

/** Calls that the server has not answered yet. */
export class ServiceCalls {
  readonly #waiting = new Map<number, Waiting>();
  #lastId = 0;

  get areWaiting(): boolean {
    return this.#waiting.size > 0;
  }

  begin(): { callId: number; answer: Promise<unknown> } {
    const callId = ++this.#lastId;
    const answer = new Promise<unknown>((resolve, reject) => this.#waiting.set(callId, { resolve, reject }));
    return { callId, answer };
  }

  answer({ callId, response }: { callId: number; response: string }): void {
    let answer: unknown;
    try {
      answer = JSON.parse(response);
    } catch {
      this.fail(callId, "the server answered no JSON");
      return;
    }
    this.#take(callId)?.resolve(answer);
  }

  fail(callId: number, message: string): void {
    this.#take(callId)?.reject(new Error(message));
  }

  failAll(message: string): void {
    for (const callId of [...this.#waiting.keys()]) this.fail(callId, message);
  }

  #take(callId: number): Waiting | undefined {
    const waiting = this.#waiting.get(callId);
    this.#waiting.delete(callId);
    return waiting;
  }
}
