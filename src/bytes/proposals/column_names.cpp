// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/column_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <set>
#include <utility>

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostLinesBack = 8;
constexpr std::size_t kMostName = 40;

/// Words in small letters: "TimeStamp_ms" -> {"timestamp", "ms"}.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

template <std::size_t N>
bool has_any(const std::vector<std::string>& words, const std::array<std::string_view, N>& known) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(known.begin(), known.end(), word) != known.end();
  });
}

constexpr std::array<std::string_view, 11> kTime = {"time", "timestamp", "t",       "ts",    "millis", "micros",
                                                    "zeit", "epoch",     "elapsed", "clock", "stamp"};
constexpr std::array<std::string_view, 5> kSeconds = {"s", "sec", "secs", "seconds", "second"};
constexpr std::array<std::string_view, 6> kMillis = {"ms", "msec", "msecs", "millis", "milliseconds", "tms"};
constexpr std::array<std::string_view, 6> kMicros = {"us", "usec", "usecs", "micros", "microseconds", "tus"};
constexpr std::array<std::string_view, 7> kNanos = {"ns",       "nsec",    "nsecs",      "nanos",
                                                    "nanosecs", "nanosec", "nanoseconds"};
constexpr std::array<std::string_view, 41> kMotion = {
    "imu",           "acc",   "accel",     "accx",    "accy",    "accz", "acceleration",
    "accelerometer", "ax",    "ay",        "az",      "gyr",     "gyro", "gyrox",
    "gyroy",         "gyroz", "gyroscope", "gx",      "gy",      "gz",   "mag",
    "magx",          "magy",  "magz",      "mx",      "my",      "mz",   "quat",
    "quaternion",    "q",     "qw",        "qx",      "qy",      "qz",   "roll",
    "pitch",         "yaw",   "euler",     "heading", "angular", "omega"};
constexpr std::array<std::string_view, 11> kOfReading = {"adc",     "raw",   "count",    "counts", "value", "val",
                                                         "reading", "force", "pressure", "analog", "fsr"};
constexpr std::array<std::string_view, 14> kOfOther = {"volt",  "volts", "voltage", "v",   "mv",      "percent", "pct",
                                                       "index", "idx",   "id",      "pin", "channel", "ch",      "ohm"};
constexpr std::array<std::string_view, 10> kFrame = {"frame", "frames", "seq",    "sequence", "counter",
                                                     "count", "cnt",    "sample", "packet",   "fn"};
constexpr std::array<std::string_view, 3> kRow = {"row", "zeile", "y"};
constexpr std::array<std::string_view, 4> kCol = {"col", "column", "spalte", "x"};
constexpr std::array<std::string_view, 6> kTemperature = {"temp", "temperature", "temperatur",
                                                          "tmp",  "celsius",     "degc"};
constexpr std::array<std::string_view, 7> kSupply = {"vcc", "supply", "vbat", "battery", "vdd", "vin", "batt"};
constexpr std::array<std::string_view, 4> kFlags = {"flag", "flags", "status", "state"};

constexpr std::array<std::string_view, 9> kArray = {"id",   "array", "sensor",  "hand", "foot",
                                                    "side", "pad",   "channel", "mat"};

/// Where the cells of a line begin and end: at separators outside quotes.
std::vector<std::pair<std::size_t, std::size_t>> cells_of(std::string_view line, char separator) {
  std::vector<std::pair<std::size_t, std::size_t>> cells;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') is_quoted = !is_quoted;
    const bool ends = i == line.size() || (!is_quoted && line[i] == separator);
    if (!ends) continue;
    const bool is_end_of_blanks = separator == ' ' && i == begin;
    if (!is_end_of_blanks) cells.emplace_back(begin, i);
    begin = i + 1;
  }
  if (!cells.empty() && cells.back().first == cells.back().second) cells.pop_back();
  return cells;
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view kAround = " \t\"'#";
  while (!text.empty() && kAround.find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && kAround.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return std::string(text.substr(0, kMostName));
}

