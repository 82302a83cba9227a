// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"
#include "dermis/out/datasets/episodes.hpp"
#include "dermis/out/datasets/frame_window.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "out/datasets/recorded_arrays.hpp"

namespace dermis::out::datasets {

/// The columns of an array. `first`: one of its frames; temperature and supply are columns where it has them.
[[nodiscard]] std::vector<Column> columns_of(const RecordedArrays::Array& array, const RawFrame& first,
                                             const EpisodeOptions& options);

/// One array in an episode: its frames become rows of its columns. Not thread-safe.
class ArraySteps {
 public:
  [[nodiscard]] static Result<ArraySteps> create(const RecordedArrays::Array& array, std::size_t window,
                                                 std::vector<Column> columns);

  /// Room for the next frame, which work() takes.
  [[nodiscard]] RawFrame& next_frame();
  /// Processes the frames, then appends a row to each of `values`, one for each column, at each of these times.
  void work(std::span<const Nanos> steps, std::span<std::vector<std::byte>> values);

  /// Says when the next step is, so that frames before its window are let go.
  void await(Nanos next) { window_.await(next); }

  [[nodiscard]] ArrayTally tally() const;

 private:
  /// Numbers of a frame that windows hold.
  struct Values {
    std::vector<float> newtons;
    std::vector<float> sigma;
    std::vector<float> counts;
    std::vector<std::uint8_t> valid;
    std::vector<float> contacts;
    std::vector<float> celsius;         // of each sensor
    std::vector<float> supply_v{0.0F};  // one
  };

  ArraySteps(const RecordedArrays::Array& array, std::size_t window, std::vector<Column> columns)
      : array_(array), window_(window), length_(window), columns_(std::move(columns)) {}
  void process(const RawFrame& raw);
  void keep_forces(Values& values);
  void keep_contacts(Values& values);
  void keep_temperatures(const RawFrame& raw);
  void append_row(const Column& column, Nanos step, std::vector<std::byte>& bytes) const;
  template <typename T>
  void append_window(std::vector<T> Values::*member, std::size_t elements, std::vector<std::byte>& bytes) const;
  void append_ages(Nanos step, std::vector<std::byte>& bytes) const;
  void append_newest(std::vector<float> Values::*member, std::size_t elements, std::vector<std::byte>& bytes) const;

  RecordedArrays::Array array_;
  FrameWindow window_;
  std::size_t length_;
  std::vector<Column> columns_;
  std::optional<touch::pipeline::Pipeline> pipeline_;
  std::optional<touch::contacts::ContactTracker> tracker_;  ///< Where contacts are a column.
  std::vector<RawFrame> frames_;
  std::size_t frame_count_ = 0;
  std::vector<Values> slots_;
  ForceFrame force_;
  ContactReport report_;
  Values last_;  ///< Temperature and supply, where a frame lacks them.
  ArrayTally tally_;
};

}  // namespace dermis::out::datasets
