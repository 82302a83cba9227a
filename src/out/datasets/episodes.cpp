// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/episodes.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "dermis/bytes/files/text.hpp"
#include "dermis/learn/calibration/parallel.hpp"
#include "dermis/out/datasets/step_plan.hpp"
#include "out/datasets/array_steps.hpp"
#include "out/datasets/episode_options.hpp"
#include "out/datasets/hold_out.hpp"
#include "out/datasets/recorded_arrays.hpp"
#include "out/datasets/robot_series.hpp"
#include "out/datasets/step_labels.hpp"
#include "out/datasets/tally_checks.hpp"

namespace dermis::out::datasets {
namespace {

constexpr std::size_t kReadingsOfBatch = std::size_t{1} << 20U;
constexpr std::size_t kFramesOfBatch = 4096;
constexpr std::size_t kBytesOfBlock = std::size_t{8} << 20U;
constexpr std::size_t kMostStepsOfBlock = 256;
constexpr std::size_t kMostBytesOfStep = std::size_t{256} << 20U;
constexpr const char* kTimeNs = "time_ns";

/// Makes episodes of one recording after the other.
///
/// Many members: a batch and a block keep their buffers from one to the next.
class Maker {
 public:
  Maker(const EpisodeOptions& options, ArrayModels models, std::vector<RobotSeries> series, StepLabels labels,
        EpisodeSink& sink, bool is_split)
      : options_(options),
        models_(std::move(models)),
        series_(std::move(series)),
        labels_(std::move(labels)),
        sink_(sink),
        is_split_(is_split) {}

  [[nodiscard]] Status add(const std::string& from, std::size_t number);
  [[nodiscard]] const EpisodeTally& tally() const { return tally_; }
  /// Once all are added. `held_out`: so many episodes at the end.
  [[nodiscard]] Status commit(std::uint64_t held_out);

 private:
  struct Arrival {
    std::size_t array = 0;
    RawFrame frame;
  };

  [[nodiscard]] Status begin_recording(const std::string& from);
  [[nodiscard]] Status end_recording(const std::string& from, Nanos first);
  void begin_episode(std::size_t number);
  [[nodiscard]] Status check_arrays(const std::string& from) const;
  [[nodiscard]] Status decide_columns();
  [[nodiscard]] Result<bool> read_batch();
  [[nodiscard]] Status take();
  [[nodiscard]] Status end_episode();
  [[nodiscard]] Status write_steps(bool is_over);
  [[nodiscard]] Status write_steps(std::span<const Nanos> times);
  [[nodiscard]] Status end_split_episode();
  [[nodiscard]] std::size_t most_steps() const;
  [[nodiscard]] Status end_cut_episode(Nanos next);
  [[nodiscard]] bool is_gap(Nanos time) const;
  [[nodiscard]] Status check_tares() const;
  [[nodiscard]] Status check_frames(const std::string& from, std::size_t number, Nanos first) const;

