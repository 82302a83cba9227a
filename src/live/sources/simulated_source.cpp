// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/simulated_source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/learn/simulation/reference_array.hpp"
#include "dermis/learn/simulation/simulator.hpp"
#include "dermis/live/sources/simulated_calibration.hpp"
#include "live/sources/contact_loop.hpp"
#include "live/sources/rehearsal.hpp"
#include "live/sources/simulated_device.hpp"

namespace dermis::live::sources {
namespace {

using learn::simulation::ScenePace;

constexpr std::size_t kMaxFrames = 1000;
constexpr std::size_t kMaxTaxelFrames = 4'000'000;  // a scene is simulated within seconds
constexpr std::size_t kLeastFrames = 16;
constexpr std::uint64_t kMostFramesToCatchUp = 100;
constexpr std::string_view kRehearsal = "rehearsal";

Result<ArrayDescription> named_array(const bytes::devices::SourceUri& uri, const ArrayDescription* given) {
  Result<ArrayDescription> array = learn::simulation::reference_array(uri.array_shape.value_or(FrameShape{16, 16}));
  if (!uri.array.empty()) {
    array = bytes::files::read_array(uri.array);
    if (!array) return array;
  } else if (given != nullptr) {
    const bool agrees = !uri.array_shape || *uri.array_shape == FrameShape{given->rows, given->cols};
    if (agrees) return *given;
  }
  if (uri.array_shape && *uri.array_shape != FrameShape{array->rows, array->cols}) {
    return bad_input(
        fmt::format("'{}': the array of {} has {}x{} taxels", uri.text, uri.array, array->rows, array->cols));
  }
  return array;
}

Result<ArrayDescription> array_of(const bytes::devices::SourceUri& uri, const ArrayDescription* given) {
  Result<ArrayDescription> array = named_array(uri, given);
  if (!array || !array->has_unknown_circuit()) return array;
  return bad_input("'" + uri.text + "': a circuit that is to be fitted cannot be simulated; name it in array.toml");
}

/// A scene once, as fast as it is read.
class UnpacedScene final : public FrameSource {
 public:
  UnpacedScene(std::unique_ptr<learn::simulation::Simulator> simulator, const std::atomic<bool>* stop)
      : simulator_(std::move(simulator)), stop_(stop) {}

  Result<bool> next(RawFrame& frame) override {
    if (stop_ != nullptr && stop_->load()) return false;
    return simulator_->next(frame);
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return simulator_->shape(); }
  [[nodiscard]] bool is_live() const override { return true; }

 private:
  std::unique_ptr<learn::simulation::Simulator> simulator_;
  const std::atomic<bool>* stop_;
};

Result<learn::simulation::RubberOptions> rubber_of(const bytes::devices::SourceUri& uri) {
  learn::simulation::RubberOptions rubber;
  rubber.gain = uri.gain;
  rubber.gain_spread = uri.gain_spread;
  if (uri.memory.empty()) return rubber;
  if (Status chosen = learn::simulation::choose_memory(uri.memory, rubber); !chosen) return chosen.error();
  return rubber;
}

/// An unknown scene has the pace of most: the simulator refuses it.
ScenePace pace_of(const bytes::devices::SourceUri& uri) {
  const learn::simulation::SceneKind* const scene = learn::simulation::find_scene(uri.path);
  return scene == nullptr ? ScenePace::step : scene->pace;
}

Result<std::unique_ptr<learn::simulation::Simulator>> simulate_scene(const bytes::devices::SourceUri& uri,
                                                                     const ArrayDescription& array,
                                                                     const learn::simulation::RubberOptions& rubber) {
  learn::simulation::SimulationOptions options;
  options.rubber = rubber;
  if (pace_of(uri) == ScenePace::any_rate) options.scene.rate_hz = uri.rate_hz;
  return learn::simulation::Simulator::create(array, options, uri.path, uri.seed, uri.frames);
}

/// A scene that is continuous in time, simulated while it is read: frames that nobody fetches are history of the
/// material all the same. After its last frame it begins again on rested rubber. Not thread-safe.
class ContinuousScene {
 public:
  using Create = std::function<Result<std::unique_ptr<learn::simulation::Simulator>>()>;

