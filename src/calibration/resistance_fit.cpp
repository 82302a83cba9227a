// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/resistance_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "dermis/compensation/crosstalk.hpp"
#include "dermis/core/parallel.hpp"
#include "dermis/core/random.hpp"

namespace dermis::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kFramesPerTask = 256;
constexpr int kMaxIterations = 8;
constexpr std::size_t kFirstFrames = 1500;  // the way to the solution is found with these
constexpr double kMostWork = 2e8;           // frames x taxels x inversions of one pass
constexpr double kNewtonSlowness = 100.0;   // of an inversion by Newton's method, against the fixed point
constexpr std::uint64_t kSelectionSeed = 1;
constexpr double kEnoughAtFirst = 0.1;     // a step this small against the standard errors ends the fit
constexpr double kEnough = 0.25;           // the same, with all frames
constexpr double kSlopeStep = 1e-3;        // of a parameter, for the derivatives of the inversion
constexpr double kTolerance = 1e-12;       // of the inversions, in readings over the supply
constexpr double kLeastIdleSigmas = 3.0;   // an idle reading below this is cut at 0 too often
constexpr double kLeastPressSigmas = 5.0;  // and a pressed one is not to be taken the logarithm of
constexpr double kLineSpread = 0.1;        // resistances of one kind are alike: a pseudo-observation of their spread
constexpr double kSheetSpread = 0.03;      // and of the spread of the rubber from line to line
constexpr double kShapeSpread = 0.1;       // first guess of the scatter of the laws' shapes over the taxels
constexpr double kLeastShapeSpread = 1e-4;
constexpr double kRubberScatter = 0.01;  // first guess
constexpr double kLeastRubberScatter = 1e-4;
constexpr double kMostRubberScatter = 1.0;
constexpr Index kFreeTerms = 3;    // of a pressed law: level, exponent, temperature
constexpr Index kShapeTerms = 4;   // x^2, x^3, t^2, t x: alike in all taxels of a piece of rubber
constexpr Index kCommonTerms = 7;  // x^4, x^5, x^6, t x^2, t x^3, t^2 x, a resistance in series: the same in all
constexpr Index kSheetTerms = kShapeTerms + kCommonTerms;
constexpr std::array kCommonRatios = {0.003, 0.01, 0.03, 0.1, 0.3, 1.0};  // drivers to loads, tried at the start

double geometric_mean(const std::vector<double>& ohms) {
  double sum = 0.0;
  double count = 0.0;
  for (const double ohm : ohms) {
    if (std::isnan(ohm) || ohm <= 0.0) continue;
    sum += std::log(ohm);
    count += 1.0;
  }
  return count > 0.0 ? std::exp(sum / count) : 0.0;
}

/// The parameters of the fit: drivers as a multiple of a reference resistance, so that 0 ohm is a value like any other;
/// loads as logarithms.
class LineParameters {
 public:
  explicit LineParameters(const ArrayDescription& array) : array_(array) {
    if (array.readout.circuit == Circuit::none) return;
    for (std::size_t k = 0; k < array.readout.drive_ohm.size(); ++k) {
      if (std::isnan(array.readout.drive_ohm[k])) drives_.push_back(k);
    }
    for (std::size_t k = 0; k < array.readout.load_ohm.size(); ++k) {
      if (std::isnan(array.readout.load_ohm[k])) loads_.push_back(k);
    }
    known_drive_ohm_ = geometric_mean(array.readout.drive_ohm);
    known_load_ohm_ = geometric_mean(array.readout.load_ohm);
    reference_ohm_ = known_load_ohm_ > 0.0 ? known_load_ohm_ : kNominalLoadOhm;
  }

  [[nodiscard]] Index count() const { return static_cast<Index>(drives_.size() + loads_.size()); }
  [[nodiscard]] const std::vector<std::size_t>& drives() const { return drives_; }
  [[nodiscard]] const std::vector<std::size_t>& loads() const { return loads_; }
  [[nodiscard]] bool has_absolute() const { return known_drive_ohm_ > 0.0 || known_load_ohm_ > 0.0; }
  [[nodiscard]] double reference_ohm() const { return reference_ohm_; }
  [[nodiscard]] bool is_drive(Index p) const { return p < static_cast<Index>(drives_.size()); }

  /// All drivers, or all loads, in the same ratio to each other.
  [[nodiscard]] VectorXd start(double common_ratio) const {
    double load_ohm = reference_ohm_;
    if (known_load_ohm_ == 0.0 && known_drive_ohm_ > 0.0) load_ohm = known_drive_ohm_ / common_ratio;
    const double drive_ohm = known_drive_ohm_ > 0.0 ? known_drive_ohm_ : common_ratio * load_ohm;
    VectorXd parameters(count());
    for (Index p = 0; p < count(); ++p) {
      parameters[p] = is_drive(p) ? drive_ohm / reference_ohm_ : std::log(load_ohm / reference_ohm_);
    }
    return parameters;
  }

  [[nodiscard]] ArrayDescription array_at(const VectorXd& parameters) const {
    ArrayDescription array = array_;
    Index p = 0;
    for (const std::size_t line : drives_) array.readout.drive_ohm[line] = parameters[p++] * reference_ohm_;
    for (const std::size_t line : loads_) array.readout.load_ohm[line] = std::exp(parameters[p++]) * reference_ohm_;
    return array;
  }

