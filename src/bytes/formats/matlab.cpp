// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/matlab.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bytes/formats/imported_frame.hpp"
#include "bytes/formats/matlab_file.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

using Values = std::vector<float>;

constexpr std::array kTimeNames = {"t", "time", "time_s", "timestamps"};
constexpr std::array kRateNames = {"fs", "Fs", "FS", "rate", "rate_hz", "sampling_rate", "sample_rate"};
constexpr const char* kUsualName = "data";
constexpr std::size_t kFewestFrames = 10;  // whose changes tell
constexpr double kClearly = 0.5;           // of the change along the next axis
constexpr double kMostRateHz = 1e9;
constexpr float kLargestExact = 16777216.0F;  // up to here a float holds every whole number

/// Where the readings of a frame are in the values of a variable.
struct Axes {
  FrameShape shape;
  std::size_t frames = 0;
  std::size_t frame_step = 0;  // from a frame to the next
  std::size_t row_step = 0;
  std::size_t col_step = 0;
};

const MatlabVariable* find(const MatlabFile& file, const std::string& name) {
  const auto& all = file.variables();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const MatlabVariable& known) { return known.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// All values of a variable of the file.
template <typename Value>
Result<std::vector<Value>> read(MatlabFile& file, const MatlabVariable& variable) {
  std::vector<Value> values;
  const auto index = static_cast<std::size_t>(&variable - file.variables().data());
  if (const Status done = file.read(index, values); !done) return done.error();
  return values;
}

std::size_t step_of(const MatlabVariable& variable, std::size_t axis) {
  std::size_t step = 1;
  for (std::size_t k = 0; k < axis; ++k) step *= variable.sizes[k];
  return step;
}

/// Those of three dimensions, of which `time` counts the frames; rows come before columns.
Axes axes_of(const MatlabVariable& variable, std::size_t time) {
  const std::size_t row = time == 0 ? 1 : 0;
  const std::size_t col = time == 2 ? 1 : 2;
  return {{variable.sizes[row], variable.sizes[col]},
          variable.sizes[time],
          step_of(variable, time),
          step_of(variable, row),
          step_of(variable, col)};
}

/// Frames and taxels, row by row.
std::optional<Axes> axes_of_table(const MatlabVariable& variable, FrameShape shape) {
  const std::vector<std::size_t>& sizes = variable.sizes;
  if (sizes[1] == shape.taxel_count()) return Axes{shape, sizes[0], 1, shape.cols * sizes[0], sizes[0]};
  if (sizes[0] == shape.taxel_count()) return Axes{shape, sizes[1], sizes[0], shape.cols, 1};
  if (sizes[0] == shape.rows && sizes[1] == shape.cols) return Axes{shape, 1, 0, 1, sizes[0]};
  return std::nullopt;
}

bool may_be_frames(const MatlabVariable& variable, const std::optional<FrameShape>& shape) {
  if (variable.value_count() == 0) return false;
  return variable.sizes.size() == 3 || (variable.sizes.size() == 2 && shape && axes_of_table(variable, *shape));
}

/// "'data' (12 x 30 x 14), 'fs' (1 x 1)"
std::string names_of(const MatlabFile& file) {
  constexpr std::size_t kMostNames = 50;
  std::string names;
  std::size_t named = 0;
  for (const MatlabVariable& variable : file.variables()) {
    if (named++ == kMostNames) break;
    names += (names.empty() ? "" : ", ") + files::in_quotes(variable.name) + " (" + variable.sizes_text() + ")";
  }
  return names;
}

Result<const MatlabVariable*> choose(const MatlabFile& file, const std::string& path, const ImportOptions& options) {
  if (file.variables().empty()) return bad_input(path + ": holds no variable of numbers, or is damaged");
  if (!options.array.empty()) {
    if (const MatlabVariable* const named = find(file, options.array)) return named;
    return bad_input(path + ": has no variable " + files::in_quotes(options.array) + "; it has: " + names_of(file));
  }
  std::vector<const MatlabVariable*> candidates;
  for (const MatlabVariable& variable : file.variables()) {
    if (may_be_frames(variable, options.shape)) candidates.push_back(&variable);
  }
  if (candidates.size() == 1) return candidates.front();
  const auto usual = std::find_if(candidates.begin(), candidates.end(),
                                  [](const MatlabVariable* variable) { return variable->name == kUsualName; });
  if (usual != candidates.end()) return *usual;
  if (candidates.empty()) {
    return bad_input(path + ": no variable has three dimensions, frames, rows and cols" +
                     (options.shape ? "" : "; of two, rows and cols must be given") + ": " + names_of(file));
  }
  return bad_input(path + ": name the variable, as " + files::in_quotes(path + "#" + candidates.front()->name) +
                   "; it has: " + names_of(file));
}

/// Mean square of the change from one value to the next along an axis.
double change_along(const MatlabVariable& variable, std::size_t axis, const Values& values) {
  const std::size_t step = step_of(variable, axis);
  const std::size_t size = variable.sizes[axis];
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k + step < values.size(); ++k) {
    if (k / step % size + 1 == size) continue;
    const auto change = static_cast<double>(values[k + step] - values[k]);
    if (!std::isfinite(change)) continue;
    sum += change * change;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(count);
}

/// The axis along which readings change least, where that is clear and there are enough of them.
std::optional<std::size_t> smoothest(const MatlabVariable& variable, const std::vector<std::size_t>& axes,
                                     const Values& values) {
  std::vector<std::pair<double, std::size_t>> changes;
  for (const std::size_t axis : axes) changes.emplace_back(change_along(variable, axis, values), axis);
  std::sort(changes.begin(), changes.end());
  const auto [least, axis] = changes[0];
  if (variable.sizes[axis] >= kFewestFrames && least < kClearly * changes[1].first) return axis;
  return std::nullopt;
}

/// Times of its frames that a file may hold: a variable of one row or column.
struct Times {
  const MatlabVariable* variable = nullptr;
  std::size_t count = 0;
};

Times times_in(const MatlabFile& file) {
  for (const char* const name : kTimeNames) {
    const MatlabVariable* const variable = find(file, name);
    if (variable == nullptr || variable->sizes.size() != 2 || std::min(variable->sizes[0], variable->sizes[1]) != 1) {
      continue;
    }
    return {variable, variable->value_count()};
  }
  return {};
}

/// The axes of three that may count the frames.
std::vector<std::size_t> axes_of_time(const MatlabVariable& variable, const Times& times,
                                      const std::optional<FrameShape>& shape) {
  std::vector<std::size_t> all;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!shape || axes_of(variable, axis).shape == *shape) all.push_back(axis);
  }
  std::vector<std::size_t> timed;
  std::copy_if(all.begin(), all.end(), std::back_inserter(timed),
               [&](std::size_t axis) { return variable.sizes[axis] == times.count; });
  return timed.empty() ? all : timed;
}

