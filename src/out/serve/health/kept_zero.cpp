// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/kept_zero.hpp"

#include <fmt/chrono.h>

#include <chrono>
#include <filesystem>
#include <system_error>

#include "dermis/bytes/files/taxel_tables_csv.hpp"
#include "dermis/live/sources/array_folder.hpp"

namespace dermis::out::serve {
namespace {

namespace fs = std::filesystem;

fs::file_time_type changed(const std::string& path) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(path, error);
  return error ? fs::file_time_type::min() : time;
}

}  // namespace

KeptZero::KeptZero(const ServedSuit& suit, const ServedArray& array)
    : shape_{array.model->array.rows, array.model->array.cols} {
  const std::string folder = fs::path(array.model_path).parent_path().string();
  if (suit.playback || !live::sources::is_array_folder(folder)) return;
  const Result<live::sources::ArrayFolder> known = live::sources::read_array_folder(folder);
  if (!known || !known->is_calibrated() || fs::path(known->model) != fs::path(array.model_path)) return;
  model_ = known->model;
  path_ = (fs::path(folder) / "zero.csv").string();
}

std::vector<double> KeptZero::read() const {
  if (path_.empty() || changed(path_) <= changed(model_)) return {};
  Result<bytes::files::TaxelTablesReader> reader =
      bytes::files::TaxelTablesReader::open(path_, shape_.rows, shape_.cols, bytes::files::TableValues::finite);
  if (!reader) return {};
  std::vector<double> offsets(shape_.taxel_count());
  const Result<bool> got = reader->next(offsets);
  return got && *got ? offsets : std::vector<double>();
}

std::string KeptZero::taken_at() const {
  const auto system = std::chrono::file_clock::to_sys(changed(path_));
  const auto seconds = std::chrono::time_point_cast<std::chrono::seconds>(system);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
}

Status KeptZero::write(std::span<const double> offsets) const {
  if (path_.empty()) return Done{};
  Result<bytes::files::TaxelTablesWriter> writer =
      bytes::files::TaxelTablesWriter::create(path_, shape_.rows, shape_.cols);
  if (!writer) return writer.error();
  if (Status written = writer->write(offsets); !written) return written;
  return writer->commit();
}

void KeptZero::remove() const {
  std::error_code error;
  if (!path_.empty()) fs::remove(path_, error);
}

}  // namespace dermis::out::serve
