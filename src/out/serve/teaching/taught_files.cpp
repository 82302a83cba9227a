// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/teaching/taught_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/frames_csv.hpp"
#include "dermis/learn/recognition/dataset.hpp"
#include "out/serve/suit/saved_files.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kMostRest = 25;
constexpr std::size_t kMostTaughtFrames = 1000 * (TouchCollector::kMostFrames + 2 * kMostRest);
constexpr std::size_t kMostReadings = std::size_t{1} << 26U;
constexpr const char* kLabelsSuffix = ".labels.csv";

using learn::recognition::Label;
using learn::recognition::LabelledFrames;
using learn::recognition::SensedArray;

Status write_touches(const std::string& path, const LabelledFrames& data) {
  const SensedArray& array = data.layout.arrays.front();
  const auto fill = [&](std::size_t number, RawFrame& frame) {
    const auto begin = data.frames.begin() + static_cast<std::ptrdiff_t>(number * data.layout.readings);
    frame.time = Nanos(static_cast<std::int64_t>(1e9 * static_cast<double>(number) / data.layout.rate_hz));
    frame.counts.assign(begin, begin + static_cast<std::ptrdiff_t>(data.layout.readings));
  };
  return write_frames(path, {array.rows, array.cols}, data.frame_count(), fill);
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
  newtons.readout.adc_noise_counts = learn::recognition::kLeastNewtons;
  return newtons;
}

Status write_labels(const std::string& path, const LabelledFrames& data) {
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(path);
  if (!file) return file.error();
  file->write("id,first,last,class,session\n");
  for (const Label& label : data.labels) {
    file->write(fmt::format("{},{},{},{},{}\n", label.id, label.first, label.last, label.name, label.group));
  }
  return file->commit();
}

Result<learn::recognition::ForceRecording> read_frames(const std::string& path,
                                                       const learn::recognition::Layout& layout) {
  const SensedArray& array = layout.arrays.front();
  auto reader = bytes::files::FramesCsvReader::open(path, FrameShape{array.rows, array.cols});
  if (!reader) return reader.error();
  const std::size_t most = std::min(kMostTaughtFrames, kMostReadings / layout.readings);
  learn::recognition::ForceRecording recording;
  RawFrame frame;
  for (std::size_t number = 0;; ++number) {
    const Result<bool> more = (*reader)->next(frame);
    if (!more) return more.error();
    if (!*more) return recording;
    if (number == most) return bad_input(path + ": has more than " + std::to_string(most) + " frames of touches");
    recording.frames.insert(recording.frames.end(), frame.counts.begin(), frame.counts.end());
  }
}

}  // namespace

Status write_taught(const std::string& path, const ArrayDescription& array, const LabelledFrames& data) {
  if (Status written = write_touches(path + ".frames.csv", data); !written) return written;
  if (Status written = bytes::files::write_array(path + ".array.toml", array_of_newtons(array)); !written)
    return written;
  return write_labels(path + kLabelsSuffix, data);
}

Result<LabelledFrames> read_taught(const std::string& path, const learn::recognition::Layout& layout) {
  Result<learn::recognition::ForceRecording> recording = read_frames(path + ".frames.csv", layout);
  if (!recording) return recording.error();
  std::vector<learn::recognition::ForceRecording> recordings;
  recordings.push_back(*std::move(recording));
  Result<LabelledFrames> data =
      learn::recognition::label_recordings(layout, std::move(recordings), path + kLabelsSuffix, "class");
  if (data) {
    std::ranges::sort(data->labels, [](const Label& a, const Label& b) { return a.first < b.first; });
  }
  return data;
}

std::vector<CollectedTouch> touches_of(const LabelledFrames& data) {
  const std::vector<Label>& labels = data.labels;
  std::vector<CollectedTouch> touches;
  std::size_t free_from = 0;
  for (std::size_t place = 0; place < labels.size(); ++place) {
    const Label& label = labels[place];
    const std::size_t free_to = place + 1 < labels.size() ? labels[place + 1].first : data.frame_count();
    const std::size_t begin = std::max(free_from, label.first - std::min(label.first, kMostRest));
    const std::size_t rest = std::min((free_to - label.last) / 2, kMostRest);
    const std::size_t end = label.last + 1 + rest;
    free_from = end;
    const auto reading = [&](std::size_t frame) {
      return data.frames.begin() + static_cast<std::ptrdiff_t>(frame * data.layout.readings);
    };
    touches.push_back({{reading(begin), reading(end)}, label.first - begin, label.last - begin});
  }
  return touches;
}

std::vector<std::string> saved_touches(const std::string& folder, const std::string& array) {
  constexpr std::size_t kMostFiles = 100;
  const std::string prefix = array + "-touches-";
  std::vector<std::string> names;
  std::error_code none;  // a folder that cannot be read has none
  for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(kLabelsSuffix)) {
      names.push_back(name.substr(0, name.size() - std::string_view(kLabelsSuffix).size()));
    }
  }
  std::sort(names.begin(), names.end(), std::greater<>());
  names.resize(std::min(names.size(), kMostFiles));
  return names;
}

}  // namespace dermis::out::serve
