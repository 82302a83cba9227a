/* SPDX-License-Identifier: Apache-2.0
   SPDX-FileCopyrightText: 2026 The dermis authors */

/* That of WASI, with what it lacks (bindings/browser/posix.cpp). */
#pragma once

#include_next <unistd.h>

#ifdef __cplusplus
extern "C" {
#endif
int dup(int);
uid_t geteuid(void);
#ifdef __cplusplus
}
#endif
