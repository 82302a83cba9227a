// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/bodies/free_places.hpp"
#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/learn/recognition/classes.hpp"
#include "dermis/live/sources/guide_voice.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/live/suits/playback.hpp"
#include "dermis/live/threats/threat_limits.hpp"
#include "dermis/out/serve/worn_body.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/model.hpp"

/// An array or a suit served live: the stream of docs/stream.md with its parameters, services and recordings.
namespace dermis::out::serve {

/// The frame in which all arrays sit, as messages name it.
inline constexpr const char* kSuitFrame = "suit";

/// An array to be served.
struct ServedArray {
  std::string name;  ///< Unique in the suit; a letter, then letters, digits and '_': topics are /<name>/raw, ...
  std::unique_ptr<FrameSource> source;
  std::shared_ptr<const touch::pipeline::Model> model;
  ArraySurface surface;
  Pose suit_from_array{};        ///< With all joints of a body at 0, as `surface` has it.
  ArrayDescription description;  ///< As calibration takes it: parts of the circuit may still be unknown.
  std::string model_path{};      ///< Path of the model or its array.toml: a calibration saves into that folder.
  std::optional<learn::recognition::Classes> classes{};  ///< Names for its touches; learned from newtons.
  std::string simulation{};                              ///< As bytes::recordings::FrameNotes::simulation.
  std::string from{};                                    ///< Name of a live source; empty: not known, or a recording.
  /// Index in the played recording, whose own forces and contacts are shown. Empty: they are computed.
  std::optional<std::size_t> played{};
  std::vector<FreePlace> places{};  ///< Those of the taxels, where they are in no grid; else empty.
};

/// The suit to be served.
struct ServedSuit {
  std::string name = "suit";
  std::vector<ServedArray> arrays;  ///< At least one.
  /// Names for touches on several arrays together, or on one beside further readings; learned from newtons.
  std::optional<learn::recognition::Classes> classes{};
  std::optional<dermis::live::threats::ThreatLimits> threats{};  ///< Zones name arrays as `arrays` does.
  /// The body that wears the suit; null: nothing is known of it.
  std::shared_ptr<WornBody> body{};
  /// Plays the recording from which all sources come; null: they are live.
  std::unique_ptr<live::suits::Playback> playback{};
  /// Heard by the simulated hands among the sources. Not null.
  std::shared_ptr<live::sources::GuideVoice> guide = std::make_shared<live::sources::GuideVoice>();
};

/// One flat array, named as its model says. Fails where the model's array is not valid.
[[nodiscard]] Result<ServedSuit> suit_of_one(std::unique_ptr<FrameSource> source, touch::pipeline::Model model);

/// The same suit, whose frames come from a recording of it. Fails where the recording cannot be read or does not fit.
[[nodiscard]] Result<ServedSuit> played_suit(const ServedSuit& suit, const std::string& recording);

/// Fails, with the mend, on a source that is neither a device nor a recording.
[[nodiscard]] Status check_served(const live::sources::SourceName& from);

/// Whether it needs no model: a recording that holds the description of its array, or a simulation, which is
/// calibrated.
[[nodiscard]] bool describes_its_array(const live::sources::SourceName& from);

/// The place to be opened: one source with its model, or a suit.
struct SuitPlace {
  std::string from{};  ///< URI or recording; of a suit: a recording of it, or empty for its own sources.
  /// Model file, or the array.toml of an array to be calibrated, where `suit` is empty. Empty: `from` is of such that
  /// describes_its_array().
  std::string model{};
  std::string suit{};     ///< suit.toml
  std::string classes{};  ///< From `dermis recognise learn`, for one source; a suit.toml names its own. Empty: none.
  std::string threats{};  ///< threats.toml; empty: none.
};

/// Opens all that the place names, the sources of a suit at once: `notice` may be called by several threads together.
/// The options `array` and `guide` are not used. Fails where a file or a source cannot be opened, and where they do not
/// fit each other.
[[nodiscard]] Result<ServedSuit> open_suit(const SuitPlace& place, live::sources::SourceOptions options = {});

}  // namespace dermis::out::serve
