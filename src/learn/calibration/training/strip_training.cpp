// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/strip_training.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dermis/touch/contacts/contact_tracker.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/tables/monotone_knots.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastTouches = 16;
constexpr double kLeastStepM = 1e-6;  // between centres of mass
constexpr std::size_t kTouchesPerKnot = 8;
constexpr std::size_t kMostKnots = 64;

struct KnownTouch {
  double centre_m = 0.0;
  double sigma_centre_m = 0.0;
  double position_m = 0.0;
};

double length_of(const ArrayDescription& array) {
  return array.rows == 1 ? array.col_pitch_m * static_cast<double>(array.cols - 1)
                         : array.row_pitch_m * static_cast<double>(array.rows - 1);
}

/// The centres of mass of the strongest contacts of the frames with a position, by rising centre.
std::vector<KnownTouch> find_touches(const touch::pipeline::Model& model, touch::pipeline::Pipeline& pipeline,
                                     std::span<const RawFrame> frames, std::span<const TouchPosition> positions) {
  const bool is_row = model.array.rows == 1;
  const double length = length_of(model.array);
  touch::contacts::ContactTracker tracker(model.array, {},
                                          touch::contacts::StripTable{{0.0, length}, {0.0, length}, 0.0});
  ForceFrame force;
  ContactReport report;
  std::vector<KnownTouch> touches;
  auto next = positions.begin();
  for (std::size_t frame = 0; frame < frames.size() && next != positions.end(); ++frame) {
    pipeline.process(frames[frame], force);
    if (next->frame != frame) continue;
    const double position_m = (next++)->along_m;
    tracker.forget();
    tracker.process(force, report);
    const auto strongest = std::max_element(report.contacts.begin(), report.contacts.end(),
                                            [](const Contact& a, const Contact& b) { return a.force_n < b.force_n; });
    if (strongest == report.contacts.end()) continue;
    touches.push_back({is_row ? strongest->position.x : strongest->position.y,
                       is_row ? strongest->sigma_position_m.x : strongest->sigma_position_m.y, position_m});
  }
  std::sort(touches.begin(), touches.end(),
            [](const KnownTouch& a, const KnownTouch& b) { return a.centre_m < b.centre_m; });
  return touches;
}

/// On to `centre_m` along the line through the first two knots, no further than to `position_m`.
Knot extended(const Knot& end, const Knot& beside, double centre_m, double position_m) {
  const double slope = (beside.y - end.y) / (beside.x - end.x);
  const double along = end.y + slope * (centre_m - end.x);
  return {centre_m, centre_m < end.x ? std::max(along, position_m) : std::min(along, position_m), 1.0};
}

/// Bins lie inside their touches: goes on to the outermost ones.
void extend(std::vector<Knot>& knots, const std::vector<KnownTouch>& touches) {
  const auto [lowest, highest] =
      std::minmax_element(touches.begin(), touches.end(),
                          [](const KnownTouch& a, const KnownTouch& b) { return a.position_m < b.position_m; });
  const Knot first = extended(knots[0], knots[1], touches.front().centre_m, lowest->position_m);
  const Knot last = extended(knots.back(), knots[knots.size() - 2], touches.back().centre_m, highest->position_m);
  if (first.x < knots.front().x && first.y <= knots.front().y) knots.insert(knots.begin(), first);
  if (last.x > knots.back().x && last.y >= knots.back().y) knots.push_back(last);
}

/// The scatter of the touches about the table beyond the noise of their centres of mass.
double scatter_m(const touch::contacts::StripTable& table, const std::vector<KnownTouch>& touches) {
  double square = 0.0;
  double noise = 0.0;
  for (const KnownTouch& touch : touches) {
    const touch::contacts::StripTable::Place place = table.at(touch.centre_m);
    square += std::pow(touch.position_m - place.position_m, 2);
    noise += std::pow(place.slope * touch.sigma_centre_m, 2);
  }
  const auto count = static_cast<double>(touches.size());
  const auto fitted = static_cast<double>(table.centre_m.size());
  return std::sqrt(std::max(square / std::max(count - fitted, 1.0) - noise / count, 0.0));
}

}  // namespace

Result<touch::contacts::StripTable> train_strip(const touch::pipeline::Model& model, std::span<const RawFrame> frames,
                                                std::span<const TouchPosition> positions) {
  if ((model.array.rows > 1) == (model.array.cols > 1)) {
    return bad_input("positions are learned on arrays of one row or one column of several taxels");
  }
  Result<touch::pipeline::Pipeline> pipeline = touch::pipeline::Pipeline::create(model);
  if (!pipeline) return pipeline.error();
  const std::vector<KnownTouch> touches = find_touches(model, *pipeline, frames, positions);
  if (touches.size() < kLeastTouches) {
    return bad_input(fmt::format("{} of {} frames with a position have a contact; at least {} are needed",
                                 touches.size(), positions.size(), kLeastTouches));
  }
  std::vector<Knot> knots;
  for (const KnownTouch& touch : touches) knots.push_back({touch.centre_m, touch.position_m, 1.0});
  thin_out(knots, std::clamp(touches.size() / kTouchesPerKnot, std::size_t{2}, kMostKnots));
  merge_equal(knots, kLeastStepM);
  pool_adjacent_violators(knots);
  if (knots.size() < 2) {
    return bad_input("positions do not rise with the centre of mass: they are counted from the first taxel on");
  }
  extend(knots, touches);
  touch::contacts::StripTable table;
  for (const Knot& knot : knots) {
    table.centre_m.push_back(knot.x);
    table.position_m.push_back(knot.y);
  }
  table.sigma_m = scatter_m(table, touches);
  return table;
}

}  // namespace dermis::learn::calibration