  [[nodiscard]] static Result<ContinuousScene> create(const Create& create) {
    Result<std::unique_ptr<learn::simulation::Simulator>> simulator = create();
    if (!simulator) return simulator.error();
    return ContinuousScene(create, *std::move(simulator));
  }

  void read(std::uint64_t number, RawFrame& frame) {
    // A machine that is too slow for the rate sees the scene slowed down, and does not fall ever further behind.
    next_ = std::max(next_, number - std::min(number, kMostFramesToCatchUp));
    for (; next_ <= number; ++next_) {
      if (const Result<bool> more = simulator_->next(frame); more && *more) continue;
      simulator_ = create_().value();
      (void)simulator_->next(frame);
    }
  }

 private:
  ContinuousScene(Create create, std::shared_ptr<learn::simulation::Simulator> simulator)
      : create_(std::move(create)), simulator_(std::move(simulator)) {}

  Create create_;
  std::shared_ptr<learn::simulation::Simulator> simulator_;
  std::uint64_t next_ = 0;
};

Result<MakeFrame> continuous_scene(const bytes::devices::SourceUri& uri, const ArrayDescription& array,
                                   const learn::simulation::RubberOptions& rubber) {
  Result<ContinuousScene> created =
      ContinuousScene::create([uri, array, rubber] { return simulate_scene(uri, array, rubber); });
  if (!created) return created.error();
  return MakeFrame(
      [scene = *std::move(created)](std::uint64_t number, RawFrame& frame) mutable { scene.read(number, frame); });
}

/// The first frames of a scene, over and over.
Result<MakeFrame> scene_loop(const bytes::devices::SourceUri& uri, const ArrayDescription& array,
                             const learn::simulation::RubberOptions& rubber, const SceneProgress& progress) {
  const Result<std::unique_ptr<learn::simulation::Simulator>> simulator = simulate_scene(uri, array, rubber);
  if (!simulator) return simulator.error();
  const std::size_t most = std::clamp(kMaxTaxelFrames / array.taxel_count(), kLeastFrames, kMaxFrames);
  const std::size_t length = std::min(most, (*simulator)->frame_count());
  std::vector<RawFrame> frames;
  while (frames.size() < most) {
    RawFrame frame;
    const Result<bool> more = (*simulator)->next(frame);
    if (!more) return more.error();
    if (!*more) break;
    frames.push_back(std::move(frame));
    if (progress) progress(static_cast<double>(frames.size()) / static_cast<double>(length));
  }
  return MakeFrame([frames = std::move(frames)](std::uint64_t number, RawFrame& frame) {
    const RawFrame& simulated = frames[number % frames.size()];
    frame.temperature_celsius = simulated.temperature_celsius;
    frame.sensor_celsius = simulated.sensor_celsius;
    frame.supply_v = simulated.supply_v;
    frame.counts = simulated.counts;
  });
}

Result<MakeFrame> contact_loop(const bytes::devices::SourceUri& uri, const ArrayDescription& array,
                               const learn::simulation::RubberOptions& rubber, const SceneProgress& progress) {
  Result<ContactLoop> created = ContactLoop::create(array, uri.seed, uri.frames, rubber, progress);
  if (!created) return created.error();
  return MakeFrame([loop = *std::move(created), rate_hz = *uri.rate_hz](std::uint64_t number, RawFrame& frame) mutable {
    loop.read(static_cast<double>(number) / rate_hz, frame);
  });
}

Result<MakeFrame> rehearsal(const bytes::devices::SourceUri& uri, const ArrayDescription& array,
                            std::shared_ptr<GuideVoice> guide, const learn::simulation::RubberOptions& rubber) {
  Result<Rehearsal> created = Rehearsal::create(array, uri.seed, *uri.rate_hz, std::move(guide), rubber);
  if (!created) return created.error();
  return MakeFrame([rehearsal = *std::move(created)](std::uint64_t number, RawFrame& frame) mutable {
    rehearsal.read(number, frame);
  });
}

Result<MakeFrame> frames_of(const bytes::devices::SourceUri& uri, const ArrayDescription& array,
                            const SourceOptions& options, const learn::simulation::RubberOptions& rubber) {
  if (uri.path == kRehearsal) return rehearsal(uri, array, options.guide, rubber);
  switch (pace_of(uri)) {
    case ScenePace::any_rate: return continuous_scene(uri, array, rubber);
    case ScenePace::own_rate: return contact_loop(uri, array, rubber, options.simulated);
    case ScenePace::step: break;
  }
  return scene_loop(uri, array, rubber, options.simulated);
}

/// Scenes of one temperature give it to all sensors.
MakeFrame with_sensors(MakeFrame frames, std::size_t sensors) {
  return [frames = std::move(frames), sensors](std::uint64_t number, RawFrame& frame) mutable {
    frame.sensor_celsius.clear();
    frames(number, frame);
    if (!frame.sensor_celsius.empty() || !frame.temperature_celsius) return;
    frame.sensor_celsius.assign(sensors, static_cast<float>(*frame.temperature_celsius));
  };
}

Result<std::unique_ptr<FrameSource>> open_scene(const bytes::devices::SourceUri& uri, const ArrayDescription& array,
                                                const SourceOptions& options) {
  const Result<learn::simulation::RubberOptions> rubber = rubber_of(uri);
  if (!rubber) return rubber.error();
  if (uri.rate_hz) {
    Result<MakeFrame> frames = frames_of(uri, array, options, *rubber);
    if (!frames) return frames.error();
    if (!array.temperature_sensors.empty()) frames = with_sensors(*std::move(frames), array.temperature_sensors.size());
    return std::unique_ptr<FrameSource>(std::make_unique<SimulatedDevice>(
        *std::move(frames), FrameShape{array.rows, array.cols}, *uri.rate_hz, options.stop));
  }
  if (uri.path == kRehearsal) return bad_input("needs a rate, as in sim:rehearsal?rate=100");
  Result<std::unique_ptr<learn::simulation::Simulator>> simulator = simulate_scene(uri, array, *rubber);
  if (!simulator) return simulator.error();
  return std::unique_ptr<FrameSource>(std::make_unique<UnpacedScene>(*std::move(simulator), options.stop));
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_simulation(const bytes::devices::SourceUri& uri,
                                                     const SourceOptions& options) {
  const Result<ArrayDescription> array = array_of(uri, options.array);
  if (!array) return array.error();
  Result<std::unique_ptr<FrameSource>> source = open_scene(uri, *array, options);
  if (!source) return bad_input("'" + uri.text + "': " + source.error().message);
  const ArrayDescription* const expected = options.array;
  if (expected != nullptr && (expected->rows != array->rows || expected->cols != array->cols)) {
    return bad_input(fmt::format("'{}': has {}x{} taxels, the array {}x{}", uri.text, array->rows, array->cols,
                                 expected->rows, expected->cols));
  }
  return source;
}

Result<SimulatedCalibration> simulate_calibration(const bytes::devices::SourceUri& uri) {
  Result<ArrayDescription> array = array_of(uri, nullptr);
  if (!array) return array.error();
  learn::simulation::SimulationOptions options;
  const Result<learn::simulation::RubberOptions> rubber = rubber_of(uri);
  if (!rubber) return bad_input("'" + uri.text + "': " + rubber.error().message);
  options.rubber = *rubber;
  auto simulator = learn::simulation::Simulator::create(*array, options, "uniform", uri.seed);
  if (!simulator) return bad_input("'" + uri.text + "': " + simulator.error().message);
  SimulatedCalibration calibration{.array = *std::move(array)};
  RawFrame frame;
  for (;;) {
    const Result<bool> more = (*simulator)->next(frame);
    if (!more) return more.error();
    if (!*more) return calibration;
    calibration.frames.push_back(frame);
    const std::vector<Load>& loads = (*simulator)->loads();
    calibration.loads.insert(calibration.loads.end(), loads.begin(), loads.end());
  }
}

}  // namespace dermis::live::sources
