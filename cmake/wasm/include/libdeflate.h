/* SPDX-License-Identifier: Apache-2.0
   SPDX-FileCopyrightText: 2026 The dermis authors */

/* Of libdeflate, which Debian has for its own processors, what recordings use (bindings/browser/crc32.cpp). */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
#endif
    uint32_t
    libdeflate_crc32(uint32_t, const void*, size_t);
