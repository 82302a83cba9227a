// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "bytes/recordings/bag_folder.hpp"
#include "bytes/recordings/recording_description.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

/// "'chest', 'left_hand' and 38 more": the names of a whole suit fill screens.
std::string names_of(const std::vector<RecordedArray>& arrays) {
  constexpr std::size_t kMostNames = 50;
  std::string names;
  for (std::size_t i = 0; i < std::min(arrays.size(), kMostNames); ++i) {
    if (i > 0) names += ", ";
    names += printable(arrays[i].name);
  }
  if (arrays.size() > kMostNames) names += " and " + std::to_string(arrays.size() - kMostNames) + " more";
  return names;
}

/// "bag#/touch" where `bag` is a folder of rosbag2: its file.
RecordingPlace place_in_folder(const std::string& text) {
  const std::size_t mark = text.rfind('#');
  for (const std::size_t end : {text.size(), mark}) {
    if (end == std::string::npos) continue;
    const std::optional<BagFolder> folder = bag_folder(text.substr(0, end));
    if (folder && !folder->file.empty()) return {folder->file, end == mark ? text.substr(mark + 1) : ""};
  }
  return {text, ""};
}

}  // namespace

Result<std::size_t> find_array(const std::vector<RecordedArray>& arrays, const std::string& path,
                               const std::string& name) {
  if (name.empty() && arrays.size() == 1) return std::size_t{0};
  if (name.empty()) {
    return bad_input(path + ": holds " + std::to_string(arrays.size()) + " arrays; name one, as " +
                     printable(path + "#" + arrays.front().name) + ": " + names_of(arrays));
  }
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const RecordedArray& array) {
    return array.name == name || array.topic == name;
  });
  if (found != arrays.end()) return static_cast<std::size_t>(found - arrays.begin());
  return bad_input(path + ": has no array " + printable(name) + "; it has: " + names_of(arrays));
}

RecordingPlace recording_place(const std::string& text) {
  std::error_code ignored;
  for (const std::string_view mark :
       {".mcap#", ".dsa#", ".dsa3#", ".csv#", ".txt#", ".npy#", ".npz#", ".mat#", ".h5#", ".hdf5#"}) {
    const std::size_t at = text.rfind(mark);
    if (at == std::string::npos || std::filesystem::exists(text, ignored)) continue;
    const std::size_t end = at + mark.size();
    return {text.substr(0, end - 1), text.substr(end)};
  }
  return place_in_folder(text);
}

RecordingReader::RecordingReader(std::unique_ptr<SuitRecordingReader> suit, std::size_t array)
    : suit_(std::move(suit)), array_(array) {
  suit_->read_only(array);
}

RecordingReader::~RecordingReader() = default;

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(const std::string& path, const std::string& array) {
  Result<std::unique_ptr<std::istream>> in = files::open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path, array);
}

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(std::unique_ptr<std::istream> in,
                                                               const std::string& name, const std::string& array) {
  Result<std::unique_ptr<SuitRecordingReader>> suit = SuitRecordingReader::open(std::move(in), name);
  if (!suit) return suit.error();
  const Result<std::size_t> chosen = find_array((*suit)->arrays(), name, array);
  if (!chosen) return chosen.error();
  return std::unique_ptr<RecordingReader>(new RecordingReader(*std::move(suit), *chosen));
}

Result<bool> RecordingReader::next(RawFrame& frame) {
  std::size_t array = 0;
  Result<bool> got_frame = suit_->next(array, frame);
  if (!got_frame || !*got_frame) return got_frame;
  ++statistics_.frames;
  statistics_.lost_frames += frame.acquisition.lost_before;
  return got_frame;
}

std::optional<FrameShape> RecordingReader::shape() const {
  const FrameShape& shape = suit_->arrays()[array_].shape;
  return shape.taxel_count() == 0 ? std::nullopt : std::optional(shape);
}

SourceStatistics RecordingReader::statistics() const {
  return statistics_;
}

void RecordingReader::seek(Nanos time) {
  suit_->seek(time);
}

bool RecordingReader::complete() const noexcept {
  return suit_->complete();
}

FrameNotes RecordingReader::notes() const {
  const RecordedArray& array = suit_->arrays()[array_];
  return {array.name, array.array_toml, array.model_hash, array.simulation, array.model_file};
}

}  // namespace dermis::bytes::recordings
