// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/calibration/calibration_services.hpp"

#include <utility>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/files/loads_csv.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/plan_request.hpp"
#include "out/serve/calibration/end_apart.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/suit/saved_files.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {
namespace {

using learn::calibration::GuidedCalibration;
using learn::calibration::GuidedData;
using learn::calibration::GuideHint;
using learn::calibration::GuideStage;

constexpr const char* kNoCalibration = "no calibration is going on; begin with /calibration/start";

/// Writes the data from which `dermis calibrate` makes the model again, or a better one.
Status write_data(const std::string& path, const ArrayDescription& array, const GuidedData& data) {
  if (Status written = bytes::files::write_array(path + ".array.toml", array); !written) return written;
  const auto fill = [&](std::size_t number, RawFrame& frame) { frame = data.frames[number]; };
  const FrameShape shape{array.rows, array.cols};
  if (Status written = write_frames(path + ".frames.csv", shape, data.frames.size(), fill); !written) return written;
  return bytes::files::write_loads(path + ".loads.csv", array, data.loads);
}

}  // namespace

live::sources::GuideWords words_of(const learn::calibration::GuideState& state, Nanos hold_time) {
  const bool press = state.stage == GuideStage::pressing && state.hint != GuideHint::release;
  const bool is_wrong =
      state.hint == GuideHint::other_taxel || state.hint == GuideHint::several || state.hint == GuideHint::one_of_two;
  return {press, is_wrong, state.taxel, state.weight_n, state.together_with, hold_time};
}

CalibrationServices::CalibrationServices(ServiceArrays arrays, UseModel use_model,
                                         std::shared_ptr<live::sources::GuideVoice> guide_voice, MayBegin may_begin,
                                         Notify notify)
    : arrays_(std::move(arrays)),
      use_model_(std::move(use_model)),
      guide_voice_(std::move(guide_voice)),
      may_begin_(std::move(may_begin)),
      notify_(std::move(notify)) {}

std::vector<websocket::Service> CalibrationServices::services() {
  return {{"/calibration/start", [this](std::string_view request) { return start(request); }},
          {"/calibration/skip", [this](std::string_view) { return take(&GuidedCalibration::skip); }},
          {"/calibration/repeat", [this](std::string_view) { return take(&GuidedCalibration::repeat); }},
          {"/calibration/finish", [this](std::string_view) { return take(&GuidedCalibration::finish); }},
          {"/calibration/save", [this](std::string_view) { return save(); }},
          {"/calibration/cancel", [this](std::string_view) { return cancel(); }}};
}

void CalibrationServices::tick(std::int64_t tick) {
  if (notify_ && tick % 3 == 0) notify_(*this);
}

std::shared_ptr<GuidedCalibration> CalibrationServices::guide() const {
  const std::lock_guard lock(mutex_);
  return last_.guide;
}

void CalibrationServices::feed(std::size_t array, const RawFrame& raw) {
  if (active_array_.load(std::memory_order_relaxed) != array) return;
  const auto present = guide();
  if (!present) return;
  present->feed(raw);
  if (guide_voice_->has_listener()) say_what_to_do();
}

void CalibrationServices::say_what_to_do() const {
  const std::lock_guard lock(mutex_);
  guide_voice_->speak(words_of(last_.guide ? last_.guide->state() : learn::calibration::GuideState{}, last_.hold_time));
}

Result<std::string> CalibrationServices::take(Step step) {
  const auto present = guide();
  if (!present) return bad_input(kNoCalibration);
  if (Status taken = (*present.*step)(); !taken) return taken.error();
  return std::string("{}");
}

