// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

namespace dermis::out::datasets {

using SharedModel = std::shared_ptr<const touch::pipeline::Model>;

/// Models of arrays by their names.
class ArrayModels {
 public:
  /// `path`: as EpisodeOptions::model. Where it is empty, those that the recordings hold, if all arrays of all of them
  /// have theirs.
  [[nodiscard]] static Result<ArrayModels> read(const std::string& path, const std::vector<std::string>& recordings,
                                                const std::function<void(const std::string&)>& notice);

  [[nodiscard]] bool is_any() const noexcept { return are_recorded_ || !models_.empty(); }
  /// Each recording has its own.
  [[nodiscard]] bool are_recorded() const noexcept { return are_recorded_; }
  /// Null: there are none at all. `is_only`: the recording has no other array. `held`: the model that it holds.
  [[nodiscard]] Result<SharedModel> of(const std::string& from, const std::string& array, bool is_only,
                                       const std::string& held) const;

 private:
  struct Named {
    std::string array;  ///< Empty: of the only one.
    SharedModel model;
  };
  std::string path_;
  std::vector<Named> models_;
  bool are_recorded_ = false;
};

/// The arrays of a file of frames, one or several. Not thread-safe.
class RecordedArrays {
 public:
  struct Array {
    std::string name;
    FrameShape shape;
    SharedModel model;  ///< Null: there are no forces.
  };

  [[nodiscard]] static Result<RecordedArrays> open(const std::string& from, const ArrayModels& models,
                                                   const live::sources::SourceOptions& options);

  [[nodiscard]] const std::vector<Array>& arrays() const noexcept { return arrays_; }
  /// Fills `frame` with the next frame, and `array` with the index of its array.
  [[nodiscard]] Result<bool> next(std::size_t& array, RawFrame& frame);

 private:
  [[nodiscard]] Status open_suit(const std::string& path, const ArrayModels& models);
  [[nodiscard]] Status open_single(const std::string& from, const ArrayModels& models,
                                   const live::sources::SourceOptions& options);
  [[nodiscard]] Status add(const std::string& from, const std::string& name, FrameShape shape, SharedModel model);

  std::unique_ptr<bytes::recordings::SuitRecordingReader> suit_;
  std::unique_ptr<FrameSource> single_;
  std::optional<RawFrame> first_;  ///< That of the single one, read while it was opened.
  std::vector<Array> arrays_;
  std::string loss_;
  std::function<void(const std::string&)> on_loss_;
};

}  // namespace dermis::out::datasets
