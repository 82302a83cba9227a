// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"
#include "dermis/core/surface.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/live/playback.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/sources/guide_voice.hpp"

namespace dermis::app {

/// What is to be served: one source with its model, or a suit.
struct SuitPlace {
  std::string from;   ///< URI or recording; of a suit: a recording of it, or empty for its own sources.
  std::string model;  ///< Model file or array.toml, where `suit` is empty.
  std::string suit;   ///< suit.toml
};

/// What is known of an array besides its frames.
struct ServedArray {
  std::string name;
  ArrayDescription description;  ///< As calibration takes it: parts of the circuit may still be unknown.
  std::string model_path;
  std::shared_ptr<const pipeline::Model> model;
  ArraySurface surface;
  Pose suit_from_array{};
};

/// Everything that was opened.
struct ServedSuit {
  std::string name;
  std::vector<ServedArray> arrays;
  std::vector<std::unique_ptr<FrameSource>> sources;  ///< Of each array.
  std::unique_ptr<live::Playback> playback;           ///< Where a recording is served.
  std::shared_ptr<sources::GuideVoice> guide = std::make_shared<sources::GuideVoice>();  ///< Of the simulated hands.
};

[[nodiscard]] Result<ServedSuit> open_served_suit(const SuitPlace& place);

/// /suit.json of docs/stream.md.
[[nodiscard]] std::string suit_json(const ServedSuit& suit);

}  // namespace dermis::app
