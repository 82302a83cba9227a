// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/zstd.hpp"

#include <zstd.h>

#include <memory>
#include <new>

namespace dermis::out::datasets {

std::string zstd_compressed(std::span<const std::byte> bytes) {
  struct Free {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  };
  thread_local const std::unique_ptr<ZSTD_CCtx, Free> kContext(ZSTD_createCCtx());
  if (kContext == nullptr) throw std::bad_alloc();
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compressCCtx(kContext.get(), compressed.data(), compressed.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // with enough room, nothing else can fail
  compressed.resize(size);
  return compressed;
}

}  // namespace dermis::out::datasets
