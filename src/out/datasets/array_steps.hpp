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

/// Sums those of another recording up, whose arrays are the same.
void add(const ArrayTally& more, ArrayTally& sum);

/// One array in the episodes of a recording: its frames become rows of its columns. Not thread-safe.
class ArraySteps {
 public:
  [[nodiscard]] static Result<ArraySteps> create(const RecordedArrays::Array& array, const EpisodeOptions& options,
                                                 std::vector<Column> columns);

  /// Room for the next frame, which work() takes.
  [[nodiscard]] RawFrame& next_frame();
  /// Processes the frames, then appends a row to each of `values`, one for each column, at each of these times.
  void work(std::span<const Nanos> steps, std::span<std::vector<std::byte>> values);

  /// Says when the next step is, so that frames before its window are let go.
  void await(Nanos next) { window_.await(next); }

  /// The next frame begins another episode of the recording. Zero and what is known of faults go on.
  void end_episode();
  /// All episodes that have ended.
  [[nodiscard]] const ArrayTally& tally() const noexcept { return tally_; }
  /// Fails where a tare was refused.
  [[nodiscard]] Status check_tare() const;
  /// Once the recording is over: what the tare took, or "". Fails where it has not ended.
  [[nodiscard]] Result<std::string> tared() const;

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

  ArraySteps(const RecordedArrays::Array& array, std::size_t window, std::vector<Column> columns);
  void process(const RawFrame& raw);
  void keep_forces(Values& values);
  void keep_contacts(Values& values);
  void keep_temperatures(const RawFrame& raw);
  [[nodiscard]] const std::vector<float>& numbers(const Values& values) const;
  void count(const Values& values);
  void count_step(Nanos step);
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
  Nanos first_of_episode_{};
  std::uint64_t frames_of_episode_ = 0;
};

}  // namespace dermis::out::datasets
