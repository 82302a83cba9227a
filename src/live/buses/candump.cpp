// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/candump.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::live::buses {
namespace {

constexpr std::size_t kMostBytes = 64;
constexpr std::size_t kLongestLine = 1024;
constexpr std::uint32_t kMostId = 0x1FFFFFFF;  // above: flags of an error
constexpr std::size_t kDigitsOfFraction = 9;
constexpr std::int64_t kNanosPerSecond = 1'000'000'000;
constexpr Nanos kJitter = std::chrono::milliseconds(1);

std::optional<std::uint32_t> hexadecimal(std::string_view text, std::size_t most_digits) {
  std::uint32_t value = 0;
  if (text.empty() || text.size() > most_digits) return std::nullopt;
  for (const char c : text) {
    const std::size_t digit = std::string_view("0123456789abcdef").find(static_cast<char>(c | 0x20));
    if (digit > 15) return std::nullopt;
    value = value << 4U | static_cast<std::uint32_t>(digit);
  }
  return value;
}

/// Takes words from the left.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(bytes::files::trimmed(text)) {}

  std::string_view take() {
    const std::size_t end = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_ = bytes::files::trimmed(rest_.substr(end));
    return word;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

/// "1436509052.249713"
std::optional<Nanos> time_of(std::string_view text) {
  const std::size_t point = std::min(text.find('.'), text.size());
  std::int64_t seconds = 0;
  constexpr std::int64_t kLatest = 9'000'000'000;
  if (!bytes::files::parse_number(text.substr(0, point), seconds) || seconds < 0 || seconds > kLatest)
    return std::nullopt;
  std::string fraction(text.substr(std::min(point + 1, text.size())));
  if (fraction.size() > kDigitsOfFraction) return std::nullopt;
  fraction.resize(kDigitsOfFraction, '0');
  std::int64_t nanos = 0;
  if (!bytes::files::parse_number(fraction, nanos) || nanos < 0) return std::nullopt;
  return Nanos(seconds * kNanosPerSecond + nanos);
}

/// "2026-11-29" and "14:03:00.249713" of candump -t A: local times, counted as if they were UTC.
std::optional<Nanos> date_time_of(std::string_view date, std::string_view clock) {
  std::array<int, 5> numbers{};  // year, month, day, hours, minutes
  const auto read = [&](std::size_t k, std::string_view text, std::size_t at, std::size_t size) {
    return at < text.size() && bytes::files::parse_number(text.substr(at, size), numbers[k]) && numbers[k] >= 0;
  };
  if (!read(0, date, 0, 4) || !read(1, date, 5, 2) || !read(2, date, 8, date.size())) return std::nullopt;
  if (!read(3, clock, 0, 2) || !read(4, clock, 3, 2)) return std::nullopt;
  const std::chrono::year_month_day day{std::chrono::year(numbers[0]),
                                        std::chrono::month(static_cast<unsigned>(numbers[1])),
                                        std::chrono::day(static_cast<unsigned>(numbers[2]))};
  const std::optional<Nanos> seconds = time_of(clock.substr(std::min<std::size_t>(6, clock.size())));
  if (!day.ok() || !seconds || numbers[3] > 23 || numbers[4] > 59 || *seconds > std::chrono::seconds(61))
    return std::nullopt;
  return std::chrono::sys_days(day).time_since_epoch() + std::chrono::hours(numbers[3]) +
         std::chrono::minutes(numbers[4]) + *seconds;
}

/// "044#2A366C2BBA", "044##12A366C2B" of CAN FD, "044#R4"
bool read_compact(std::string_view word, CandumpLine& line) {
  const std::size_t mark = word.find('#');
  std::string_view data = word.substr(mark + 1);
  const auto id = hexadecimal(word.substr(0, mark), 8);
  if (!id) return false;
  line.frame.id = *id;
  if (data.starts_with('R')) {
    line.has_data = false;
    return true;
  }
  if (data.starts_with('#')) {
    if (data.size() < 2) return false;
    data.remove_prefix(2);
  }
  if (data.size() % 2 != 0 || data.size() > 2 * kMostBytes) return false;
  for (; !data.empty(); data.remove_prefix(2)) {
    const auto byte = hexadecimal(data.substr(0, 2), 2);
    if (!byte) return false;
    line.frame.data.push_back(static_cast<std::uint8_t>(*byte));
  }
  return true;
}

/// "044   [5]  2A 36 6C 2B BA  '*6l+.'"
bool read_columns(std::string_view first, Words& words, CandumpLine& line) {
  if (first == "RX" || first == "TX") {  // candump -x
    static_cast<void>(words.take());
    static_cast<void>(words.take());
    first = words.take();
  }
  const auto id = hexadecimal(first, 8);
  std::string_view size_word = words.take();
  if (!id || size_word.size() < 3 || !size_word.starts_with('[') || !size_word.ends_with(']')) return false;
  size_word = size_word.substr(1, size_word.size() - 2);
  std::size_t size = 0;
  if (!bytes::files::parse_number(size_word, size) || size > kMostBytes) return false;
  line.frame.id = *id;
  if (words.rest().starts_with("remote")) {
    line.has_data = false;
    return true;
  }
  for (std::size_t k = 0; k < size; ++k) {
    const std::string_view word = words.take();
    const auto byte = hexadecimal(word, 2);
    if (!byte || word.size() != 2) return false;
    line.frame.data.push_back(static_cast<std::uint8_t>(*byte));
  }
  return true;
}

class CandumpFrames final : public FrameSource {
 public:
  CandumpFrames(std::unique_ptr<std::istream> in, std::string name, const CanArray& array, CandumpOptions options)
      : in_(std::move(in)), name_(std::move(name)), array_(array), assembly_(array), options_(std::move(options)) {}

  Result<bool> next(RawFrame& frame) override {
    while (true) {
      const Result<std::optional<CandumpLine>> line = next_line();
      if (!line) return line.error();
      if (!*line) return end();
      const bool is_wanted = options_.interface.empty() || (*line)->interface == options_.interface;
      if (!is_wanted || !(*line)->has_data) continue;
      const CanAssembly::Taken taken = assembly_.take((*line)->frame);
      if (taken == CanAssembly::Taken::nothing) continue;
      if (const Status only = check_interface((*line)->interface); !only) return only.error();
      if (const Status in_order = check_order((*line)->time); !in_order) return in_order.error();
      if (taken == CanAssembly::Taken::part) continue;
      if (const Status timed = set_time(**line, frame); !timed) return timed.error();
      frame.counts = assembly_.counts();
      frame.temperature_celsius.reset();
      frame.supply_v.reset();
      return true;
    }
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return array_.shape; }
  [[nodiscard]] SourceStatistics statistics() const override {
    SourceStatistics statistics;
    statistics.frames = frames_;
    statistics.damaged_frames = assembly_.incomplete();
    return statistics;
  }

 private:
  [[nodiscard]] Error error(const std::string& what) const {
    return bad_input(name_ + ":" + std::to_string(line_) + ": " + what);
  }

  /// Empty at the end. A last line without its end may be cut, and is left out where it is.
  Result<std::optional<CandumpLine>> next_line() {
    while (in_->getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))) {
      ++line_;
      const std::string_view text = bytes::files::trimmed(std::string_view(buffer_.data()));
      if (text.empty()) continue;
      std::optional<CandumpLine> line = parse_candump_line(text);
      if (line) return line;
      if (in_->eof() && line_ > 1) break;
      return error("is no line of candump, such as (1436509052.249713) can0 044#2A366C2BBA");
    }
    if (in_->bad()) return bytes::files::read_failure(name_);
    if (!in_->eof()) return error("is longer than a line of candump");
    return std::optional<CandumpLine>();
  }

