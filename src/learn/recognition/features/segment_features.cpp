// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/segment_features.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "learn/recognition/features/pose_block.hpp"
#include "learn/recognition/valid_reading.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr double kHeldShare = 0.5;  // of the peak force: these frames make up the held image
constexpr double kAreaLevel = 0.1;  // of the largest reading

double frames_per_frame(const Layout& examples, const Layout& source) {
  return examples.rate_hz > 0.0 && source.rate_hz > 0.0 ? source.rate_hz / examples.rate_hz : 1.0;
}

/// How many frames the segment has at the rate of the examples.
std::size_t resampled_count(std::size_t frames, double source_per_frame) {
  constexpr double kRounding = 1e-9;
  return 1 + static_cast<std::size_t>(static_cast<double>(frames - 1) / source_per_frame + kRounding);
}

/// A frame without force has the centre of the frame before.
void set_centre(FrameSeries& series, std::size_t frame, const Moments& moments) {
  const bool is_touched = moments.sum > 0.0 || frame == 0;
  series.row[frame] = is_touched ? moments.row : series.row[frame - 1];
  series.col[frame] = is_touched ? moments.col : series.col[frame - 1];
}

/// Sum of |a - b|, which is added to `sums`.
double add_differences(std::span<const double> a, std::span<const double> b, std::span<double> sums) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    sum += difference;
    sums[i] += difference;
  }
  return sum;
}

/// Further readings at the end, and their change since the beginning.
void write_extras(const Segment& segment, std::span<double> out) {
  const std::size_t count = out.size() / 2;
  const std::span<const float> first = segment.extras.first(count);
  const std::span<const float> last = segment.extras.last(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<double>(last[i]);
    out[count + i] = static_cast<double>(last[i]) - static_cast<double>(first[i]);
  }
}

}  // namespace

SegmentFeatures::ArrayFeatures::ArrayFeatures(const SensedArray& examples, const SensedArray& source,
                                              double least_reading, std::size_t most_frames)
    : regrid(source, common_lattice(examples, source)),
      lattice(common_lattice(examples, source)),
      analysis(lattice),
      hog(lattice, hog_cells(examples.rows), hog_cells(examples.cols)),
      form(lattice, least_reading),
      time(least_reading, most_frames),
      image(lattice.taxels()),
      before(lattice.taxels()),
      held(lattice.taxels()),
      changed(lattice.taxels()) {
  series.resize(most_frames);
}

SegmentFeatures::SegmentFeatures(const Layout& examples, const Layout& source, bool moving, std::size_t most_frames)
    : source_(source),
      moving_(moving),
      most_frames_(most_frames),
      source_frames_per_frame_(frames_per_frame(examples, source)),
      columns_(feature_columns(examples, moving)),
      blend_(source.readings),
      features_(columns_.count) {
  assert(examples.arrays.size() == source.arrays.size() && examples.extras == source.extras);
  const std::size_t most = resampled_count(most_frames, source_frames_per_frame_);
  for (std::size_t i = 0; i < examples.arrays.size(); ++i) {
    arrays_.emplace_back(examples.arrays[i], source.arrays[i], examples.least_reading(), most);
    if (tells_of_taxels(examples)) arrays_.back().taxels.emplace(examples.arrays[i], arrays_.back().lattice);
  }
  force_.reserve(most);
}

std::span<const double> SegmentFeatures::compute(const Segment& segment) {
  assert(!segment.frames.empty() && segment.frames.size() % source_.readings == 0);
  const std::size_t most = most_frames_ * source_.readings;
  Segment last = segment;
  if (last.frames.size() > most) last.frames = last.frames.last(most);
  measure(last);
  for (ArrayFeatures& array : arrays_) accumulate(array, last);
  for (const BlockColumns& block : columns_.blocks) {
    write(block, segment, std::span(features_).subspan(block.begin, block.size));
  }
  return features_;
}

/// The image of one frame at the rate of the examples.
void SegmentFeatures::image_at(ArrayFeatures& array, const Segment& segment, std::size_t frame) {
  const double place = static_cast<double>(frame) * source_frames_per_frame_;
  const auto below = static_cast<std::size_t>(place);
  const std::span<const float> first = segment.frames.subspan(below * source_.readings, source_.readings);
  const auto share = static_cast<float>(place - static_cast<double>(below));
  const bool is_last = (below + 1) * source_.readings >= segment.frames.size();
  if (share == 0.0F || is_last) return array.regrid.apply(first, array.image);
  const std::span<const float> second = segment.frames.subspan((below + 1) * source_.readings, source_.readings);
  for (std::size_t i = 0; i < blend_.size(); ++i) {
    const auto before = static_cast<float>(valid_reading(first[i]));
    blend_[i] = before + share * (static_cast<float>(valid_reading(second[i])) - before);
  }
  array.regrid.apply(blend_, array.image);
}

