// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/recorded_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "dermis/bytes/files/array_toml.hpp"

namespace dermis::live::sources {
namespace {

/// As parameters of a URI.
std::string parameters_of(const LineOrder& order) {
  std::vector<std::string> parameters;
  if (order.skip_columns > 0) parameters.push_back(fmt::format("skip_columns={}", order.skip_columns));
  if (order.transpose) parameters.emplace_back("transpose=1");
  if (order.flip_rows) parameters.emplace_back("flip_rows=1");
  if (order.flip_cols) parameters.emplace_back("flip_cols=1");
  if (!order.row_order.empty()) parameters.push_back(fmt::format("row_order={}", fmt::join(order.row_order, ",")));
  if (!order.col_order.empty()) parameters.push_back(fmt::format("col_order={}", fmt::join(order.col_order, ",")));
  return fmt::format("{}", fmt::join(parameters, "&"));
}

}  // namespace

Status check_recorded_order(const std::string& path, std::string_view recorded_toml, const ArrayDescription& array) {
  if (array.order.is_plain() || recorded_toml.empty()) return Done{};
  const Result<ArrayDescription> recorded = bytes::files::array_from_toml(recorded_toml, path);
  if (!recorded || !recorded->order.is_plain()) return Done{};
  return bad_input(
      fmt::format("'{}': was recorded before its array.toml said which way round; a new recording turns it "
                  "where it takes its frames from 'file:{}?{}'",
                  path, path, parameters_of(array.order)));
}

}  // namespace dermis::live::sources
