// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/array_steps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "dermis/bytes/files/text.hpp"

namespace dermis::out::datasets {
namespace {

constexpr std::size_t kNumbersOfContact = 5;  // x, y, force, sigma, area
constexpr float kNoFrame = -1.0F;             // age of an empty place of a window

template <typename T>
void append(const T* values, std::size_t count, std::vector<std::byte>& bytes) {
  const auto* const first = reinterpret_cast<const std::byte*>(values);
  bytes.insert(bytes.end(), first, first + count * sizeof(T));
}

float finite_or_zero(float value) {
  return std::isnan(value) ? 0.0F : value;
}

bool is_wanted(const EpisodeOptions& options, std::string_view quantity) {
  const std::vector<std::string>& wanted = options.quantities;
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), quantity) != wanted.end();
}

/// NaN where there is no value.
std::vector<float> picture_of(std::vector<float> values, const std::vector<std::uint8_t>& valid) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (valid[k] == 0) values[k] = std::numeric_limits<float>::quiet_NaN();
  }
  return values;
}

/// One dimension in place of several.
void flatten(Column& column) {
  if (column.shape.size() < 2) return;
  std::string axis = column.axes.front();
  for (std::size_t k = 1; k < column.axes.size(); ++k) axis += "_" + column.axes[k];
  column.shape = {column.elements()};
  column.axes = {axis};
}

}  // namespace

std::vector<Column> columns_of(const RecordedArrays::Array& array, const RawFrame& first,
                               const EpisodeOptions& options) {
  const std::size_t rows = array.shape.rows;
  const std::size_t cols = array.shape.cols;
  Column taxels{array.name, "", ColumnType::float32, {rows, cols}, {"rows", "cols"}};
  if (options.window > 1)
    taxels = {array.name, "", ColumnType::float32, {options.window, rows, cols}, {"window", "rows", "cols"}};
  std::vector<Column> columns;
  const auto add = [&](const char* quantity, Column column, std::size_t kinds = 1) {
    if (!is_wanted(options, quantity)) return;
    column.kinds = kinds;
    if (std::string_view(quantity) != "forces") column.quantity = quantity;
    if (options.flat) flatten(column);
    columns.push_back(std::move(column));
  };
  const bool has_forces = array.model != nullptr;
  if (has_forces) add("forces", taxels);
  if (has_forces) add("sigma", taxels);
  Column valid = taxels;
  valid.type = ColumnType::boolean;
  add("valid", valid);
  add("raw", taxels);
  add("age", {array.name, "", ColumnType::float32, {options.window}, {"window"}});
  add("fresh", {array.name, "", ColumnType::int64, {1}, {"frames"}});
  if (has_forces) {
    add("contacts",
        {array.name, "", ColumnType::float32, {kContactsOfStep, kNumbersOfContact}, {"contacts", "quantities"}},
        kNumbersOfContact);
  }
  const std::size_t sensors = std::max<std::size_t>(1, first.sensor_celsius.size());
  if (first.temperature_celsius || !first.sensor_celsius.empty()) {
    add("temperature", {array.name, "", ColumnType::float32, {sensors}, {sensors > 1 ? "sensors" : "celsius"}},
        sensors);
  }
  if (first.supply_v) add("supply", {array.name, "", ColumnType::float32, {1}, {"volts"}});
  return columns;
}

ArraySteps::ArraySteps(const RecordedArrays::Array& array, std::size_t window, std::vector<Column> columns)
    : array_(array), window_(window), length_(window), columns_(std::move(columns)) {
  tally_.name = array.name;
  tally_.rows = array.shape.rows;
  tally_.cols = array.shape.cols;
  tally_.has_forces = array.model != nullptr;
  tally_.invalid.resize(array.shape.taxel_count());
}

Result<ArraySteps> ArraySteps::create(const RecordedArrays::Array& array, const EpisodeOptions& options,
                                      std::vector<Column> columns) {
  ArraySteps steps(array, options.window, std::move(columns));
  for (const Column& column : steps.columns_) {
    if (column.quantity == "temperature") steps.last_.celsius.resize(column.elements());
  }
  if (array.model == nullptr) return steps;
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(*array.model);
  if (!pipeline) return pipeline.error();
  steps.pipeline_.emplace(*std::move(pipeline));
  steps.pipeline_->drift().set_options({.track = options.follow_drift});
  if (options.tare) steps.pipeline_->tare();
  if (options.tare_force) steps.pipeline_->tare(touch::pipeline::TareOver::any_load);
  const auto is_contacts = [](const Column& column) { return column.quantity == "contacts"; };
  if (std::any_of(steps.columns_.begin(), steps.columns_.end(), is_contacts)) {
    steps.tracker_.emplace(array.model->array, touch::contacts::ContactOptions{}, array.model->strip);
  }
  return steps;
}

RawFrame& ArraySteps::next_frame() {
  if (frame_count_ == frames_.size()) frames_.emplace_back();
  return frames_[frame_count_++];
}

