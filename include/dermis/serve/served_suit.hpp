// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dermis/calibration/guided_calibration.hpp"
#include "dermis/core/array_description.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/frames.hpp"
#include "dermis/core/result.hpp"
#include "dermis/core/surface.hpp"
#include "dermis/live/playback.hpp"
#include "dermis/pipeline/model.hpp"

/// An array or a suit served live: the stream of docs/stream.md with its parameters, services and recordings.
namespace dermis::serve {

/// The frame in which all arrays sit, as messages name it.
inline constexpr const char* kSuitFrame = "suit";

/// An array to be served.
struct ServedArray {
  std::string name;  ///< Unique in the suit; a letter, then letters, digits and '_': topics are /<name>/raw, ...
  std::unique_ptr<FrameSource> source;
  std::shared_ptr<const pipeline::Model> model;
  ArraySurface surface;
  Pose suit_from_array{};
  ArrayDescription description;  ///< As calibration takes it: parts of the circuit may still be unknown.
  std::string model_path{};      ///< Of the model or its array.toml: a calibration saves into that folder.
};

/// What is to be served.
struct ServedSuit {
  std::string name = "suit";
  std::vector<ServedArray> arrays;             ///< At least one.
  std::unique_ptr<live::Playback> playback{};  ///< Of the recording from which all sources come; null: they are live.
  /// Told after every frame what a guided calibration asks for, as simulated hands need it; thread-safe. Empty: nobody.
  std::function<void(const calibration::GuideState&, Nanos hold_time)> guide_listener{};
};

/// One flat array, named as its model says. Fails where the model's array is not valid.
[[nodiscard]] Result<ServedSuit> suit_of_one(std::unique_ptr<FrameSource> source, pipeline::Model model);

/// What is to be opened: one source with its model, or a suit.
struct SuitPlace {
  std::string from{};   ///< URI or recording; of a suit: a recording of it, or empty for its own sources.
  std::string model{};  ///< Model file, or the array.toml of an array to be calibrated, where `suit` is empty.
  std::string suit{};   ///< suit.toml
};

/// Opens a source by its URI; `array`: what its frames must fit.
using OpenSource =
    std::function<Result<std::unique_ptr<FrameSource>>(const std::string& uri, const ArrayDescription& array)>;

/// Opens all that the place names. Fails where one cannot be opened or two do not fit each other.
[[nodiscard]] Result<ServedSuit> open_suit(const SuitPlace& place, const OpenSource& open_source);

}  // namespace dermis::serve