  const EpisodeOptions& options_;
  ArrayModels models_;
  std::vector<RobotSeries> series_;
  StepLabels labels_;
  EpisodeSink& sink_;
  bool is_split_;  ///< Each of the times is an episode of the only recording.
  std::optional<RecordedArrays> recorded_;
  std::vector<RecordedArrays::Array> arrays_;
  std::vector<Column> columns_;
  std::vector<ArraySteps> steps_;
  std::optional<StepPlan> plan_;
  std::vector<Arrival> batch_;
  std::size_t batch_count_ = 0;
  StepBlock block_;
  std::size_t steps_of_block_ = 1;
  std::uint64_t steps_of_episode_ = 0;
  std::string from_;  ///< The recording.
  EpisodeTally tally_;
};

Status Maker::check_arrays(const std::string& from) const {
  const std::vector<RecordedArrays::Array>& now = recorded_->arrays();
  const auto is_same = [](const RecordedArrays::Array& a, const RecordedArrays::Array& b) {
    return a.name == b.name && a.shape == b.shape;
  };
  if (std::equal(now.begin(), now.end(), arrays_.begin(), arrays_.end(), is_same)) return Done{};
  std::vector<std::string> names;
  for (const RecordedArrays::Array& array : arrays_) {
    names.push_back(fmt::format("{} ({}x{})", bytes::files::in_quotes(array.name), array.shape.rows, array.shape.cols));
  }
  return bad_input(
      fmt::format("{}: has other arrays than the first recording, which has {}", from, fmt::join(names, ", ")));
}

/// Those of the arrays in the first batch, which has one frame at least.
Status Maker::decide_columns() {
  std::vector<RawFrame> first(arrays_.size());
  for (std::size_t k = batch_count_; k-- > 0;) {
    RawFrame& seen = first[batch_[k].array];
    if (batch_[k].frame.temperature_celsius) seen.temperature_celsius = batch_[k].frame.temperature_celsius;
    if (!batch_[k].frame.sensor_celsius.empty()) seen.sensor_celsius = batch_[k].frame.sensor_celsius;
    if (batch_[k].frame.supply_v) seen.supply_v = batch_[k].frame.supply_v;
  }
  columns_ = {{"", kTimeNs, ColumnType::int64, {1}, {"ns"}}};
  if (const std::optional<Column> label = labels_.column()) columns_.push_back(*label);
  for (const RobotSeries& series : series_) columns_.push_back(series.column());
  for (std::size_t k = 0; k < arrays_.size(); ++k) {
    const std::vector<Column> of_array = columns_of(arrays_[k], first[k], options_);
    columns_.insert(columns_.end(), of_array.begin(), of_array.end());
  }
  std::size_t step_bytes = 0;
  for (const Column& column : columns_) step_bytes += column.row_bytes();
  if (step_bytes > kMostBytesOfStep) {
    return bad_field("window", fmt::format("a step of {} frames would have more than 256 MiB", options_.window));
  }
  steps_of_block_ = std::clamp<std::size_t>(kBytesOfBlock / step_bytes, 1, kMostStepsOfBlock);
  return Done{};
}

Status Maker::begin_recording(const std::string& from) {
  steps_.clear();
  from_ = from;
  for (const RecordedArrays::Array& array : recorded_->arrays()) {
    std::vector<Column> columns;
    std::copy_if(columns_.begin(), columns_.end(), std::back_inserter(columns),
                 [&](const Column& column) { return column.array == array.name; });
    Result<ArraySteps> steps = ArraySteps::create(array, options_, std::move(columns));
    if (!steps) return bad_input(from + ": " + steps.error().message);
    steps_.push_back(*std::move(steps));
  }
  return Done{};
}

void Maker::begin_episode(std::size_t number) {
  steps_of_episode_ = 0;
  if (options_.times.empty()) {
    plan_.emplace(arrays_.size(), options_.window, options_.fps);
  } else {
    plan_.emplace(arrays_.size(), is_split_ ? joined(options_.times) : options_.times[number]);
  }
}

/// False at the end of the recording.
Result<bool> Maker::read_batch() {
  batch_count_ = 0;
  std::size_t readings = 0;
  while (batch_count_ < kFramesOfBatch && readings < kReadingsOfBatch) {
    if (batch_count_ == batch_.size()) batch_.emplace_back();
    Arrival& next = batch_[batch_count_];
    Result<bool> more = recorded_->next(next.array, next.frame);
    if (!more || !*more) return more;
    readings += next.frame.counts.size();
    ++batch_count_;
  }
  return true;
}

bool Maker::is_gap(Nanos time) const {
  const std::optional<Nanos> newest = plan_->newest();
  return options_.times.empty() && newest && time - *newest > kLongestGap;
}

/// Every episode at given times has a frame.
Status Maker::check_frames(const std::string& from, std::size_t number, Nanos first) const {
  for (std::size_t k = 0; k < options_.times.size(); ++k) {
    if (!is_split_ && k != number) continue;
    const std::vector<Nanos>& times = options_.times[k];
    if (times.back() < first) {
      return bad_input(fmt::format("{}: begins after the last step of episode {}; mend its times", from, k));
    }
    if (times.front() > *plan_->newest()) {
      return bad_input(fmt::format("{}: ends before the first step of episode {}; mend its times", from, k));
    }
  }
  return Done{};
}

/// The batch, of one episode or of several.
Status Maker::take() {
  for (std::size_t k = 0; k < batch_count_; ++k) {
    Arrival& arrival = batch_[k];
    if (is_gap(arrival.frame.time)) {
      if (Status ended = end_episode(); !ended) return ended;
      ++tally_.gaps;
      begin_episode(0);
    }
    plan_->see(arrival.array, arrival.frame.time);
    std::swap(steps_[arrival.array].next_frame(), arrival.frame);
  }
  return write_steps(false);
}

Status Maker::write_steps(std::span<const Nanos> times) {
  block_.steps = times.size();
  block_.values.resize(columns_.size());
  for (std::vector<std::byte>& values : block_.values) values.clear();
  const auto* const first = reinterpret_cast<const std::byte*>(times.data());
  block_.values[0].assign(first, first + times.size_bytes());
  std::size_t begin = 1;
  if (!labels_.names().empty()) labels_.append(times, block_.values[begin++]);
  for (RobotSeries& series : series_) {
    std::vector<std::byte>& values = block_.values[begin++];
    for (const Nanos time : times) series.append(time, values);
  }
  std::vector<std::size_t> begins;
  for (const RecordedArrays::Array& array : arrays_) {
    begins.push_back(begin);
    while (begin < columns_.size() && columns_[begin].array == array.name) ++begin;
  }
  begins.push_back(begin);
  learn::calibration::parallel_for(steps_.size(), [&](std::size_t k) {
    steps_[k].work(times, std::span(block_.values).subspan(begins[k], begins[k + 1] - begins[k]));
  });
  if (Status tared = check_tares(); !tared) return tared;
  const std::string label = options_.cut && !times.empty() ? labels_.name_at(times.front()) : "";
  if (times.empty() || (options_.cut && label.empty())) return Done{};
  if (steps_of_episode_ == 0) tally_.sources.push_back({from_, 0, times.front(), {}, label});
  tally_.sources.back().steps += times.size();
  tally_.sources.back().last = times.back();
  steps_of_episode_ += times.size();
  tally_.steps += times.size();
  return sink_.write(block_);
}

/// Steps that one block may have: those of the episode that are left.
std::size_t Maker::most_steps() const {
  if (!is_split_ || tally_.episodes == options_.times.size()) return steps_of_block_;
  return std::min(steps_of_block_, options_.times[tally_.episodes].size() - steps_of_episode_);
}

/// Where the next step is behind a mark.
Status Maker::end_cut_episode(Nanos next) {
  if (!options_.cut || steps_of_episode_ == 0 || !labels_.is_between(tally_.sources.back().last, next)) return Done{};
  steps_of_episode_ = 0;
  ++tally_.episodes;
  return sink_.end_episode();
}

/// Windows go on from one episode of a recording to the next.
Status Maker::end_split_episode() {
  if (!is_split_ || steps_of_episode_ == 0 || steps_of_episode_ < options_.times[tally_.episodes].size()) return Done{};
  steps_of_episode_ = 0;
  ++tally_.episodes;
  return sink_.end_episode();
}

Status Maker::write_steps(bool is_over) {
  const std::vector<Nanos> due = plan_->take_due(is_over);
  std::span<const Nanos> left = due;
  do {
    if (options_.stop != nullptr && options_.stop->load()) return failed("interrupted; nothing is written");
    std::span<const Nanos> now = left.first(std::min(left.size(), most_steps()));
    if (options_.cut) now = now.first(labels_.steps_of_span(now));
    left = left.subspan(now.size());
    if (Status ended = now.empty() ? Status(Done{}) : end_cut_episode(now.front()); !ended) return ended;
    if (Status written = write_steps(now); !written) return written;
    if (Status ended = end_split_episode(); !ended) return ended;
  } while (!left.empty());
  if (const std::optional<Nanos> next = plan_->next()) {
    for (ArraySteps& steps : steps_) steps.await(*next);
  }
  if (options_.progressed) options_.progressed(tally_.steps);
  return Done{};
}

Status Maker::end_episode() {
  if (Status written = write_steps(true); !written) return written;
  for (ArraySteps& steps : steps_) steps.end_episode();
  if (steps_of_episode_ == 0) return Done{};
  ++tally_.episodes;
  return sink_.end_episode();
}

Status Maker::check_tares() const {
  for (const ArraySteps& steps : steps_) {
    if (Status tared = steps.check_tare(); !tared) return failed(from_ + ": " + tared.error().message);
  }
  return Done{};
}

Status Maker::end_recording(const std::string& from, Nanos first) {
  const auto tell = [&](const std::string& line) {
    if (options_.notice && !line.empty()) options_.notice(line);
  };
  for (const RobotSeries& series : series_) {
    const Result<std::string> told = series.check_clock(from, first, *plan_->newest());
    if (!told) return told.error();
    tell(*told);
  }
  if (models_.is_any() && !options_.tare && !options_.tare_force) tell(labels_.tare_notice(from, first));
  tally_.arrays.resize(arrays_.size());
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const Result<std::string> tared = steps_[k].tared();
    if (!tared) return failed(from + ": " + tared.error().message);
    tell(tared->empty() ? "" : from + ": " + *tared);
    datasets::add(steps_[k].tally(), tally_.arrays[k]);
  }
  return Done{};
}

Status Maker::commit(std::uint64_t held_out) {
  if (Status filled = check_windows(tally_, options_); !filled) return filled;
  tell_stale_steps(tally_, options_);
  tally_.held_out = held_out;
  tally_.labels = labels_.names();
  tally_.how = described(options_, models_.are_recorded());
  return sink_.commit(tally_);
}

Status Maker::add(const std::string& from, std::size_t number) {
  const live::sources::SourceOptions how{.notice = options_.notice, .loss = options_.loss};
  Result<RecordedArrays> opened = RecordedArrays::open(from, models_, how);
  if (!opened) return opened.error();
  recorded_.emplace(*std::move(opened));
  const bool is_first = arrays_.empty();
  if (is_first) arrays_ = recorded_->arrays();
  if (Status same = check_arrays(from); !same) return same;
  for (RobotSeries& series : series_) {
    if (Status read = series.read(from, number); !read) return read;
  }
  Result<bool> more = read_batch();
  if (more && batch_count_ == 0) return bad_input(from + ": has no frame");
  if (!more) return more.error();
  if (is_first) {
    if (Status decided = decide_columns(); !decided) return decided;
    if (Status begun = sink_.begin(columns_); !begun) return begun;
  }
  if (Status begun = begin_recording(from); !begun) return begun;
  labels_.begin(number);
  const std::uint64_t episodes_before = tally_.episodes;
  begin_episode(number);
  const Nanos first = batch_.front().frame.time;
  while (true) {
    if (Status taken = take(); !taken) return taken;
    if (!*more || plan_->is_done()) break;
    more = read_batch();
    if (!more) return more.error();
  }
  if (Status right = check_frames(from, number, first); !right) return right;
  if (Status ended = end_episode(); !ended) return ended;
  if (options_.cut && tally_.episodes == episodes_before) {
    return bad_field("cut", from + ": its labels lie at no step; mend its marks");
  }
  return end_recording(from, first);
}

}  // namespace

