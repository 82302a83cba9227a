// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/taught_files.hpp"

#include <fmt/core.h>

#include "dermis/files/atomic_file.hpp"
#include "dermis/files/npy.hpp"

namespace dermis::serve {
namespace {

using recognition::Label;
using recognition::LabelledFrames;
using recognition::SensedArray;

Status write_text(const std::string& path, const std::string& text) {
  Result<files::AtomicFile> file = files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

Status write_frames(const std::string& path, const LabelledFrames& data) {
  const SensedArray& array = data.layout.arrays.front();
  auto writer = files::NpyWriter::create(path, {array.rows, array.cols});
  if (!writer) return writer.error();
  RawFrame frame;
  for (auto at = data.frames.begin(); at != data.frames.end();) {
    const auto end = at + static_cast<std::ptrdiff_t>(data.layout.readings);
    frame.counts.assign(at, end);
    if (Status written = (*writer)->write(frame); !written) return written;
    at = end;
  }
  return (*writer)->commit();
}

}  // namespace

Status write_taught(const std::string& path, const LabelledFrames& data) {
  const SensedArray& array = data.layout.arrays.front();
  std::string labels = "id,first,last,class,session\n";
  for (const Label& label : data.labels) {
    labels += fmt::format("{},{},{},{},{}\n", label.id, label.first, label.last, label.name, label.group);
  }
  const std::string arrays = fmt::format("array,rows,cols,first_column,row_pitch_mm,col_pitch_mm\n{},{},{},0,{},{}\n",
                                         array.name, array.rows, array.cols, array.row_pitch_mm, array.col_pitch_mm);
  if (Status written = write_frames(path + ".frames.npy", data); !written) return written;
  if (Status written = write_text(path + ".arrays.csv", arrays); !written) return written;
  return write_text(path + ".labels.csv", labels);
}

}  // namespace dermis::serve
