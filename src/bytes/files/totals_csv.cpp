// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/totals_csv.hpp"

#include <initializer_list>
#include <utility>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {

TotalsCsvWriter::TotalsCsvWriter(AtomicFile file) : file_(std::move(file)) {}

Result<TotalsCsvWriter> TotalsCsvWriter::create(const std::string& path) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->write("time_s,status,total_n,sigma_total_n,left_out\n");
  return TotalsCsvWriter(*std::move(file));
}

Status TotalsCsvWriter::write(const ForceFrame& frame) {
  const TotalForce total = frame.total();
  line_.clear();
  append_seconds(line_, frame.time);
  line_ += ',';
  line_ += to_string(frame.status);
  for (const double value : {total.newtons, total.sigma_newtons}) {
    line_ += ',';
    append_number(line_, value);
  }
  line_ += ',' + std::to_string(total.left_out) + '\n';
  file_.write(line_);
  return file_.status();
}

Status TotalsCsvWriter::commit() {
  return file_.commit();
}

}  // namespace dermis::bytes::files
