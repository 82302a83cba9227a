// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/recorded_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "dermis/bytes/files/array_toml.hpp"

namespace dermis::live::sources {
namespace {

/// "7,3;0,1"
std::string taxel_list(const LineOrder& order) {
  std::string list;
  const std::size_t cols = order.taxel_order.size() / order.taxel_rows;
  for (std::size_t k = 0; k < order.taxel_order.size(); ++k) {
    if (k > 0) list += k % cols == 0 ? ';' : ',';
    list += std::to_string(order.taxel_order[k]);
  }
  return list;
}

}  // namespace

std::string order_parameters(const LineOrder& order) {
  std::vector<std::string> parameters;
  if (order.skip_columns > 0) parameters.push_back(fmt::format("skip_columns={}", order.skip_columns));
  if (order.transpose) parameters.emplace_back("transpose=1");
  if (order.flip_rows) parameters.emplace_back("flip_rows=1");
  if (order.flip_cols) parameters.emplace_back("flip_cols=1");
  if (!order.row_order.empty()) parameters.push_back(fmt::format("row_order={}", fmt::join(order.row_order, ",")));
  if (!order.col_order.empty()) parameters.push_back(fmt::format("col_order={}", fmt::join(order.col_order, ",")));
  if (!order.taxel_order.empty()) {
    parameters.push_back(fmt::format("rows={}&cols={}&taxel_order={}", order.taxels_sent.rows, order.taxels_sent.cols,
                                     taxel_list(order)));
  }
  return fmt::format("{}", fmt::join(parameters, "&"));
}

Status check_recorded_order(const std::string& path, std::string_view recorded_toml, const ArrayDescription& array) {
  if (array.order.is_plain() || recorded_toml.empty()) return Done{};
  const Result<ArrayDescription> recorded = bytes::files::array_from_toml(recorded_toml, path);
  if (!recorded || !recorded->order.is_plain()) return Done{};
  return bad_input(
      fmt::format("'{}': was recorded before its array.toml said which way round; a new recording turns it "
                  "where it takes its frames from 'file:{}?{}'",
                  path, path, order_parameters(array.order)));
}

}  // namespace dermis::live::sources
