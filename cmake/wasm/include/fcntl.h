/* SPDX-License-Identifier: Apache-2.0
   SPDX-FileCopyrightText: 2026 The dermis authors */

/* That of WASI, with what it lacks of Linux (bindings/browser/posix.cpp). */
#pragma once

#include_next <fcntl.h>

#define F_DUPFD_CLOEXEC 1030
#define RENAME_NOREPLACE 1U

#ifdef __cplusplus
extern "C" {
#endif
int renameat2(int, const char*, int, const char*, unsigned);
#ifdef __cplusplus
}
#endif
