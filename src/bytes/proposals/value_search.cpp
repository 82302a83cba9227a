// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/value_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/checksum_search.hpp"
#include "bytes/proposals/draft.hpp"
#include "bytes/proposals/trial.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostLeading = 24;  // bytes before the readings
constexpr std::size_t kMostTrailing = 12;
constexpr std::size_t kPackets = 24;
constexpr std::size_t kMostSpans = 8;
constexpr std::size_t kMostUnexplained = 4;
constexpr std::size_t kFewest = 4;  // readings
constexpr double kOfUnexplained = 0.2;
constexpr double kOfLeading = 0.1;  // more, before the readings
constexpr double kOfTags = 0.8;

struct Type {
  const char* name;
  std::size_t bits;
};
constexpr std::array kTypes = {
    Type{"u8", 8},     Type{"u16le", 16}, Type{"u16be", 16},           Type{"i16le", 16},          Type{"i16be", 16},
    Type{"u12be", 12}, Type{"u12le", 12}, Type{"u10be", 10},           Type{"u10le", 10},          Type{"f32le", 32},
    Type{"f32be", 32}, Type{"u32le", 32}, Type{"u32be", 32},           Type{"u24le", 24},          Type{"u24be", 24},
    Type{"f64le", 64}, Type{"f64be", 64}, Type{"u16le mask=0FFF", 16}, Type{"u16be mask=0FFF", 16}};

/// How unusual an array of so many readings is.
double strangeness(std::size_t count) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count))));
  if (side * side == count) return 0.0;
  for (std::size_t rows = side + 1; rows > 1; --rows) {
    if (count % rows == 0) return count / rows > 4 * rows ? 0.25 : 0.1;
  }
  return 0.3;
}

/// Packets in turn may hold the rows of one.
double strangeness(std::size_t count, const std::vector<PacketField>& fields) {
  double least = strangeness(count);
  for (const PacketField& field : fields) {
    if (field.field == "row") least = std::min(least, strangeness(count * field.numbers.size()));
  }
  return least;
}

std::optional<FrameShape> any_shape(std::size_t count) {
  if (count <= 1024) return FrameShape{1, count};
  for (std::size_t cols = 1024; cols >= 32; --cols) {
    if (count % cols == 0 && count / cols <= 1024) return FrameShape{count / cols, cols};
  }
  return std::nullopt;
}

/// Numbers near both ends of their range, and none between them, lack their sign.
bool are_without_sign(const Readings& readings, double range) {
  std::array<std::size_t, 3> counts{};  // low, between, high
  for (const std::vector<float>& frame : readings) {
    for (const float value : frame) ++counts[value < 0.25 * range ? 0 : value < 0.75 * range ? 1 : 2];
  }
  return range > 1e4 && counts[0] > 0 && counts[1] == 0 && 50 * counts[2] > counts[0];
}

/// Every second byte is near 0 or near 255, and often either: the upper half of a small number with a sign.
bool have_sign_bytes(const Readings& readings) {
  for (const std::size_t phase : {0U, 1U}) {
    std::array<std::size_t, 3> counts{};  // low, between, high
    for (const std::vector<float>& frame : readings) {
      for (std::size_t k = phase; k < frame.size(); k += 2) ++counts[frame[k] < 8.0F ? 0 : frame[k] < 248.0F ? 1 : 2];
    }
    if (50 * counts[1] < counts[0] + counts[2] && 20 * std::min(counts[0], counts[2]) > counts[0] + counts[2])
      return true;
  }
  return false;
}

/// The first or the last reading never changes, and is far from 0 beyond all others.
bool has_mark_at_an_end(const Readings& readings) {
  const std::size_t count = readings.front().size();
  for (const std::size_t end : {std::size_t{0}, count - 1}) {
    const float mark = readings.front()[end];
    const auto is_beyond = [&](float value) { return std::abs(value) >= std::abs(mark); };
    const bool is_mark = std::ranges::all_of(readings, [&](const std::vector<float>& frame) {
      return frame[end] == mark && std::ranges::count_if(frame, is_beyond) == 1;
    });
    if (is_mark && count > 1) return true;
  }
  return false;
}

class ValueSearch {
 public:
  ValueSearch(const Packets& packets, std::span<const std::uint8_t> bytes, const std::vector<PacketField>& fields)
      : packets_(packets), sample_(first_packets(packets, bytes, kPackets)), fields_(fields) {
    for (std::size_t at = 0; at < packets.size; ++at) is_constant_.push_back(is_constant(packets, at) ? 1 : 0);
  }

