// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/core/quantile.hpp"
#include "dermis/core/touch.hpp"
#include "dermis/compensation/line_fault.hpp"
#include "dermis/core/neighbours.hpp"
#include "dermis/pipeline/model.hpp"
#include "dermis/pipeline/pipeline.hpp"
#include "open_source.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using compensation::LineFault;
using compensation::LineFaultEffect;
using compensation::LineFaultKind;

constexpr double kMuchNoise = 1.5;          // times what the model says
constexpr double kMuchOffsetDrift = 0.3;    // of the unloaded conductance, common to the array
constexpr double kMuchSaturation = 0.01;    // of all readings
constexpr double kTemperatureMargin = 1.0;  // sensor noise [C]
constexpr std::size_t kLeastUnloadedFrames = 10;
constexpr double kSurelyTouchedSigmas = 20.0;  // of calibrated noise: noise that has grown is no touch

struct DoctorOptions {
  std::string model;
  std::string in;
  bool json = false;
};

/// A fault and the frames in which it stood.
struct FaultHistory {
  LineFault fault;                     ///< As it was last seen.
  std::optional<std::size_t> until{};  ///< First frame without it; empty while it stands.
};

/// Noise against what the model says, from how much the taxels that nothing touches differ from one frame to the next,
/// each in its own standard deviations: in the median of the frames, without the taxels that differ most.
class NoiseMeter {
 public:
  /// Deviations of the taxels from their unloaded conductance in standard deviations; NaN: touched, or held at 0 S.
  void add(const std::vector<double>& deviations) {
    differences_.clear();
    for (std::size_t taxel = 0; taxel < last_.size(); ++taxel) {
      const double difference = std::abs(deviations[taxel] - last_[taxel]);
      if (!std::isnan(difference)) differences_.push_back(difference);
    }
    last_ = deviations;
    if (differences_.size() >= kLeastTaxels) ratios_.push_back(rms_without_outliers() / std::sqrt(2.0));
  }

  /// Standard deviation over that of the model; empty where something touches too much of the array all the time.
  [[nodiscard]] std::optional<double> ratio() const {
    if (ratios_.empty()) return std::nullopt;
    return upper_median(ratios_);
  }

 private:
  [[nodiscard]] double rms_without_outliers() const {
    double limit = std::numeric_limits<double>::infinity();
    double rms = 0.0;
    for (int round = 0; round < kRounds; ++round) {
      double square = 0.0;
      double count = 0.0;
      for (const double difference : differences_) {
        if (difference > limit) continue;
        square += difference * difference;
        count += 1.0;
      }
      rms = std::sqrt(square / std::max(count, 1.0));
      limit = std::max(3.0 * rms, 1.0);
    }
    return rms;
  }

  static constexpr std::size_t kLeastTaxels = 8;
  static constexpr int kRounds = 10;
  std::vector<double> last_;
  std::vector<double> differences_;
  std::vector<double> ratios_;
};

/// What the frames of a recording say about an array.
class Examination {
 public:
  explicit Examination(const pipeline::Model& model)
      : model_(model),
        expected_(model.array.taxel_count()),
        deviation_(model.array.taxel_count()),
        unloaded_share_(model.array.taxel_count()),
        unloaded_frames_(model.array.taxel_count()) {}

  void add(const RawFrame& raw, const pipeline::Pipeline& pipeline) {
    const std::size_t frame = frames_++;
    const ConductanceFrame& conductance = pipeline.conductance();
    if (has(conductance.status, FrameStatus::rejected)) {
      ++rejected_[preprocessing::to_string(pipeline.rejection())];
      return;
    }
    if (!first_time_) first_time_ = raw.time;
    last_time_ = raw.time;
    ++accepted_;
    follow_temperature(raw);
    follow_faults(pipeline.line_faults().faults(), frame);
    const auto saturated = [](TaxelStatus status) { return status == TaxelStatus::saturated; };
    const auto& taxels = pipeline.conditioned().taxels;
    saturated_ += static_cast<std::size_t>(std::count_if(taxels.begin(), taxels.end(), saturated));
    if (has(conductance.status, FrameStatus::not_converged)) {
      ++unsolved_;
      return;
    }
    worst_certificate_ = std::max(worst_certificate_, conductance.residual_sigma);
    expect_unloaded(conductance);
    follow_noise(conductance);
    follow_offsets(conductance);
  }

