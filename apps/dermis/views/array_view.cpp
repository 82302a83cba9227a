// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "views/array_view.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/bytes/recordings/frame_files.hpp"
#include "dermis/live/forces/frame_output.hpp"
#include "dermis/out/report/frame_picture.hpp"
#include "dermis/touch/pipeline/direct_model.hpp"

namespace dermis::views {
namespace {

constexpr std::size_t kLooked = 65536;

/// array.toml has a table [array], suit.toml a list of them.
bool is_suit(const std::string& path) {
  return path.ends_with(".toml") && bytes::files::first_bytes_of(path, kLooked).find("[[array]]") != std::string::npos;
}

}  // namespace

Result<std::unique_ptr<ArrayView>> ArrayView::open(const std::string& from, const std::string& model,
                                                   live::sources::SourceOptions options) {
  std::unique_ptr<ArrayView> view(new ArrayView());
  view->from_ = from;
  if (!model.empty()) {
    const Status used = is_suit(model) ? view->use_suit(model) : view->use_model(model);
    if (!used) return used.error();
    options.array = view->work_ ? &view->work_->model.array : &*view->uncalibrated_;
  }
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(from, options);
  if (!source) return source.error();
  view->source_ = *std::move(source);
  if (const Status described = view->describe(); !described) return described.error();
  return view;
}

Status ArrayView::use_model(const std::string& path) {
  Result<live::forces::ModelAtWork> work = live::forces::ModelAtWork::read(path);
  if (!work) return work.error();
  use(*std::move(work));
  return Done{};
}

Status ArrayView::use_suit(const std::string& path) {
  const Result<SuitDescription> suit = bytes::files::read_suit(path);
  if (!suit) return suit.error();
  if (suit->arrays.size() != 1) return bad_input(path + ": has several arrays; name the model of one");
  const SuitArray& one = suit->arrays.front();
  const Result<ArrayDescription> described = bytes::files::read_array(one.model);
  const bool has_counts_alone = described && described->readout.quantity == Quantity::counts;
  if (has_counts_alone) {
    uncalibrated_ = *described;
  } else if (Status used = use_model(one.model); !used) {
    return used;
  }
  const ArrayDescription& array = has_counts_alone ? *uncalibrated_ : work_->model.array;
  const Result<ArraySurface> surface = ArraySurface::create(array, one.shape);
  if (!surface) return bad_input(path + ": " + surface.error().message);
  places_ = free_places({array.rows, array.cols}, one.shape);
  return Done{};
}

void ArrayView::use(live::forces::ModelAtWork work) {
  work_.emplace(std::move(work));
  tracker_.emplace(work_->model.array, touch::contacts::ContactOptions{}, work_->model.strip);
  troubles_.emplace(work_->model.array, from_);
}

Status ArrayView::set_array(const ArrayDescription& array) {
  name_ = array.name;
  row_pitch_m_ = array.row_pitch_m;
  col_pitch_m_ = array.col_pitch_m;
  full_scale_counts_ = array.readout.full_scale_counts();
  if (work_ || array.readout.quantity == Quantity::counts) return Done{};
  Result<live::forces::ModelAtWork> work = live::forces::ModelAtWork::create(touch::pipeline::direct_model(array));
  if (!work) return work.error();
  use(*std::move(work));
  return Done{};
}

/// By the model, else by what the file says of itself.
Status ArrayView::describe() {
  if (work_) return set_array(work_->model.array);
  if (uncalibrated_) return set_array(*uncalibrated_);
  const bytes::recordings::FrameNotes notes = live::sources::notes_of_source(*source_, from_);
  name_ = notes.name;
  if (name_.empty()) name_ = is_live() ? from_ : std::filesystem::path(from_).filename().string();
  if (notes.array_toml.empty()) return Done{};
  const Result<ArrayDescription> array = bytes::files::array_from_toml(notes.array_toml, from_);
  if (!array) return Done{};
  return set_array(*array);
}

Result<bool> ArrayView::next() {
  Result<bool> more = source_->next(raw_);
  if (!more || !*more) return more;
  if (work_) {
    work_->pipeline.process(raw_, force_);
    troubles_->add(raw_, force_, work_->pipeline, source_.get());
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
  if (work_) return out::report::force_scale(largest);
  if (full_scale_counts_) return *full_scale_counts_;
  double high = 255.0;
  while (high < largest) high = 2.0 * high + 1.0;
  return high;
}

}  // namespace dermis::views