 private:
  ArrayDescription array_;
  std::vector<std::size_t> drives_;
  std::vector<std::size_t> loads_;
  double known_drive_ohm_ = 0.0;
  double known_load_ohm_ = 0.0;
  double reference_ohm_ = kNominalLoadOhm;
};

/// A least-squares problem sum |y + D step - B law|^2 in which the laws of the taxels are eliminated. E = [D, y].
struct NormalEquations {
  MatrixXd global;              // E^T E
  std::vector<MatrixXd> local;  // of every taxel: B^T [B, E]
  std::vector<double> readings;

  NormalEquations(std::size_t taxels, Index law_terms, Index columns)
      : global(MatrixXd::Zero(columns, columns)),
        local(taxels, MatrixXd::Zero(law_terms, law_terms + columns)),
        readings(taxels) {}

  /// `row`: E; the global part is the caller's, who has many rows at once.
  template <typename Row>
  void add_local(std::size_t taxel, const VectorXd& basis, const Row& row, double weight) {
    MatrixXd& sums = local[taxel];
    const Index terms = basis.size();
    for (Index k = 0; k < terms; ++k) {
      const double weighted = weight * basis[k];
      for (Index j = 0; j < terms; ++j) sums(j, k) += weighted * basis[j];
    }
    for (Index k = 0; k < row.size(); ++k) {
      const double weighted = weight * row[k];
      for (Index j = 0; j < terms; ++j) sums(j, terms + k) += weighted * basis[j];
    }
    readings[taxel] += 1.0;
  }

  NormalEquations& operator+=(const NormalEquations& other) {
    global += other.global;
    for (std::size_t k = 0; k < local.size(); ++k) {
      local[k] += other.local[k];
      readings[k] += other.readings[k];
    }
    return *this;
  }
};

/// The laws that minimise, as linear functions of the step: law = [law_slope, law] (step, 1).
struct Elimination {
  MatrixXd normal;                   // of E, laws eliminated; its last row and column hold the gradient and the cost
  std::vector<MatrixXd> laws;        // of every taxel [terms, columns]
  std::vector<MatrixXd> covariance;  // of every law at a fixed step [terms, terms]
  double readings = 0.0;
  double taxels = 0.0;
};

Elimination eliminate_laws(const NormalEquations& equations, const VectorXd& prior_precision) {
  Elimination result;
  result.normal = equations.global.selfadjointView<Eigen::Lower>();
  const Index terms = prior_precision.size();
  const Index columns = result.normal.cols();
  result.laws.resize(equations.local.size());
  result.covariance.resize(equations.local.size());
  for (std::size_t taxel = 0; taxel < equations.local.size(); ++taxel) {
    if (equations.readings[taxel] == 0.0) continue;
    const MatrixXd& local = equations.local[taxel];
    MatrixXd own = local.leftCols(terms);
    own.diagonal() += prior_precision;
    const Eigen::LDLT<MatrixXd> factors(own);
    result.laws[taxel] = factors.solve(local.rightCols(columns));
    result.covariance[taxel] = factors.solve(MatrixXd::Identity(terms, terms));
    result.normal.noalias() -= local.rightCols(columns).transpose() * result.laws[taxel];
    result.readings += equations.readings[taxel];
    result.taxels += 1.0;
  }
  return result;
}

/// A pressed taxel of one frame.
struct Pressed {
  std::size_t taxel = 0;
  double log_force = 0.0;  // scaled
  double temperature = 0.0;
  double siemens = 0.0;
  double sigma_siemens = 0.0;
  VectorXd slope;  // d siemens / d parameter
};

ForceScale force_scale(const CircuitFrames& frames) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const CircuitFrame& frame : frames.frames) {
    for (const float newtons : frame.newtons) {
      if (!(newtons > 0.0F)) continue;
      lowest = std::min(lowest, std::log(static_cast<double>(newtons)));
      highest = std::max(highest, std::log(static_cast<double>(newtons)));
    }
  }
  if (!(highest > lowest)) return {std::isfinite(lowest) ? lowest : 0.0, 1.0};
  return {0.5 * (lowest + highest), 0.5 * (highest - lowest)};
}

VectorXd unloaded_basis(double temperature, bool has_temperature) {
  if (!has_temperature) return VectorXd::Ones(1);
  return Eigen::Vector3d(1.0, temperature, temperature * temperature);
}

VectorXd pressed_basis(double x, double t) {
  VectorXd basis(kFreeTerms + kShapeTerms);
  basis << 1.0, x, t, x * x, x * x * x, t * t, t * x;
  return basis;
}

/// Inversions of one circuit at the parameters and a little beside each of them.
class SlopedInversion {
 public:
  static Result<SlopedInversion> create(const LineParameters& lines, const VectorXd& parameters, bool with_slopes) {
    SlopedInversion result;
    const Index count = with_slopes ? parameters.size() : 0;
    for (Index p = -1; p < count; ++p) {
      VectorXd shifted = parameters;
      if (p >= 0) shifted[p] += kSlopeStep;
      auto inversion = compensation::make_crosstalk_inversion(lines.array_at(shifted), {.tolerance_ratio = kTolerance});
      if (!inversion) return inversion.error();
      result.inversions_.push_back(std::move(*inversion));
    }
    return result;
  }