Result<std::string> CalibrationServices::start(std::string_view text) {
  if (may_begin_) {
    if (Status may = may_begin_(); !may) return may.error();
  }
  const Result<learn::calibration::PlanRequest> request = learn::calibration::plan_request_from_json(text);
  if (!request) return request.error();
  const Result<std::size_t> array = arrays_.find(request->array);
  if (!array) return array.error();
  const ArrayDescription& description = arrays_[*array].description;
  Result<learn::calibration::CalibrationPlan> plan = request->plan(description);
  if (!plan) return plan.error();
  if (guide()) return bad_input("a calibration is going on; cancel it first");
  const Nanos hold_time = plan->hold_time;
  Result<std::unique_ptr<GuidedCalibration>> created = GuidedCalibration::create(description, *std::move(plan));
  if (!created) return created.error();
  replace({*array, *std::move(created), hold_time});
  return std::string("{}");
}

void CalibrationServices::replace(Calibration calibration) {
  {
    const std::lock_guard lock(mutex_);
    active_array_ = calibration.guide ? calibration.array : kNone;
    std::swap(last_, calibration);
  }
  say_what_to_do();
  if (calibration.guide) ending_ = end_apart(std::move(calibration.guide));
}

Result<std::string> CalibrationServices::save() {
  const auto present = guide();
  if (!present) return bad_input(kNoCalibration);
  const auto fit = present->calibration();
  const GuidedData data = present->data();
  if (!fit && present->state().stage != GuideStage::failed) return bad_input("the model is not ready; finish first");
  const ServiceArray& array = arrays_[last_.array];
  const std::string name = array.new_name();
  const std::string path = array.path_of(name);
  if (Status written = write_data(path, array.description, data); !written) return written.error();
  if (!fit) return failed("no model could be fitted; what was measured is in " + name + ".frames.csv and .loads.csv");
  const std::string file = name + ".safetensors";
  if (Status written = bytes::models::write_model(path + ".safetensors", fit->model); !written) return written.error();
  if (Status used = use_model_(last_.array, {fit, &fit->model}); !used) return used.error();
  {
    const std::lock_guard lock(mutex_);
    last_.saved_file = file;
  }
  return json_text(nlohmann::json{{"file", file}});
}

Result<std::string> CalibrationServices::cancel() {
  if (!guide()) return bad_input(kNoCalibration);
  replace({last_.array});
  return std::string("{}");
}

std::optional<CalibrationProgress> CalibrationServices::progress() const {
  const std::lock_guard lock(mutex_);
  if (last_.array == kNone) return std::nullopt;
  CalibrationProgress progress;
  progress.array = arrays_[last_.array].name;
  if (last_.guide) progress.state = last_.guide->state();
  if (!last_.saved_file.empty()) progress.state.message += " Saved as " + last_.saved_file + " and in use.";
  return progress;
}

Result<std::unique_ptr<Part>> make_calibration(Host& host) {
  const auto use_model = [&host](std::size_t array, const std::shared_ptr<const touch::pipeline::Model>& model) {
    return host.use_model(array, model);
  };
  const auto may_begin = [&host]() -> Status {
    const auto& playback = host.suit.playback;
    if (!playback || playback->status().state != PlaybackStatus::State::ended) return Done{};
    return bad_input("the recording has ended: play it from its beginning, then begin");
  };
  const Result<Topic> topic =
      host.topics.add({.stream = "/calibration", .dds = "/calibration"}, bytes::ros_messages::calibration_state_type());
  if (!topic) return topic.error();
  const auto notify = [&host, topic = *topic,
                       message = std::vector<std::uint8_t>()](const CalibrationServices& calibration) mutable {
    if (!topic.is_wanted()) return;
    std::optional<CalibrationProgress> progress = calibration.progress();
    if (!progress) return;
    bytes::ros_messages::CalibrationState state = calibration_message(*std::move(progress));
    state.time = host.now();
    bytes::ros_messages::encode_calibration_state(state, kSuitFrame, message);
    topic.publish(state.time, message);
  };
  return std::unique_ptr<Part>(
      std::make_unique<CalibrationServices>(service_arrays(host.suit), use_model, host.suit.guide, may_begin, notify));
}

}  // namespace dermis::out::serve