/// When frames were taken.
struct Timing {
  std::vector<double> seconds;  // of each; empty: a rate gives them
  std::optional<double> rate_hz;
};

class Matlab final : public FrameSource {
 public:
  Matlab(std::string place, Axes axes, Values values, Timing timing)
      : place_(std::move(place)), axes_(axes), values_(std::move(values)), timing_(std::move(timing)) {}

  Result<bool> next(RawFrame& frame) override {
    if (frame_ == axes_.frames) return false;
    const Result<Nanos> time = time_of_next();
    if (!time) return time.error();
    begin_frame(frame, *time);
    frame.counts.resize(axes_.shape.taxel_count());
    for (std::size_t taxel = 0; taxel < frame.counts.size(); ++taxel) {
      frame.counts[taxel] = values_[frame_ * axes_.frame_step + taxel / axes_.shape.cols * axes_.row_step +
                                    taxel % axes_.shape.cols * axes_.col_step];
    }
    ++frame_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return axes_.shape; }

 private:
  [[nodiscard]] Result<Nanos> time_of_next() const {
    if (timing_.rate_hz) return time_of_frame(place_, frame_, *timing_.rate_hz);
    const std::optional<Nanos> time = files::nanos_from_seconds(timing_.seconds[frame_]);
    if (time) return *time;
    return bad_input(place_ + ": frame " + std::to_string(frame_) +
                     " has no time; seconds of at most 9e9 are expected");
  }

  std::string place_;
  Axes axes_;
  Values values_;  // of the variable
  Timing timing_;
  std::size_t frame_ = 0;
};

