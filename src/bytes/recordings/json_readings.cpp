// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "bytes/recordings/bag_messages.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::recordings {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;
constexpr std::size_t kMostParts = 256;
constexpr int kDeepest = 8;

bool is_row(const json& value) {
  return value.is_array() && !value.empty() && value.size() <= kMaxLines * kMaxLines &&
         std::ranges::all_of(value, [](const json& one) { return one.is_number() || one.is_null(); });
}

bool is_matrix(const json& value) {
  return value.is_array() && !value.empty() && value.size() <= kMaxLines && value[0].size() <= kMaxLines &&
         std::ranges::all_of(value, [&](const json& row) { return is_row(row) && row.size() == value[0].size(); });
}

void append(const json& row, std::vector<float>& counts) {
  for (const json& value : row) {
    counts.push_back(value.is_null() ? std::numeric_limits<float>::quiet_NaN() : value.get<float>());
  }
}

BagReading row_reading(const json& row, const std::string& part) {
  BagReading reading{.part = part, .shape = {1, row.size()}};
  append(row, reading.frame.counts);
  return reading;
}

BagReading matrix_reading(const json& rows, const std::string& part) {
  BagReading reading{.part = part, .shape = {rows.size(), rows[0].size()}};
  for (const json& row : rows) append(row, reading.frame.counts);
  return reading;
}

/// The readings of a text, by their places in it.
class Found {
 public:
  void add(const json& value, const std::string& part, int depth) {
    if (depth > kDeepest || matrices_.size() + rows_.size() >= kMostParts) return;
    if (is_matrix(value)) return matrices_.push_back(matrix_reading(value, part));
    if (is_row(value)) return rows_.push_back(row_reading(value, part));
    if (value.is_array()) {
      for (std::size_t k = 0; k < value.size(); ++k) {
        add(value[k], std::string(part).append("[").append(std::to_string(k)).append("]"), depth + 1);
      }
    }
    if (!value.is_object()) return;
    for (const auto& [key, member] : value.items()) {
      add(member, part.empty() ? key : std::string(part).append(".").append(key), depth + 1);
    }
  }

  [[nodiscard]] std::vector<BagReading> readings() && { return std::move(matrices_.empty() ? rows_ : matrices_); }

 private:
  std::vector<BagReading> matrices_;
  std::vector<BagReading> rows_;
};

}  // namespace

std::vector<BagReading> readings_of_json(std::string_view text) {
  if (text.size() > kMostBytes) return {};
  Found found;
  found.add(json::parse(text, nullptr, false), "", 0);
  return std::move(found).readings();
}

}  // namespace dermis::bytes::recordings