/// Forces of NaN are no forces: 0, and not valid.
void ArraySteps::keep_forces(Values& values) {
  const std::size_t count = force_.newtons.size();
  for (std::size_t k = 0; k < count; ++k) {
    values.valid[k] = std::isnan(force_.newtons[k]) ? 0 : 1;
    values.newtons[k] = finite_or_zero(force_.newtons[k]);
    values.sigma[k] = finite_or_zero(force_.sigma_newtons[k]);
  }
}

void ArraySteps::keep_contacts(Values& values) {
  tracker_->process(force_, report_);
  std::vector<Contact>& contacts = report_.contacts;
  std::erase_if(contacts, [](const Contact& contact) { return contact.phase == ContactPhase::release; });
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Contact& a, const Contact& b) { return a.force_n > b.force_n; });
  values.contacts.assign(kContactsOfStep * kNumbersOfContact, 0.0F);
  auto at = values.contacts.begin();
  for (std::size_t k = 0; k < std::min(kContactsOfStep, contacts.size()); ++k) {
    const Contact& contact = contacts[k];
    for (const double number : std::array<double, kNumbersOfContact>{
             contact.position.x, contact.position.y, contact.force_n, contact.sigma_force_n, contact.area_m2}) {
      *at++ = static_cast<float>(number);
    }
  }
}

/// Where a sensor has no reading, it has its last one.
void ArraySteps::keep_temperatures(const RawFrame& raw) {
  std::vector<float>& celsius = last_.celsius;
  if (raw.sensor_celsius.empty() && raw.temperature_celsius && std::isfinite(*raw.temperature_celsius)) {
    std::fill(celsius.begin(), celsius.end(), static_cast<float>(*raw.temperature_celsius));
  }
  for (std::size_t k = 0; k < std::min(celsius.size(), raw.sensor_celsius.size()); ++k) {
    if (std::isfinite(raw.sensor_celsius[k])) celsius[k] = raw.sensor_celsius[k];
  }
}

const std::vector<float>& ArraySteps::numbers(const Values& values) const {
  return pipeline_ ? values.newtons : values.counts;
}

/// A frame without any value says nothing of single taxels.
void ArraySteps::count(const Values& values) {
  const std::vector<float>& all = numbers(values);
  if (std::find(values.valid.begin(), values.valid.end(), 1) == values.valid.end()) {
    ++tally_.empty_frames;
    return;
  }
  if (tally_.first_picture.empty()) {
    tally_.first_picture = picture_of(all, values.valid);
    tally_.lowest = std::numeric_limits<float>::max();
    tally_.highest = std::numeric_limits<float>::lowest();
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (values.valid[k] == 0) {
      ++tally_.invalid[k];
    } else {
      tally_.lowest = std::min(tally_.lowest, all[k]);
      tally_.highest = std::max(tally_.highest, all[k]);
    }
  }
}

void ArraySteps::process(const RawFrame& raw) {
  ++tally_.frames;
  if (frames_of_episode_++ == 0) first_of_episode_ = raw.time;
  if (pipeline_) pipeline_->process(raw, force_);
  const std::optional<std::size_t> slot = window_.add(raw.time);
  if (!slot) {
    ++tally_.late_frames;
    return;
  }
  if (*slot >= slots_.size()) slots_.resize(*slot + 1);
  Values& values = slots_[*slot];
  const std::size_t taxels = array_.shape.taxel_count();
  values.counts.resize(taxels);
  values.valid.resize(taxels);
  for (std::size_t k = 0; k < taxels; ++k) {
    const float count = raw.counts[k];
    values.valid[k] = std::isfinite(count) ? 1 : 0;
    values.counts[k] = finite_or_zero(count);
  }
  if (pipeline_) {
    values.newtons.resize(taxels);
    values.sigma.resize(taxels);
    keep_forces(values);
  }
  if (tracker_) keep_contacts(values);
  count(values);
  keep_temperatures(raw);
  if (raw.supply_v) last_.supply_v.assign(1, static_cast<float>(*raw.supply_v));
  values.celsius = last_.celsius;
  values.supply_v = last_.supply_v;
}

/// Empty places come first, as zeros.
template <typename T>
void ArraySteps::append_window(std::vector<T> Values::*member, std::size_t elements,
                               std::vector<std::byte>& bytes) const {
  const auto& held = window_.held();
  bytes.resize(bytes.size() + (length_ - held.size()) * elements * sizeof(T));
  for (const FrameWindow::Held& frame : held) append((slots_[frame.slot].*member).data(), elements, bytes);
}

void ArraySteps::append_ages(Nanos step, std::vector<std::byte>& bytes) const {
  const auto& held = window_.held();
  for (std::size_t k = held.size(); k < length_; ++k) append(&kNoFrame, 1, bytes);
  for (const FrameWindow::Held& frame : held) {
    const auto age_s = static_cast<float>(std::chrono::duration<double>(step - frame.time).count());
    append(&age_s, 1, bytes);
  }
}