Result<Axes> find_axes(const MatlabVariable& variable, const std::string& place, const Values& values,
                       const Times& times, const std::optional<FrameShape>& shape) {
  if (variable.sizes.size() == 2) {
    const std::optional<Axes> axes = shape ? axes_of_table(variable, *shape) : std::nullopt;
    if (axes) return *axes;
    return bad_input(place + " is " + variable.sizes_text() + ", frames and taxels: rows and cols must be given");
  }
  if (variable.sizes.size() != 3) return bad_input(place + " is " + variable.sizes_text() + "; three are expected");
  const std::vector<std::size_t> possible = axes_of_time(variable, times, shape);
  if (possible.empty()) {
    return bad_input(place + " is " + variable.sizes_text() + ", the array is " + files::size_text(*shape));
  }
  if (possible.size() == 1) return axes_of(variable, possible.front());
  if (const auto time = smoothest(variable, possible, values)) return axes_of(variable, *time);
  return bad_input(place + " is " + variable.sizes_text() +
                   ", and it is not clear which of these counts the frames: rows and cols must be given");
}

/// Readings that a float cannot hold come from another program than one of counts.
Status check_exact(const std::string& place, const Values& values) {
  const auto is_inexact = [](float value) { return std::abs(value) > kLargestExact && std::isfinite(value); };
  if (std::none_of(values.begin(), values.end(), is_inexact)) return Done{};
  return bad_input(place + " has values beyond 16777216, which cannot be held exactly");
}

/// A number on its own, for frames a second.
Result<std::optional<double>> rate_in(MatlabFile& file) {
  for (const char* const name : kRateNames) {
    const MatlabVariable* const variable = find(file, name);
    if (variable == nullptr || variable->value_count() != 1) continue;
    const Result<std::vector<double>> value = read<double>(file, *variable);
    if (!value) return value.error();
    if (value->front() > 0.0 && value->front() <= kMostRateHz) return std::optional(value->front());
  }
  return std::optional<double>();
}

/// The times of the frames, or a rate, by what is given, else by the file.
Result<Timing> timing_of(MatlabFile& file, const std::string& path, const Axes& axes, const Times& times,
                         const std::optional<double>& given_hz) {
  if (given_hz) return Timing{{}, given_hz};
  if (times.variable != nullptr && times.count == axes.frames && axes.frames > 1) {
    Result<std::vector<double>> seconds = read<double>(file, *times.variable);
    if (!seconds) return seconds.error();
    return Timing{*std::move(seconds), std::nullopt};
  }
  const Result<std::optional<double>> rate_hz = rate_in(file);
  if (!rate_hz) return rate_hz.error();
  if (*rate_hz) return Timing{{}, *rate_hz};
  return bad_input(path +
                   ": has no times, neither a variable 'time_s' nor a rate 'fs': give a rate, when it is "
                   "converted or as 'file:" +
                   path + "?rate=HZ'");
}

}  // namespace

std::size_t MatlabVariable::value_count() const noexcept {
  std::size_t count = 1;
  for (const std::size_t size : sizes) {
    if (__builtin_mul_overflow(count, size, &count)) return std::numeric_limits<std::size_t>::max();
  }
  return count;
}

std::string MatlabVariable::sizes_text() const {
  std::string text;
  for (const std::size_t size : sizes) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

Result<std::unique_ptr<FrameSource>> open_matlab(MatlabFile& file, const std::string& name,
                                                 const ImportOptions& options) {
  const Result<const MatlabVariable*> variable = choose(file, name, options);
  if (!variable) return variable.error();
  const std::string place = name + ": variable " + files::in_quotes((*variable)->name);
  if ((*variable)->value_count() > kMostMatlabValues) {
    return bad_input(place + " has more than 67 million values; save it in parts");
  }
  Result<Values> values = read<float>(file, **variable);
  if (!values) return values.error();
  if (const Status exact = check_exact(place, *values); !exact) return exact.error();
  const Times times = times_in(file);
  const Result<Axes> axes = find_axes(**variable, place, *values, times, options.shape);
  if (!axes) return axes.error();
  if (const Status shape = check_shape(name, axes->shape, options.shape); !shape) return shape.error();
  Result<Timing> timing = timing_of(file, name, *axes, times, options.rate_hz);
  if (!timing) return timing.error();
  return std::unique_ptr<FrameSource>(std::make_unique<Matlab>(place, *axes, *std::move(values), *std::move(timing)));
}

Result<std::unique_ptr<FrameSource>> open_matlab(std::unique_ptr<std::istream> in, const std::string& name,
                                                 const ImportOptions& options) {
  const Result<std::unique_ptr<MatlabFile>> file = open_matlab_file(std::move(in), name);
  if (!file) return file.error();
  return open_matlab(**file, name, options);
}

}  // namespace dermis::bytes::formats
