// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dermis/core/contacts.hpp"
#include "dermis/core/frame_source.hpp"
#include "dermis/core/result.hpp"
#include "dermis/fusion/contact.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/pipeline/pipeline.hpp"

namespace dermis::app {

/// End of a colour scale that covers a value: 1, 2 or 5 times a power of ten newtons, at least 1.
[[nodiscard]] double force_scale(double newtons);

/// A source of frames as it is shown: in newtons with its contacts where there is a model, or where a recording says
/// that its readings are forces; else in counts.
class ArrayView {
 public:
  /// `model`: a file, or empty.
  [[nodiscard]] static Result<std::unique_ptr<ArrayView>> open(const std::string& from, const std::string& model);

  /// Returns false at the end.
  [[nodiscard]] Result<bool> next();

  // Of the last frame.
  [[nodiscard]] const RawFrame& raw() const noexcept { return raw_; }
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
  [[nodiscard]] const ContactReport& contacts() const noexcept { return report_; }

  [[nodiscard]] FrameShape shape() const;
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const char* unit() const noexcept { return model_ ? "N" : "counts"; }
  [[nodiscard]] double row_pitch_m() const noexcept { return row_pitch_m_; }
  [[nodiscard]] double col_pitch_m() const noexcept { return col_pitch_m_; }
  /// End of a colour scale that covers the largest of the values: of forces, force_scale(); of counts, that of the ADC,
  /// as described or as it must be.
  [[nodiscard]] double scale(double largest) const;
  [[nodiscard]] bool is_live() const { return source_->is_live(); }
  [[nodiscard]] bool has_model() const noexcept { return model_.has_value(); }
  [[nodiscard]] SourceStatistics statistics() const { return source_->statistics(); }

 private:
  ArrayView() = default;
  [[nodiscard]] Status open_model(const std::string& model);
  [[nodiscard]] Status use_model(pipeline::Model model);
  [[nodiscard]] Status describe(const std::string& from);
  [[nodiscard]] Status set_array(const ArrayDescription& array);

  std::unique_ptr<FrameSource> source_;
  std::optional<pipeline::Model> model_;
  std::optional<pipeline::Pipeline> pipeline_;
  std::optional<fusion::ContactTracker> tracker_;
  std::string name_;
  double row_pitch_m_ = 0.010;
  double col_pitch_m_ = 0.010;
  std::optional<double> full_scale_counts_;
  RawFrame raw_;
  ForceFrame force_;
  ContactReport report_;
  std::vector<double> values_;
};

/// 0 where none is finite.
[[nodiscard]] double largest_of(const std::vector<double>& values);

}  // namespace dermis::app
