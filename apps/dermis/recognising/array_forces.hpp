// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/learn/recognition/segment.hpp"
#include "dermis/live/forces/operation.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"

namespace dermis::recognising {

/// Frames of one array, and how they become loads.
struct ArrayForceInput {
  std::string from;                       ///< As for live::sources::open_source().
  std::string model{};                    ///< As for bytes::models::read_model(); empty: the readings are the loads.
  bool tare = false;                      ///< The first second is unloaded.
  bool tare_force = false;                ///< With `tare` and a model: whatever load stands there.
  live::sources::SourceOptions source{};  ///< With a model, the array is that of the model.
  std::string name{};                     ///< Name of the array; empty: as its model says, or "array".
};

/// Mean of each reading over the first second, and at least 10 frames, but at most 10 s.
class UnloadedReadings {
 public:
  /// Whether the frame is one of those. Once one is not, none is any more.
  bool add(const RawFrame& frame);
  void subtract_from(std::vector<float>& readings) const;

 private:
  std::vector<double> sum_;
  std::vector<double> count_;
  std::size_t frames_ = 0;
  Nanos first_time_{};
  bool is_done_ = false;
};

/// Frames of an array as loads: newtons of a model, or readings, tared if asked. Where there is no load, 0. Not
/// thread-safe.
class ArrayForces {
 public:
  [[nodiscard]] static Result<ArrayForces> open(const ArrayForceInput& input);

  /// Takes the next frame; false at the end of the source, after telling its options' `loss` where most frames had no
  /// force. Fails where a load stands on the array that is to be tared.
  [[nodiscard]] Result<bool> next();

  /// Whether the frame belongs to the tare; its loads are 0.
  [[nodiscard]] bool is_tare() const noexcept { return is_tare_; }
  [[nodiscard]] const std::vector<float>& loads() const noexcept { return loads_; }
  /// The quantity of a load: a force by a model, else a reading, whatever the source gives.
  [[nodiscard]] Quantity quantity() const noexcept { return work_ ? Quantity::force : Quantity::counts; }
  [[nodiscard]] Nanos time() const noexcept { return raw_.time; }

  /// The array as far as it is known: with the pitch by a model; empty where only the first frame will show it.
  [[nodiscard]] std::optional<learn::recognition::SensedArray> array() const;
  [[nodiscard]] bool is_live() const { return frames_->is_live(); }

 private:
  ArrayForces() = default;
  void process_forces();
  void process_readings();
  void tell_loss();
  [[nodiscard]] Status check_tare() const;

  std::unique_ptr<FrameSource> frames_;
  std::optional<live::forces::ModelAtWork> work_;
  std::optional<touch::pipeline::FrameTroubles> troubles_;  ///< Of the forces.
  std::function<void(const std::string&)> loss_;
  std::optional<UnloadedReadings> unloaded_;
  std::string from_;
  std::string name_;
  RawFrame raw_;
  ForceFrame force_;
  std::vector<float> loads_;
  bool is_tare_ = false;
};

/// The loads of an array at the times of another one: its last frame until then. Not thread-safe.
class HeldForces {
 public:
  /// Reads its first frame; fails where there is none.
  [[nodiscard]] static Result<HeldForces> open(const ArrayForceInput& input);

  /// Goes on to a time, which may not fall.
  [[nodiscard]] Status move_to(Nanos time);

  /// 0 where there was no frame for learn::recognition::kLongestSilence.
  [[nodiscard]] const std::vector<float>& loads() const noexcept { return loads_; }
  /// Whether the array is still being tared.
  [[nodiscard]] bool is_tare() const noexcept { return is_tare_; }
  /// At how many times there was no frame for learn::recognition::kLongestSilence, beginning with the first time.
  [[nodiscard]] std::size_t silent() const noexcept { return silent_; }
  [[nodiscard]] learn::recognition::SensedArray array() const {
    return array_.array().value_or(learn::recognition::SensedArray{});
  }

 private:
  HeldForces(ArrayForces array, bool is_tare);

  ArrayForces array_;     ///< One frame ahead,
  bool has_next_ = true;  ///< if there is one.
  bool is_tare_;          ///< State of the held frame, as the members below.
  std::optional<Nanos> last_;
  std::vector<float> loads_;
  std::size_t silent_ = 0;
};

}  // namespace dermis::recognising
