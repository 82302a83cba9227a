// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/teaching/lesson.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/learn/recognition/stream_recogniser.hpp"
#include "out/serve/teaching/taught_files.hpp"

namespace dermis::out::serve {
namespace {

using learn::recognition::LabelledFrames;

constexpr std::size_t kMostExamples = 1000;
constexpr double kBrightest = 255.0;
constexpr double kSameTouch = 0.5;  // no two touches agree so well with one example

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

learn::recognition::Layout taught_layout(const ServiceArray& array) {
  learn::recognition::Layout layout;
  layout.arrays = {learn::recognition::sensed_array(array.description, array.name)};
  layout.readings = array.description.taxel_count();
  layout.rate_hz = TouchCollector::kRateHz;
  layout.quantity = Quantity::force;
  return layout;
}

/// Frames that both have in common, of those that one of them has.
double agreement(const learn::recognition::Label& label, const learn::recognition::Touch& touch) {
  const std::size_t first = std::max(label.first, touch.first);
  const std::size_t last = std::min(label.last, touch.last);
  if (last < first) return 0.0;
  const std::size_t any = std::max(label.last, touch.last) - std::min(label.first, touch.first) + 1;
  return static_cast<double>(last - first + 1) / static_cast<double>(any);
}

/// Examples begin and end as such touches are found in the stream, not as they were collected. So touches are cut alike
/// in learning and in recognition.
void cut_as_found(LabelledFrames& data, const learn::recognition::TouchLimits& limits) {
  std::vector<double> forces;
  for (std::size_t frame = 0; frame < data.frame_count(); ++frame) {
    const std::span<const float> frames(data.frames);
    forces.push_back(
        learn::recognition::force_of(data.layout, frames.subspan(frame * data.layout.readings, data.layout.readings)));
  }
  for (const learn::recognition::Touch& touch : learn::recognition::find_touches(limits, forces)) {
    const auto label = std::find_if(data.labels.begin(), data.labels.end(), [&](const learn::recognition::Label& one) {
      return agreement(one, touch) > kSameTouch;
    });
    if (label == data.labels.end()) continue;
    label->first = touch.first;
    label->last = touch.last;
  }
}

Result<learn::recognition::Learned> learn_all(LabelledFrames& data) {
  const std::optional<learn::recognition::TouchLimits> limits = learn::recognition::learn_touches(data);
  if (limits) cut_as_found(data, *limits);
  const Result<learn::recognition::LearningSet> set = learn::recognition::LearningSet::create(data);
  if (!set) return set.error();
  std::vector<std::size_t> all(data.labels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Result<learn::recognition::Learned> learned = set->learn(all);
  if (learned) learned->classes.touches = limits;
  return learned;
}

}  // namespace

Lesson::Lesson(ServiceArrays arrays) : arrays_(std::move(arrays)) {
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    taught_.push_back({TouchCollector(arrays_[k].description.taxel_count())});
  }
}

void Lesson::feed(const live::suits::ArrayResult& result) {
  if (listening_.load(std::memory_order_relaxed) != result.array) return;
  const std::lock_guard lock(mutex_);
  if (listening_ != result.array) return;
  Taught& taught = taught_[result.array];
  std::optional<CollectedTouch> touch = taught.collector.next(result.force, result.report);
  if (!touch || taught.examples.size() >= kMostExamples) return;
  taught.examples.push_back({++last_id_, class_name_, session_, *std::move(touch)});
}

void Lesson::listen(std::size_t array, std::string class_name, std::string session) {
  const std::lock_guard lock(mutex_);
  listening_ = class_name.empty() ? kNone : array;
  class_name_ = std::move(class_name);
  session_ = std::move(session);
  taught_[array].collector = TouchCollector(arrays_[array].description.taxel_count());
}

LessonState Lesson::state(std::size_t array, std::uint64_t known) const {
  const std::lock_guard lock(mutex_);
  const Taught& taught = taught_[array];
  LessonState state;
  if (listening_ == array) {
    state.listening = class_name_;
    state.is_touched = taught.collector.is_touched();
  }
  for (const Example& example : taught.examples) {
    ShownExample& shown = state.examples.emplace_back(example.id, example.class_name, example.session);
    if (example.id > known) shown.picture = picture_of(example.touch, arrays_[array].description.taxel_count());
  }
  return state;
}

Status Lesson::discard(std::size_t array, std::uint64_t id) {
  const std::lock_guard lock(mutex_);
  const std::size_t gone =
      std::erase_if(taught_[array].examples, [&](const Example& example) { return example.id == id; });
  if (gone == 0) return bad_field("example", "there is none of that id");
  return Done{};
}

std::vector<std::string> Lesson::saved_files(std::size_t array) const {
  std::vector<std::string> names = saved_touches(arrays_[array].folder(), arrays_[array].name);
  const std::lock_guard lock(mutex_);
  const std::vector<std::string>& known = taught_[array].files;
  std::erase_if(names, [&](const std::string& name) { return std::ranges::find(known, name) != known.end(); });
  return names;
}

Result<std::size_t> Lesson::load(std::size_t array, const std::string& name) {
  const std::vector<std::string> names = saved_touches(arrays_[array].folder(), arrays_[array].name);
  if (std::ranges::find(names, name) == names.end()) {
    return bad_field("file", "there are no saved touches of that name");
  }
  const Result<LabelledFrames> data = read_taught(arrays_[array].path_of(name), taught_layout(arrays_[array]));
  if (!data) return data.error();
  std::vector<CollectedTouch> touches = touches_of(*data);
  const std::lock_guard lock(mutex_);
  Taught& taught = taught_[array];
  if (std::ranges::find(taught.files, name) != taught.files.end()) {
    return bad_field("file", "is among the examples already");
  }
  if (taught.examples.size() + touches.size() > kMostExamples) {
    return bad_field("file", fmt::format("with it there were more than {} examples", kMostExamples));
  }
  for (std::size_t place = 0; place < touches.size(); ++place) {
    const learn::recognition::Label& label = data->labels[place];
    taught.examples.push_back({++last_id_, label.name, label.group, std::move(touches[place])});
  }
  taught.files.push_back(name);
  return touches.size();
}

Result<LearnedLesson> Lesson::learn(std::size_t array) {
  LabelledFrames data = data_of(array);
  if (data.labels.empty()) return bad_input("nothing was taught yet");
  Result<learn::recognition::Learned> learned = learn_all(data);
  if (!learned) return learned.error();
  const ServiceArray& taught = arrays_[array];
  std::string name = taught.new_name("touches");
  const std::string path = taught.path_of(name);
  if (Status written = write_taught(path, taught.description, data); !written) return written.error();
  if (Status written = learn::recognition::write_classes(path + ".safetensors", learned->classes); !written) {
    return written.error();
  }
  const std::lock_guard lock(mutex_);
  taught_[array].files.push_back(name);
  return LearnedLesson{std::move(name), *std::move(learned)};
}

LabelledFrames Lesson::data_of(std::size_t array) const {
  const std::lock_guard lock(mutex_);
  LabelledFrames data{taught_layout(arrays_[array]), {}, {}, {}};
  for (const Example& example : taught_[array].examples) {
    const std::size_t before = data.frame_count();
    const CollectedTouch& touch = example.touch;
    std::transform(touch.frames.begin(), touch.frames.end(), std::back_inserter(data.frames),
                   [](float newtons) { return std::isfinite(newtons) ? newtons : 0.0F; });
    data.labels.push_back({fmt::format("t{}", example.id), before + touch.first, before + touch.last,
                           example.class_name, example.session, static_cast<double>(example.id)});
  }
  return data;
}

}  // namespace dermis::out::serve
