// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/taught_files.hpp"

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>

#include "dermis/files/array_toml.hpp"
#include "dermis/files/atomic_file.hpp"
#include "dermis/files/frames_csv.hpp"

namespace dermis::serve {
namespace {

using recognition::Label;
using recognition::LabelledFrames;
using recognition::SensedArray;

Status write_frames(const std::string& path, const LabelledFrames& data) {
  const SensedArray& array = data.layout.arrays.front();
  auto writer = files::FramesCsvWriter::create(path, {array.rows, array.cols});
  if (!writer) return writer.error();
  RawFrame frame;
  for (std::size_t number = 0; number < data.frame_count(); ++number) {
    const auto begin = data.frames.begin() + static_cast<std::ptrdiff_t>(number * data.layout.readings);
    frame.time = Nanos(static_cast<std::int64_t>(1e9 * static_cast<double>(number) / data.layout.rate_hz));
    frame.counts.assign(begin, begin + static_cast<std::ptrdiff_t>(data.layout.readings));
    if (Status written = (*writer)->write(frame); !written) return written;
  }
  return (*writer)->commit();
}

/// The array, as one whose readings are newtons.
ArrayDescription array_of_newtons(const ArrayDescription& array) {
  ArrayDescription newtons;
  newtons.name = array.name;
  newtons.rows = array.rows;
  newtons.cols = array.cols;
  newtons.row_pitch_m = array.row_pitch_m;
  newtons.col_pitch_m = array.col_pitch_m;
  newtons.taxel_area_m2 = array.taxel_area_m2;
  newtons.readout.circuit = Circuit::none;
  newtons.readout.quantity = Quantity::force;
  newtons.readout.adc_noise_counts = recognition::kLeastNewtons;
  return newtons;
}

Status write_labels(const std::string& path, const LabelledFrames& data) {
  Result<files::AtomicFile> file = files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write("id,first,last,class,session\n");
  for (const Label& label : data.labels) {
    file->write(fmt::format("{},{},{},{},{}\n", label.id, label.first, label.last, label.name, label.group));
  }
  return file->commit();
}

}  // namespace

Status write_taught(const std::string& path, const ArrayDescription& array, const LabelledFrames& data) {
  if (Status written = write_frames(path + ".frames.csv", data); !written) return written;
  if (Status written = files::write_array(path + ".array.toml", array_of_newtons(array)); !written) return written;
  return write_labels(path + ".labels.csv", data);
}

}  // namespace dermis::serve
