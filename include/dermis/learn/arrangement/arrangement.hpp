// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/learn/arrangement/press_finder.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::arrangement {

inline constexpr std::size_t kMostPlaces = 1024;     ///< That a person presses.
inline constexpr std::size_t kMostChannels = 65536;  ///< Of the board.

/// Where a board is pressed, in the order in which it is.
struct Places {
  std::vector<bytes::files::NamedPlace> places{};  ///< 1 ... kMostPlaces
  std::optional<FrameShape> grid{};                ///< They are its taxels, row by row; empty: they are in no grid.
  double pitch_m = 0.0;                            ///< That of the grid, or the usual distance of two neighbours.
};

/// "6x9", or the path of a places.csv. `pitch_mm`: of a grid.
[[nodiscard]] Result<Places> read_press_places(const std::string& text, double pitch_mm);

/// Fails where they are too many or none.
[[nodiscard]] Result<Places> places_of(std::vector<bytes::files::NamedPlace> places);

/// "place 3 of 17 (x 12 mm, y 30 mm; index tip)"
[[nodiscard]] std::string place_words(const Places& places, std::size_t place);

/// "channel 12", with its row and column where the board sends several rows.
[[nodiscard]] std::string channel_words(std::size_t channel, FrameShape sent);

/// The press of each place; empty: nothing answered there.
using Answers = std::vector<std::optional<Press>>;

struct RecordedAnswers {
  Answers answers;
  std::vector<std::string> remarks{};  ///< Presses that were left out.
};

/// The presses of a recording, as many as there are places. Where there are more, weak touches and places that were
/// pressed twice in a row are left out, if that fits. Fails where the count does not tell which press is where.
[[nodiscard]] Result<RecordedAnswers> answers_of(std::vector<Press> presses, std::size_t places);

/// A board once its places were pressed.
struct Arrangement {
  ArrayDescription array;          ///< As its device is read: the order of its channels; circuit "auto" of a grid.
  std::vector<Vector3> positions;  ///< Those of its taxels, row-major, in its frame [m].
  std::vector<std::optional<std::size_t>> channels;  ///< One a place; empty: no channel answered there alone.
  std::vector<std::string> remarks;                  ///< Sentences on places and channels that are in doubt.
};

/// `sent`: shape of the frames. `most_counts`: the largest reading, for the bits of the ADC. Places without a channel
/// of their own are absent from a grid, and left out where there is none. Fails where not one answered.
[[nodiscard]] Result<Arrangement> arrange(const Places& places, const Answers& answers, FrameShape sent,
                                          double most_counts, const std::string& name);

/// The files that come of it: NAME.toml, NAME.positions.csv, and NAME.suit.toml, which has both and the source.
struct ArrangementFiles {
  std::string array;
  std::string positions;
  std::string suit;
};

/// `array`: the path of NAME.toml.
[[nodiscard]] ArrangementFiles arrangement_files(const std::string& array);

/// Writes them. `from`: the source whose frames are those of the array, for suit.toml.
[[nodiscard]] Status write_arrangement(const std::string& array, const Arrangement& arrangement,
                                       const std::string& from);

}  // namespace dermis::learn::arrangement