  void try_span(std::size_t begin, std::size_t end, const Type& type, std::size_t count, std::size_t unexplained,
                bool is_count_known) {
    ValueSpan span{begin, end, type.name, count};
    const bool is_masked = span.type.find("mask") != std::string::npos;
    if (is_masked && !has_tags(begin, end, span.type[3] == 'b')) return;
    const std::optional<Trial> trial = decode(span);
    if (!trial || trial->readings.empty()) return;
    span.readings = trial->readings;
    double sum = 0.0;
    double size = 0.0;
    bool has_negative = false;
    for (const std::vector<float>& frame : span.readings) {
      for (const float value : frame) {
        const double magnitude = std::abs(static_cast<double>(value));
        if (!std::isfinite(value) || magnitude > 1e10 || (magnitude > 0.0 && magnitude < 1e-12)) return;
        has_negative = has_negative || value < 0.0F;
        sum += magnitude;
        size += 1.0;
      }
    }
    if (span.type.front() == 'i' && !has_negative) return;  // the same as without a sign
    if (type.bits == 64 && sum == 0.0) return;              // too small for a float: other bytes
    span.merit = -0.5 * roughness_along(span.readings) - 0.3 * roughness_in_time(span.readings) -
                 0.03 * std::log2(1.0 + sum / size) - kOfUnexplained * static_cast<double>(unexplained) -
                 (is_count_known ? 0.0 : strangeness(count, fields_));
    span.merit -= kOfLeading * static_cast<double>(this->unexplained(packets_.mark_size, begin));
    span.merit -= has_mark_at_an_end(span.readings) ? 0.3 : 0.0;
    const bool is_behind_number = std::ranges::any_of(fields_, [&](const PacketField& field) {
      const bool is_before = !field.numbers.empty() && field.at + field.size <= begin && unexplained == 0;
      return is_before && this->are_constant(field.at + field.size, begin);
    });
    span.merit += (is_behind_number ? 0.3 : 0.0) + (is_masked ? kOfTags : 0.0);
    span.merit -= type.bits == 8 && have_sign_bytes(span.readings) ? 0.3 : 0.0;
    for (const PacketField& field : fields_) span.merit -= field.at < end && field.at + field.size > begin ? 0.4 : 0.0;
    if (span.type.front() == 'u' && are_without_sign(span.readings, std::exp2(static_cast<double>(type.bits))))
      span.merit -= 0.3;
    spans_.push_back(std::move(span));
  }

  /// Bytes that vary and that no field explains.
  [[nodiscard]] std::size_t unexplained(std::size_t begin, std::size_t end) const {
    std::size_t count = 0;
    for (std::size_t at = begin; at < end; ++at) {
      const bool is_field = std::any_of(fields_.begin(), fields_.end(),
                                        [&](const PacketField& one) { return at >= one.at && at < one.at + one.size; });
      count += is_constant_[at] == 0 && !is_field ? 1 : 0;
    }
    return count;
  }

  std::vector<ValueSpan> best() {
    std::stable_sort(spans_.begin(), spans_.end(),
                     [](const ValueSpan& a, const ValueSpan& b) { return a.merit > b.merit; });
    if (spans_.size() > kMostSpans) spans_.resize(kMostSpans);
    return std::move(spans_);
  }

 private:
  [[nodiscard]] bool are_constant(std::size_t begin, std::size_t end) const {
    return std::all_of(is_constant_.begin() + static_cast<std::ptrdiff_t>(begin),
                       is_constant_.begin() + static_cast<std::ptrdiff_t>(end),
                       [](std::uint8_t one) { return one != 0; });
  }

  /// The upper four of 16 bits count the readings of each packet.
  [[nodiscard]] bool has_tags(std::size_t begin, std::size_t end, bool is_big_endian) const {
    for (const Bytes& packet : packets_.packets) {
      for (std::size_t at = begin; at + 1 < end; at += 2) {
        const auto tag = [&](std::size_t place) { return std::size_t{packet[place + (is_big_endian ? 0 : 1)]} >> 4U; };
        if (tag(begin) > 1 || tag(at) != ((tag(begin) + (at - begin) / 2) & 0xFU)) return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::optional<Trial> decode(const ValueSpan& span) const {
    const std::optional<FrameShape> shape = any_shape(span.count);
    if (!shape) return std::nullopt;
    Draft draft{.arrays = {{"", *shape}}};
    const std::size_t mark = packets_.escape.empty() ? packets_.mark_size : 0;
    if (mark > 0) draft.packet.push_back(layouts::hexadecimal(std::span(packets_.packets.front()).first(mark)));
    if (span.begin > mark) draft.packet.push_back("skip " + std::to_string(span.begin - mark));
    draft.packet.push_back("values " + span.type);
    if (span.end < packets_.size) draft.packet.push_back("skip " + std::to_string(packets_.size - span.end));
    if (!packets_.escape.empty()) draft.keys.emplace_back("escape", files::quoted_toml(packets_.escape));
    return try_layout(toml_of(draft), sample_);
  }

  const Packets& packets_;
  std::span<const std::uint8_t> sample_;
  const std::vector<PacketField>& fields_;
  std::vector<std::uint8_t> is_constant_;
  std::vector<ValueSpan> spans_;
};

}  // namespace

std::vector<ValueSpan> value_spans(const Packets& packets, std::span<const std::uint8_t> bytes, std::size_t begin,
                                   std::size_t end, const std::vector<PacketField>& fields,
                                   const std::vector<std::size_t>& counts) {
  ValueSearch search(packets, bytes, fields);
  for (std::size_t from = begin; from < std::min(end, begin + kMostLeading); ++from) {
    const std::size_t leading = search.unexplained(begin, from);
    if (leading > kMostUnexplained) break;
    for (std::size_t to = end; to > from && to + kMostTrailing > end; --to) {
      const std::size_t unexplained = leading + search.unexplained(to, end);
      if (unexplained > kMostUnexplained) break;
      for (const Type& type : kTypes) {
        const std::size_t count = (to - from) * 8 / type.bits;
        const bool is_whole = (count * type.bits + 7) / 8 == to - from;
        const bool is_known = std::find(counts.begin(), counts.end(), count) != counts.end();
        if (!is_whole || count < (is_known ? 1 : kFewest) || (!counts.empty() && !is_known)) continue;
        if (counts.empty() && (unexplained > 1 || strangeness(count, fields) > 0.2) && from > begin) continue;
        search.try_span(from, to, type, count, unexplained, is_known);
      }
    }
  }
  return search.best();
}

}  // namespace dermis::bytes::proposals
