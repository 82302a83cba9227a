// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "simulated_device.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "contact_loop.hpp"
#include "dermis/files/array_toml.hpp"
#include "dermis/simulation/simulator.hpp"
#include "pacer.hpp"
#include "rehearsal.hpp"

namespace dermis::app {
namespace {

constexpr std::size_t kMaxFrames = 1000;
constexpr std::size_t kMaxTaxelFrames = 4'000'000;  // a scene is simulated within seconds
constexpr std::size_t kLeastFrames = 16;
constexpr Nanos kDeviceBuffer = std::chrono::milliseconds(500);

/// The array of examples/chest.
ArrayDescription reference_array(const FrameShape& shape) {
  ArrayDescription array;
  array.name = "chest";
  array.rows = shape.rows;
  array.cols = shape.cols;
  array.taxel_area_m2 = 38.48e-6;
  array.readout.drive_ohm.assign(shape.rows, 20.0);
  array.readout.load_ohm.assign(shape.cols, 200.0);
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

Result<ArrayDescription> array_of(const acquisition::SourceUri& uri, const ArrayDescription* given) {
  Result<ArrayDescription> array = reference_array(uri.array_shape.value_or(FrameShape{16, 16}));
  if (!uri.array.empty()) {
    array = files::read_array(uri.array);
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

/// Sets counts, temperature and supply of the frame of that number, from 0 on without end.
using Playback = std::function<void(std::uint64_t, RawFrame&)>;

class SimulatedDevice final : public FrameSource {
 public:
  SimulatedDevice(Playback play, const FrameShape& shape, double rate_hz, const std::atomic<bool>* stop)
      : play_(std::move(play)), shape_(shape), rate_hz_(rate_hz), stop_(stop) {}

  Result<bool> next(RawFrame& frame) override {
    if (!pacer_) begin();
    const std::uint64_t oldest = frame_due_at(pacer_->elapsed() - kDeviceBuffer);
    const std::uint64_t lost = oldest > next_ ? oldest - next_ : 0;
    next_ += lost;
    lost_ += lost;
    const Nanos taken = moment_of(next_);
    if (!pacer_->wait_until(taken)) return false;

    play_(next_, frame);
    frame.time = begin_utc_ + taken;
    frame.acquisition = {};
    frame.acquisition.sequence = next_;
    frame.acquisition.device_time = taken;
    frame.acquisition.lost_before = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, ~std::uint32_t{0}));
    const Nanos arrival = pacer_->elapsed();
    frame.acquisition.arrival_steady = begin_steady_ + arrival;
    frame.acquisition.arrival_utc = begin_utc_ + arrival;
    if (frames_ == 0) first_arrival_ = arrival;
    last_arrival_ = arrival;
    ++frames_;
    ++next_;
    return true;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override { return shape_; }

  [[nodiscard]] SourceStatistics statistics() const override {
    SourceStatistics statistics;
    statistics.frames = frames_;
    statistics.lost_frames = lost_;
    const double seconds = std::chrono::duration<double>(last_arrival_ - first_arrival_).count();
    if (seconds > 0.0) statistics.rate_hz = static_cast<double>(frames_ - 1) / seconds;
    return statistics;
  }

 private:
  void begin() {
    pacer_.emplace(stop_);
    begin_steady_ = std::chrono::steady_clock::now().time_since_epoch();
    begin_utc_ = std::chrono::system_clock::now().time_since_epoch();
  }
  [[nodiscard]] Nanos moment_of(std::uint64_t frame) const {
    return Nanos(std::llround(1e9 * static_cast<double>(frame) / rate_hz_));
  }
  [[nodiscard]] std::uint64_t frame_due_at(Nanos moment) const {
    return static_cast<std::uint64_t>(std::max(0.0, 1e-9 * static_cast<double>(moment.count()) * rate_hz_));
  }

  Playback play_;
  FrameShape shape_;
  double rate_hz_;
  const std::atomic<bool>* stop_;
  std::optional<Pacer> pacer_;  // from the first frame on
  Nanos begin_steady_{};
  Nanos begin_utc_{};
  std::uint64_t next_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t frames_ = 0;
  Nanos first_arrival_{};
  Nanos last_arrival_{};
};

Result<Playback> play_frames(simulation::Simulator& simulator, std::size_t taxels) {
  const std::size_t most = std::clamp(kMaxTaxelFrames / taxels, kLeastFrames, kMaxFrames);
  std::vector<RawFrame> frames;
  while (frames.size() < most) {
    RawFrame frame;
    const Result<bool> more = simulator.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    frames.push_back(std::move(frame));
  }
  return Playback([frames = std::move(frames)](std::uint64_t number, RawFrame& frame) {
    const RawFrame& simulated = frames[number % frames.size()];
    frame.temperature_celsius = simulated.temperature_celsius;
    frame.supply_v = simulated.supply_v;
    frame.counts = simulated.counts;
  });
}

Result<Playback> play_contacts(const acquisition::SourceUri& uri, const ArrayDescription& array) {
  Result<ContactLoop> created = ContactLoop::create(array, uri.seed, uri.frames);
  if (!created) return created.error();
  return Playback([loop = *std::move(created), rate_hz = *uri.rate_hz](std::uint64_t number, RawFrame& frame) mutable {
    loop.read(static_cast<double>(number) / rate_hz, frame);
  });
}

Result<Playback> play_rehearsal(const acquisition::SourceUri& uri, const ArrayDescription& array) {
  if (!uri.rate_hz) return bad_input("needs a rate, as in sim:rehearsal?rate=100");
  Result<Rehearsal> created = Rehearsal::create(array, uri.seed, *uri.rate_hz);
  if (!created) return created.error();
  return Playback([rehearsal = *std::move(created)](std::uint64_t number, RawFrame& frame) mutable {
    rehearsal.read(number, frame);
  });
}

Result<Playback> play_scene(const acquisition::SourceUri& uri, const ArrayDescription& array) {
  if (uri.path == "contacts") return play_contacts(uri, array);
  Result<std::unique_ptr<simulation::Simulator>> simulator =
      simulation::Simulator::create(array, {}, uri.path, uri.seed, uri.frames);
  if (!simulator) return simulator.error();
  return play_frames(**simulator, array.taxel_count());
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_simulation(const acquisition::SourceUri& uri, const ArrayDescription* array,
                                                     const std::atomic<bool>* stop) {
  const Result<ArrayDescription> simulated = array_of(uri, array);
  if (!simulated) return simulated.error();
  if (simulated->has_unknown_circuit()) {
    return bad_input("'" + uri.text + "': a circuit that is to be fitted cannot be simulated; name it in array.toml");
  }
  const bool is_rehearsal = uri.path == "rehearsal";
  if (!uri.rate_hz && !is_rehearsal) {
    Result<std::unique_ptr<simulation::Simulator>> simulator =
        simulation::Simulator::create(*simulated, {}, uri.path, uri.seed, uri.frames);
    if (!simulator) return bad_input("'" + uri.text + "': " + simulator.error().message);
    return std::unique_ptr<FrameSource>(std::move(*simulator));
  }
  Result<Playback> play = is_rehearsal ? play_rehearsal(uri, *simulated) : play_scene(uri, *simulated);
  if (!play) return bad_input("'" + uri.text + "': " + play.error().message);
  return std::unique_ptr<FrameSource>(std::make_unique<SimulatedDevice>(
      *std::move(play), FrameShape{simulated->rows, simulated->cols}, *uri.rate_hz, stop));
}

}  // namespace dermis::app
