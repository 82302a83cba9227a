// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/episode_table.hpp"

#include <cstddef>
#include <span>
#include <utility>

namespace dermis::out::datasets {
namespace {

constexpr std::size_t kMostWaitingBytes = std::size_t{4} << 20U;

struct Statistic {
  const char* name;
  double (ColumnStatistics::*of)(std::size_t element) const;
};
constexpr std::array kStatistics = {
    Statistic{"min", &ColumnStatistics::lowest}, Statistic{"max", &ColumnStatistics::highest},
    Statistic{"mean", &ColumnStatistics::mean}, Statistic{"std", &ColumnStatistics::deviation}};

}  // namespace

Result<std::unique_ptr<EpisodeTable>> EpisodeTable::create(const std::string& path,
                                                           const std::vector<Feature>& features) {
  std::vector<ParquetColumn> columns;
  for (const char* const name : kNumbers) columns.push_back({name, ParquetType::int64});
  columns.push_back({"tasks", ParquetType::text, {1}});
  for (const Feature& feature : features) {
    const std::string prefix = "stats/" + feature.name + "/";
    for (const Statistic& one : kStatistics)
      columns.push_back({prefix + one.name, ParquetType::float64, feature.shape});
    columns.push_back({prefix + "count", ParquetType::int64, {1}});
  }
  auto file = ParquetFile::create(path, std::move(columns));
  if (!file) return file.error();
  return std::unique_ptr<EpisodeTable>(new EpisodeTable(*std::move(file)));
}

Status EpisodeTable::add(const std::array<std::int64_t, kNumbers.size()>& numbers, const std::string& task,
                         const std::vector<ColumnStatistics>& statistics) {
  std::vector<std::vector<double>> kept;  // of each statistic of each feature
  for (const ColumnStatistics& of_feature : statistics) {
    for (const Statistic& one : kStatistics) {
      std::vector<double>& values = kept.emplace_back();
      for (std::size_t k = 0; k < of_feature.elements(); ++k) values.push_back((of_feature.*one.of)(k));
    }
  }
  const std::string text = plain_text(task);
  std::vector<std::span<const std::byte>> row;
  for (const std::int64_t& number : numbers) row.push_back(std::as_bytes(std::span(&number, 1)));
  row.push_back(std::as_bytes(std::span(text)));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    row.push_back(std::as_bytes(std::span(kept[k])));
    if ((k + 1) % kStatistics.size() == 0) row.push_back(std::as_bytes(std::span(&numbers[1], 1)));  // the length
  }
  file_->write(1, row);
  return file_->waiting_bytes() > kMostWaitingBytes ? file_->end_row_group() : Status(Done{});
}

}  // namespace dermis::out::datasets
