// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/forces_csv.hpp"

#include <cassert>
#include <utility>

#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {

ForcesCsvWriter::ForcesCsvWriter(AtomicFile file, std::size_t taxel_count, ForceColumn column)
    : file_(std::move(file)), taxel_count_(taxel_count), column_(column) {}

Result<ForcesCsvWriter> ForcesCsvWriter::create(const std::string& path, std::size_t rows, std::size_t cols,
                                                ForceColumn column) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  std::string header = "time_s,status";
  append_taxel_names(header, rows, cols);
  file->write(header + "\n");
  return ForcesCsvWriter(*std::move(file), rows * cols, column);
}

Status ForcesCsvWriter::write(const ForceFrame& frame) {
  const std::vector<float>& values = column_ == ForceColumn::newtons ? frame.newtons : frame.sigma_newtons;
  assert(values.size() == taxel_count_);
  line_.clear();
  append_seconds(line_, frame.time);
  line_ += ',';
  line_ += to_string(frame.status);
  for (const float value : values) {
    line_ += ',';
    append_number(line_, value);
  }
  line_ += '\n';
  file_.write(line_);
  return file_.status();
}

Status ForcesCsvWriter::commit() {
  return file_.commit();
}

}  // namespace dermis::bytes::files
