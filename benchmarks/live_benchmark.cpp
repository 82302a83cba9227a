// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// A suit of 40 arrays of 16x16 taxels at 1,000 frames a second each: how long a frame takes from its arrival to its
// contacts, with and without a recording of all, and how many cores that keeps busy beside the sources. Frames are
// those of the simulator's scene contacts; in the last run a row of them is saturated.
//
// usage: live_benchmark [--arrays 40] [--rate 1000] [--seconds 10]
#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "rows.hpp"
#include "support/reference_array.hpp"

namespace dermis {
namespace {

using Clock = std::chrono::steady_clock;
using Frames = std::shared_ptr<const std::vector<RawFrame>>;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kLines = 16;
constexpr std::size_t kScenes = 8;
constexpr std::size_t kSceneFrames = 2000;
constexpr Nanos kDeviceBuffer = std::chrono::milliseconds(500);  // as that of sim:...?rate=

struct Settings {
  std::size_t arrays = 40;
  double rate_hz = 1000.0;
  double seconds = 10.0;
};

/// The law of the simulated rubber, but for its scatter: newtons = 10 (e / reference)^(1 / exponent), with temperature.
/// Hidden units that add nothing take the time of those of a calibration.
touch::fusion::ForceNetworks networks_of_rubber(std::size_t taxels) {
  const learn::simulation::RubberOptions rubber;
  constexpr double kHalfSpanCelsius = 30.0;
  touch::fusion::ForceNetworks networks;
  networks.shape = {touch::fusion::kInputsWithTemperature, 4, 2};
  networks.unloaded.temperature.half_span_celsius = kHalfSpanCelsius;
  networks.unloaded.offset_siemens.assign(taxels, 1.0 / rubber.unloaded_ohm);
  networks.unloaded.per_celsius.assign(taxels, -rubber.temperature_coefficient / rubber.unloaded_ohm);
  networks.reference_siemens.assign(taxels, static_cast<float>(1.0 / rubber.resistance_at_10n_ohm));
  networks.heaviest_siemens.assign(taxels, static_cast<float>(5.0 / rubber.resistance_at_10n_ohm));
  networks.heaviest_newtons.assign(taxels, 60.0F);
  networks.gain.assign(taxels, 1.0F);
  networks.dead.assign(taxels, 0);
  networks.offset_sigma_siemens.assign(taxels, 2e-7F);
  networks.relative_sigma.assign(touch::fusion::kSigmaKnots * taxels, 0.02F);
  const auto fill = [&](std::size_t parameter, double value) {
    std::fill_n(networks.parameters.begin() + static_cast<std::ptrdiff_t>(parameter * taxels), taxels,
                static_cast<float>(value));
  };
  networks.parameters.assign(networks.shape.parameter_count() * taxels, 1e-6F);
  fill(networks.shape.output_bias(), std::log(10.0));
  fill(networks.shape.direct_weight(0), 1.0 / rubber.exponent);
  fill(networks.shape.direct_weight(2), rubber.temperature_coefficient / rubber.exponent * kHalfSpanCelsius);
  return networks;
}

Frames simulate(const ArrayDescription& array, std::uint64_t seed) {
  auto simulator = learn::simulation::Simulator::create(array, {}, "contacts", seed, kSceneFrames);
  if (!simulator) std::abort();
  std::vector<RawFrame> frames(kSceneFrames);
  for (RawFrame& frame : frames) {
    if (!(*simulator)->next(frame)) std::abort();
  }
  return std::make_shared<const std::vector<RawFrame>>(std::move(frames));
}

/// Row 3 of all frames at the end of the ADC.
Frames with_saturated_row(const Frames& frames) {
  std::vector<RawFrame> spoiled = *frames;
  for (RawFrame& frame : spoiled) std::fill_n(frame.counts.begin() + 3 * kLines, kLines, 4095.0F);
  return std::make_shared<const std::vector<RawFrame>>(std::move(spoiled));
}

/// A device that sends at a rate; what is not fetched in time is lost. Adds up the time that it takes itself.
class PacedSource final : public FrameSource {
 public:
  PacedSource(Frames frames, const Settings& settings, Clock::time_point begin, std::atomic<std::int64_t>& spent_ns)
      : frames_(std::move(frames)),
        rate_hz_(settings.rate_hz),
        seconds_(settings.seconds),
        begin_(begin),
        spent_ns_(spent_ns) {}

