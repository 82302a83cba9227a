// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/source_uri.hpp"

namespace dermis::bytes::devices {

constexpr Nanos kLong = std::chrono::seconds(10);

inline std::unique_ptr<ByteStream> target(const std::string& uri) {
  const Result<SourceUri> parsed = parse_target_uri(uri);
  EXPECT_TRUE(parsed) << uri;
  return *make_target_stream(*parsed);
}

inline void send(ByteStream& stream, const std::vector<std::uint8_t>& bytes) {
  std::span<const std::uint8_t> rest = bytes;
  while (!rest.empty()) {
    const ByteStream::Transferred written = stream.write(rest, kLong);
    ASSERT_EQ(written.end, ByteStream::End::none);
    rest = rest.subspan(written.bytes);
  }
}

inline void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
}

}  // namespace dermis::bytes::devices
