// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "array_view.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "dermis/files/array_toml.hpp"
#include "dermis/pipeline/direct_model.hpp"
#include "dermis/recordings/frame_files.hpp"
#include "frame_output.hpp"
#include "open_source.hpp"

namespace dermis::app {

double force_scale(double newtons) {
  double decade = 1.0;
  while (decade < 1e9 && 10.0 * decade <= newtons) decade *= 10.0;
  for (const double step : {1.0, 2.0, 5.0}) {
    if (newtons <= step * decade) return step * decade;
  }
  return 10.0 * decade;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::isfinite(value) ? value : 0.0);
  return largest;
}

Result<std::unique_ptr<ArrayView>> ArrayView::open(const std::string& from, const std::string& model) {
  std::unique_ptr<ArrayView> view(new ArrayView());
  if (!model.empty()) {
    if (const Status opened = view->open_model(model); !opened) return opened.error();
  }
  Result<std::unique_ptr<FrameSource>> source = open_source(from, view->model_ ? &view->model_->array : nullptr);
  if (!source) return source.error();
  view->source_ = *std::move(source);
  if (const Status described = view->describe(from); !described) return described.error();
  return view;
}

Status ArrayView::open_model(const std::string& path) {
  Result<pipeline::Model> model = pipeline::read_model(path);
  if (!model) return model.error();
  return use_model(std::move(*model));
}

Status ArrayView::use_model(pipeline::Model model) {
  Result<pipeline::Pipeline> pipeline = pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  model_ = std::move(model);
  pipeline_.emplace(std::move(*pipeline));
  tracker_.emplace(model_->array, fusion::ContactOptions{}, model_->strip);
  return Done{};
}

Status ArrayView::set_array(const ArrayDescription& array) {
  name_ = array.name;
  row_pitch_m_ = array.row_pitch_m;
  col_pitch_m_ = array.col_pitch_m;
  full_scale_counts_ = array.readout.full_scale_counts();
  if (model_ || array.readout.quantity == Quantity::counts) return Done{};
  return use_model(pipeline::direct_model(array));
}

/// By the model, else by what the file says of itself.
Status ArrayView::describe(const std::string& from) {
  if (model_) return set_array(model_->array);
  const recordings::FrameNotes notes = notes_of_source(*source_, from);
  name_ = notes.name;
  if (name_.empty()) name_ = is_live() ? from : std::filesystem::path(from).filename().string();
  if (notes.array_toml.empty()) return Done{};
  const Result<ArrayDescription> array = files::array_from_toml(notes.array_toml, from);
  if (!array) return Done{};
  return set_array(*array);
}

Result<bool> ArrayView::next() {
  Result<bool> more = source_->next(raw_);
  if (!more || !*more) return more;
  if (pipeline_) {
    pipeline_->process(raw_, force_);
    tracker_->process(force_, report_);
    values_.assign(force_.newtons.begin(), force_.newtons.end());
  } else {
    values_.assign(raw_.counts.begin(), raw_.counts.end());
  }
  return more;
}

FrameShape ArrayView::shape() const {
  return source_->shape().value_or(FrameShape{1, values_.size()});
}

double ArrayView::scale(double largest) const {
  if (model_) return force_scale(largest);
  if (full_scale_counts_) return *full_scale_counts_;
  double high = 255.0;
  while (high < largest) high = 2.0 * high + 1.0;
  return high;
}

}  // namespace dermis::app