  void forget() {
    for (const auto& inversion : inversions_) inversion->forget();
  }

  [[nodiscard]] Index slope_count() const { return static_cast<Index>(inversions_.size()) - 1; }

  /// false: the circuit cannot give these readings.
  bool invert(const std::vector<double>& ratio, std::vector<double>& siemens) {
    return inversions_[0]->invert(ratio, siemens).solved;
  }

  /// Of the frame inverted last.
  void propagate_noise(double sigma_ratio, std::vector<double>& sigma) {
    inversions_[0]->propagate_noise(sigma_ratio, sigma);
  }

  /// d siemens / d parameter [taxels, parameters] at readings whose inversion is `siemens`.
  bool differentiate(const std::vector<double>& ratio, const std::vector<double>& siemens, MatrixXd& slopes) {
    shifted_.resize(ratio.size());
    for (Index p = 0; p < slopes.cols(); ++p) {
      if (!inversions_[static_cast<std::size_t>(p) + 1]->invert(ratio, shifted_).solved) return false;
      for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
        slopes(static_cast<Index>(taxel), p) = (shifted_[taxel] - siemens[taxel]) / kSlopeStep;
      }
    }
    return true;
  }

 private:
  std::vector<std::unique_ptr<compensation::CrosstalkInversion>> inversions_;
  std::vector<double> shifted_;
};

/// What one pass over the frames gives.
struct Pass {
  NormalEquations idle;
  std::vector<Pressed> pressed;
  std::size_t unsolved = 0;
};

/// What all taxels of a piece of rubber have in common. A contact resistance in series with each cannot be told from
/// the mean of the drivers by the laws: without its column the fit would take a law that is not quite a cubic for it.
VectorXd common_basis(double x, double t, double excess) {
  VectorXd basis(kCommonTerms);
  basis << std::pow(x, 4), std::pow(x, 5), std::pow(x, 6), t * x * x, t * x * x * x, t * t * x, -excess;
  return basis;
}

class ResistanceFitter {
 public:
  ResistanceFitter(const ArrayDescription& array, const CircuitFrames& frames)
      : array_(array),
        frames_(frames),
        lines_(array),
        scale_(force_scale(frames)),
        taxels_(array.taxel_count()),
        reference_siemens_(1.0 / lines_.reference_ohm()),
        unloaded_terms_(unloaded_basis(0.0, frames.has_temperature).size()),
        sheet_mean_(VectorXd::Zero(kSheetTerms)),
        shape_variance_(VectorXd::Constant(kShapeTerms, kShapeSpread * kShapeSpread)) {}

  Result<ResistanceFit> run() {
    if (Status started = choose_start(); !started) return started.error();
    if (Status first = iterate_until(kEnoughAtFirst); !first) return first.error();
    if (most_frames() > chosen_.size() && chosen_.size() < frames_.frames.size()) {
      choose_frames(most_frames());
      if (Status last = iterate_until(kEnough); !last) return last.error();
    }
    return report();
  }

  /// Frames that a fit has not seen, against its laws.
  std::vector<double> judge(const ResistanceFit& fit, double cut) {
    scale_ = fit.force_scale;
    reference_siemens_ = fit.reference_siemens;
    laws_ = fit.laws;
    sheet_mean_ = fit.common;
    rubber_variance_ = kRubberScatter * kRubberScatter;  // the same for all circuits
    std::vector<double> squares(frames_.frames.size(), cut);
    parallel_for((squares.size() + kFramesPerTask - 1) / kFramesPerTask, [&](std::size_t task) {
      auto inversion = SlopedInversion::create(lines_, VectorXd(0), false);
      if (!inversion) return;
      const std::size_t end = std::min(squares.size(), (task + 1) * kFramesPerTask);
      for (std::size_t k = task * kFramesPerTask; k < end; ++k) squares[k] = judge_frame(*inversion, k, cut);
    });
    return squares;
  }

