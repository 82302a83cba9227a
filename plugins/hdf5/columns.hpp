// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/frame_source.hpp"
#include "hdf5.hpp"

/// Datasets whose first dimension are the frames, read from the first to the last, block by block.
namespace dermis::bytes::recordings {

/// HDF5's name of a type of this machine.
template <typename T>
[[nodiscard]] hid_t hdf5_type();

/// The frames of which all chunks lie side by side: read together, each chunk is unpacked once.
[[nodiscard]] inline hsize_t frames_per_block(const Hdf5Dataset& dataset, hsize_t most) {
  return std::clamp<hsize_t>(dataset.chunk.empty() ? most : dataset.chunk[0], 1, most);
}

/// A dataset (N, rows, cols) of numbers, or (N, taxels) of a given shape, read as counts.
class CountsDataset {
 public:
  /// Fails where the dataset has not that form or, where one is given, another shape.
  [[nodiscard]] static Result<CountsDataset> open(const Hdf5Input& file, const char* name,
                                                  std::optional<FrameShape> shape);

  /// The same of any dataset of which an element of the first dimension has as many values as `shape`.
  [[nodiscard]] static Result<CountsDataset> open_rows(const Hdf5Input& file, const char* name, FrameShape shape);

  [[nodiscard]] FrameShape shape() const noexcept { return shape_; }
  [[nodiscard]] hsize_t frame_count() const noexcept { return dataset_.sizes[0]; }
  /// Fails on whole numbers that a float does not hold exactly. `index` < frame_count(), rising.
  [[nodiscard]] Status read(hsize_t index, std::vector<float>& counts);

 private:
  CountsDataset(Hdf5Dataset dataset, FrameShape shape) : dataset_(std::move(dataset)), shape_(shape) {}
  [[nodiscard]] Status read_block();
  template <typename Wide>
  [[nodiscard]] Status read_as(std::vector<Wide>& wide);

  Hdf5Dataset dataset_;
  FrameShape shape_;
  hsize_t first_ = 0;  ///< Frames [first_, first_ + count_) are in counts_.
  hsize_t count_ = 0;
  std::vector<float> counts_;
  std::vector<std::int64_t> integers_;
  std::vector<double> doubles_;
};

/// A dataset (N) of numbers.
template <typename T>
class NumberColumn {
 public:
  /// Fails where the dataset has not one number for each of `frame_count` frames.
  [[nodiscard]] static Result<NumberColumn> open(const Hdf5Input& file, const char* name, hsize_t frame_count) {
    Result<Hdf5Dataset> dataset = file.dataset(name);
    if (!dataset) return dataset.error();
    if (dataset->sizes != Hdf5Sizes{frame_count}) {
      return bad_input(dataset->place + " does not hold one number for each of " + std::to_string(frame_count) +
                       " frames");
    }
    return NumberColumn(*std::move(dataset));
  }

  /// `index` < frame_count, rising.
  [[nodiscard]] Status read(hsize_t index, T& value) {
    if (index - first_ >= values_.size()) {
      constexpr hsize_t kMostFrames = 65536;
      first_ = index;
      values_.resize(std::min(frames_per_block(dataset_, kMostFrames), dataset_.sizes[0] - index));
      Status done = dataset_.read(index, values_.size(), hdf5_type<T>(), values_.data());
      if (!done) return done;
    }
    value = values_[index - first_];
    return Done{};
  }

  [[nodiscard]] const std::string& place() const noexcept { return dataset_.place; }

 private:
  explicit NumberColumn(Hdf5Dataset dataset) : dataset_(std::move(dataset)) {}

  Hdf5Dataset dataset_;
  hsize_t first_ = 0;
  std::vector<T> values_;
};

}  // namespace dermis::bytes::recordings
