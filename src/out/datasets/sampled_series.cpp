// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/sampled_series.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dermis/bytes/files/csv_table.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/joint_states.hpp"

namespace dermis::out::datasets {
namespace {

constexpr std::size_t kMostJoints = 1024;

}  // namespace

Result<SampledSeries> SampledSeries::read(const std::string& csv) {
  const Result<bytes::files::CsvTable> table = bytes::files::CsvTable::read(csv);
  if (!table) return table.error();
  const Result<std::size_t> time_column = table->needed_column("time_s");
  if (!time_column) return time_column.error();
  std::vector<Nanos> times(table->rows());
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (!bytes::files::parse_seconds(table->at(row, *time_column), times[row]))
      return table->error(row, "time_s is no time");
    if (row > 0 && times[row] < times[row - 1]) return table->error(row, "time_s goes back");
  }
  SampledSeries series;
  for (std::size_t column = 0; column < table->columns().size(); ++column) {
    if (column == *time_column) continue;
    Numbers numbers{table->columns()[column], times};
    for (std::size_t row = 0; row < times.size(); ++row) {
      const Result<double> number = table->number_at(row, column);
      if (!number) return number.error();
      numbers.values.push_back(static_cast<float>(*number));
    }
    series.numbers_.push_back(std::move(numbers));
  }
  if (times.empty() || series.numbers_.empty()) return table->error("has no numbers beside time_s");
  return series;
}

Result<SampledSeries> SampledSeries::read_topic(const std::string& recording, const std::string& topic) {
  SampledSeries series;
  bool has_too_many = false;
  const auto take = [&](Nanos time, const bytes::ros_messages::JointNumbers& joints) {
    for (std::size_t k = 0; k < joints.names.size(); ++k) {
      if (!std::isfinite(joints.numbers[k])) continue;
      const auto is_it = [&](const Numbers& numbers) { return numbers.name == joints.names[k]; };
      auto found = std::find_if(series.numbers_.begin(), series.numbers_.end(), is_it);
      has_too_many = has_too_many || (found == series.numbers_.end() && series.numbers_.size() == kMostJoints);
      if (has_too_many) return;
      if (found == series.numbers_.end()) found = series.numbers_.insert(found, {joints.names[k]});
      if (!found->times.empty() && time < found->times.back()) continue;
      found->times.push_back(time);
      found->values.push_back(static_cast<float>(joints.numbers[k]));
    }
  };
  if (Status read = bytes::recordings::read_joint_states(recording, topic, take); !read) return read.error();
  if (has_too_many) {
    return bad_input(fmt::format("{}: has more than {} joints in {}; name another topic", recording, kMostJoints,
                                 bytes::files::in_quotes(topic)));
  }
  if (series.numbers_.empty()) return bad_input(recording + ": has no joint in " + bytes::files::in_quotes(topic));
  return series;
}

std::vector<std::string> SampledSeries::names() const {
  std::vector<std::string> names;
  for (const Numbers& numbers : numbers_) names.push_back(numbers.name);
  return names;
}

bool SampledSeries::reorder(const std::vector<std::string>& names) {
  if (names.size() != numbers_.size()) return false;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto begin = numbers_.begin() + static_cast<std::ptrdiff_t>(k);
    const auto found = std::find_if(begin, numbers_.end(), [&](const Numbers& one) { return one.name == names[k]; });
    if (found == numbers_.end()) return false;
    std::iter_swap(begin, found);
  }
  return true;
}

std::pair<Nanos, Nanos> SampledSeries::range() const {
  std::pair<Nanos, Nanos> range = {numbers_.front().times.front(), numbers_.front().times.back()};
  for (const Numbers& numbers : numbers_) {
    range.first = std::min(range.first, numbers.times.front());
    range.second = std::max(range.second, numbers.times.back());
  }
  return range;
}

Nanos SampledSeries::longest_gap() const {
  const auto has_fewer = [](const Numbers& a, const Numbers& b) { return a.times.size() < b.times.size(); };
  const std::vector<Nanos>& times = std::max_element(numbers_.begin(), numbers_.end(), has_fewer)->times;
  Nanos longest{};
  for (std::size_t k = 1; k < times.size(); ++k) longest = std::max(longest, times[k] - times[k - 1]);
  return longest;
}

void SampledSeries::append(Nanos time, std::vector<std::byte>& row) const {
  for (const Numbers& numbers : numbers_) {
    const auto after = std::upper_bound(numbers.times.begin(), numbers.times.end(), time);
    const std::ptrdiff_t place = std::max<std::ptrdiff_t>(after - numbers.times.begin() - 1, 0);
    const auto* const bytes = reinterpret_cast<const std::byte*>(&numbers.values[static_cast<std::size_t>(place)]);
    row.insert(row.end(), bytes, bytes + sizeof(float));
  }
}

}  // namespace dermis::out::datasets
