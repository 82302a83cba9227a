// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/files/csv_reader.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kFirstBufferBytes = std::size_t{1} << 16U;
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 25U;

/// Texts that are mistaken for CSV or saved as it, and are none here.
std::string foreign_text(std::string_view line) {
  if (const auto other = wrong_kind(line, kTableKind)) return *other;
  const auto has = [line](char c) { return line.find(c) != std::string_view::npos; };
  if (line.starts_with("\xFF\xFE") || line.starts_with("\xFE\xFF") || has('\0')) {
    return "is UTF-16 text; save it as UTF-8";
  }
  if (has('"')) return "has quotes around its values; write them without";
  if (!has(',') && has(';')) return "has semicolons between its values; write commas, and decimals with a point";
  if (!has(',') && has('\t')) return "has tabs between its values; write commas";
  return {};
}

}  // namespace

CsvReader::CsvReader(std::istream& in, std::string name)
    : in_(in), name_(std::move(name)), buffer_(kFirstBufferBytes) {}

Result<bool> CsvReader::next_line(std::string_view& line) {
  while (take_raw_line(line)) {
    ++line_number_;
    if (line.size() > kMaxLineBytes) return error("is longer than 32 MiB; one frame or load belongs on each line");
    if (line_number_ == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    line = trimmed(line);
    if (line.empty()) continue;
    const std::string mistake = std::exchange(is_first_line_, false) ? foreign_text(line) : "";
    if (!mistake.empty()) return error(mistake);
    return true;
  }
  if (in_.bad()) return read_failure(name_);
  return false;
}

std::string CsvReader::place() const {
  return name_ + ":" + std::to_string(std::max<std::size_t>(line_number_, 1));
}

Error CsvReader::error(std::string_view message) const {
  return bad_input(place() + ": " + std::string(message));
}

bool CsvReader::take_raw_line(std::string_view& line) {
  while (true) {
    const char* const from = buffer_.data() + scanned_;
    const auto* const line_end = static_cast<const char*>(std::memchr(from, '\n', end_ - scanned_));
    scanned_ = line_end != nullptr ? static_cast<std::size_t>(line_end - buffer_.data()) : end_;
    const bool is_too_long = scanned_ - begin_ > kMaxLineBytes;
    was_cut_ = line_end == nullptr;
    if (line_end != nullptr || is_too_long || !fill()) break;
  }
  line = {buffer_.data() + begin_, scanned_ - begin_};
  if (begin_ == end_) return false;
  begin_ = scanned_ = std::min(scanned_ + 1, end_);
  return true;
}

/// Moves the open line to the front, makes room for more and reads; false at the end of the stream.
bool CsvReader::fill() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
            buffer_.begin());
  end_ -= begin_;
  scanned_ -= begin_;
  begin_ = 0;
  if (2 * end_ > buffer_.size()) buffer_.resize(2 * buffer_.size());
  in_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
  const auto received = static_cast<std::size_t>(in_.gcount());
  end_ += received;
  return received > 0;
}

bool CsvCells::next(std::string_view& cell) noexcept {
  if (at_end_) return false;
  const std::size_t comma = rest_.find(',');
  at_end_ = comma == std::string_view::npos;
  cell = trimmed(rest_.substr(0, comma));
  rest_.remove_prefix(at_end_ ? rest_.size() : comma + 1);
  return true;
}

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  CsvCells rest(line);
  for (std::string_view cell; rest.next(cell);) cells.push_back(cell);
  return cells;
}

std::size_t count_cells(std::string_view line) noexcept {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

Status check_count(std::string_view line, std::size_t columns) {
  const std::size_t count = count_cells(line);
  if (count == columns) return Done{};
  const bool may_be_decimals = count > columns && !line.ends_with(',');
  return bad_input("has " + std::to_string(count) + " values, the header " + std::to_string(columns) +
                   (may_be_decimals ? ": write decimals with a point, as each comma begins a value" : ""));
}

}  // namespace dermis::bytes::files
