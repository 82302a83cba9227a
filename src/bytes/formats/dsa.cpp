// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "bytes/formats/dsa_events.hpp"
#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/text_lines.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/formats/imports.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kMostMatrices = 64;
constexpr std::size_t kMostTemperatures = std::size_t{1} << 20U;
constexpr std::size_t kDigits = 8;  // of a number in the code of a frame

struct Temperature {
  Nanos time{};
  double celsius = 0.0;
};

/// Milliseconds, as the recordings have them.
std::optional<Nanos> parse_milliseconds(std::string_view text) {
  constexpr std::size_t kMost = 9'000'000'000'000;
  std::size_t milliseconds = 0;
  if (!files::parse_number(text, milliseconds) || milliseconds > kMost) return std::nullopt;
  return std::chrono::milliseconds(milliseconds);
}

/// The number at `index` of a list with commas.
std::optional<double> number_at(std::string_view list, std::size_t index) {
  Cells cells(list, Cells::Separator::comma);
  std::string_view cell;
  for (std::size_t i = 0; i <= index; ++i) {
    if (!cells.next(cell)) return std::nullopt;
  }
  double value = 0.0;
  if (!files::parse_number(cell, value) || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The cells of a frame as its code gives them: a float of 8 hexadecimal digits each, and -n for n cells of 0.
class Cursor {
 public:
  explicit Cursor(std::string_view code) : code_(code) {}

  /// False where the code is over, or wrong.
  bool next(float& value) {
    if (zeros_ == 0 && !read(value)) return false;
    if (zeros_ == 0) return true;
    --zeros_;
    value = 0.0F;
    return true;
  }
  [[nodiscard]] bool at_end() const { return zeros_ == 0 && code_.empty(); }

 private:
  bool read(float& value) {
    std::uint32_t bits = 0;
    const std::string_view digits = code_.substr(0, kDigits);
    if (files::hexadecimal_at(digits, bits) != kDigits) return false;
    code_.remove_prefix(kDigits);
    value = std::bit_cast<float>(bits);
    if (!std::isfinite(value) || value < -static_cast<float>(kMaxLines * kMaxLines)) return false;
    if (value < 0.0F) zeros_ = static_cast<std::size_t>(-value);
    return value >= 0.0F || zeros_ > 0;
  }

  std::string_view code_;
  std::size_t zeros_ = 0;
};

class Dsa final : public FrameSource {
 public:
  Dsa(std::unique_ptr<std::istream> in, const std::string& name, const ImportOptions& options)
      : events_(std::move(in), name), options_(options) {}

  /// Looks through the file for the matrices, which come first, and the temperatures, which come last.
  Status open() {
    std::vector<FrameShape> matrices;
    const bool is_number = options_.array.empty() || files::parse_number(options_.array, matrix_);
    if (!is_number || matrix_ > kMostMatrices) matrix_ = kMostMatrices;
    DsaEvent event;
    do {
      if (Status read = events_.next(event); !read) return read;
      if (event.kind == DsaEvent::Kind::matrix) matrices.push_back(event.shape);
      if (matrices.size() > kMostMatrices) return events_.error("has more than 64 matrices");
      if (event.kind == DsaEvent::Kind::frame && matrices_.empty()) {
        if (Status chosen = choose(matrices); !chosen) return chosen;
      }
      if (event.kind == DsaEvent::Kind::temperatures) add_temperature(event);
      if (temperatures_.size() > kMostTemperatures) return events_.error("has more than a million temperatures");
    } while (event.kind != DsaEvent::Kind::end);
    if (matrices_.empty()) return events_.error("there is no frame");
    if (Status begun = events_.rewind(); !begun) return begun;
    return check_shape(events_.name(), shape_, options_.shape);
  }

  Result<bool> next(RawFrame& frame) override {
    DsaEvent event;
    do {
      if (const Status read = events_.next(event); !read) return read.error();
      if (event.is_cut) tell_cut(options_, events_.place(), frames_);
      if (event.kind == DsaEvent::Kind::end) return false;
    } while (event.kind != DsaEvent::Kind::frame);
    const std::optional<Nanos> time = parse_milliseconds(event.time_ms);
    if (!time) return events_.error("the frame has the time_stamp " + files::in_quotes(event.time_ms));
    tell_time_backwards(*time);
    begin_frame(frame, *time);
    frame.temperature_celsius = temperature_at(*time);
    frame.counts.resize(shape_.taxel_count());
    if (!decode(event.text, frame.counts)) {
      return events_.error("the code of the frame is wrong, or has not the cells of the matrices");
    }
    ++frames_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }
  [[nodiscard]] std::string place() const override { return events_.place(); }

 private:
  /// Once.
  void tell_time_backwards(Nanos time) {
    if (time < last_time_ && !std::exchange(has_noted_time_, true) && options_.notice) {
      options_.notice(events_.place() + ": the time_stamp of the frame is before that of the last one");
    }
    last_time_ = time;
  }

  Status choose(const std::vector<FrameShape>& matrices) {
    const std::size_t count = matrices.size();
    if (count == 0) return events_.error("has no matrix");
    if (matrix_ >= count || (options_.array.empty() && count > 1)) {
      return bad_input(events_.name() + ": has " + std::to_string(count) + " matrices; name one by its number, as " +
                       files::in_quotes(events_.name() + "#0"));
    }
    for (const FrameShape& shape : matrices) {
      if (Status valid = check_shape(events_.name(), shape, std::nullopt); !valid) return valid;
    }
    matrices_ = matrices;
    shape_ = matrices_[matrix_];
    return Done{};
  }

  void add_temperature(const DsaEvent& event) {
    const std::optional<Nanos> time = parse_milliseconds(event.time_ms);
    const std::optional<double> celsius = number_at(event.text, matrix_ + 1);
    if (time && celsius) temperatures_.push_back({*time, *celsius});
  }

  /// The last one until then; before there is one, the first.
  [[nodiscard]] std::optional<double> temperature_at(Nanos time) const {
    if (temperatures_.empty()) return std::nullopt;
    const auto later = std::upper_bound(temperatures_.begin(), temperatures_.end(), time,
                                        [](Nanos at, const Temperature& t) { return at < t.time; });
    return (later == temperatures_.begin() ? later : std::prev(later))->celsius;
  }

  /// Cells of all matrices, one after the other; those of ours into `counts`.
  [[nodiscard]] bool decode(std::string_view code, std::span<float> counts) const {
    Cursor cursor(code);
    for (std::size_t matrix = 0; matrix < matrices_.size(); ++matrix) {
      for (std::size_t cell = 0; cell < matrices_[matrix].taxel_count(); ++cell) {
        float value = 0.0F;
        if (!cursor.next(value)) return false;
        if (matrix == matrix_) counts[cell] = value;
      }
    }
    return cursor.at_end();
  }

  DsaEvents events_;
  ImportOptions options_;
  std::vector<FrameShape> matrices_;
  std::size_t matrix_ = 0;  ///< Which of them is read.
  FrameShape shape_;
  std::vector<Temperature> temperatures_;
  std::size_t frames_ = 0;
  Nanos last_time_{};
  bool has_noted_time_ = false;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_dsa(std::unique_ptr<std::istream> in, const std::string& name,
                                              const ImportOptions& options) {
  return open_as<Dsa>(std::move(in), name, options);
}

}  // namespace dermis::bytes::formats
