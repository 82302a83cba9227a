// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/matlab.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "bytes/formats/matlab_file.hpp"
#include "dermis/bytes/files/array_frames.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

using Values = std::vector<float>;
using files::ArrayTimes;
using files::axes_of;
using files::axes_of_table;
using files::FrameAxes;
using files::NumberArray;

constexpr std::array kNamesOfTimes = {"t", "time", "time_s", "timestamps", "timestamp"};
constexpr std::array kRateNames = {"fs", "Fs", "FS", "rate", "rate_hz", "sampling_rate", "sample_rate"};
constexpr const char* kUsualName = "data";
constexpr double kMostRateHz = 1e9;
constexpr float kLargestExact = 16777216.0F;  // up to here a float holds every whole number

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

NumberArray array_of(const MatlabVariable& variable) {
  return NumberArray::first_fastest(variable.sizes);
}

bool may_be_frames(const MatlabVariable& variable, const std::optional<FrameShape>& shape) {
  if (variable.value_count() == 0) return false;
  return variable.sizes.size() >= 3 ||
         (variable.sizes.size() == 2 && shape && axes_of_table(array_of(variable), *shape));
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

Result<const MatlabVariable*> choose(const MatlabFile& file, const std::string& path, const std::string& variable_name,
                                     const ImportOptions& options) {
  if (file.variables().empty()) return bad_input(path + ": holds no variable of numbers, or is damaged");
  if (!variable_name.empty()) {
    if (const MatlabVariable* const named = find(file, variable_name)) return named;
    return bad_input(path + ": has no variable " + files::in_quotes(variable_name) + "; it has: " + names_of(file));
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

/// Times of its frames that a file may hold: a variable of one row or column.
struct Times {
  const MatlabVariable* variable = nullptr;
  std::size_t count = 0;
};

Times times_in(const MatlabFile& file) {
  for (const char* const name : kNamesOfTimes) {
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
    if (!shape || axes_of(array_of(variable), axis).shape == *shape) all.push_back(axis);
  }
  std::vector<std::size_t> timed;
  std::copy_if(all.begin(), all.end(), std::back_inserter(timed),
               [&](std::size_t axis) { return variable.sizes[axis] == times.count; });
  return timed.empty() ? all : timed;
}

Result<FrameAxes> find_axes(const MatlabVariable& variable, const std::string& place, const Values& values,
                            const Times& times, const std::optional<FrameShape>& shape, const std::string& axes) {
  const NumberArray array = array_of(variable);
  if (!axes.empty() || variable.sizes.size() > 3) {
    const files::ArrayHints hints{place.substr(0, place.find(": variable ")) + "#" + variable.name, axes, shape,
                                  times.count};
    const Result<FrameAxes> told = files::frame_axes(array, hints, values);
    return told ? told : Result<FrameAxes>(bad_input(place + " " + told.error().message));
  }
  if (variable.sizes.size() == 2) {
    const std::optional<FrameAxes> table = shape ? axes_of_table(array_of(variable), *shape) : std::nullopt;
    if (table) return *table;
    return bad_input(place + " is " + variable.sizes_text() + ", frames and taxels: rows and cols must be given");
  }
  const std::vector<std::size_t> possible = axes_of_time(variable, times, shape);
  if (possible.empty()) {
    return bad_input(place + " is " + variable.sizes_text() + ", the array is " + files::size_text(*shape));
  }
  if (possible.size() == 1) return axes_of(array, possible.front());
  if (const auto time = smoothest_axis(array, possible, values)) return axes_of(array, *time);
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
Result<ArrayTimes> timing_of(MatlabFile& file, const std::string& path, const FrameAxes& axes, const Times& times,
                             const std::optional<double>& given_hz) {
  if (given_hz) return ArrayTimes{{}, given_hz};
  if (times.variable != nullptr && times.count == axes.frames && axes.frames > 1) {
    Result<std::vector<double>> seconds = read<double>(file, *times.variable);
    if (!seconds) return seconds.error();
    return ArrayTimes{*std::move(seconds), std::nullopt};
  }
  const Result<std::optional<double>> rate_hz = rate_in(file);
  if (!rate_hz) return rate_hz.error();
  if (*rate_hz) return ArrayTimes{{}, *rate_hz};
  return bad_input(path +
                   ": has no times, neither a variable 'time_s' nor a rate 'fs': give a rate, when it is "
                   "converted or as 'file:" +
                   path + "?rate=HZ'");
}

}  // namespace

std::size_t MatlabVariable::value_count() const noexcept {
  return array_of(*this).value_count();
}

std::string MatlabVariable::sizes_text() const {
  return array_of(*this).sizes_text();
}

Result<std::unique_ptr<FrameSource>> open_matlab(MatlabFile& file, const std::string& name,
                                                 const ImportOptions& options) {
  const files::ArrayChoice choice = files::array_choice(options.array);
  const Result<const MatlabVariable*> variable = choose(file, name, choice.name, options);
  if (!variable) return variable.error();
  const std::string place = name + ": variable " + files::in_quotes((*variable)->name);
  if ((*variable)->value_count() > files::kMostArrayValues) {
    return bad_input(place + " has more than 67 million values; save it in parts");
  }
  Result<Values> values = read<float>(file, **variable);
  if (!values) return values.error();
  if (const Status exact = check_exact(place, *values); !exact) return exact.error();
  const Times times = times_in(file);
  const Result<FrameAxes> axes = find_axes(**variable, place, *values, times, options.shape, choice.axes);
  if (!axes) return axes.error();
  if (const Status shape = check_shape(name, axes->shape, options.shape); !shape) return shape.error();
  Result<ArrayTimes> timing = timing_of(file, name, *axes, times, options.rate_hz);
  if (!timing) return timing.error();
  return files::frames_of_array(place, *axes, *std::move(values), *std::move(timing));
}

Result<std::unique_ptr<FrameSource>> open_matlab(std::unique_ptr<std::istream> in, const std::string& name,
                                                 const ImportOptions& options) {
  const Result<std::unique_ptr<MatlabFile>> file = open_matlab_file(std::move(in), name);
  if (!file) return file.error();
  return open_matlab(**file, name, options);
}

}  // namespace dermis::bytes::formats
