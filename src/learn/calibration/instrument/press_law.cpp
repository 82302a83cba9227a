// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/instrument/press_law.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kLeastSingles = 20;  // to learn a law from
constexpr double kResolved = 5.0;          // a conductance over its noise
constexpr double kSigmasOfDeviation = 1.4826;
constexpr double kLeastScatter = 0.002;
constexpr double kReadable = 3.0;       // an unloaded conductance over its noise
constexpr int kOwnTerms = 4;            // level, exponent, bend, temperature
constexpr int kSharedTerms = 6;         // z, z^2, z^3, z^4, t, t z
constexpr double kOwnPrecision = 0.01;  // of an exponent about the common one: a tenth, beside a scatter of 1 %

/// Every taxel that is pressed, or may be.
bool may_be_pressed(float newtons) {
  return newtons != 0.0F;
}

/// Mean conductance of each taxel in the frames in which it is idle.
std::vector<double> unloaded_siemens(const std::vector<const CircuitFrame*>& frames, const InvertedFrames& inverted) {
  std::vector<double> sum(frames.front()->newtons.size());
  std::vector<double> count(sum.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::size_t taxel = 0; taxel < sum.size(); ++taxel) {
      if (may_be_pressed(frames[k]->newtons[taxel])) continue;
      sum[taxel] += inverted[k]->siemens[taxel];
      count[taxel] += 1.0;
    }
  }
  for (std::size_t taxel = 0; taxel < sum.size(); ++taxel) sum[taxel] /= std::max(count[taxel], 1.0);
  return sum;
}

bool are_all_there(const InvertedFrames& inverted) {
  return std::all_of(inverted.begin(), inverted.end(), [](const auto& frame) { return frame.has_value(); });
}

bool is_above_noise(std::size_t taxel, const std::vector<double>& unloaded, const InvertedFrames& inverted,
                    double sigmas) {
  return unloaded[taxel] > sigmas * inverted.front()->sigma_siemens[taxel];
}

/// No press can lower a taxel that conducts nothing, so an instrument that takes everything from idle taxels would be
/// right.
bool stay_readable(const std::vector<bool>& readable, const std::vector<double>& unloaded,
                   const InvertedFrames& inverted) {
  constexpr double kStillReadable = 1.0;
  constexpr double kMostLost = 0.1;
  double all = 0.0;
  double lost = 0.0;
  for (std::size_t taxel = 0; taxel < readable.size(); ++taxel) {
    if (!readable[taxel]) continue;
    all += 1.0;
    if (!is_above_noise(taxel, unloaded, inverted, kStillReadable)) lost += 1.0;
  }
  return lost <= kMostLost * all;
}

/// The evidence of a frame on one of its taxels.
struct LawPoint {
  double z = 0.0;      // ln of the conductance above the unloaded one
  double sigma = 0.0;  // of z, by the noise of readings
  double t = 0.0;      // temperature
};

using OwnBasis = Eigen::Vector<double, kOwnTerms>;
using SharedBasis = Eigen::Vector<double, kSharedTerms>;

SharedBasis shared_basis(const LawPoint& point) {
  const double z = point.z;
  return SharedBasis{z, z * z, z * z * z, z * z * z * z, point.t, point.t * z};
}

OwnBasis own_basis(const LawPoint& point) {
  return {1.0, point.z, point.z * point.z, point.t};
}

/// ln F of each taxel by z.
class PressLaws {
 public:
  explicit PressLaws(std::size_t taxels) : taxels_(taxels) {}

  /// Least squares with the taxels' own terms eliminated. `taxels`, `log_force`: of each point.
  void fit(const std::vector<LawPoint>& points, const std::vector<std::size_t>& taxels,
           const std::vector<double>& log_force) {
    SharedMatrix normal = SharedMatrix::Identity() * 1e-6;
    SharedBasis right = SharedBasis::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const SharedBasis common = shared_basis(points[k]);
      taxels_[taxels[k]].add(own_basis(points[k]), common, log_force[k]);
      normal += common * common.transpose();
      right += common * log_force[k];
    }
    for (OwnLaw& taxel : taxels_) {
      taxel.factors.compute(taxel.normal);
      normal -= taxel.between.transpose() * taxel.factors.solve(taxel.between);
      right -= taxel.between.transpose() * taxel.factors.solve(taxel.right);
    }
    factors_.compute(normal);
    common_ = factors_.solve(right);
    for (OwnLaw& taxel : taxels_) taxel.terms = taxel.factors.solve(taxel.right - taxel.between * common_);
  }

  [[nodiscard]] double log_force(std::size_t taxel, const LawPoint& point) const {
    return taxels_[taxel].terms.dot(own_basis(point)) + common_.dot(shared_basis(point));
  }
  /// d ln F / d z.
  [[nodiscard]] double slope(std::size_t taxel, const LawPoint& point) const {
    constexpr double kStep = 1e-4;
    LawPoint moved = point;
    moved.z += kStep;
    return (log_force(taxel, moved) - log_force(taxel, point)) / kStep;
  }
  /// Variance of the law at a point, over that of a press: the leverage of a press that was learned from.
  [[nodiscard]] double variance(std::size_t taxel, const LawPoint& point) const {
    const OwnLaw& law = taxels_[taxel];
    const OwnBasis own = own_basis(point);
    const OwnBasis answer = law.factors.solve(own);
    const SharedBasis shared = shared_basis(point) - law.between.transpose() * answer;
    return own.dot(answer) + shared.dot(factors_.solve(shared));
  }

 private:
  using SharedMatrix = Eigen::Matrix<double, kSharedTerms, kSharedTerms>;
  using OwnMatrix = Eigen::Matrix<double, kOwnTerms, kOwnTerms>;

  struct OwnLaw {
    OwnMatrix normal = OwnBasis(1e-9, kOwnPrecision, kOwnPrecision, kOwnPrecision).asDiagonal();
    Eigen::Matrix<double, kOwnTerms, kSharedTerms> between = Eigen::Matrix<double, kOwnTerms, kSharedTerms>::Zero();
    OwnBasis right = OwnBasis::Zero();
    Eigen::LLT<OwnMatrix> factors;
    OwnBasis terms = OwnBasis::Zero();

    void add(const OwnBasis& basis, const SharedBasis& common, double value) {
      normal += basis * basis.transpose();
      between += basis * common.transpose();
      right += basis * value;
    }
  };

  std::vector<OwnLaw> taxels_;
  Eigen::LDLT<SharedMatrix> factors_;
  SharedBasis common_ = SharedBasis::Zero();
};