Result<EpisodeTally> make_episodes(const std::vector<std::string>& recordings, const EpisodeOptions& options,
                                   EpisodeSink& sink) {
  if (Status valid = options.validate(); !valid) return valid.error();
  if (recordings.empty()) return bad_input("name a recording");
  if (Status right = check_times(options.times, recordings.size()); !right) return right.error();
  Result<std::vector<RobotSeries>> series = RobotSeries::choose(recordings, options);
  if (!series) return series.error();
  Result<HoldOut> hold_out = HoldOut::create(options.hold_out, recordings);
  if (!hold_out) return hold_out.error();
  Result<ArrayModels> models = ArrayModels::read(options.model, recordings, options.notice);
  if (!models) return models.error();
  if (!models->is_any() && (options.tare || options.tare_force || options.follow_drift)) {
    return bad_field(options.follow_drift ? "follow-drift" : "tare", "needs a model: without one there are no forces");
  }
  Result<StepLabels> labels = StepLabels::read(recordings, hold_out->order(), options.cut);
  if (!labels) return labels.error();
  Maker maker(options, *std::move(models), *std::move(series), *std::move(labels), sink,
              are_split(options.times, recordings.size()));
  std::uint64_t trained = 0;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const std::size_t number = hold_out->order()[k];
    if (Status added = maker.add(recordings[number], number); !added) return added.error();
    if (k + 1 == hold_out->trained()) trained = maker.tally().episodes;
  }
  const Result<std::uint64_t> held_out = hold_out->episodes(maker.tally().episodes, trained);
  if (!held_out) return held_out.error();
  if (Status committed = maker.commit(*held_out); !committed) return committed.error();
  return maker.tally();
}

}  // namespace dermis::out::datasets
