// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// ActionNet and STAG gloves (TouchStreamer): lines of bytes that are 11 or more, so that '\n' is never one of them. A
// glove that is asked by 'a' answers with a line for the whole frame: index + 11, two bytes for each reading, '\n'. One
// that streams sends a line for each row: index + 11, row + 11, two bytes for each reading, '\n'.
#include <algorithm>
#include <cstring>
#include <utility>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/layouts/window_decoder.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::Verdict;
using layouts::WindowDecoder;

constexpr FrameShape kGlove = {32, 32};
constexpr std::uint8_t kOffset = 11;
constexpr int kMaxDigit = 255 - kOffset;
constexpr std::string_view kRequest = "a";

/// Reads `count` readings; false where a low byte is more than its bits can hold.
bool read_readings(const std::uint8_t* bytes, std::size_t count, int bit_shift, float* values) {
  unsigned wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned high = static_cast<unsigned>(bytes[2 * i]) - kOffset;
    const unsigned low = static_cast<unsigned>(bytes[2 * i + 1]) - kOffset;
    wrong |= (high >> 8U) | (low >> static_cast<unsigned>(bit_shift));  // below 11 the differences wrap
    values[i] = static_cast<float>(static_cast<int>((high << static_cast<unsigned>(bit_shift)) + low));
  }
  return wrong == 0;
}

class StagDecoder final : public WindowDecoder {
 public:
  StagDecoder(FrameShape shape, int bit_shift) : shape_(shape), bit_shift_(bit_shift) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return shape_; }
  [[nodiscard]] std::string_view request() const noexcept override { return streams_ ? std::string_view{} : kRequest; }

 private:
  [[nodiscard]] std::size_t reply_size() const noexcept { return 2 + 2 * shape_.taxel_count(); }
  [[nodiscard]] std::size_t row_line_size() const noexcept { return 3 + 2 * shape_.cols; }

  Verdict judge(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) override {
    if (ended) index_.reset();
    const std::size_t longest = std::max(reply_size(), row_line_size());
    const std::size_t reach = std::min(longest, bytes.size());
    const std::size_t searched = std::exchange(searched_, 0);
    const void* const end = std::memchr(bytes.data() + searched, '\n', reach - searched);
    if (end == nullptr) {
      if (reach == longest) return {Verdict::Kind::noise, reach};
      if (!ended) searched_ = reach;
      return {};
    }
    const auto size = static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - bytes.data()) + 1;
    if (size == reply_size()) return judge_reply(bytes.first(size), frame);
    if (size == row_line_size()) return judge_rows(bytes, ended, frame);
    return broken(size);
  }

  /// Before the first frame it is the end of a frame whose beginning nobody saw.
  [[nodiscard]] Verdict broken(std::size_t size) const noexcept {
    return {counts().frames > 0 ? Verdict::Kind::damaged : Verdict::Kind::noise, size};
  }

  Verdict judge_reply(std::span<const std::uint8_t> line, RawFrame& frame) {
    frame.counts.resize(shape_.taxel_count());
    if (!read_readings(&line[1], shape_.taxel_count(), bit_shift_, frame.counts.data()) || !accept(line[0], frame)) {
      return broken(line.size());
    }
    streams_ = false;
    return {Verdict::Kind::frame, line.size()};
  }

  /// The first line has the size of a row's. Up to the last row the lines have to follow each other.
  Verdict judge_rows(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) {
    const std::size_t line_size = row_line_size();
    if (bytes.size() < shape_.rows * line_size && !ended && !is_idle()) {
      searched_ = line_size - 1;
      return {};
    }
    frame.counts.resize(shape_.taxel_count());
    for (std::size_t row = 0; row < shape_.rows; ++row) {
      const std::size_t begin = row * line_size;
      if (bytes.size() < begin + line_size) return {};
      const std::span<const std::uint8_t> line = bytes.subspan(begin, line_size);
      const bool follows = line[0] == bytes[0] && line[1] == row + kOffset && line.back() == '\n';
      if (!follows || !read_readings(&line[2], shape_.cols, bit_shift_, &frame.counts[row * shape_.cols])) {
        return row == 0 ? Verdict{Verdict::Kind::noise, line_size} : broken(begin);
      }
    }
    if (!accept(bytes[0], frame)) return broken(shape_.rows * line_size);
    streams_ = true;
    return {Verdict::Kind::frame, shape_.rows * line_size};
  }

  /// The index of the frame: a byte that has to change. Where it wraps differs; forwards, a leap is a loss.
  bool accept(std::uint8_t byte, RawFrame& frame) {
    if (byte < kOffset || byte == index_) return false;
    const unsigned step = index_ && byte > *index_ ? static_cast<unsigned>(byte - *index_) : 1;
    frame.acquisition.lost_before = step - 1;
    index_ = byte;
    sequence_ += step;
    frame.acquisition.sequence = sequence_;
    return true;
  }

  FrameShape shape_;
  int bit_shift_;
  bool streams_ = false;
  std::size_t searched_ = 0;           // bytes of a line that are known to hold no end
  std::optional<std::uint8_t> index_;  // as on the wire, of the last frame
  std::uint64_t sequence_ = 0;
};

/// Answers requests.
class StagEncoder final : public Encoder {
 public:
  explicit StagEncoder(int bit_shift) : bit_shift_(bit_shift) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    bytes.push_back(static_cast<std::uint8_t>(index_ + kOffset));
    index_ = (index_ + 1) % (kMaxDigit + 1);
    for (const float count : frame.counts) {
      const auto reading = static_cast<unsigned>(to_wire(count, 0, ((kMaxDigit + 1) << bit_shift_) - 1));
      const unsigned low = reading & ((1U << static_cast<unsigned>(bit_shift_)) - 1);
      bytes.push_back(static_cast<std::uint8_t>((reading >> static_cast<unsigned>(bit_shift_)) + kOffset));
      bytes.push_back(static_cast<std::uint8_t>(low + kOffset));
    }
    bytes.push_back('\n');
  }

  [[nodiscard]] std::string_view request() const noexcept override { return kRequest; }

 private:
  int bit_shift_;
  int index_ = 0;
};

Status check(const ProtocolOptions& options) {
  if (options.bit_shift == 5 || options.bit_shift == 6) return Done{};
  return bad_input("bit_shift=" + std::to_string(options.bit_shift) + ": protocol=stag has 5 or 6");
}

}  // namespace

Result<std::unique_ptr<Decoder>> make_stag_decoder(const ProtocolOptions& options) {
  if (const Status valid = check(options); !valid) return valid.error();
  return std::unique_ptr<Decoder>(std::make_unique<StagDecoder>(options.shape.value_or(kGlove), options.bit_shift));
}

Result<std::unique_ptr<Encoder>> make_stag_encoder(const ProtocolOptions& options) {
  if (const Status valid = check(options); !valid) return valid.error();
  return std::unique_ptr<Encoder>(std::make_unique<StagEncoder>(options.bit_shift));
}

}  // namespace dermis::bytes::devices
