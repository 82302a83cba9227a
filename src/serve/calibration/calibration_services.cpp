// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/calibration/calibration_services.hpp"

#include <utility>

#include "dermis/calibration/plan_request.hpp"
#include "dermis/files/array_toml.hpp"
#include "dermis/files/loads_csv.hpp"
#include "serve/requests/json_request.hpp"
#include "serve/suit/saved_files.hpp"

namespace dermis::serve {
namespace {

using calibration::GuidedCalibration;
using calibration::GuidedData;
using calibration::GuideHint;
using calibration::GuideStage;

constexpr const char* kNoCalibration = "no calibration is going on; begin with /calibration/start";

Result<std::string> answer(const Status& status) {
  if (!status) return status.error();
  return std::string("{}");
}

/// What `dermis calibrate` needs to make the model again, or a better one.
Status write_data(const std::string& path, const ArrayDescription& array, const GuidedData& data) {
  if (Status written = files::write_array(path + ".array.toml", array); !written) return written;
  const auto fill = [&](std::size_t number, RawFrame& frame) { frame = data.frames[number]; };
  const FrameShape shape{array.rows, array.cols};
  if (Status written = write_frames(path + ".frames.csv", shape, data.frames.size(), fill); !written) return written;
  return files::write_loads(path + ".loads.csv", array, data.loads);
}

}  // namespace

sources::GuideWords words_of(const calibration::GuideState& state, Nanos hold_time) {
  const bool press = state.stage == GuideStage::pressing && state.hint != GuideHint::release;
  const bool is_wrong =
      state.hint == GuideHint::other_taxel || state.hint == GuideHint::several || state.hint == GuideHint::one_of_two;
  return {press, is_wrong, state.taxel, state.weight_n, state.together_with, hold_time};
}

CalibrationServices::CalibrationServices(ServiceArrays arrays, UseModel use_model,
                                         std::shared_ptr<sources::GuideVoice> guide_voice)
    : arrays_(std::move(arrays)), use_model_(std::move(use_model)), guide_voice_(std::move(guide_voice)) {}

const std::vector<std::string>& CalibrationServices::names() {
  static const std::vector<std::string> kNames = {"/calibration/start",  "/calibration/skip", "/calibration/repeat",
                                                  "/calibration/finish", "/calibration/save", "/calibration/cancel"};
  return kNames;
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
  guide_voice_->say(words_of(last_.guide ? last_.guide->state() : calibration::GuideState{}, last_.hold_time));
}

Result<std::string> CalibrationServices::call(std::string_view service, std::string_view request) {
  const std::lock_guard calls(calls_mutex_);
  if (service == "/calibration/start") return start(request);
  if (service == "/calibration/save") return save();
  if (service == "/calibration/cancel") return cancel();
  const auto present = guide();
  if (!present) return bad_input(kNoCalibration);
  if (service == "/calibration/skip") return answer(present->skip());
  if (service == "/calibration/repeat") return answer(present->repeat());
  if (service == "/calibration/finish") return answer(present->finish());
  return bad_input("there is no such service");
}

Result<std::string> CalibrationServices::start(std::string_view text) {
  const Result<calibration::PlanRequest> request = calibration::plan_request_from_json(text);
  if (!request) return request.error();
  const Result<std::size_t> array = arrays_.find(request->array);
  if (!array) return array.error();
  const ArrayDescription& description = arrays_[*array].description;
  Result<calibration::CalibrationPlan> plan = request->plan(description);
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
  // Its end may have to wait for a fit, the caller not.
  if (calibration.guide) {
    ending_ = std::async(std::launch::async, [old = std::move(calibration.guide)]() mutable { old.reset(); });
  }
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
  if (Status written = pipeline::write_model(path + ".safetensors", fit->model); !written) return written.error();
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

}  // namespace dermis::serve
