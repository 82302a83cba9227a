// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// What the C++ library of zig lacks for a program of one thread: its thread ends with it. Only for WebAssembly.
// NOLINTBEGIN(bugprone-reserved-identifier): the names of the Itanium ABI
extern "C" int __cxa_atexit(void (*destroy)(void*), void* object, void* library);
extern "C" int __cxa_thread_atexit(void (*destroy)(void*), void* object, void* library) {
  return __cxa_atexit(destroy, object, library);
}
// NOLINTEND(bugprone-reserved-identifier)
