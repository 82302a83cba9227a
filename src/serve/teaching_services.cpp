// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/teaching_services.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "dermis/recognition/classes_file.hpp"
#include "dermis/recognition/learning.hpp"
#include "dermis/recognition/stream_recogniser.hpp"
#include "serve/taught_files.hpp"

namespace dermis::serve {
namespace {

using nlohmann::json;
using recognition::LabelledFrames;

constexpr std::size_t kMostExamples = 1000;
constexpr std::size_t kMostNameBytes = 60;
constexpr std::size_t kMostRequestBytes = 4096;
constexpr double kBrightest = 255.0;
constexpr double kSameTouch = 0.5;  // no two touches agree so well with one example

std::string time_stamp() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y%m%d-%H%M%S}", fmt::gmtime(now));
}

std::string dumped(const json& answer) {
  return answer.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<std::string> text_of(const json& request, const char* field) {
  const auto found = request.find(field);
  if (found == request.end()) return std::string();
  if (!found->is_string()) return bad_input(std::string(field) + ": must be a text");
  std::string text = found->get<std::string>();
  const bool is_plain = std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == ',' || c == '"' || c == '\x7f';
  });
  if (text.size() > kMostNameBytes || !is_plain) {
    return bad_input(std::string(field) + ": must have at most 60 bytes, without commas and quotes");
  }
  return text;
}

/// The mean over the touch of each taxel, its brightest as 255.
std::vector<std::uint8_t> picture_of(const CollectedTouch& touch, std::size_t taxels) {
  std::vector<double> sums(taxels);
  for (std::size_t frame = touch.first; frame <= touch.last; ++frame) {
    for (std::size_t k = 0; k < taxels; ++k) {
      const float newtons = touch.frames[frame * taxels + k];
      if (newtons > 0.0F) sums[k] += static_cast<double>(newtons);
    }
  }
  const double most = std::max(*std::max_element(sums.begin(), sums.end()), 1e-9);
  std::vector<std::uint8_t> picture;
  for (const double sum : sums) picture.push_back(static_cast<std::uint8_t>(kBrightest * sum / most));
  return picture;
}

std::string folder_of(const TaughtArray& array) {
  return std::filesystem::path(array.model).parent_path().string();
}

recognition::Layout taught_layout(const TaughtArray& array) {
  recognition::Layout layout;
  layout.arrays = {recognition::sensed_array(array.description, array.name)};
  layout.readings = array.description.taxel_count();
  layout.rate_hz = TouchCollector::kRateHz;
  layout.least_reading = recognition::kLeastNewtons;
  return layout;
}

/// Frames that both have in common, of those that one of them has.
double agreement(const recognition::Label& label, const recognition::Touch& touch) {
  const std::size_t first = std::max(label.first, touch.first);
  const std::size_t last = std::min(label.last, touch.last);
  if (last < first) return 0.0;
  const std::size_t any = std::max(label.last, touch.last) - std::min(label.first, touch.first) + 1;
  return static_cast<double>(last - first + 1) / static_cast<double>(any);
}

/// Examples begin and end as such touches are found in the stream, not as they were when they were collected: what is
/// learned of is cut as what is answered for.
void cut_as_found(LabelledFrames& data, const recognition::TouchLimits& limits) {
  std::vector<double> forces;
  for (std::size_t frame = 0; frame < data.frame_count(); ++frame) {
    const std::span<const float> frames(data.frames);
    forces.push_back(
        recognition::force_of(data.layout, frames.subspan(frame * data.layout.readings, data.layout.readings)));
  }
  for (const recognition::Touch& touch : recognition::find_touches(limits, forces)) {
    const auto label = std::find_if(data.labels.begin(), data.labels.end(),
                                    [&](const recognition::Label& one) { return agreement(one, touch) > kSameTouch; });
    if (label == data.labels.end()) continue;
    label->first = touch.first;
    label->last = touch.last;
  }
}

}  // namespace

TeachingServices::TeachingServices(std::vector<TaughtArray> arrays, UseClasses use_classes)
    : use_classes_(std::move(use_classes)) {
  for (TaughtArray& array : arrays) {
    const std::size_t taxels = array.description.taxel_count();
    lessons_.push_back({std::move(array), TouchCollector(taxels)});
  }
}

