// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/recorded_arrays.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/models/model_file.hpp"

namespace dermis::out::datasets {
namespace {

/// Names of columns and folders have letters, digits and '_' of it.
std::string plain_name(std::string name) {
  const auto is_other = [](char c) {
    return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_');
  };
  std::replace_if(name.begin(), name.end(), is_other, '_');
  return name.empty() ? "array" : name;
}

/// All arrays of a recording have the models that gave their forces. One that cannot be read is refused where its
/// frames are.
bool holds_models(const std::string& from) {
  const Result<live::sources::SourceName> source = live::sources::SourceName::parse(from);
  if (!source || source->kind != live::sources::SourceKind::recording) return false;
  const auto recording = bytes::recordings::SuitRecordingReader::open(source->file);
  if (!recording) return false;
  const auto has_model = [&](const bytes::recordings::RecordedArray& array) {
    return !array.model_file.empty() || (!source->array.empty() && source->array != array.name);
  };
  return !(*recording)->arrays().empty() && std::ranges::all_of((*recording)->arrays(), has_model);
}

}  // namespace

Result<ArrayModels> ArrayModels::read(const std::string& path, const std::vector<std::string>& recordings,
                                      const std::function<void(const std::string&)>& notice) {
  ArrayModels models;
  models.path_ = path;
  if (path.empty()) {
    const auto lacks = std::ranges::find_if_not(recordings, holds_models);
    models.are_recorded_ = lacks == recordings.end();
    if (!notice) return models;
    if (models.are_recorded_) notice("the forces are those of the models that the recordings hold");
    if (!models.are_recorded_ && std::ranges::any_of(recordings, holds_models)) {
      notice(fmt::format("there are no forces: {} holds no model; name one for all", bytes::files::in_quotes(*lacks)));
    }
    return models;
  }
  std::vector<std::pair<std::string, std::string>> named;  // arrays and their files
  const Result<SuitDescription> suit =
      path.ends_with(".toml") ? bytes::files::read_suit(path) : Result<SuitDescription>(bad_input(""));
  if (suit) {
    for (const SuitArray& array : suit->arrays) named.emplace_back(array.name, array.model);
  } else {
    named.emplace_back("", path);
  }
  for (const auto& [array, file] : named) {
    Result<touch::pipeline::Model> model = bytes::models::read_model(file);
    if (!model) return model.error();
    models.models_.push_back({array, std::make_shared<const touch::pipeline::Model>(*std::move(model))});
  }
  return models;
}

Result<SharedModel> ArrayModels::of(const std::string& from, const std::string& array, bool is_only,
                                    const std::string& held) const {
  if (are_recorded_) {
    Result<touch::pipeline::Model> model = bytes::models::model_from_bytes(held, from + ": its model");
    if (!model) return model.error();
    return std::make_shared<const touch::pipeline::Model>(*std::move(model));
  }
  if (models_.empty()) return SharedModel();
  for (const Named& named : models_) {
    if (named.array == array || (named.array.empty() && is_only)) return named.model;
  }
  if (models_.front().array.empty()) {
    return bad_field("model", "is of one array, and the recording has several; give the suit.toml that names theirs");
  }
  return bad_field("model", fmt::format("{} has no array {}", path_, bytes::files::in_quotes(array)));
}

Status RecordedArrays::add(const std::string& from, const std::string& name, FrameShape shape, SharedModel model) {
  if (shape.taxel_count() == 0) return bad_input(from + ": has no frame of the array " + bytes::files::in_quotes(name));
  if (model != nullptr && FrameShape{model->array.rows, model->array.cols} != shape) {
    return bad_input(fmt::format("{}: the array {} is {}, its model is of {}", from, bytes::files::in_quotes(name),
                                 bytes::files::size_text(shape),
                                 bytes::files::size_text(FrameShape{model->array.rows, model->array.cols})));
  }
  const std::string plain = plain_name(name);
  if (std::any_of(arrays_.begin(), arrays_.end(), [&](const Array& other) { return other.name == plain; })) {
    return bad_input(fmt::format("{}: two arrays would have the name {}", from, bytes::files::in_quotes(plain)));
  }
  arrays_.push_back({plain, shape, std::move(model)});
  return Done{};
}

Status RecordedArrays::open_suit(const std::string& path, const ArrayModels& models) {
  auto suit = bytes::recordings::SuitRecordingReader::open(path);
  if (!suit) return suit.error();
  suit_ = *std::move(suit);
  loss_ = path + ": is cut off; it was read up to there";
  for (const bytes::recordings::RecordedArray& array : suit_->arrays()) {
    const Result<SharedModel> model = models.of(path, array.name, false, array.model_file);
    if (!model) return model.error();
    if (Status added = add(path, array.name, array.shape, *model); !added) return added;
  }
  return Done{};
}

Status RecordedArrays::open_single(const std::string& from, const ArrayModels& models,
                                   const live::sources::SourceOptions& options) {
  const Result<live::sources::SourceName> source = live::sources::SourceName::parse(from);
  if (!source) return source.error();
  Result<std::unique_ptr<FrameSource>> opened = live::sources::open_source(*source, options);
  if (!opened) return opened.error();
  single_ = *std::move(opened);
  if (single_->is_live()) return live::sources::has_no_end(from);
  const bytes::recordings::FrameNotes notes = live::sources::notes_of_source(*single_, from);
  const Result<SharedModel> model = models.of(from, notes.name, true, notes.model_file);
  if (!model) return model.error();
  first_.emplace();
  const Result<bool> more = single_->next(*first_);
  if (!more) return more.error();
  if (!*more) return bad_input(from + ": has no frame");
  const std::string model_name = *model == nullptr ? "" : (*model)->array.name;
  return add(from, notes.name.empty() ? model_name : notes.name, single_->shape().value_or(FrameShape{}), *model);
}

Result<RecordedArrays> RecordedArrays::open(const std::string& from, const ArrayModels& models,
                                            const live::sources::SourceOptions& options) {
  RecordedArrays recorded;
  recorded.on_loss_ = options.loss;
  const Result<live::sources::SourceName> source = live::sources::SourceName::parse(from);
  if (!source) return source.error();
  const Result<std::vector<std::string>> several = live::sources::several_arrays(*source);
  if (!several) return several.error();
  const Status opened =
      several->empty() ? recorded.open_single(from, models, options) : recorded.open_suit(source->file, models);
  if (!opened) return opened.error();
  return recorded;
}

Result<bool> RecordedArrays::next(std::size_t& array, RawFrame& frame) {
  if (suit_ != nullptr) {
    Result<bool> more = suit_->next(array, frame);
    if (more && !*more && !suit_->complete() && on_loss_) on_loss_(loss_);
    return more;
  }
  array = 0;
  if (first_) {
    frame = *std::move(first_);
    first_.reset();
    return true;
  }
  return single_->next(frame);
}

}  // namespace dermis::out::datasets