  Result<bool> next(RawFrame& /*frame*/) override { return failed("is polled"); }
  [[nodiscard]] std::optional<Readiness> readiness() const override {
    return Readiness{.due = (begin_ + taken(next_)).time_since_epoch()};
  }
  Result<Polled> poll(RawFrame& frame) override {
    const Clock::time_point now = Clock::now();
    const double elapsed = Seconds(now - begin_ - kDeviceBuffer).count();
    const auto oldest = static_cast<std::uint64_t>(std::max(0.0, elapsed * rate_hz_));
    if (oldest > next_) lost_ += oldest - next_;
    next_ = std::max(next_, oldest);
    if (Seconds(taken(next_)).count() >= seconds_) return Polled::end;
    if (begin_ + taken(next_) > now) return Polled::nothing;
    frame = (*frames_)[next_ % frames_->size()];
    frame.time = std::chrono::hours(24) + taken(next_);
    frame.acquisition = {};
    frame.acquisition.arrival_steady = now.time_since_epoch();
    ++next_;
    spent_ns_ += (Clock::now() - now).count();
    return Polled::frame;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return FrameShape{kLines, kLines}; }
  [[nodiscard]] SourceStatistics statistics() const override {
    SourceStatistics statistics;
    statistics.lost_frames = lost_;
    return statistics;
  }

 private:
  [[nodiscard]] Nanos taken(std::uint64_t frame) const {
    return Nanos(std::llround(1e9 * static_cast<double>(frame) / rate_hz_));
  }

  Frames frames_;
  double rate_hz_;
  double seconds_;
  Clock::time_point begin_;
  std::atomic<std::int64_t>& spent_ns_;
  std::uint64_t next_ = 0;
  std::uint64_t lost_ = 0;
};

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Of all frames of all arrays; each array writes its own.
class Latencies {
 public:
  explicit Latencies(const Settings& settings) : of_array_(settings.arrays) {
    for (auto& times : of_array_) times.reserve(static_cast<std::size_t>(settings.rate_hz * settings.seconds) + 1);
  }
  void add(std::size_t array, Nanos latency) { of_array_[array].push_back(static_cast<float>(latency.count())); }