  Result<bool> end() const {
    if (frames_ > 0) return false;
    return bad_input(name_ + ": has no frame of the array '" + array_.name + "'" +
                     (options_.interface.empty() ? "" : " from " + options_.interface) + "; is this its map?");
  }

  Status check_interface(const std::string& interface) {
    if (interface_.empty()) interface_ = interface;
    if (interface_ == interface) return Done{};
    return error("the array comes from " + interface_ + " and from " + interface +
                 "; choose, as interface=" + interface_);
  }

  /// Differences from line to line fall and rise.
  Status check_order(std::optional<Nanos> time) {
    if (!time) return Done{};
    if (*time + kJitter < last_) return error("the times go back; log with candump -l or -t a, not with differences");
    last_ = std::max(last_, *time);
    return Done{};
  }

  Status set_time(const CandumpLine& line, RawFrame& frame) {
    frame.acquisition = {};
    if (!line.time && !options_.rate_hz) {
      return error("has no time: log with candump -l or -t a, or give a rate, as rate=HZ");
    }
    if (line.time && options_.rate_hz) return error("has times of its own; leave rate out");
    const auto by_rate = [&] {
      return bytes::files::nanos_from_seconds(static_cast<double>(frames_) / *options_.rate_hz);
    };
    const std::optional<Nanos> time = line.time ? line.time : by_rate();
    if (!time) return error("would be later than 9e9 seconds; give a higher rate");
    frame.time = *time;
    if (line.time) frame.acquisition.arrival_utc = *time;
    ++frames_;
    return Done{};
  }

  std::unique_ptr<std::istream> in_;
  std::string name_;
  CanArray array_;
  CanAssembly assembly_;
  CandumpOptions options_;
  std::array<char, kLongestLine> buffer_{};
  std::size_t line_ = 0;
  std::size_t frames_ = 0;
  std::string interface_;
  Nanos last_{};  // time of a part
};

}  // namespace

std::optional<CandumpLine> parse_candump_line(std::string_view text) {
  Words words(text);
  CandumpLine line;
  std::string_view word = words.take();
  if (word.starts_with('(')) {
    const std::string_view date = word.ends_with(')') ? std::string_view() : std::exchange(word, words.take());
    if (!word.ends_with(')')) return std::nullopt;
    word.remove_suffix(1);
    line.time = date.empty() ? time_of(word.substr(1)) : date_time_of(date.substr(1), word);
    if (!line.time) return std::nullopt;
    word = words.take();
  }
  line.interface = word;
  word = words.take();
  if (line.interface.empty() || word.empty()) return std::nullopt;
  const bool is_read =
      word.find('#') != std::string_view::npos ? read_compact(word, line) : read_columns(word, words, line);
  if (!is_read) return std::nullopt;
  line.has_data = line.has_data && line.frame.id <= kMostId;
  return line;
}

Result<std::unique_ptr<FrameSource>> open_candump(std::unique_ptr<std::istream> in, const std::string& name,
                                                  const CanArray& array, const CandumpOptions& options) {
  return std::unique_ptr<FrameSource>(std::make_unique<CandumpFrames>(std::move(in), name, array, options));
}

}  // namespace dermis::live::buses
