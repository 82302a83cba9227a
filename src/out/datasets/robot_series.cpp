// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/robot_series.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/joint_states.hpp"
#include "dermis/live/sources/source_name.hpp"

namespace dermis::out::datasets {
namespace {

constexpr Nanos kFreshFor = std::chrono::milliseconds(100);  // a number behind which no other comes

/// "0.000 to 12.500 s"
std::string range_text(const std::pair<Nanos, Nanos>& range) {
  const auto seconds = [](Nanos time) { return std::chrono::duration<double>(time).count(); };
  return fmt::format("{:.3f} to {:.3f} s", seconds(range.first), seconds(range.second));
}

/// A file of CSV may have an absolute path, too.
bool is_topic(const std::string& from) {
  std::error_code none;
  return from.starts_with('/') && !from.ends_with(".csv") && !std::filesystem::is_regular_file(from, none);
}

/// Empty where the file is no MCAP.
Result<std::string> mcap_of(const std::string& recording) {
  const Result<live::sources::SourceName> source = live::sources::SourceName::parse(recording);
  if (!source) return source.error();
  return source->kind == live::sources::SourceKind::recording ? source->file : "";
}

Result<std::vector<std::string>> topics_of(const std::string& recording) {
  const Result<std::string> mcap = mcap_of(recording);
  if (!mcap) return mcap.error();
  return mcap->empty() ? std::vector<std::string>() : bytes::recordings::joint_topics(*mcap);
}

/// Topics of joints that every recording has, without those of the actions.
Result<std::vector<std::string>> shared_topics(const std::vector<std::string>& recordings,
                                               const std::vector<std::string>& actions) {
  std::vector<std::string> shared;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const Result<std::vector<std::string>> topics = topics_of(recordings[k]);
    if (!topics) return topics.error();
    if (k == 0) shared = *topics;
    std::erase_if(shared, [&](const std::string& topic) {
      return std::ranges::find(*topics, topic) == topics->end() || std::ranges::find(actions, topic) != actions.end();
    });
    if (shared.empty()) break;
  }
  return shared;
}

Status check_number(const std::string& field, const std::vector<std::string>& from, std::size_t recordings) {
  const bool is_for_all = from.empty() || (from.size() == 1 && is_topic(from.front()));
  if (is_for_all || from.size() == recordings) return Done{};
  return bad_field(field, fmt::format("has {} files for {} recordings", from.size(), recordings));
}

Result<SampledSeries> read_topic(const std::string& recording, const std::string& topic) {
  const Result<std::vector<std::string>> topics = topics_of(recording);
  if (!topics) return topics.error();
  if (std::ranges::find(*topics, topic) == topics->end()) {
    return bad_input(fmt::format("{}: has no topic {} of joints; it has {}", recording, bytes::files::in_quotes(topic),
                                 topics->empty() ? "none" : fmt::format("{}", fmt::join(*topics, ", "))));
  }
  return SampledSeries::read_topic(*mcap_of(recording), topic);
}

/// The only topic of joints that the recordings have, if it is of the same joints in each.
Result<std::vector<std::string>> found_states(const std::vector<std::string>& recordings,
                                              const EpisodeOptions& options) {
  Result<std::vector<std::string>> topics = shared_topics(recordings, options.actions);
  if (!topics || topics->empty()) return topics;
  std::string why;
  if (topics->size() > 1) {
    why = fmt::format("the recordings have the joints of {}; name the topic of the state for a column",
                      fmt::join(*topics, ", "));
  } else {
    RobotSeries series("state", *topics);
    for (std::size_t k = 0; k < recordings.size() && why.empty(); ++k) {
      const Status read = series.read(recordings[k], k);
      if (!read) why = read.error().message + "; so there is no column of the state";
    }
  }
  if (why.empty()) return topics;
  if (options.notice) options.notice(why);
  return std::vector<std::string>();
}

}  // namespace

Result<std::vector<RobotSeries>> RobotSeries::choose(const std::vector<std::string>& recordings,
                                                     const EpisodeOptions& options) {
  std::vector<RobotSeries> series;
  std::vector<std::string> states = options.states;
  if (states.empty() && options.finds_state) {
    Result<std::vector<std::string>> found = found_states(recordings, options);
    if (!found) return found.error();
    states = *std::move(found);
  }
  for (const auto& [quantity, from] :
       {std::pair("state", &std::as_const(states)), std::pair("action", &options.actions)}) {
    if (Status right = check_number(quantity, *from, recordings.size()); !right) return right.error();
    if (!from->empty()) series.emplace_back(quantity, *from);
  }
  return series;
}

Status RobotSeries::read(const std::string& recording, std::size_t number) {
  const std::string& from = from_.size() == 1 ? from_.front() : from_[number];
  Result<SampledSeries> read = is_topic(from) ? read_topic(recording, from) : SampledSeries::read(from);
  if (!read) return read.error();
  if (names_.empty()) names_ = read->names();
  if (!read->reorder(names_)) {
    return bad_input(fmt::format("{} of {}: has other columns than that of the first recording, which has {}", from,
                                 recording, fmt::join(names_, ", ")));
  }
  now_ = *std::move(read);
  now_from_ = from;
  range_ = now_->range();
  // As long as a number comes as often as others did, it is the newest one.
  lasts_until_ = range_.second + std::max(now_->longest_gap(), kFreshFor);
  step_count_ = 0;
  steps_outside_ = 0;
  return Done{};
}

void RobotSeries::append(Nanos step, std::vector<std::byte>& row) {
  if (step_count_++ == 0) step_range_.first = step;
  step_range_.second = step;
  if (step < range_.first || step > lasts_until_) ++steps_outside_;
  now_->append(step, row);
}

Result<std::string> RobotSeries::check_clock(const std::string& recording, Nanos first, Nanos last) const {
  const std::pair<Nanos, Nanos> frames = {std::min(first, step_range_.first), std::max(last, step_range_.second)};
  if (range_.second < frames.first || range_.first > frames.second) {
    return bad_input(fmt::format("{}: its times are {}, the frames of {} {}; give one on the clock of the frames",
                                 now_from_, range_text(range_), recording, range_text(frames)));
  }
  if (steps_outside_ == 0) return std::string();
  return fmt::format("{}: {} of {} steps of {} have no number of their own: it has {}, the steps are {}", now_from_,
                     steps_outside_, step_count_, recording, range_text(range_), range_text(step_range_));
}

}  // namespace dermis::out::datasets