  [[nodiscard]] std::vector<float> sorted() const {
    std::vector<float> all;
    for (const auto& times : of_array_) all.insert(all.end(), times.begin(), times.end());
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  std::vector<std::vector<float>> of_array_;
};

/// Writes all frames with their forces, as `dermis serve --record` does.
std::unique_ptr<bytes::recordings::SuitRecordingWriter> open_recording(const std::string& path,
                                                                       const Settings& settings) {
  std::vector<bytes::recordings::RecordedArray> recorded(settings.arrays);
  for (std::size_t k = 0; k < settings.arrays; ++k) {
    recorded[k].name = fmt::format("array{}", k);
    recorded[k].shape = {kLines, kLines};
  }
  auto writer = bytes::recordings::SuitRecordingWriter::create(path, std::move(recorded));
  if (!writer) std::abort();
  return *std::move(writer);
}

std::vector<live::suits::LiveArray> make_arrays(const Settings& settings, const std::vector<Frames>& scenes,
                                                std::atomic<std::int64_t>& spent_ns) {
  const ArrayDescription array = support::reference_array(kLines, kLines);
  const auto model = std::make_shared<const touch::pipeline::Model>(touch::pipeline::Model{
      .array = array, .networks = networks_of_rubber(array.taxel_count()), .baselines = {}, .provenance = {}});
  const Clock::time_point begin = Clock::now() + std::chrono::milliseconds(500);
  std::vector<live::suits::LiveArray> arrays;
  for (std::size_t k = 0; k < settings.arrays; ++k) {
    // Devices are not in step.
    const auto phase = std::chrono::duration_cast<Nanos>(
        Seconds(static_cast<double>(k) / static_cast<double>(settings.arrays) / settings.rate_hz));
    arrays.push_back({fmt::format("array{}", k),
                      std::make_unique<PacedSource>(scenes[k % scenes.size()], settings, begin + phase, spent_ns),
                      model, ArraySurface::create(array).value()});
  }
  return arrays;
}

struct Outcome {
  std::vector<float> latencies_ns;
  std::uint64_t lost = 0;
  bool is_written = true;
  double cores = 0.0;       // without the sources,
  double of_sources = 0.0;  // which take these
};

Outcome run(const Settings& settings, const std::vector<Frames>& scenes, const std::string& recording) {
  std::unique_ptr<bytes::recordings::SuitRecordingWriter> writer;
  if (!recording.empty()) writer = open_recording(recording, settings);
  Latencies latencies(settings);
  std::atomic<bool> is_written = true;
  live::suits::LiveOptions options;
  options.on_result = [&](const live::suits::ArrayResult& result) {
    latencies.add(result.array, Clock::now().time_since_epoch() - result.raw.acquisition.arrival_steady);
    if (writer && !writer->write(result.array, result.raw, result.force)) is_written = false;
  };
  std::atomic<std::int64_t> spent_ns = 0;
  auto suit = live::suits::LiveSuit::create(make_arrays(settings, scenes, spent_ns), std::move(options));
  if (!suit) std::abort();
  const double before = processor_seconds();
  (*suit)->start();
  while (!(*suit)->ended()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  Outcome outcome;
  outcome.of_sources = 1e-9 * static_cast<double>(spent_ns.load()) / settings.seconds;
  outcome.cores = (processor_seconds() - before) / settings.seconds - outcome.of_sources;
  if (writer && !writer->commit()) is_written = false;
  outcome.is_written = is_written;
  outcome.latencies_ns = latencies.sorted();
  for (std::size_t k = 0; k < settings.arrays; ++k) outcome.lost += (*suit)->statistics(k).source.lost_frames;
  return outcome;
}

bool report(const std::string& work, const Settings& settings, const Outcome& outcome, nlohmann::ordered_json& rows) {
  const auto quantile_us = [&](double share) {
    const auto last = static_cast<double>(outcome.latencies_ns.size() - 1);
    return 1e-3 * static_cast<double>(outcome.latencies_ns[static_cast<std::size_t>(share * last)]);
  };
  const auto all = static_cast<std::size_t>(settings.rate_hz * settings.seconds) * settings.arrays;
  const bool checked = outcome.lost == 0 && outcome.latencies_ns.size() == all && outcome.is_written;
  fmt::print("{:<24}{:>10}{:>8}{:>10.0f}{:>10.0f}{:>10.0f}{:>10.0f}{:>8.2f}{:>9.3f}{:>9}\n", work,
             outcome.latencies_ns.size(), outcome.lost, quantile_us(0.5), quantile_us(0.99), quantile_us(0.999),
             quantile_us(1.0), outcome.cores, outcome.of_sources, checked ? "yes" : "NO");
  rows.push_back({{"work", fmt::format("{}, {} arrays at {} Hz", work, settings.arrays, settings.rate_hz)},
                  {"engine", "dermis"},
                  {"threads", settings.arrays},
                  {"median", quantile_us(0.5)},
                  {"unit", "us"},
                  {"p99", quantile_us(0.99)},
                  {"max", quantile_us(1.0)},
                  {"lost", outcome.lost},
                  {"cores", outcome.cores},
                  {"cores_of_sources", outcome.of_sources},
                  {"checked", checked}});
  return checked;
}

Settings read_settings(int argc, char** argv) {
  Settings settings;
  for (int k = 1; k + 1 < argc; k += 2) {
    const double value = std::atof(argv[k + 1]);
    if (std::strcmp(argv[k], "--arrays") == 0) settings.arrays = static_cast<std::size_t>(value);
    if (std::strcmp(argv[k], "--rate") == 0) settings.rate_hz = value;
    if (std::strcmp(argv[k], "--seconds") == 0) settings.seconds = value;
  }
  return settings;
}

bool measure(const Settings& settings) {
  std::vector<Frames> scenes;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed)
    scenes.push_back(simulate(support::reference_array(kLines, kLines), seed));
  fmt::print("{} arrays of 16x16 at {} frames/s, {} s; from the arrival of a frame to its contacts\n", settings.arrays,
             settings.rate_hz, settings.seconds);
  fmt::print("{:<24}{:>10}{:>8}{:>10}{:>10}{:>10}{:>10}{:>8}{:>9}{:>9}\n", "work", "frames", "lost", "p50 us", "p99 us",
             "p99.9 us", "max us", "cores", "sources", "checked");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  report("suit to contacts", settings, run(settings, scenes, {}), rows);
  const std::string recording =
      (std::filesystem::temp_directory_path() / fmt::format("live_benchmark_{}.mcap", getpid())).string();
  report("the same, recorded", settings, run(settings, scenes, recording), rows);
  std::filesystem::remove(recording);
  std::transform(scenes.begin(), scenes.end(), scenes.begin(), with_saturated_row);
  report("one saturated row", settings, run(settings, scenes, {}), rows);
  return benchmarks::write_rows("live", rows);
}

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  return dermis::measure(dermis::read_settings(argc, argv)) ? 0 : 1;
}