bool has_letters(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
}

std::vector<std::string> names_in(const Line& head, const Line& line, char separator) {
  const auto names = cells_of(head.text, separator);
  const auto cells = cells_of(line.text, separator);
  if (names.size() < 2 || names.size() != cells.size()) return {};
  std::set<std::string_view> different;
  for (const auto& [begin, end] : names) different.insert(head.text.substr(begin, end - begin));
  if (different.size() < names.size()) return {};  // rather readings
  std::vector<std::string> result;
  for (const Token& token : line.tokens) {
    if (token.kind == Token::Kind::text) continue;
    const auto at = static_cast<std::size_t>(token.text.data() - line.text.data());
    const auto cell = std::find_if(cells.begin(), cells.end(), [&](const auto& one) { return at <= one.second; });
    const auto& name = names[static_cast<std::size_t>(std::min(cell, cells.end() - 1) - cells.begin())];
    result.push_back(trimmed(head.text.substr(name.first, name.second - name.first)));
  }
  return result;
}

}  // namespace

std::string field_of_name(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  if (words.empty()) return {};
  const bool is_unit_alone = words.size() == 1 && (has_any(words, kMillis) || has_any(words, kMicros));
  if (is_unit_alone || has_any(words, kTime)) {
    if (has_any(words, kMillis)) return "time_ms";
    if (has_any(words, kMicros)) return "time_us";
    if (has_any(words, kNanos)) return "time_ns";
    return has_any(words, kSeconds) ? "time_s" : "time";
  }
  if (has_any(words, kTemperature)) return "temperature";
  if (has_any(words, kSupply)) return "supply";
  if (has_any(words, kFrame)) return "frame";
  if (has_any(words, kRow)) return "row";
  if (has_any(words, kCol)) return "col";
  if (has_any(words, kFlags)) return "flags";
  return has_any(words, kArray) ? "array" : "";
}

double time_unit_of_name(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  if (has_any(words, kSeconds)) return 1.0;
  if (has_any(words, kMillis)) return 1e-3;
  if (has_any(words, kMicros)) return 1e-6;
  return has_any(words, kNanos) ? 1e-9 : 0.0;
}

bool is_of_motion(std::string_view name) {
  return has_any(words_of(name), kMotion);
}

int rank_of_key(std::string_view key) {
  const std::vector<std::string> words = words_of(key);
  return has_any(words, kOfReading) ? 1 : has_any(words, kOfOther) ? -1 : 0;
}

std::string unit_of_name(std::string_view name) {
  for (const std::string& word : words_of(name)) {
    if (word == "kpa") return "kPa";
    if (word == "ohm" || word == "ohms") return "ohms";
    if (word == "newton" || word == "newtons") return "newtons";
    if (word == "volt" || word == "volts") return "volts";
  }
  if (name.ends_with("[N]") || name.ends_with("(N)")) return "newtons";
  return name.ends_with("[V]") || name.ends_with("(V)") ? "volts" : "";
}

std::string stem_of(std::string_view name) {
  std::size_t end = name.size();
  constexpr std::string_view kNumber = "0123456789[](). ";
  while (end > 0 && kNumber.find(name[end - 1]) != std::string_view::npos) --end;
  return std::string(name.substr(0, end));
}

std::vector<std::string> names_of_columns(const std::vector<Line>& lines, std::size_t line) {
  for (std::size_t back = 1; back <= std::min(line, kMostLinesBack); ++back) {
    const Line& head = lines[line - back];
    const bool is_json = head.text.starts_with('{') || head.text.starts_with('[');
    if (!has_letters(head.text) || is_json) continue;
    for (const char separator : {';', '\t', ',', ' '}) {
      std::vector<std::string> names = names_in(head, lines[line], separator);
      if (!names.empty()) return names;
    }
  }
  return {};
}

}  // namespace dermis::bytes::proposals
