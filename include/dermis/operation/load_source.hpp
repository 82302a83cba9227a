// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/operation/operation.hpp"
#include "dermis/recognition/segment.hpp"
#include "dermis/sources/open_source.hpp"

namespace dermis::operation {

/// What classes are learned from and recognised in; both must see the same loads in the same frames.
struct LoadInput {
  std::string from;                 ///< As for sources::open_source().
  std::string model{};              ///< As for pipeline::read_model(); empty: the readings are the loads.
  bool tare = false;                ///< The first second is unloaded.
  sources::SourceOptions source{};  ///< With a model, the array is that of the model.
};

/// Whether loads by `model` (empty: readings) are what the classes of a file were learned from, whose layout is
/// `examples`.
[[nodiscard]] Status check_loads(const recognition::Layout& examples, const std::string& classes,
                                 const std::string& model);

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

/// Frames of a source as loads: newtons of a model, or readings, tared if asked. Where there is no load to tell, 0.
/// Not thread-safe.
class LoadSource {
 public:
  [[nodiscard]] static Result<LoadSource> open(const LoadInput& input);

  /// Takes the next frame; false at the end of the source.
  [[nodiscard]] Result<bool> next();

  /// Whether the frame belongs to the tare; its loads are 0.
  [[nodiscard]] bool is_tare() const noexcept { return is_tare_; }
  [[nodiscard]] const std::vector<float>& loads() const noexcept { return loads_; }
  [[nodiscard]] Nanos time() const noexcept { return raw_.time; }

  /// The array as far as it is known: with the pitch by a model, else from the first frame on.
  [[nodiscard]] std::optional<recognition::SensedArray> array() const;
  [[nodiscard]] bool is_live() const { return frames_->is_live(); }

 private:
  LoadSource() = default;
  void process_forces();
  void process_readings();

  std::unique_ptr<FrameSource> frames_;
  std::optional<ModelAtWork> work_;
  std::optional<UnloadedReadings> unloaded_;
  RawFrame raw_;
  ForceFrame force_;
  std::vector<float> loads_;
  bool is_tare_ = false;
};

}  // namespace dermis::operation
