// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/marks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/csv_table.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

using ros_messages::Mark;

bool holds_marks(const McapChannel& channel) {
  return channel.topic == kMarksTopic && channel.schema_name == ros_messages::mark_type().name;
}

/// Whether a message may be one: the index of a whole file knows.
bool may_hold_marks(const McapReader& mcap) {
  if (!mcap.statistics()) return true;
  return std::ranges::any_of(mcap.channels(), [](const auto& channel) { return holds_marks(channel.second); });
}

Result<std::vector<Mark>> recorded_marks(const std::string& recording) {
  const Result<std::unique_ptr<McapReader>> mcap = McapReader::open(recording);
  if (!mcap) return mcap.error();
  std::vector<Mark> marks;
  McapMessage message;
  while (may_hold_marks(**mcap) && marks.size() < kMostMarks) {
    const Result<bool> got = (*mcap)->next(message);
    if (!got) return got.error();
    if (!*got) break;
    if (!holds_marks((*mcap)->channels().at(message.channel))) continue;
    Result<Mark> mark = ros_messages::decode_mark(message.data);
    if (!mark) {
      return bad_input(
          fmt::format("{}: message {} of {}: {}", recording, message.sequence, kMarksTopic, mark.error().message));
    }
    marks.push_back(*std::move(mark));
  }
  return marks;
}

Result<std::vector<Mark>> edited_marks(const std::string& path, Nanos start) {
  const Result<files::CsvTable> table = files::CsvTable::read(path);
  if (!table) return table.error();
  const Result<std::size_t> time = table->needed_column("time_s");
  if (!time) return time.error();
  const Result<std::size_t> label = table->needed_column("label");
  if (!label) return label.error();
  if (table->rows() > kMostMarks) return table->error("has more than 100000 marks");
  constexpr double kLongest = 1e9;  // s, 30 years
  std::vector<Mark> marks;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const Result<double> seconds = table->number_at(row, *time);
    if (!seconds) return seconds.error();
    if (std::abs(*seconds) > kLongest) return table->error(row, "time_s: is no time of a recording");
    marks.push_back({.time = start + Nanos(std::llround(1e9 * *seconds)), .label = table->at(row, *label)});
  }
  return marks;
}

/// A CSV of the project knows neither quotes nor commas in a text.
bool may_be_label(const std::string& label) {
  return label.size() <= kMostLabelBytes && std::ranges::none_of(label, [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == ',' || c == '"' || c == '\x7f';
         });
}

}  // namespace

std::string marks_path(const std::string& recording) {
  return std::filesystem::path(recording).replace_extension(".marks.csv").string();
}

Result<std::vector<Mark>> read_marks(const std::string& recording, Nanos start) {
  Result<std::vector<Mark>> marks = recorded_marks(recording);
  if (!marks) return marks;
  const std::string path = marks_path(recording);
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) {
    Result<std::vector<Mark>> edited = edited_marks(path, start);
    if (!edited) return edited;
    std::erase_if(*marks, [](const Mark& mark) { return mark.event.empty(); });
    marks->insert(marks->end(), edited->begin(), edited->end());
  }
  std::ranges::stable_sort(*marks, {}, &Mark::time);
  return marks;
}

Status write_marks(const std::string& recording, Nanos start, std::span<const Mark> marks) {
  if (marks.size() > kMostMarks) return bad_input("a recording has at most 100000 marks");
  std::string text = "time_s,label\n";
  for (const Mark& mark : marks) {
    if (!mark.event.empty()) continue;
    if (!may_be_label(mark.label)) {
      return bad_input("label: at most 200 bytes, without commas, quotes and control characters");
    }
    text += fmt::format("{:.9f},{}\n", 1e-9 * static_cast<double>((mark.time - start).count()), mark.label);
  }
  Result<files::AtomicFile> file = files::AtomicFile::create(marks_path(recording));
  if (!file) return file.error();
  file->write(text);
  return file->commit();
}

}  // namespace dermis::bytes::recordings
