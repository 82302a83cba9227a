// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>  // of glibc: defines __GLIBC__

/// A function with this mark is compiled for AVX-512, for AVX2 and for any x86 processor; the dynamic linker takes the
/// one for the machine. It is for plain loops that the compiler makes vectors of; Highway is for all that needs more.
/// Elsewhere, and under sanitizers, which instrument the choice itself, it is nothing: NEON is in every ARM of 64 bits.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#if defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
#define DERMIS_PROCESSOR_CLONES
#endif
#endif
#ifndef DERMIS_PROCESSOR_CLONES
#define DERMIS_PROCESSOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
#else
#define DERMIS_PROCESSOR_CLONES
#endif