/// Zeros where there is no frame yet.
void ArraySteps::append_newest(std::vector<float> Values::*member, std::size_t elements,
                               std::vector<std::byte>& bytes) const {
  const auto& held = window_.held();
  if (held.empty()) {
    bytes.resize(bytes.size() + elements * sizeof(float));
  } else {
    append((slots_[held.back().slot].*member).data(), elements, bytes);
  }
}

void ArraySteps::append_row(const Column& column, Nanos step, std::vector<std::byte>& bytes) const {
  const std::size_t taxels = array_.shape.taxel_count();
  const std::string& quantity = column.quantity;
  if (quantity.empty()) append_window(&Values::newtons, taxels, bytes);
  if (quantity == "sigma") append_window(&Values::sigma, taxels, bytes);
  if (quantity == "raw") append_window(&Values::counts, taxels, bytes);
  if (quantity == "valid") append_window(&Values::valid, taxels, bytes);
  if (quantity == "age") append_ages(step, bytes);
  if (quantity == "temperature") append_newest(&Values::celsius, column.elements(), bytes);
  if (quantity == "supply") append_newest(&Values::supply_v, 1, bytes);
  if (quantity == "contacts") append_newest(&Values::contacts, column.elements(), bytes);
  if (quantity == "fresh") {
    const auto fresh = static_cast<std::int64_t>(window_.fresh());
    append(&fresh, 1, bytes);
  }
}

void ArraySteps::work(std::span<const Nanos> steps, std::span<std::vector<std::byte>> values) {
  for (std::size_t k = 0; k < frame_count_; ++k) process(frames_[k]);
  frame_count_ = 0;
  for (const Nanos step : steps) {
    window_.step(step);
    count_step(step);
    for (std::size_t column = 0; column < columns_.size(); ++column) append_row(columns_[column], step, values[column]);
  }
}

void ArraySteps::count_step(Nanos step) {
  tally_.most_fresh = std::max(tally_.most_fresh, window_.came());
  if (window_.held().empty()) return;
  const Nanos age = step - window_.held().back().time;
  ++tally_.steps;
  if (window_.came() == 0) ++tally_.stale_steps;
  tally_.age += age;
  tally_.oldest = std::max(tally_.oldest, age);
}

void ArraySteps::end_episode() {
  if (!window_.held().empty()) {
    const FrameWindow::Held& newest = window_.held().back();
    tally_.last_picture = picture_of(numbers(slots_[newest.slot]), slots_[newest.slot].valid);
    tally_.time += newest.time - first_of_episode_;
    ++tally_.episodes;
  }
  tally_.missed += window_.missed();
  tally_.most_of_episode = std::max(tally_.most_of_episode, frames_of_episode_);
  frames_of_episode_ = 0;
  window_ = FrameWindow(length_);
}

Status ArraySteps::check_tare() const {
  if (!pipeline_ || pipeline_->last_tare().state != touch::pipeline::Tare::State::refused) return Done{};
  return failed(fmt::format("{} is not tared: {}, or force the tare if that is zero; nothing is written",
                            bytes::files::in_quotes(array_.name),
                            touch::pipeline::describe(pipeline_->last_tare(), array_.model->array)));
}

Result<std::string> ArraySteps::tared() const {
  if (!pipeline_) return std::string();
  const touch::pipeline::Tare& tare = pipeline_->last_tare();
  if (tare.state == touch::pipeline::Tare::State::taking) {
    return failed(bytes::files::in_quotes(array_.name) +
                  " is over before its tare, which takes 1 s and 10 frames; leave the tare out");
  }
  const std::string said = touch::pipeline::describe(tare, array_.model->array);
  return said.empty() ? said : fmt::format("{}: {}", array_.name, said);
}

void add(const ArrayTally& more, ArrayTally& sum) {
  if (sum.name.empty()) {
    sum = more;
    return;
  }
  const bool is_first = sum.first_picture.empty();
  const bool has_values = !more.first_picture.empty();
  if (has_values) {
    sum.lowest = is_first ? more.lowest : std::min(sum.lowest, more.lowest);
    sum.highest = is_first ? more.highest : std::max(sum.highest, more.highest);
    sum.last_picture = more.last_picture;
  }
  if (is_first) sum.first_picture = more.first_picture;
  sum.frames += more.frames;
  sum.missed += more.missed;
  sum.most_fresh = std::max(sum.most_fresh, more.most_fresh);
  sum.most_of_episode = std::max(sum.most_of_episode, more.most_of_episode);
  sum.time += more.time;
  sum.episodes += more.episodes;
  sum.steps += more.steps;
  sum.stale_steps += more.stale_steps;
  sum.age += more.age;
  sum.oldest = std::max(sum.oldest, more.oldest);
  sum.late_frames += more.late_frames;
  sum.empty_frames += more.empty_frames;
  for (std::size_t k = 0; k < sum.invalid.size(); ++k) sum.invalid[k] += more.invalid[k];
}

}  // namespace dermis::out::datasets