  /// What is wrong, in plain words, one sentence each, worst first.
  [[nodiscard]] std::vector<std::string> problems() const;
  void print(const compensation::LineFaultMonitor& monitor) const;
  [[nodiscard]] nlohmann::ordered_json to_json(const compensation::LineFaultMonitor& monitor) const;

 private:
  void follow_temperature(const RawFrame& raw) {
    if (!raw.temperature_celsius) return;
    coldest_ = std::min(coldest_.value_or(*raw.temperature_celsius), *raw.temperature_celsius);
    hottest_ = std::max(hottest_.value_or(*raw.temperature_celsius), *raw.temperature_celsius);
  }

  void follow_faults(std::span<const LineFault> present, std::size_t frame) {
    for (FaultHistory& known : faults_) {
      const auto is_same = [&](const LineFault& fault) { return same(fault, known.fault); };
      const auto now = std::find_if(present.begin(), present.end(), is_same);
      if (now != present.end()) known.fault = *now;
      if (now == present.end() && !known.until) known.until = frame;
    }
    for (const LineFault& fault : present) {
      const auto is_open = [&](const FaultHistory& known) { return !known.until && same(fault, known.fault); };
      if (std::none_of(faults_.begin(), faults_.end(), is_open)) faults_.push_back({fault});
    }
  }

  static bool same(const LineFault& a, const LineFault& b) {
    return a.kind == b.kind && a.place == b.place && a.frame == b.frame;
  }

  void expect_unloaded(const ConductanceFrame& conductance) {
    const UnloadedLaw& unloaded = model_.networks.unloaded;
    const double centre_celsius = unloaded.temperature.centre_celsius;
    const double offset_celsius = conductance.temperature_celsius.value_or(centre_celsius) - centre_celsius;
    for (std::size_t taxel = 0; taxel < expected_.size(); ++taxel) {
      expected_[taxel] = unloaded.at(taxel, offset_celsius);
    }
  }

