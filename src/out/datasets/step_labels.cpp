// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/step_labels.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/marks.hpp"
#include "out/datasets/recorded_arrays.hpp"
#include "out/datasets/tally_numbers.hpp"

namespace dermis::out::datasets {
namespace {

using bytes::ros_messages::Mark;

Result<Nanos> first_frame(const std::string& from) {
  Result<RecordedArrays> opened = RecordedArrays::open(from, {}, {});
  if (!opened) return opened.error();
  std::size_t array = 0;
  RawFrame frame;
  const Result<bool> more = opened->next(array, frame);
  if (!more) return more.error();
  return frame.time;
}

/// None of what is no recording.
Result<std::vector<Mark>> marks_of(const std::string& from) {
  const Result<live::sources::SourceName> source = live::sources::SourceName::parse(from);
  if (!source) return source.error();
  if (source->kind != live::sources::SourceKind::recording) return std::vector<Mark>();
  Result<Nanos> start = Nanos{};
  std::error_code error;
  if (std::filesystem::exists(bytes::recordings::marks_path(source->file), error)) start = first_frame(from);
  if (!start) return start.error();
  return bytes::recordings::read_marks(source->file, *start);
}

/// Names stand in JSON, where bytes that are not UTF-8 cannot.
std::string utf8_of(const std::string& label) {
  using Json = nlohmann::json;
  return Json::parse(Json(label).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

}  // namespace

StepLabels::Marks StepLabels::taken(const std::vector<Mark>& marks) {
  Marks taken;
  for (const Mark& mark : marks) {
    if (mark.event == "tare") taken.tares.push_back(mark.time);
    if (!mark.event.empty()) continue;
    taken.spans.push_back({mark.time, -1});
    if (mark.label.empty()) continue;
    const std::string name = utf8_of(mark.label);
    const auto found = std::find(names_.begin(), names_.end(), name);
    taken.spans.back().label = found - names_.begin();
    if (found == names_.end()) names_.push_back(name);
  }
  return taken;
}

Result<StepLabels> StepLabels::read(const std::vector<std::string>& recordings, const std::vector<std::size_t>& order,
                                    bool cut) {
  StepLabels labels;
  labels.recordings_.resize(recordings.size());
  for (const std::size_t number : order) {
    const std::string& from = recordings[number];
    const Result<std::vector<Mark>> marks = marks_of(from);
    if (!marks) return marks.error();
    labels.recordings_[number] = labels.taken(*marks);
    const std::vector<Span>& spans = labels.recordings_[number].spans;
    if (!cut || std::ranges::any_of(spans, [](const Span& span) { return span.label >= 0; })) continue;
    return bad_field("cut", fmt::format("{} has no mark with a label; set some on the time line of 'dermis serve', or "
                                        "leave it out",
                                        bytes::files::in_quotes(from)));
  }
  return labels;
}

std::optional<Column> StepLabels::column() const {
  if (names_.empty()) return std::nullopt;
  return Column{
      .array = "", .quantity = "label", .type = ColumnType::int64, .shape = {1}, .axes = {"label"}, .labels = names_};
}

std::size_t StepLabels::after(Nanos time) const {
  const std::vector<Span>& spans = marks_->spans;
  const auto is_later = [](Nanos of, const Span& span) { return of < span.begin; };
  return static_cast<std::size_t>(std::upper_bound(spans.begin(), spans.end(), time, is_later) - spans.begin());
}

std::int64_t StepLabels::at(Nanos step) const {
  const std::size_t next = after(step);
  return next == 0 ? -1 : marks_->spans[next - 1].label;
}

std::string StepLabels::name_at(Nanos step) const {
  const std::int64_t label = at(step);
  return label < 0 ? "" : names_[static_cast<std::size_t>(label)];
}

void StepLabels::append(std::span<const Nanos> steps, std::vector<std::byte>& values) const {
  for (const Nanos step : steps) {
    const std::int64_t label = at(step);
    const auto* const first = reinterpret_cast<const std::byte*>(&label);
    values.insert(values.end(), first, first + sizeof label);
  }
}

std::size_t StepLabels::steps_of_span(std::span<const Nanos> steps) const {
  std::size_t count = 0;
  while (count < steps.size() && !is_between(steps.front(), steps[count])) ++count;
  return count;
}

std::string StepLabels::tare_notice(const std::string& from, Nanos first) const {
  constexpr std::size_t kMost = 5;
  const std::vector<Nanos>& times = marks_->tares;
  if (times.empty()) return "";
  std::vector<std::string> words;
  for (std::size_t k = 0; k < std::min(kMost, times.size()); ++k) {
    words.push_back(fmt::format("{:.1f} s", seconds_of(times[k] - first)));
  }
  const std::string more = times.size() > kMost ? fmt::format(" and {} times more", times.size() - kMost) : "";
  return fmt::format(
      "{} was tared while it was recorded, at {}{}: make the dataset with a tare, or its forces begin at the zero of "
      "the calibration",
      bytes::files::in_quotes(from), fmt::join(words, ", "), more);
}

}  // namespace dermis::out::datasets