/// Conductances on a scale on which the powers of z stay small.
class Scale {
 public:
  Scale(const Presses& presses, const InvertedFrames& inverted, const std::vector<double>& unloaded) {
    std::vector<double> logs;
    for (std::size_t k = 0; k < presses.single.size(); ++k) {
      const std::size_t taxel = presses.single[k].taxels.front();
      const double excess = inverted[k]->siemens[taxel] - unloaded[taxel];
      if (excess > kResolved * inverted[k]->sigma_siemens[taxel]) logs.push_back(std::log(excess));
    }
    if (logs.size() < kLeastSingles) return;
    const double low = quantile(logs, 0.02);
    const double high = quantile(logs, 0.98);
    centre_ = 0.5 * (low + high);
    half_span_ = std::max(0.5 * (high - low), 0.1);
    is_there_ = true;
  }

  [[nodiscard]] bool is_there() const { return is_there_; }

  [[nodiscard]] std::optional<LawPoint> point(const CircuitFrame& frame, const InvertedFrame& inverted,
                                              std::size_t taxel, double unloaded, double least_sigmas) const {
    constexpr double kBeyond = 1.2;  // laws are not continued
    const double excess = inverted.siemens[taxel] - unloaded;
    const double sigma = inverted.sigma_siemens[taxel];
    if (!(excess > least_sigmas * sigma)) return std::nullopt;
    const double z = (std::log(excess) - centre_) / half_span_;
    if (z < -kBeyond) return std::nullopt;
    const double beyond = std::max(z - kBeyond, 0.0);
    return LawPoint{z - beyond, std::hypot(sigma / excess / half_span_, beyond), frame.temperature};
  }

 private:
  double centre_ = 0.0;
  double half_span_ = 1.0;
  bool is_there_ = false;
};

struct LearnedLaws {
  PressLaws laws;
  double scatter = 0.0;  // of a single press about its law
};

/// The scatter of a single press, by the median. A law follows each press by its leverage.
double scatter_about(const PressLaws& laws, const std::vector<LawPoint>& points, const std::vector<std::size_t>& taxels,
                     const std::vector<double>& log_forces) {
  constexpr double kLeastFreedom = 0.05;  // of a press
  std::vector<double> deviations;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double freedom = std::max(1.0 - laws.variance(taxels[k], points[k]), kLeastFreedom);
    deviations.push_back(std::abs(log_forces[k] - laws.log_force(taxels[k], points[k])) / std::sqrt(freedom));
  }
  return kSigmasOfDeviation * quantile(deviations, 0.5);
}

/// Empty: too few presses that are evidence.
std::optional<LearnedLaws> learn_laws(const Presses& presses, const InvertedFrames& inverted,
                                      const std::vector<double>& unloaded, const Scale& scale) {
  if (!scale.is_there()) return std::nullopt;
  std::vector<LawPoint> points;
  std::vector<std::size_t> taxels;
  std::vector<double> log_forces;
  for (std::size_t k = 0; k < presses.single.size(); ++k) {
    const Press& press = presses.single[k];
    const std::size_t taxel = press.taxels.front();
    const auto point = scale.point(*press.frame, *inverted[k], taxel, unloaded[taxel], kResolved);
    if (!point) continue;
    points.push_back(*point);
    taxels.push_back(taxel);
    log_forces.push_back(std::log(press.newtons));
  }
  if (points.size() < kLeastSingles) return std::nullopt;
  LearnedLaws learned{PressLaws(unloaded.size())};
  learned.laws.fit(points, taxels, log_forces);
  learned.scatter = std::max(kLeastScatter, scatter_about(learned.laws, points, taxels, log_forces));
  return learned;
}