  [[nodiscard]] bool is_touched(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const {
    const double unloaded = std::max(expected_[taxel], 0.0);
    return conductance.siemens[taxel] > touched_above(unloaded, conductance.sigma_siemens[taxel], sigmas);
  }

  [[nodiscard]] bool is_near_touch(const ConductanceFrame& conductance, std::size_t taxel, double sigmas) const {
    constexpr PerAxis<std::size_t> kReach{.row = 3, .column = 3};  // taxels around that may be touched a little
    for (const std::size_t near : Neighbours(model_.array.rows, model_.array.cols, taxel, kReach)) {
      if (is_touched(conductance, near, sigmas)) return true;
    }
    return false;
  }

  void follow_noise(const ConductanceFrame& conductance) {
    for (std::size_t taxel = 0; taxel < deviation_.size(); ++taxel) {
      const bool tells = conductance.taxels[taxel] == TaxelStatus::ok && conductance.siemens[taxel] > 0.0 &&
                         !is_near_touch(conductance, taxel, kSurelyTouchedSigmas);
      deviation_[taxel] = tells ? (conductance.siemens[taxel] - expected_[taxel]) / conductance.sigma_siemens[taxel]
                                : std::numeric_limits<double>::quiet_NaN();
    }
    noise_.add(deviation_);
  }

  [[nodiscard]] std::optional<double> noise_counts() const {
    const std::optional<double> ratio = noise_.ratio();
    if (!ratio) return std::nullopt;
    return *ratio * model_.array.readout.adc_noise_counts;
  }

  /// Frames in which neither the taxel nor one of its neighbours is touched tell what it conducts unloaded.
  void follow_offsets(const ConductanceFrame& conductance) {
    constexpr double kTouchedSigmas = 3.0;
    for (std::size_t taxel = 0; taxel < unloaded_share_.size(); ++taxel) {
      if (conductance.taxels[taxel] != TaxelStatus::ok || !(expected_[taxel] > 0.0)) continue;
      if (is_near_touch(conductance, taxel, kTouchedSigmas)) continue;
      unloaded_share_[taxel] += conductance.siemens[taxel] / expected_[taxel];
      ++unloaded_frames_[taxel];
    }
  }

  /// Median over the taxels of how far they have moved from their unloaded conductance.
  [[nodiscard]] std::optional<double> offset_drift() const {
    std::vector<double> drifts;
    for (std::size_t taxel = 0; taxel < unloaded_share_.size(); ++taxel) {
      const auto frames = static_cast<double>(unloaded_frames_[taxel]);
      if (unloaded_frames_[taxel] >= kLeastUnloadedFrames) drifts.push_back(unloaded_share_[taxel] / frames - 1.0);
    }
    if (drifts.empty()) return std::nullopt;
    return upper_median(std::move(drifts));
  }

  [[nodiscard]] double saturated_share() const {
    return static_cast<double>(saturated_) /
           static_cast<double>(std::max<std::size_t>(accepted_ * model_.array.taxel_count(), 1));
  }

  [[nodiscard]] double seconds() const {
    return first_time_ ? std::chrono::duration<double>(last_time_ - *first_time_).count() : 0.0;
  }

  [[nodiscard]] std::string sentence(const FaultHistory& history) const;

  const pipeline::Model& model_;
  std::size_t frames_ = 0;
  std::size_t accepted_ = 0;
  std::map<std::string, std::size_t> rejected_;
  std::optional<Nanos> first_time_;
  Nanos last_time_{};
  NoiseMeter noise_;
  std::vector<double> expected_;   // unloaded conductance at the frame's temperature [taxels]
  std::vector<double> deviation_;  // from it, in standard deviations [taxels]
  std::size_t saturated_ = 0;
  std::size_t unsolved_ = 0;
  double worst_certificate_ = 0.0;
  std::optional<double> coldest_;
  std::optional<double> hottest_;
  std::vector<double> unloaded_share_;        // sum over frames of conductance / unloaded conductance [taxels]
  std::vector<std::size_t> unloaded_frames_;  // [taxels]
  std::vector<FaultHistory> faults_;
};

/// What the fault is, and what to look at.
std::pair<std::string, std::string> diagnosis(const LineFault& fault, const ArrayDescription& array) {
  const std::string place = place_name(fault, array);
  switch (traits_of(fault.kind).effect) {
    case LineFaultEffect::silent:
      if (fault.grounded) return {"is shorted to 0 V", "look for a bridge between " + place + " and ground"};
      return {fault.ground_evidence < 0.0 ? "is open" : "is open or shorted to 0 V",
              "check the wire or crimp of " + place};
    case LineFaultEffect::supplied:
      return {"is shorted to the supply", "look for a bridge between " + place + " and the supply"};
    case LineFaultEffect::shorted: return {"are shorted together", "look for a bridge between " + place};
    case LineFaultEffect::stuck:
      return {"is stuck: its reading does not change", "check the electronics that read " + place};
    case LineFaultEffect::dead:
      return {"is dead: it reads less than an unloaded taxel", "check the contact of " + place + " with its lines"};
    case LineFaultEffect::drifting: break;
  }
  return {
      fmt::format("has risen from {:.0f} to about {:.0f} ohm", array.readout.drive_ohm[fault.place], fault.drive_ohm),
      "check the contact between the " + place + " and its line for corrosion"};
}

std::string Examination::sentence(const FaultHistory& history) const {
  const LineFault& fault = history.fault;
  const auto [what, mend] = diagnosis(fault, model_.array);
  const std::size_t masked = masked_taxel_count(fault, model_.array);
  std::string text = place_name(fault, model_.array) + " " + what;
  text += history.until ? fmt::format(" from frame {} to {}: {}", fault.frame, *history.until - 1, mend)
                        : fmt::format(" since frame {}: {}", fault.frame, mend);
  if (history.until) return text + "; it comes and goes, as a loose contact does";
  if (masked == 0) return text + ", or calibrate again; until then heavy loads on the line read too little";
  return text + fmt::format("; {} masked, the rest is still good",
                            masked == 1 ? "the taxel is" : fmt::format("its {} taxels are", masked));
}

std::vector<std::string> Examination::problems() const {
  std::vector<std::string> found;
  for (const FaultHistory& history : faults_) found.push_back(sentence(history));
  if (accepted_ == 0) found.emplace_back("no frame could be used");
  if (unsolved_ > 0) {
    found.push_back(
        fmt::format("{} frames do not fit the circuit of the array: check readout in array.toml", unsolved_));
  }
  for (const auto& [reason, count] : rejected_) found.push_back(fmt::format("{} frames rejected: {}", count, reason));
  const std::optional<double> noise = noise_counts();
  if (noise && *noise > kMuchNoise * model_.array.readout.adc_noise_counts) {
    found.push_back(
        fmt::format("the readings have {:.1f} counts of noise, {:.1f} were calibrated: check grounding and supply",
                    *noise, model_.array.readout.adc_noise_counts));
  }
  if (saturated_share() > kMuchSaturation) {
    found.push_back(fmt::format("{:.1f} % of the readings stand at the end of the ADC: forces there are lower bounds",
                                100.0 * saturated_share()));
  }
  const std::optional<double> drift = offset_drift();
  if (drift && std::abs(*drift) > kMuchOffsetDrift) {
    found.push_back(
        fmt::format("unloaded taxels conduct {:+.0f} % against the calibration: calibrate again", 100.0 * *drift));
  }
  const TemperatureSpan& calibrated = model_.networks.unloaded.temperature;
  const double half_span = calibrated.half_span_celsius + kTemperatureMargin;
  if (model_.networks.shape.inputs == fusion::kInputsWithTemperature && coldest_ &&
      (*coldest_ < calibrated.centre_celsius - half_span || *hottest_ > calibrated.centre_celsius + half_span)) {
    found.emplace_back("the temperature leaves the calibrated range: forces there are those at its end");
  }
  return found;
}

/// Lines that would not be missed, while nothing presses them.
std::vector<std::string> unseen_lines(const compensation::LineFaultMonitor& monitor, const ArrayDescription& array) {
  std::vector<std::string> lines;
  for (std::size_t row = 0; row < array.rows; ++row) {
    if (!monitor.sees_silent_row(row)) lines.push_back(fmt::format("row {}", row));
  }
  for (std::size_t col = 0; col < array.cols; ++col) {
    if (!monitor.sees_silent_column(col)) lines.push_back(fmt::format("column {}", col));
  }
  return lines;
}

void Examination::print(const compensation::LineFaultMonitor& monitor) const {
  const ArrayDescription& array = model_.array;
  const double duration = seconds();
  fmt::print("array        {}, {} x {}, {}\n", array.name, array.rows, array.cols, to_string(array.readout.circuit));
  fmt::print("frames       {}, {} rejected, {:.1f} s", frames_, frames_ - accepted_, duration);
  if (duration > 0.0) fmt::print(", {:.1f} frames/s", static_cast<double>(accepted_ - 1) / duration);
  const std::optional<double> noise = noise_counts();
  fmt::print("\nnoise        {}, calibrated {:.2f} counts\n",
             noise ? fmt::format("{:.2f} counts", *noise) : "unknown (touched all the time)",
             array.readout.adc_noise_counts);
  fmt::print("saturated    {:.2f} % of all readings\n", 100.0 * saturated_share());
  const std::optional<double> drift = offset_drift();
  fmt::print("unloaded     {}\n", drift ? fmt::format("{:+.1f} % against the calibration", 100.0 * *drift) : "unknown");
  const TemperatureSpan& calibrated = model_.networks.unloaded.temperature;
  if (coldest_) fmt::print("temperature  {:.1f} to {:.1f} C", *coldest_, *hottest_);
  if (!coldest_) fmt::print("temperature  unknown");
  fmt::print(", calibrated {:.1f} to {:.1f} C\n", calibrated.centre_celsius - calibrated.half_span_celsius,
             calibrated.centre_celsius + calibrated.half_span_celsius);
  fmt::print("circuit      {} frames unsolved, worst misfit {:.2f} standard deviations\n", unsolved_,
             worst_certificate_);
  const std::size_t unseen = unseen_lines(monitor, array).size();
  if (unseen > 0) {
    fmt::print("blind        {} of {} lines read too little unloaded for a break to be seen\n", unseen,
               array.rows + array.cols);
  }
  fmt::print("\n");
  const std::vector<std::string> wrong = problems();
  for (const std::string& problem : wrong) fmt::print("{}\n", problem);
  if (wrong.empty()) fmt::print("healthy\n");
}

nlohmann::ordered_json Examination::to_json(const compensation::LineFaultMonitor& monitor) const {
  nlohmann::ordered_json json;
  const std::vector<std::string> wrong = problems();
  json["healthy"] = wrong.empty();
  json["frames"] = frames_;
  json["frames_rejected"] = frames_ - accepted_;
  json["seconds"] = seconds();
  json["noise_counts"] = noise_counts() ? nlohmann::ordered_json(*noise_counts()) : nlohmann::ordered_json();
  json["calibrated_noise_counts"] = model_.array.readout.adc_noise_counts;
  json["saturated_share"] = saturated_share();
  json["offset_drift"] = offset_drift() ? nlohmann::ordered_json(*offset_drift()) : nlohmann::ordered_json();
  json["coldest_celsius"] = coldest_ ? nlohmann::ordered_json(*coldest_) : nlohmann::ordered_json();
  json["hottest_celsius"] = hottest_ ? nlohmann::ordered_json(*hottest_) : nlohmann::ordered_json();
  json["frames_unsolved"] = unsolved_;
  json["worst_misfit_sigma"] = worst_certificate_;
  json["blind_lines"] = unseen_lines(monitor, model_.array);
  json["faults"] = nlohmann::ordered_json::array();
  for (const FaultHistory& history : faults_) {
    nlohmann::ordered_json fault;
    fault["kind"] = to_string(history.fault.kind);
    fault["place"] = place_name(history.fault, model_.array);
    fault["since_frame"] = history.fault.frame;
    fault["until_frame"] = history.until ? nlohmann::ordered_json(*history.until) : nlohmann::ordered_json();
    fault["grounded"] = history.fault.grounded;
    if (history.fault.kind == LineFaultKind::drifting_driver) fault["drive_ohm"] = history.fault.drive_ohm;
    json["faults"].push_back(fault);
  }
  json["problems"] = wrong;
  return json;
}

Status examine(const DoctorOptions& options) {
  Result<std::unique_ptr<Operation>> opened = open_operation(options.model, options.in);
  if (!opened) return opened.error();
  auto& [model, pipeline, source] = **opened;
  Examination examination(model);
  RawFrame raw;
  ForceFrame force;
  while (!stop_flag().load()) {
    const Result<bool> more = source->next(raw);
    if (!more) return more.error();
    if (!*more) break;
    pipeline.process(raw, force);
    examination.add(raw, pipeline);
  }
  if (options.json) {
    fmt::print("{}\n", examination.to_json(pipeline.line_faults()).dump(2));
  } else {
    examination.print(pipeline.line_faults());
  }
  const std::size_t problems = examination.problems().size();
  if (problems == 0) return Done{};
  return failed(fmt::format("the array is not healthy: {} finding{}", problems, problems == 1 ? "" : "s"));
}

}  // namespace

void add_doctor(CLI::App& app, Action& action) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand("doctor", "Health of an array, in plain words: line faults, noise, drift");
  command->add_option("--model", options->model, "Model file of 'dermis calibrate'")->required();
  command->add_option("--in", options->in, "Raw counts: frames.csv, a recording, or the URI of a device")->required();
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([&action, options] { action = [options] { return examine(*options); }; });
}

}  // namespace dermis::app
