// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/bodies/free_places.hpp"
#include "dermis/live/forces/operation.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"
#include "dermis/touch/pipeline/frame_troubles.hpp"

namespace dermis::views {

/// A source of frames, ready to be shown. With a model, or if a recording says that its readings are forces, it shows
/// newtons and contacts. Otherwise it shows counts. Not thread-safe.
class ArrayView {
 public:
  /// `model`: as for bytes::models::read_model(), or empty; or a suit.toml of one array, whose places are taken, too.
  /// `from` and `options`: as for live::sources::open_source(), but the array is that of the model where there is one.
  [[nodiscard]] static Result<std::unique_ptr<ArrayView>> open(const std::string& from, const std::string& model,
                                                               live::sources::SourceOptions options = {});

  /// Takes the next frame. Returns false at the end.
  [[nodiscard]] Result<bool> next();

  /// The verdict on the frames so far: failed where most have no force (touch::pipeline::FrameTroubles::verdict()).
  [[nodiscard]] Status verdict() const { return troubles_ ? troubles_->verdict() : Status(Done{}); }

  // Data of the last frame.
  [[nodiscard]] const RawFrame& raw() const noexcept { return raw_; }
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
  [[nodiscard]] const ContactReport& contacts() const noexcept { return report_; }

  [[nodiscard]] FrameShape shape() const;
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// The name that was opened.
  [[nodiscard]] const std::string& from() const noexcept { return from_; }
  [[nodiscard]] const char* unit() const noexcept { return work_ ? "N" : "counts"; }
  [[nodiscard]] double row_pitch_m() const noexcept { return row_pitch_m_; }
  [[nodiscard]] double col_pitch_m() const noexcept { return col_pitch_m_; }
  /// End of a colour scale that covers the largest of the values. For forces it is out::report::force_scale(). For
  /// counts it is that of the ADC, as described or as large as needed.
  [[nodiscard]] double scale(double largest) const;
  /// Those of the taxels, where they are in no grid; else empty.
  [[nodiscard]] const std::vector<FreePlace>& places() const noexcept { return places_; }
  [[nodiscard]] bool is_live() const { return source_->is_live(); }
  [[nodiscard]] bool has_model() const noexcept { return work_.has_value(); }
  [[nodiscard]] SourceStatistics statistics() const { return source_->statistics(); }

 private:
  ArrayView() = default;
  void use(live::forces::ModelAtWork work);
  [[nodiscard]] Status describe();
  [[nodiscard]] Status use_suit(const std::string& path);
  [[nodiscard]] Status use_model(const std::string& path);
  [[nodiscard]] Status set_array(const ArrayDescription& array);

  std::unique_ptr<FrameSource> source_;
  std::optional<live::forces::ModelAtWork> work_;
  std::optional<touch::contacts::ContactTracker> tracker_;
  std::optional<touch::pipeline::FrameTroubles> troubles_;  ///< Of the forces.
  std::string from_;
  std::string name_;
  double row_pitch_m_ = ArrayDescription{}.row_pitch_m;
  double col_pitch_m_ = ArrayDescription{}.col_pitch_m;
  std::optional<double> full_scale_counts_;
  std::optional<ArrayDescription> uncalibrated_;  ///< A suit without newtons: there are counts alone.
  std::vector<FreePlace> places_;
  RawFrame raw_;
  ForceFrame force_;
  ContactReport report_;
  std::vector<double> values_;
};

}  // namespace dermis::views