void add_total(const Press& press, const InvertedFrame& inverted, const std::vector<double>& unloaded,
               const Scale& scale, const LearnedLaws& learned, InstrumentMisfit& misfit) {
  double total = 0.0;
  double variance = 0.0;
  for (const std::size_t taxel : press.taxels) {
    const auto point = scale.point(*press.frame, inverted, taxel, unloaded[taxel], 0.0);
    if (!point) continue;
    const double force = std::exp(learned.laws.log_force(taxel, *point));
    const double of_law = learned.scatter * learned.scatter * (1.0 + learned.laws.variance(taxel, *point));
    total += force;
    variance += force * force * (of_law + std::pow(learned.laws.slope(taxel, *point) * point->sigma, 2));
  }
  misfit.totals.push_back(total > 0.0 ? std::log(total / press.newtons) : -1.0);
  misfit.sigmas.push_back(total > 0.0 ? std::sqrt(variance) / total : 1.0);
}

/// A mean of what taxels conduct too much, over their noise.
struct IdleMean {
  double sum = 0.0;
  double weight = 0.0;

  void add(double excess, double sigma) {
    if (!(sigma > 0.0) || !std::isfinite(sigma)) return;
    sum += excess / (sigma * sigma);
    weight += 1.0 / (sigma * sigma);
  }
  [[nodiscard]] double mean() const { return weight > 0.0 ? sum / weight : 0.0; }
  [[nodiscard]] double variance() const { return weight > 0.0 ? 1.0 / weight : 0.0; }
};

void add_idle(const Press& press, const InvertedFrame& inverted, const std::vector<double>& unloaded, std::size_t cols,
              const std::vector<bool>& readable, InstrumentMisfit& misfit) {
  const std::size_t pressed = press.taxels.front();
  IdleMean row;
  IdleMean column;
  IdleMean elsewhere;
  for (std::size_t taxel = 0; taxel < unloaded.size(); ++taxel) {
    if (press.frame->newtons[taxel] != 0.0F || !readable[taxel]) continue;
    const bool is_in_row = taxel / cols == pressed / cols;
    IdleMean& mean = is_in_row ? row : taxel % cols == pressed % cols ? column : elsewhere;
    mean.add(inverted.siemens[taxel] - unloaded[taxel], inverted.sigma_siemens[taxel]);
  }
  for (const IdleMean& line : {row, column}) {
    const bool is_known = line.weight > 0.0 && elsewhere.weight > 0.0;
    misfit.idle.push_back(
        is_known ? (line.mean() - elsewhere.mean()) / std::sqrt(line.variance() + elsewhere.variance()) : 0.0);
  }
}

}  // namespace

std::vector<bool> readable_taxels(const Presses& presses, const InvertedFrames& inverted) {
  if (presses.single.empty() || !are_all_there(inverted)) return {};
  const std::vector<double> unloaded = unloaded_siemens(frames_of(presses), inverted);
  std::vector<bool> readable(unloaded.size());
  for (std::size_t taxel = 0; taxel < unloaded.size(); ++taxel) {
    readable[taxel] = is_above_noise(taxel, unloaded, inverted, kReadable);
  }
  return readable;
}

std::optional<InstrumentMisfit> misfit_of(const Presses& presses, const InvertedFrames& inverted, std::size_t cols,
                                          const std::vector<bool>& readable) {
  const std::vector<const CircuitFrame*> frames = frames_of(presses);
  if (presses.single.size() < kLeastSingles || !are_all_there(inverted)) return std::nullopt;
  const std::vector<double> unloaded = unloaded_siemens(frames, inverted);
  if (!stay_readable(readable, unloaded, inverted)) return std::nullopt;
  InstrumentMisfit misfit;
  for (std::size_t k = 0; k < presses.single.size(); ++k) {
    add_idle(presses.single[k], *inverted[k], unloaded, cols, readable, misfit);
  }
  const Scale scale(presses, inverted, unloaded);
  const std::optional<LearnedLaws> learned = learn_laws(presses, inverted, unloaded, scale);
  if (!learned) return std::nullopt;
  for (std::size_t k = 0; k < presses.several.size(); ++k) {
    add_total(presses.several[k], *inverted[presses.single.size() + k], unloaded, scale, *learned, misfit);
  }
  const std::vector<double> of_idle = sigmas_of_idle(misfit.idle);
  misfit.sigmas.insert(misfit.sigmas.end(), of_idle.begin(), of_idle.end());
  return misfit;
}

std::vector<double> sigmas_of_idle(std::span<const double> idle) {
  constexpr std::size_t kKinds = 2;  // rows, columns
  std::vector<double> sigmas(idle.size());
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    std::vector<double> values;
    for (std::size_t k = kind; k < idle.size(); k += kKinds) values.push_back(idle[k]);
    const double middle = quantile(values, 0.5);
    for (double& value : values) value = std::abs(value - middle);
    const double sigma = std::max(1.0, kSigmasOfDeviation * quantile(values, 0.5));
    for (std::size_t k = kind; k < idle.size(); k += kKinds) sigmas[k] = sigma;
  }
  return sigmas;
}

}  // namespace dermis::learn::calibration
