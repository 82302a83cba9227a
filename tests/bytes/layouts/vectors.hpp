// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/bytes/layouts/shipped_layouts.hpp"
#include "support/places.hpp"

namespace dermis::bytes::layouts {

/// Bytes of a protocol that a layout describes, and their frames: vectors/NAME.bin and vectors/NAME.csv. The bytes come
/// from encoders that were written by hand from the publications, before there were layouts.
struct Vector {
  std::vector<std::uint8_t> bytes;
  std::vector<RawFrame> frames;
  FrameShape shape;
};

inline Vector vector_of(const ShippedLayout& layout) {
  const auto path = support::project_folder() / "tests/bytes/layouts/vectors" / layout.name;
  std::ifstream file(path.string() + ".bin", std::ios::binary);
  Vector vector{.bytes = {std::istreambuf_iterator<char>(file), {}}, .frames = {}, .shape = {}};
  const auto reader = files::FramesCsvReader::open(path.string() + ".csv").value();
  vector.shape = reader->shape().value();
  RawFrame frame;
  while (reader->next(frame).value()) vector.frames.push_back(frame);
  return vector;
}

/// "pressure_mat", of a test.
inline std::string test_name(const testing::TestParamInfo<ShippedLayout>& layout) {
  std::string name(layout.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace dermis::bytes::layouts
