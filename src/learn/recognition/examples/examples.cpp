// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/examples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "learn/recognition/valid_reading.hpp"

namespace dermis::learn::recognition {
namespace {

std::string name_of(const Label& label) {
  return "label '" + label.id + "'";
}

Status check_places(const std::vector<Label>& labels, std::size_t frames) {
  std::set<std::string> ids;
  for (const Label& label : labels) {
    if (!ids.insert(label.id).second) return bad_input(name_of(label) + " stands twice; give each its own id");
    if (label.name.empty()) return bad_input(name_of(label) + " names no class");
    if (label.last < label.first) return bad_input(name_of(label) + " ends before it begins");
    if (label.last >= frames) {
      return bad_input(name_of(label) + " ends at frame " + std::to_string(label.last) + "; there are " +
                       std::to_string(frames) + " frames, counted from 0");
    }
  }
  return Done{};
}

Status check_overlaps(const std::vector<Label>& labels) {
  std::vector<std::size_t> order(labels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return labels[a].first < labels[b].first; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Label& before = labels[order[i - 1]];
    const Label& label = labels[order[i]];
    if (label.first > before.last) continue;
    return bad_input(name_of(label) + " overlaps " + name_of(before) + " at frame " + std::to_string(label.first) +
                     "; a frame belongs to one example");
  }
  return Done{};
}

Status check_finite(const std::vector<float>& values, std::size_t columns, const char* kind) {
  const auto bad = std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
  if (bad == values.end()) return Done{};
  const auto place = static_cast<std::size_t>(bad - values.begin());
  return bad_input(std::string(kind) + " " + std::to_string(place % columns) + " of frame " +
                   std::to_string(place / columns) + " is not a number; write 0 where nothing was measured");
}

}  // namespace

Segment LabelledFrames::segment(const Label& label) const {
  const std::size_t count = label.last - label.first + 1;
  return {std::span(frames).subspan(label.first * layout.readings, count * layout.readings),
          std::span(extras).subspan(label.first * layout.extras, count * layout.extras)};
}

std::size_t LabelledFrames::longest() const {
  std::size_t longest = 1;
  for (const Label& label : labels) longest = std::max(longest, label.last - label.first + 1);
  return longest;
}

Status LabelledFrames::check_labels() const {
  if (Status checked = check_places(labels, frame_count()); !checked) return checked;
  return check_overlaps(labels);
}

Status LabelledFrames::check_frames() const {
  return check_finite(frames, layout.readings, "reading");
}

Status LabelledFrames::check_extras() const {
  return check_finite(extras, layout.extras, "further reading");
}

Status LabelledFrames::validate() const {
  if (Status checked = layout.validate(); !checked) return checked;
  if (frames.size() % layout.readings != 0 || extras.size() != frame_count() * layout.extras) {
    return bad_input("further readings: there must be as many lines as frames");
  }
  if (Status checked = check_labels(); !checked) return checked;
  if (Status checked = check_frames(); !checked) return checked;
  return check_extras();
}

std::vector<float> held_image(const LabelledFrames& data, const Label& label) {
  constexpr double kHeldShare = 0.5;  // of the largest force
  const Segment segment = data.segment(label);
  const std::size_t readings = data.layout.readings;
  std::vector<double> forces(segment.frames.size() / readings);
  for (std::size_t i = 0; i < segment.frames.size(); ++i) forces[i / readings] += valid_reading(segment.frames[i]);
  const double held_from = kHeldShare * *std::max_element(forces.begin(), forces.end());
  const auto held = static_cast<double>(
      std::count_if(forces.begin(), forces.end(), [&](double force) { return force >= held_from; }));
  std::vector<double> sum(readings);
  for (std::size_t i = 0; i < segment.frames.size(); ++i) {
    if (forces[i / readings] >= held_from) sum[i % readings] += valid_reading(segment.frames[i]) / held;
  }
  return {sum.begin(), sum.end()};
}

}  // namespace dermis::learn::recognition