/// Force and largest reading of every frame.
void SegmentFeatures::measure(const Segment& segment) {
  const std::size_t frames = resampled_count(segment.frames.size() / source_.readings, source_frames_per_frame_);
  force_.assign(frames, 0.0);
  for (ArrayFeatures& array : arrays_) {
    array.series.resize(frames);
    for (std::size_t frame = 0; frame < frames; ++frame) {
      image_at(array, segment, frame);
      array.series.force[frame] = std::accumulate(array.image.begin(), array.image.end(), 0.0);
      array.series.peak[frame] = *std::max_element(array.image.begin(), array.image.end());
      force_[frame] += array.series.force[frame];
    }
  }
}

/// The held image, the mean change between frames, and what the frames say one by one.
void SegmentFeatures::accumulate(ArrayFeatures& array, const Segment& segment) {
  FrameSeries& series = array.series;
  const double held_from = kHeldShare * *std::max_element(force_.begin(), force_.end());
  const double area_from = kAreaLevel * *std::max_element(series.peak.begin(), series.peak.end());
  std::fill(array.held.begin(), array.held.end(), 0.0);
  std::fill(array.changed.begin(), array.changed.end(), 0.0);
  if (array.taxels) array.taxels->begin();
  std::size_t held_frames = 0;
  for (std::size_t frame = 0; frame < series.frames(); ++frame) {
    image_at(array, segment, frame);
    if (force_[frame] >= held_from) {
      ++held_frames;
      std::transform(array.held.begin(), array.held.end(), array.image.begin(), array.held.begin(), std::plus<>());
    }
    if (array.taxels) array.taxels->add(array.image);
    if (!moving_) continue;
    set_centre(series, frame, moments_of(array.lattice, array.image));
    series.area[frame] = static_cast<double>(
        std::count_if(array.image.begin(), array.image.end(), [&](double value) { return value > area_from; }));
    if (frame > 0) series.change[frame] = add_differences(array.image, array.before, array.changed);
    std::swap(array.image, array.before);
  }
  for (double& value : array.held) value /= static_cast<double>(held_frames);
  array.analysis.analyse(array.held);
  if (series.frames() < 2) return;
  for (double& value : array.changed) value /= static_cast<double>(series.frames() - 1);
}

/// Blocks of one array in their order: the changed form is the last, as it is of another image.
void SegmentFeatures::write(const BlockColumns& block, const Segment& segment, std::span<double> out) {
  ArrayFeatures& array = arrays_[block.array];
  switch (block.block) {
    case Block::hog: return array.hog.write(array.analysis, out);
    case Block::pose: return write_pose(array.analysis, out);
    case Block::polar: return array.polar.write(array.analysis, out);
    case Block::form: return array.form.write(array.analysis, out);
    case Block::time: return array.time.write(array.series, out);
    case Block::changed_form: array.analysis.analyse(array.changed); return array.form.write(array.analysis, out);
    case Block::share: return write_shares(out);
    case Block::extra: return write_extras(segment, out);
    case Block::pattern: return write_pattern(out);
    case Block::course: return write_course(out);
  }
}

/// Each array's part of the held force.
void SegmentFeatures::write_shares(std::span<double> out) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < arrays_.size(); ++i) {
    out[i] = std::accumulate(arrays_[i].held.begin(), arrays_[i].held.end(), 0.0);
    sum += out[i];
  }
  for (double& force : out) force = sum > 0.0 ? force / sum : 0.0;
}

/// Roots of the held readings of all arrays, over their length.
void SegmentFeatures::write_pattern(std::span<double> out) {
  std::span<double> rest = out;
  for (ArrayFeatures& array : arrays_) {
    array.taxels->write_roots(array.held, rest.first(array.taxels->taxels()));
    rest = rest.subspan(array.taxels->taxels());
  }
  const double length = std::sqrt(std::inner_product(out.begin(), out.end(), out.begin(), 0.0));
  for (double& value : out) value = length > 0.0 ? value / length : 0.0;
}

/// Mean, and where time counts deviation and change: each of all arrays.
void SegmentFeatures::write_course(std::span<double> out) {
  const auto put = [&](auto&& write_array) {
    for (ArrayFeatures& array : arrays_) {
      write_array(array, out.first(array.taxels->taxels()));
      out = out.subspan(array.taxels->taxels());
    }
  };
  put([](ArrayFeatures& array, std::span<double> part) { array.taxels->write_mean(part); });
  if (!moving_) return;
  put([](ArrayFeatures& array, std::span<double> part) { array.taxels->write_deviation(part); });
  put([](ArrayFeatures& array, std::span<double> part) { array.taxels->write_roots(array.changed, part); });
}

}  // namespace dermis::learn::recognition