const std::vector<std::string>& TeachingServices::names() {
  static const std::vector<std::string> kNames = {"/recognition/listen",     "/recognition/examples",
                                                  "/recognition/throw_away", "/recognition/saved",
                                                  "/recognition/load",       "/recognition/train"};
  return kNames;
}

void TeachingServices::feed(const live::ArrayResult& result) {
  if (listening_.load(std::memory_order_relaxed) != result.array) return;
  const std::lock_guard lock(mutex_);
  if (listening_ != result.array) return;
  Lesson& lesson = lessons_[result.array];
  std::optional<CollectedTouch> touch = lesson.collector.next(result.force, result.report);
  if (!touch || lesson.examples.size() >= kMostExamples) return;
  lesson.examples.push_back({++last_id_, class_name_, session_, *std::move(touch)});
}

Result<std::string> TeachingServices::call(std::string_view service, std::string_view request) {
  const json parsed = request.size() <= kMostRequestBytes ? json::parse(request, nullptr, false) : json();
  if (!parsed.is_object()) return bad_input("the request is no JSON object of at most 4 KiB");
  if (service == "/recognition/listen") return listen(parsed);
  if (service == "/recognition/examples") return examples(parsed);
  if (service == "/recognition/throw_away") return throw_away(parsed);
  if (service == "/recognition/saved") return saved(parsed);
  if (service == "/recognition/load") return load(parsed);
  if (service == "/recognition/train") return train(parsed);
  return bad_input("there is no such service");
}

Result<std::size_t> TeachingServices::find_array(const json& request) const {
  const Result<std::string> name = text_of(request, "array");
  if (!name) return name.error();
  if (name->empty() && lessons_.size() == 1) return std::size_t{0};
  const auto found =
      std::find_if(lessons_.begin(), lessons_.end(), [&](const Lesson& lesson) { return lesson.array.name == *name; });
  if (found == lessons_.end()) return bad_input("array: there is none of that name");
  return static_cast<std::size_t>(found - lessons_.begin());
}

Result<std::string> TeachingServices::listen(const json& request) {
  const Result<std::size_t> array = find_array(request);
  if (!array) return array.error();
  Result<std::string> name = text_of(request, "class");
  if (!name) return name.error();
  if (*name == "unknown") return bad_input("class: 'unknown' is what is none of the classes");
  Result<std::string> session = text_of(request, "session");
  if (!session) return session.error();
  const std::lock_guard lock(mutex_);
  listening_ = name->empty() ? kNone : *array;
  class_name_ = *std::move(name);
  session_ = session->empty() ? "1" : *std::move(session);
  Lesson& lesson = lessons_[*array];
  lesson.collector = TouchCollector(lesson.array.description.taxel_count());
  return std::string("{}");
}

Result<std::string> TeachingServices::examples(const json& request) const {
  const Result<std::size_t> array = find_array(request);
  if (!array) return array.error();
  const auto known = request.find("known");
  const bool has_known = known != request.end();
  if (has_known && !known->is_number_unsigned()) return bad_input("known: must be the id of an example, or 0");
  const std::lock_guard lock(mutex_);
  const Lesson& lesson = lessons_[*array];
  const bool is_listening = listening_ == *array;
  json answer = {{"listening", is_listening ? class_name_ : ""},
                 {"touched", is_listening && lesson.collector.is_touched()},
                 {"examples", json::array()}};
  for (const Example& example : lesson.examples) {
    json one = {{"id", example.id}, {"class", example.name}, {"session", example.session}};
    const bool is_known = has_known && example.id <= known->get<std::uint64_t>();
    if (!is_known) one["picture"] = picture_of(example.touch, lesson.array.description.taxel_count());
    answer["examples"].push_back(std::move(one));
  }
  return dumped(answer);
}

Result<std::string> TeachingServices::throw_away(const json& request) {
  const Result<std::size_t> array = find_array(request);
  if (!array) return array.error();
  const auto id = request.find("example");
  if (id == request.end() || !id->is_number_unsigned()) return bad_input("example: must be the id of one");
  const std::lock_guard lock(mutex_);
  const auto wanted = id->get<std::uint64_t>();
  const std::size_t gone =
      std::erase_if(lessons_[*array].examples, [&](const Example& example) { return example.id == wanted; });
  if (gone == 0) return bad_input("example: there is none of that id");
  return std::string("{}");
}

