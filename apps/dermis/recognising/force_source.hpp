// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "recognising/array_forces.hpp"
#include "recognising/further_readings.hpp"

namespace dermis::recognising {

/// The input that classes are learned from and recognised in; both must see the same loads in the same frames.
struct ForceInput {
  std::string from;         ///< As for live::sources::open_source(), or a recording of several arrays.
  std::string model{};      ///< As for bytes::models::read_model(); of several arrays suit.toml, which names that
                            ///< of each. Empty: the readings are the loads.
  bool tare = false;        ///< The first second is unloaded.
  bool tare_force = false;  ///< With `tare` and a model: whatever load stands there.
  live::sources::SourceOptions
      source{};  ///< The array, which is that of the model where there is one, counts of one alone.
  std::vector<std::string> arrays{};  ///< Which of several are taken, in this order; one: as `from` names it. Empty:
                                      ///< all of suit.toml, else of the recording.
  std::string extra{};                ///< As for FurtherReadings::read(); empty: none.
};

/// Whether loads by `model` (empty: readings) are what the classes of a file were learned from, whose layout is
/// `examples`.
[[nodiscard]] Status check_loads(const learn::recognition::Layout& examples, const std::string& classes,
                                 const std::string& model);

/// Frames of a source as forces (ArrayForces). Several arrays stand side by side in each frame of the first: their last
/// frames until its time (HeldLoads). Not thread-safe.
class ForceSource {
 public:
  /// Fails on further readings beside a source that is live.
  [[nodiscard]] static Result<ForceSource> open(const ForceInput& input);

  /// Takes the next frame; false at the end of the source.
  [[nodiscard]] Result<bool> next();

  /// Whether the frame belongs to the tare of some array.
  [[nodiscard]] bool is_tare() const noexcept;
  [[nodiscard]] const std::vector<float>& loads() const noexcept { return loads_; }
  /// Further readings beside the frame; NaN where one is missing.
  [[nodiscard]] std::span<const float> extras() const noexcept;
  [[nodiscard]] Nanos time() const noexcept { return first_.time(); }

  /// The layout of the frames, without their rate; empty where only the first frame will show it.
  [[nodiscard]] std::optional<learn::recognition::Layout> layout() const;
  [[nodiscard]] std::vector<std::string> extra_names() const;
  [[nodiscard]] bool is_live() const { return first_.is_live(); }
  [[nodiscard]] const live::sources::SourceName& from() const noexcept { return from_; }

  /// A line for each kind of trouble that there was.
  [[nodiscard]] std::vector<std::string> describe_troubles() const;

 private:
  explicit ForceSource(ArrayForces first);

  ArrayForces first_;
  std::vector<HeldForces> others_;
  std::optional<FurtherReadings> further_;
  live::sources::SourceName from_;
  std::vector<float> loads_;
};

}  // namespace dermis::recognising
