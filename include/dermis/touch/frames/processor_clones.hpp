// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>  // of glibc: defines __GLIBC__

/// A function with this mark is compiled for AVX-512, for AVX2 and for any x86 processor; the dynamic linker takes the
/// one for the machine. It is for plain loops that the compiler makes vectors of; Highway is for all that needs more.
/// With other compilers than g++ it is nothing, nor under sanitizers, which instrument the choice itself. NEON is in
/// every ARM processor of 64 bits.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define DERMIS_PROCESSOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define DERMIS_PROCESSOR_CLONES
#endif