LabelledFrames TeachingServices::data_of(std::size_t array) const {
  const std::lock_guard lock(mutex_);
  const Lesson& lesson = lessons_[array];
  LabelledFrames data{taught_layout(lesson.array), {}, {}, {}};
  for (const Example& example : lesson.examples) {
    const std::size_t before = data.frame_count();
    const CollectedTouch& touch = example.touch;
    std::transform(touch.frames.begin(), touch.frames.end(), std::back_inserter(data.frames),
                   [](float newtons) { return std::isfinite(newtons) ? newtons : 0.0F; });
    data.labels.push_back({fmt::format("t{}", example.id), before + touch.first, before + touch.last, example.name,
                           example.session, static_cast<double>(example.id)});
  }
  return data;
}

Result<std::string> TeachingServices::saved(const json& request) const {
  const Result<std::size_t> array = find_array(request);
  if (!array) return array.error();
  const TaughtArray& taught = lessons_[*array].array;
  std::vector<std::string> names = saved_touches(folder_of(taught), taught.name);
  const std::lock_guard lock(mutex_);
  const std::vector<std::string>& known = lessons_[*array].files;
  std::erase_if(names, [&](const std::string& name) { return std::ranges::find(known, name) != known.end(); });
  return dumped({{"files", names}});
}

/// Only what saved() names: no request leads out of the folder of the model.
Result<std::string> TeachingServices::load(const json& request) {
  const Result<std::size_t> array = find_array(request);
  if (!array) return array.error();
  const auto file = request.find("file");
  Lesson& lesson = lessons_[*array];
  const std::string folder = folder_of(lesson.array);
  const std::vector<std::string> names = saved_touches(folder, lesson.array.name);
  const bool is_saved =
      file != request.end() && file->is_string() && std::ranges::find(names, file->get<std::string>()) != names.end();
  if (!is_saved) return bad_input("file: there are no saved touches of that name");
  const auto name = file->get<std::string>();
  const Result<LabelledFrames> data =
      read_taught((std::filesystem::path(folder) / name).string(), taught_layout(lesson.array));
  if (!data) return data.error();
  std::vector<CollectedTouch> touches = touches_of(*data);
  const std::lock_guard lock(mutex_);
  if (std::ranges::find(lesson.files, name) != lesson.files.end())
    return bad_input("file: is among the examples already");
  if (lesson.examples.size() + touches.size() > kMostExamples) {
    return bad_input(fmt::format("file: with it there were more than {} examples", kMostExamples));
  }
  for (std::size_t place = 0; place < touches.size(); ++place) {
    const recognition::Label& label = data->labels[place];
    lesson.examples.push_back({++last_id_, label.name, label.group, std::move(touches[place])});
  }
  lesson.files.push_back(name);
  return dumped({{"examples", touches.size()}});
}

Result<std::string> TeachingServices::train(const json& request) {
  const Result<std::size_t> array = find_array(request);
  if (!array) return array.error();
  LabelledFrames data = data_of(*array);
  if (data.labels.empty()) return bad_input("nothing was taught yet");
  const std::optional<recognition::TouchLimits> limits = recognition::learn_touches(data);
  if (limits) cut_as_found(data, *limits);
  const Result<recognition::LearningSet> set = recognition::LearningSet::create(data);
  if (!set) return set.error();
  std::vector<std::size_t> all;
  for (std::size_t label = 0; label < data.labels.size(); ++label) all.push_back(label);
  Result<recognition::Learned> learned = set->learn(all);
  if (!learned) return learned.error();
  recognition::Classes& classes = learned->classes;
  classes.touches = limits;
  const TaughtArray& taught = lessons_[*array].array;
  const std::string name = taught.name + "-touches-" + time_stamp();
  const std::string path = (std::filesystem::path(folder_of(taught)) / name).string();
  if (Status written = write_taught(path, taught.description, data); !written) return written.error();
  if (Status written = recognition::write_classes(path + ".safetensors", classes); !written) return written.error();
  {
    const std::lock_guard lock(mutex_);
    lessons_[*array].files.push_back(name);
  }
  const json answer = {{"file", name + ".safetensors"},
                       {"classes", classes.names},
                       {"accuracy", learned->report.accuracy},
                       {"judged", learned->report.judged},
                       {"advice", recognition::advice(*learned)}};
  if (Status used = use_classes_(*array, std::move(classes)); !used) return used.error();
  return dumped(answer);
}

}  // namespace dermis::serve