 private:
  double judge_frame(SlopedInversion& inversion, std::size_t k, double cut) const {
    const CircuitFrame& frame = frames_.frames[k];
    std::vector<double> siemens(taxels_);
    std::vector<double> sigma(taxels_);
    if (!inversion.invert(frame.ratio, siemens)) {
      inversion.forget();
      return cut;
    }
    inversion.propagate_noise(frame.sigma_ratio, sigma);
    const VectorXd basis = unloaded_basis(frame.temperature, frames_.has_temperature);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      const auto newtons = static_cast<double>(frame.newtons[taxel]);
      double square = 0.0;
      if (newtons == 0.0 && laws_[taxel].unloaded.size() > 0) {
        const double expected = laws_[taxel].unloaded.dot(basis) * reference_siemens_;
        square = std::pow((siemens[taxel] - expected) / sigma[taxel], 2);
      } else if (newtons > 0.0 && laws_[taxel].pressed.size() > 0) {
        const PressedPoint point = pressed_point({taxel,
                                                  (std::log(newtons) - scale_.centre) / scale_.half_span,
                                                  frame.temperature,
                                                  siemens[taxel],
                                                  sigma[taxel],
                                                  {}});
        square = point.usable ? point.residual * point.residual / (point.relative_variance + rubber_variance_) : cut;
      } else {
        continue;
      }
      sum += square < cut ? square : cut;
      count += 1.0;
    }
    return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  }

  Status iterate_until(double enough) {
    for (int k = 0; k < kMaxIterations; ++k) {
      const Result<double> step = iterate();
      if (!step) return step.error();
      if (k > 0 && *step < enough) break;
    }
    return Done{};
  }

  /// The common ratio of drivers to loads that leaves least; also the first unloaded laws.
  Status choose_start() {
    choose_frames(std::min(kFirstFrames, most_frames()));
    double best = std::numeric_limits<double>::infinity();
    VectorXd best_parameters;
    for (const double ratio : kCommonRatios) {
      parameters_ = lines_.start(ratio);
      laws_.assign(taxels_, {});
      Result<Pass> pass = pass_over_frames(false);
      if (!pass) return pass.error();
      if (2 * pass->unsolved > chosen_.size()) continue;
      const double cost = cost_of(*pass);
      if (cost < best) {
        best = cost;
        best_parameters = parameters_;
      }
      if (lines_.count() == 0) break;
    }
    if (!std::isfinite(best)) {
      return bad_input("readout: no resistances explain the calibration frames in this circuit; check its kind");
    }
    parameters_ = best_parameters;
    laws_.assign(taxels_, {});
    Result<Pass> pass = pass_over_frames(false);
    if (!pass) return pass.error();
    cost_of(*pass);  // the laws at the start
    return Done{};
  }

  /// Takes about this many frames of all, spread at random: neighbours in time may press the same taxels.
  void choose_frames(std::size_t most) {
    chosen_.clear();
    const double share = static_cast<double>(most) / static_cast<double>(frames_.frames.size());
    for (std::size_t k = 0; k < frames_.frames.size(); ++k) {
      if (share >= 1.0 || Random::stream(kSelectionSeed, k).uniform() < share) chosen_.push_back(k);
    }
  }

  /// As many as the time allows: an inversion for each parameter and frame.
  [[nodiscard]] std::size_t most_frames() const {
    const auto cost = static_cast<double>(taxels_ * static_cast<std::size_t>(lines_.count() + 4));
    const bool is_slow = array_.readout.circuit == Circuit::divider && array_.readout.idle_rows == IdleRows::floating;
    return static_cast<std::size_t>(kMostWork / cost / (is_slow ? kNewtonSlowness : 1.0));
  }

  /// The laws at the parameters, and what they leave, in standard deviations of the readings a frame.
  double cost_of(const Pass& pass) {
    const Elimination idle = eliminate_laws(pass.idle, unloaded_prior());
    set_unloaded_laws(idle);
    const Elimination pressed = eliminate_laws(pressed_equations(pass.pressed, idle), pressed_prior());
    return idle.normal(idle.normal.rows() - 1, idle.normal.cols() - 1) +
           pressed.normal(pressed.normal.rows() - 1, pressed.normal.cols() - 1);
  }

  Result<double> iterate() {
    Result<Pass> pass = pass_over_frames(true);
    if (!pass) return pass.error();
    unsolved_ = pass->unsolved;
    const Elimination idle = eliminate_laws(pass->idle, unloaded_prior());
    set_unloaded_laws(idle);
    const Elimination pressed = eliminate_laws(pressed_equations(pass->pressed, idle), pressed_prior());

    const Index lines = lines_.count();
    const Index unknowns = lines + kSheetTerms;
    MatrixXd normal = pressed.normal;
    add_idle(idle, normal);
    for (Index s = lines; s < unknowns; ++s) normal(s, s) += 1.0;  // shapes of the order of 1 at most
    add_sheet(idle, normal);
    add_line_priors(normal);
    pin_scale(normal);
    const Eigen::LDLT<MatrixXd> factors(normal.topLeftCorner(unknowns, unknowns));
    const VectorXd solution = -factors.solve(normal.col(unknowns).head(unknowns));
    covariance_ = factors.solve(MatrixXd::Identity(unknowns, unknowns));

    idle_readings_ = idle.readings;
    pressed_readings_ = pressed.readings;
    const double share = take_step(solution.head(lines));
    sheet_mean_ = solution.tail(kSheetTerms);
    set_pressed_laws(pressed, solution);
    learn_variances(idle, pressed, solution, pass->pressed);
    return share;
  }

  /// Moves the parameters, and tells the largest step in standard errors.
  double take_step(const VectorXd& step) {
    double largest = 0.0;
    for (Index p = 0; p < step.size(); ++p) {
      largest = std::max(largest, std::abs(step[p]) / std::sqrt(covariance_(p, p)));
      if (lines_.is_drive(p)) {
        constexpr double kLeastReach = 0.02;
        const double reach = std::max(0.7 * parameters_[p], kLeastReach);
        parameters_[p] = std::max(0.0, parameters_[p] + std::clamp(step[p], -reach, reach));
      } else {
        parameters_[p] += std::clamp(step[p], -0.7, 0.7);
      }
    }
    return largest;
  }

  Result<Pass> pass_over_frames(bool with_slopes) {
    const Index columns = (with_slopes ? lines_.count() : 0) + 1;
    const std::size_t count = chosen_.size();
    const std::size_t tasks = (count + kFramesPerTask - 1) / kFramesPerTask;
    if (auto trial = SlopedInversion::create(lines_, parameters_, false); !trial) return trial.error();
    std::vector<Pass> passes(tasks, Pass{NormalEquations(taxels_, unloaded_terms_, columns), {}, 0});
    parallel_for(tasks, [&](std::size_t task) {
      auto inversion = SlopedInversion::create(lines_, parameters_, with_slopes);
      std::vector<double> siemens;
      std::vector<double> sigma;
      MatrixXd slopes;
      MatrixXd rows;
      for (std::size_t k = task * kFramesPerTask; k < std::min(count, (task + 1) * kFramesPerTask); ++k) {
        const CircuitFrame& frame = frames_.frames[chosen_[k]];
        if (!solve_frame(*inversion, frame, siemens, sigma, slopes)) {
          ++passes[task].unsolved;
          inversion->forget();
          continue;
        }
        take_frame(frame, siemens, sigma, slopes, rows, passes[task]);
      }
    });
    Pass all = std::move(passes.front());
    for (std::size_t task = 1; task < tasks; ++task) {
      all.idle += passes[task].idle;
      all.unsolved += passes[task].unsolved;
      std::move(passes[task].pressed.begin(), passes[task].pressed.end(), std::back_inserter(all.pressed));
    }
    return all;
  }

  bool solve_frame(SlopedInversion& inversion, const CircuitFrame& frame, std::vector<double>& siemens,
                   std::vector<double>& sigma, MatrixXd& slopes) const {
    siemens.resize(taxels_);
    sigma.resize(taxels_);
    if (!inversion.invert(frame.ratio, siemens)) return false;
    inversion.propagate_noise(frame.sigma_ratio, sigma);
    slopes.resize(static_cast<Index>(taxels_), inversion.slope_count());
    if (slopes.cols() == 0) return true;
    CircuitFrame smooth = frame;
    std::vector<double> smooth_siemens = siemens;
    if (!remove_idle_noise(inversion, smooth, smooth_siemens, sigma)) return false;
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      if (frame.newtons[taxel] != 0.0F) siemens[taxel] = smooth_siemens[taxel];
    }
    return inversion.differentiate(smooth.ratio, smooth_siemens, slopes);
  }

  /// Idle readings tell something only where they are well above 0, where noise is cut.
  [[nodiscard]] bool is_readable(std::size_t taxel, double temperature, double sigma) const {
    const VectorXd& law = laws_[taxel].unloaded;
    if (law.size() == 0) return true;  // not known yet
    return law.dot(unloaded_basis(temperature, frames_.has_temperature)) * reference_siemens() >=
           kLeastIdleSigmas * sigma;
  }

  [[nodiscard]] double reference_siemens() const { return reference_siemens_; }

  /// The readings that the circuit would give with the idle taxels at their laws. Derivatives taken at noisy readings
  /// would follow the noise, and the fit would do away with the noise by making all conductances small.
  bool remove_idle_noise(SlopedInversion& inversion, CircuitFrame& frame, std::vector<double>& siemens,
                         const std::vector<double>& sigma) const {
    constexpr int kMaxSteps = 10;
    constexpr double kEnoughSigmas = 0.02;
    const VectorXd basis = unloaded_basis(frame.temperature, frames_.has_temperature);
    for (int k = 0; k < kMaxSteps; ++k) {
      double largest = 0.0;
      for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
        const VectorXd& law = laws_[taxel].unloaded;
        if (frame.newtons[taxel] != 0.0F || law.size() == 0) continue;
        const double sigmas = (siemens[taxel] - law.dot(basis) * reference_siemens()) / sigma[taxel];
        frame.ratio[taxel] -= sigmas * frame.sigma_ratio;
        largest = std::max(largest, std::abs(sigmas));
      }
      if (!inversion.invert(frame.ratio, siemens)) return false;
      if (largest < kEnoughSigmas) return true;
    }
    return true;
  }

  void take_frame(const CircuitFrame& frame, const std::vector<double>& siemens, const std::vector<double>& sigma,
                  const MatrixXd& slopes, MatrixXd& rows, Pass& pass) const {
    const VectorXd basis = unloaded_basis(frame.temperature, frames_.has_temperature);
    rows.resize(slopes.cols() + 1, slopes.rows());
    Index used = 0;
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      const auto newtons = static_cast<double>(frame.newtons[taxel]);
      const auto slope = slopes.row(static_cast<Index>(taxel));
      if (newtons > 0.0) {
        pass.pressed.push_back({taxel, (std::log(newtons) - scale_.centre) / scale_.half_span, frame.temperature,
                                siemens[taxel], sigma[taxel], slope.transpose()});
      }
      if (newtons != 0.0 || !is_readable(taxel, frame.temperature, sigma[taxel])) continue;
      const double relative_sigma = sigma[taxel] / reference_siemens();
      const double weight = 1.0 / (noise_variance_ * relative_sigma * relative_sigma);
      auto row = rows.col(used++);
      row.head(slopes.cols()) = slope.transpose() / reference_siemens();
      row[slopes.cols()] = siemens[taxel] / reference_siemens();
      pass.idle.add_local(taxel, basis, row, weight);
      row *= std::sqrt(weight);
    }
    pass.idle.global.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(used));
  }

  /// A pressed reading against its law.
  struct PressedPoint {
    bool usable = false;
    double excess = 0.0;             // over the unloaded conductance, over the reference conductance
    double logarithm = 0.0;          // of it, without bias
    double relative_variance = 0.0;  // from the noise of the readings
    double residual = 0.0;           // from the law
    VectorXd basis;
    VectorXd common;
  };

  [[nodiscard]] PressedPoint pressed_point(const Pressed& reading) const {
    PressedPoint point;
    point.basis = pressed_basis(reading.log_force, reading.temperature);
    point.excess = reading.siemens / reference_siemens();
    const TaxelLaw& law = laws_[reading.taxel];
    if (law.unloaded.size() > 0) {
      point.excess -= law.unloaded.dot(unloaded_basis(reading.temperature, frames_.has_temperature));
    }
    const double sigma = reading.sigma_siemens / reference_siemens();
    const bool has_law = law.pressed.size() > 0;
    point.common = common_basis(reading.log_force, reading.temperature, point.excess);
    const double expected_logarithm =
        has_law ? law.pressed.dot(point.basis) + sheet_mean_.tail(kCommonTerms).dot(point.common) : 0.0;
    // The variance from the law, not from the reading: weights must not follow the noise.
    const double expected = has_law ? std::exp(expected_logarithm) : point.excess;
    point.usable = std::min(expected, point.excess) > kLeastPressSigmas * sigma;
    if (!point.usable) return point;
    point.relative_variance = noise_variance_ * std::pow(sigma / expected, 2);
    point.logarithm = std::log(point.excess) + 0.5 * point.relative_variance;
    point.residual = point.logarithm - expected_logarithm;
    return point;
  }

  /// Columns: parameters, what the taxels' laws have in common, ln(g - u).
  [[nodiscard]] NormalEquations pressed_equations(const std::vector<Pressed>& readings, const Elimination& idle) const {
    const Index slopes = readings.empty() ? 0 : readings.front().slope.size();
    NormalEquations equations(taxels_, kFreeTerms + kShapeTerms, slopes + kSheetTerms + 1);
    VectorXd row(slopes + kSheetTerms + 1);
    for (const Pressed& reading : readings) {
      const PressedPoint point = pressed_point(reading);
      if (!point.usable) continue;
      VectorXd slope = reading.slope / reference_siemens();
      const MatrixXd& idle_law = idle.laws[reading.taxel];
      if (idle_law.size() > 0) {
        slope -= idle_law.leftCols(slopes).transpose() * unloaded_basis(reading.temperature, frames_.has_temperature);
      }
      row << slope / point.excess, -point.basis.tail(kShapeTerms), -point.common, point.logarithm;
      const double weight = 1.0 / (point.relative_variance + rubber_variance_);
      equations.add_local(reading.taxel, point.basis, row, weight);
      equations.global.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    }
    return equations;
  }

  [[nodiscard]] VectorXd unloaded_prior() const { return VectorXd::Ones(unloaded_terms_); }

  [[nodiscard]] VectorXd pressed_prior() const {
    constexpr double kFreePrecision = 1e-2;
    VectorXd precision(kFreeTerms + kShapeTerms);
    precision << VectorXd::Constant(kFreeTerms, kFreePrecision), shape_variance_.cwiseInverse();
    return precision;
  }

  void set_unloaded_laws(const Elimination& idle) {
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      if (idle.laws[taxel].size() > 0) laws_[taxel].unloaded = idle.laws[taxel].rightCols(1);
    }
  }

  void set_pressed_laws(const Elimination& pressed, const VectorXd& solution) {
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      if (pressed.laws[taxel].size() == 0) continue;
      const Index unknowns = solution.size();
      laws_[taxel].pressed = pressed.laws[taxel].leftCols(unknowns) * solution + pressed.laws[taxel].col(unknowns);
      laws_[taxel].pressed.tail(kShapeTerms) += sheet_mean_.head(kShapeTerms);
    }
  }

  /// Adds the idle readings' equations, which do not know the shapes of the pressed laws.
  void add_idle(const Elimination& idle, MatrixXd& normal) const {
    const Index lines = lines_.count();
    const Index last = lines + kSheetTerms;
    normal.topLeftCorner(lines, lines) += idle.normal.topLeftCorner(lines, lines);
    normal.col(last).head(lines) += idle.normal.col(lines).head(lines);
  }

  /// Adds the equation row . step + value = 0 with this standard deviation.
  void add_equation(const VectorXd& row, double value, double sigma, MatrixXd& normal) const {
    const Index lines = lines_.count();
    normal.topLeftCorner(lines, lines) += row * row.transpose() / (sigma * sigma);
    normal.col(lines + kSheetTerms).head(lines) += row * value / (sigma * sigma);
  }

  [[nodiscard]] std::size_t sensed_line(std::size_t taxel) const {
    return array_.readout.circuit == Circuit::flexitac ? taxel / array_.cols : taxel % array_.cols;
  }
  [[nodiscard]] std::size_t driven_line(std::size_t taxel) const {
    return array_.readout.circuit == Circuit::flexitac ? taxel % array_.cols : taxel / array_.cols;
  }

  /// The rubber is taken to differ from sensed line to sensed line no more than it does from driven line to driven
  /// line, where it is measured: what the unloaded conductances then differ by is the loads.
  void add_sheet(const Elimination& idle, MatrixXd& normal) {
    if (lines_.loads().empty() || array_.sensed_lines() < 2 || array_.driven_lines() < 2) return;
    const Index lines = lines_.count();
    VectorXd sensed = VectorXd::Zero(static_cast<Index>(array_.sensed_lines()));
    VectorXd driven = VectorXd::Zero(static_cast<Index>(array_.driven_lines()));
    VectorXd sensed_count = sensed;
    VectorXd driven_count = driven;
    MatrixXd slopes = MatrixXd::Zero(sensed.size(), lines);
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      const MatrixXd& law = idle.laws[taxel];
      if (law.size() == 0 || law(0, lines) <= 0.0) continue;
      const auto sensed_index = static_cast<Index>(sensed_line(taxel));
      const auto driven_index = static_cast<Index>(driven_line(taxel));
      const double level = std::log(law(0, lines));
      sensed[sensed_index] += level;
      driven[driven_index] += level;
      sensed_count[sensed_index] += 1.0;
      driven_count[driven_index] += 1.0;
      slopes.row(sensed_index) += law.row(0).head(lines) / law(0, lines);
    }
    // Means of lines compare only where most of their taxels are known.
    if (2.0 * sensed_count.minCoeff() < static_cast<double>(driven.size())) return;
    if (2.0 * driven_count.minCoeff() < static_cast<double>(sensed.size())) return;
    sensed.array() /= sensed_count.array();
    driven.array() /= driven_count.array();
    slopes.array().colwise() /= sensed_count.array();
    driven.array() -= driven.mean();
    sheet_scatter_ =
        std::sqrt((driven.squaredNorm() + kSheetSpread * kSheetSpread) / static_cast<double>(driven.size()));
    const Eigen::RowVectorXd mean_slope = slopes.colwise().mean();
    const double mean = sensed.mean();
    for (Index line = 0; line < sensed.size(); ++line) {
      add_equation((slopes.row(line) - mean_slope).transpose(), sensed[line] - mean, sheet_scatter_, normal);
    }
  }

  /// Values of all lines of a kind, in the units of the parameters, and the parameter of each; -1: given.
  struct Group {
    VectorXd values;
    std::vector<Index> parameters;
    double unit = 1.0;  // what a spread of 1 means
  };

  [[nodiscard]] Group group(bool of_drives) const {
    const ArrayDescription array = lines_.array_at(parameters_);
    const std::vector<double>& ohms = of_drives ? array.readout.drive_ohm : array.readout.load_ohm;
    Group result;
    result.values.resize(static_cast<Index>(ohms.size()));
    result.parameters.assign(ohms.size(), -1);
    for (std::size_t k = 0; k < ohms.size(); ++k) {
      const double relative = ohms[k] / lines_.reference_ohm();
      result.values[static_cast<Index>(k)] = of_drives ? relative : std::log(relative);
    }
    Index p = of_drives ? 0 : static_cast<Index>(lines_.drives().size());
    for (const std::size_t line : of_drives ? lines_.drives() : lines_.loads()) result.parameters[line] = p++;
    constexpr double kLeastUnit = 1e-4;
    if (of_drives && !ohms.empty()) result.unit = std::max(kLeastUnit, result.values.mean());
    return result;
  }

  /// Resistances of one kind are alike: each lies about their mean with a spread that is learned.
  void add_line_priors(MatrixXd& normal) const {
    for (const bool of_drives : {true, false}) {
      const Group lines = group(of_drives);
      if (lines.values.size() == 0) continue;
      const auto count = static_cast<double>(lines.values.size());
      const double mean = lines.values.mean();
      VectorXd mean_row = VectorXd::Zero(lines_.count());
      for (const Index p : lines.parameters) {
        if (p >= 0) mean_row[p] += 1.0 / count;
      }
      for (std::size_t k = 0; k < lines.parameters.size(); ++k) {
        VectorXd row = -mean_row;
        if (lines.parameters[k] >= 0) row[lines.parameters[k]] += 1.0;
        const double spread = of_drives ? drive_spread_ : load_spread_;
        add_equation(row, lines.values[static_cast<Index>(k)] - mean, spread * lines.unit, normal);
      }
    }
  }

  /// Without any resistance given, only ratios exist: the loads' mean is set.
  void pin_scale(MatrixXd& normal) const {
    if (lines_.has_absolute() || lines_.loads().empty()) return;
    constexpr double kPinSigma = 1e-4;
    const auto loads = static_cast<Index>(lines_.loads().size());
    VectorXd row = VectorXd::Zero(lines_.count());
    row.tail(loads).setConstant(1.0 / static_cast<double>(loads));
    add_equation(row, parameters_.tail(loads).mean(), kPinSigma, normal);
  }

  void learn_variances(const Elimination& idle, const Elimination& pressed, const VectorXd& solution,
                       const std::vector<Pressed>& readings) {
    VectorXd idle_step(lines_.count() + 1);
    idle_step << solution.head(lines_.count()), 1.0;
    const double idle_freedom = idle.readings - static_cast<double>(unloaded_terms_) * idle.taxels;
    if (idle_freedom > 0.0) noise_variance_ *= idle_step.dot(idle.normal * idle_step) / idle_freedom;
    VectorXd pressed_step(solution.size() + 1);
    pressed_step << solution, 1.0;
    const double pressed_freedom = pressed.readings - static_cast<double>(kFreeTerms + 1) * pressed.taxels;
    if (pressed_freedom > 0.0) {
      learn_rubber(readings, pressed.readings / pressed_freedom);
      learn_shapes(pressed, pressed_step);
    }
    learn_spreads();
  }

  /// What the readings scatter about their laws more than their noise explains: a Newton step of its likelihood.
  void learn_rubber(const std::vector<Pressed>& readings, double freedom_lost) {
    double excess_variance = 0.0;
    double weight = 0.0;
    for (const Pressed& reading : readings) {
      const PressedPoint point = pressed_point(reading);
      if (!point.usable) continue;
      const double total = point.relative_variance + rubber_variance_;
      excess_variance += (freedom_lost * point.residual * point.residual - total) / (total * total);
      weight += 1.0 / (total * total);
    }
    if (weight == 0.0) return;
    rubber_variance_ = std::clamp(rubber_variance_ + excess_variance / weight,
                                  kLeastRubberScatter * kLeastRubberScatter, kMostRubberScatter * kMostRubberScatter);
  }

  /// Scatter of the shapes over the taxels: MacKay's fixed point (Neural Computation 4, 1992).
  void learn_shapes(const Elimination& pressed, const VectorXd& step) {
    VectorXd squares = VectorXd::Zero(kShapeTerms);
    VectorXd freedom = VectorXd::Zero(kShapeTerms);
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      if (pressed.laws[taxel].size() == 0) continue;
      squares += (pressed.laws[taxel].bottomRows(kShapeTerms) * step).cwiseAbs2();
      freedom.array() += 1.0 - pressed.covariance[taxel].diagonal().tail(kShapeTerms).array() / shape_variance_.array();
    }
    constexpr double kLeastFreedom = 1.0;
    shape_variance_ = squares.cwiseQuotient(freedom.cwiseMax(kLeastFreedom))
                          .cwiseMax(kLeastShapeSpread * kLeastShapeSpread)
                          .cwiseMin(1.0);
  }

  void learn_spreads() {
    for (const bool of_drives : {true, false}) {
      const Group lines = group(of_drives);
      if (lines.values.size() == 0) continue;
      double square = kLineSpread * kLineSpread;
      for (std::size_t k = 0; k < lines.parameters.size(); ++k) {
        square += std::pow((lines.values[static_cast<Index>(k)] - lines.values.mean()) / lines.unit, 2);
        const Index p = lines.parameters[k];
        if (p >= 0) square += covariance_(p, p) / (lines.unit * lines.unit);
      }
      (of_drives ? drive_spread_ : load_spread_) = std::sqrt(square / static_cast<double>(lines.values.size()));
    }
  }

  [[nodiscard]] ResistanceFit report() const {
    ResistanceFit fit;
    fit.array = lines_.array_at(parameters_);
    fit.drive_error.assign(fit.array.readout.drive_ohm.size(), 0.0);
    fit.load_error.assign(fit.array.readout.load_ohm.size(), 0.0);
    for (Index p = 0; p < lines_.count(); ++p) {
      const double sigma = std::sqrt(covariance_(p, p));
      if (lines_.is_drive(p)) {
        fit.drive_error[lines_.drives()[static_cast<std::size_t>(p)]] = std::min(1.0, sigma / parameters_[p]);
      } else {
        fit.load_error[lines_.loads()[static_cast<std::size_t>(p) - lines_.drives().size()]] = std::min(1.0, sigma);
      }
    }
    const auto drives = static_cast<Index>(lines_.drives().size());
    if (drives > 0) {
      const double sigma = std::sqrt(covariance_.topLeftCorner(drives, drives).sum()) / static_cast<double>(drives);
      fit.common_drive_error = std::min(1.0, sigma / parameters_.head(drives).mean());
    }
    fit.rubber_scatter = std::sqrt(rubber_variance_);
    fit.noise = std::sqrt(noise_variance_);
    fit.sheet_scatter = sheet_scatter_;
    fit.idle_readings = static_cast<std::size_t>(idle_readings_);
    fit.pressed_readings = static_cast<std::size_t>(pressed_readings_);
    fit.unsolved = unsolved_;
    fit.has_absolute = lines_.has_absolute();
    fit.reference_siemens = reference_siemens();
    fit.laws = laws_;
    fit.common = sheet_mean_;
    fit.force_scale = scale_;
    return fit;
  }

  ArrayDescription array_;
  const CircuitFrames& frames_;
  LineParameters lines_;
  ForceScale scale_;
  std::size_t taxels_;
  double reference_siemens_;
  Index unloaded_terms_;
  VectorXd parameters_;
  std::vector<TaxelLaw> laws_;
  VectorXd sheet_mean_;
  VectorXd shape_variance_;
  double noise_variance_ = 1.0;
  double rubber_variance_ = kRubberScatter * kRubberScatter;
  double drive_spread_ = kLineSpread;
  double load_spread_ = kLineSpread;
  double sheet_scatter_ = 0.0;
  MatrixXd covariance_;
  double idle_readings_ = 0.0;
  double pressed_readings_ = 0.0;
  std::size_t unsolved_ = 0;
  std::vector<std::size_t> chosen_;  // frames in use
};

}  // namespace

Result<ResistanceFit> fit_resistances(const ArrayDescription& array, const CircuitFrames& frames) {
  return ResistanceFitter(array, frames).run();
}

std::vector<double> judge_frames(const ResistanceFit& fit, const CircuitFrames& frames, double cut) {
  return ResistanceFitter(fit.array, frames).judge(fit, cut);
}

}  // namespace dermis::calibration
