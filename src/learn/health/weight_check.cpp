// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/health/weight_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

#include "dermis/touch/frames/cover.hpp"
#include "learn/health/film_change.hpp"

namespace dermis::learn::health {
namespace {

constexpr Nanos kOnset = std::chrono::seconds(1);  // a hand lets go meanwhile
constexpr Nanos kPiece = std::chrono::seconds(1);
constexpr std::size_t kLeastFrames = 3;
constexpr double kMostDeviation = 0.05;  // within a piece, relative: more is a hand
constexpr double kLeastChange = 0.03;    // of a gain: less is not worth a calibration
constexpr double kSomethingElse = 2.0;   // times the weight, or a part of it
constexpr double kLeft = 1.0 / 3.0;      // of the weight, once it is taken off
constexpr double kNewtonsPerGram = 9.80665e-3;
constexpr double kSigmas = 3.0;
constexpr double kTooMuch = 0.1;      // of a gain: a check that is less sure is of little use
constexpr double kLeastSigma = 1e-3;  // relative

constexpr double kNarrower = 0.88;  // than a point on the cover: less cannot be its noise
constexpr double kReachOfPoint = 2.5;
constexpr double kMuchWider = 1.25;  // a point on a cover that spreads more, or a larger object

/// Standard deviation of the forces of a point on the cover, along the narrower axis; 0 without a cover.
double point_under(const ArrayDescription& array) {
  if (!array.cover || array.cover->is_unknown() || array.rows == 1 || array.cols == 1) return 0.0;
  const CoverKernel kernel(array);
  const double spread = std::min(kernel.row_spread_m(), kernel.col_spread_m());
  const double pitch = std::min(array.row_pitch_m, array.col_pitch_m);
  return spread > 0.0 ? std::sqrt(spread * spread + pitch * pitch / 12.0) : 0.0;
}

/// On the cover, where the presses tell something of it.
std::string cover_line(const WeightFinding& finding) {
  if (finding.point_m == 0.0) return {};
  const std::string widths = fmt::format("{:.1f} mm wide under the cover, where a point was {:.1f} mm",
                                         1e3 * finding.narrowest_m, 1e3 * finding.point_m);
  if (finding.has_lost_cover()) {
    return fmt::format("recalibrate: the cover has changed, it spreads less: the object is {}\n", widths);
  }
  if (finding.narrowest_m < kMuchWider * finding.point_m) return {};
  return fmt::format("the object is {}: if it is smaller than a taxel, the cover has changed and spreads more\n",
                     widths);
}

/// Unloaded conductances that are not known are 0.
std::vector<double> conducting(std::vector<double> siemens) {
  for (double& one : siemens) one = one > 0.0 ? one : 0.0;
  return siemens;
}

std::string film_line(double factor) {
  return fmt::format(
      "recalibrate: the film between the lines has changed: it conducts about {:.0f} % {} than when it was "
      "calibrated\n",
      100.0 * std::abs(factor - 1.0), factor > 1.0 ? "more" : "less");
}

bool is_near(double ratio) {
  return ratio < kSomethingElse && ratio > 1.0 / kSomethingElse;
}

/// Standard deviation of the logarithm of the mean ratio. It is the model's for a force, or the scatter of the presses
/// if that is more.
double sigma_of(const std::vector<WeighedPress>& presses, double log_ratio, double weight_n) {
  double modelled = 0.0;
  double seen = 0.0;
  for (const WeighedPress& press : presses) {
    modelled += std::pow(press.sigma_newtons / press.newtons, 2);
    seen += std::pow(std::log(press.newtons / weight_n) - log_ratio, 2);
  }
  const auto count = static_cast<double>(presses.size());
  const double of_one = std::max(modelled / count, count > 1.0 ? seen / (count - 1.0) : 0.0);
  return std::max(std::sqrt(of_one / count), kLeastSigma);
}

void weigh(WeightFinding& finding) {
  if (finding.presses.empty()) return;
  double sum = 0.0;
  for (const WeighedPress& press : finding.presses) sum += std::log(press.newtons / finding.weight_n);
  const double log_ratio = sum / static_cast<double>(finding.presses.size());
  finding.ratio = std::exp(log_ratio);
  finding.sigma = sigma_of(finding.presses, log_ratio, finding.weight_n);
}

std::string readings(const std::vector<WeighedPress>& presses) {
  constexpr std::size_t kMostNamed = 8;
  std::string text;
  for (std::size_t k = 0; k < std::min(presses.size(), kMostNamed); ++k) {
    text += fmt::format("{}{:.3g}", k == 0 ? "" : ", ", presses[k].newtons);
  }
  return text + (presses.size() > kMostNamed ? ", ... N" : " N");
}

std::string missing(const WeightFinding& finding) {
  if (finding.others > 0) {
    const bool is_in_grams = is_near(finding.other_n / (kNewtonsPerGram * finding.weight_n));
    return fmt::format("no press reads between half and twice the weight; {} read something else, the last {:.3g} N{}",
                       finding.others, finding.other_n,
                       is_in_grams ? fmt::format("; if it weighs {0:g} grams, write '{0:g} g'", finding.weight_n) : "");
  }
  if (finding.unsteady > 0) return "no press lay still for a second: put the object down and let go of it";
  return "nothing was put on";
}

}  // namespace

double WeightFinding::limit() const noexcept {
  return std::max(kSigmas * sigma, kLeastChange);
}

bool WeightFinding::has_aged() const noexcept {
  return !presses.empty() && std::abs(std::log(ratio)) > limit();
}

bool WeightFinding::has_lost_cover() const noexcept {
  return !presses.empty() && narrowest_m < kNarrower * point_m;
}

std::string describe(const WeightFinding& finding) {
  if (finding.presses.empty()) return missing(finding);
  const std::size_t count = finding.presses.size();
  std::string text = fmt::format("weight  {:.4g} N, put on {}\n", finding.weight_n,
                                 count == 1 ? "once" : fmt::format("{} times", count));
  text += fmt::format("reads   {:.3g} N ({})\n", finding.ratio * finding.weight_n, readings(finding.presses));
  if (finding.others + finding.unsteady > 0) {
    text += fmt::format("besides {} of another weight, {} not steady\n", finding.others, finding.unsteady);
  }
  if (finding.has_changed_film()) return text + film_line(finding.film_factor);
  text += cover_line(finding);
  const double change = finding.ratio - 1.0;
  if (finding.has_aged()) {
    return text + fmt::format("recalibrate: gains have changed by about {:.0f} % (\u00b1 {:.0f} %): it reads {}\n",
                              100.0 * std::abs(change), std::max(100.0 * finding.sigma, 1.0),
                              change > 0.0 ? "too much" : "too little");
  }
  const bool has_told = finding.limit() <= kTooMuch;
  return text + fmt::format("{}: reads {:.1f} % {}, within {:.0f} %{}\n", has_told ? "well" : "no change seen",
                            100.0 * std::abs(change), change > 0.0 ? "high" : "low", 100.0 * finding.limit(),
                            has_told ? "" : ": put the object on again, in other places");
}

WeightCheck::WeightCheck(const touch::pipeline::Model& model, double weight_n)
    : tracker_(model.array, {}, model.strip) {
  assert(weight_n > 0.0);
  finding_.weight_n = weight_n;
  finding_.point_m = point_under(model.array);
  const ArrayDescription& array = model.array;
  if (array.readout.film && !array.cover) sheet_ = {array, conducting(model.networks.unloaded.offset_siemens)};
  middle_ = {0.5 * static_cast<double>(array.cols - 1) * array.col_pitch_m,
             0.5 * static_cast<double>(array.rows - 1) * array.row_pitch_m};
  room_ = {middle_.x - kReachOfPoint * finding_.point_m, middle_.y - kReachOfPoint * finding_.point_m};
}

template <typename Values>
void WeightCheck::Sums::add(const Values& frame) {
  values.resize(frame.size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] += frame[k];
  ++frames;
}

std::vector<double> WeightCheck::Sums::mean() const {
  std::vector<double> mean = values;
  for (double& value : mean) value /= static_cast<double>(frames);
  return mean;
}

void WeightCheck::add(const ForceFrame& force, std::span<const double> ratio) {
  if (has(force.status, FrameStatus::rejected)) return;
  tracker_.process(force, report_);
  const bool is_pressed = std::any_of(report_.contacts.begin(), report_.contacts.end(),
                                      [](const Contact& contact) { return contact.phase != ContactPhase::release; });
  if (is_pressed && !is_taken_off()) return hold(force, ratio);
  if (press_) count(*press_, finding_);
  rest(ratio);
}

/// A film that has changed may leave forces behind.
bool WeightCheck::is_taken_off() const {
  const bool was_there = !finding_.presses.empty() || (press_ && press_->steadiest);
  return sheet_ && was_there && report_.total_force_n < kLeft * finding_.weight_n;
}

void WeightCheck::rest(std::span<const double> ratio) {
  if (press_) idle_ = {};
  press_.reset();
  if (sheet_) idle_.add(ratio);
}

void WeightCheck::hold(const ForceFrame& force, std::span<const double> ratio) {
  const Nanos time = force.time;
  if (!press_) {
    press_ = Press{};
    press_->onset = time;
  }
  if (time - press_->onset < kOnset) return;
  std::optional<Piece>& piece = press_->piece;
  if (piece && time - piece->begin >= kPiece && piece->frames >= kLeastFrames) {
    close_piece(*press_);
    piece.reset();
  }
  if (!piece) {
    piece = Piece{};
    piece->begin = time;
  }
  ++piece->frames;
  piece->sum_n += report_.total_force_n;
  piece->sum_square += report_.total_force_n * report_.total_force_n;
  piece->sum_sigma_n += report_.sigma_total_n;
  piece->sum_width_m += width_m();
  if (!sheet_) return;
  piece->ratio.add(ratio);
  piece->newtons.add(force.newtons);
}

/// At the rim a cover loses some, and nothing can be said.
double WeightCheck::width_m() const {
  const auto strongest = std::max_element(report_.contacts.begin(), report_.contacts.end(),
                                          [](const Contact& a, const Contact& b) { return a.force_n < b.force_n; });
  const bool is_inside =
      std::abs(strongest->position.x - middle_.x) < room_.x && std::abs(strongest->position.y - middle_.y) < room_.y;
  return is_inside ? strongest->minor_axis_m : finding_.point_m;
}

void WeightCheck::close_piece(Press& press) const {
  const Piece& piece = *press.piece;
  const auto frames = static_cast<double>(piece.frames);
  const WeighedPress weighed{piece.sum_n / frames, piece.sum_sigma_n / frames};
  const double variance = std::max(piece.sum_square / frames - weighed.newtons * weighed.newtons, 0.0);
  const double deviation = std::sqrt(variance) / weighed.newtons;
  if (!std::isfinite(weighed.sigma_newtons) || !(deviation < kMostDeviation)) return;
  const double ratio = weighed.newtons / finding_.weight_n;
  const bool is_the_weight = is_near(ratio);
  if (!is_the_weight) press.other_n = weighed.newtons;
  if (!is_the_weight || (press.steadiest && deviation >= press.deviation)) return;
  press.steadiest = weighed;
  press.deviation = deviation;
  press.width_m = piece.sum_width_m / frames;
  if (idle_.frames < kLeastFrames) return;
  press.steadiest->readings = {piece.ratio.mean(), idle_.mean(), piece.newtons.mean()};
}

void WeightCheck::count(const Press& press, WeightFinding& finding) {
  if (press.steadiest) {
    const bool is_first = finding.presses.empty();
    finding.narrowest_m = is_first ? press.width_m : std::min(finding.narrowest_m, press.width_m);
    finding.presses.push_back(*press.steadiest);
  } else if (press.other_n) {
    ++finding.others;
    finding.other_n = *press.other_n;
  } else {
    ++finding.unsteady;
  }
}

WeightFinding WeightCheck::finding() const {
  WeightFinding finding = finding_;
  if (press_ && press_->steadiest) count(*press_, finding);
  weigh(finding);
  if (sheet_) finding.film_factor = film_change(sheet_->array, sheet_->idle_siemens, finding.weight_n, finding.presses);
  return finding;
}

}  // namespace dermis::learn::health
