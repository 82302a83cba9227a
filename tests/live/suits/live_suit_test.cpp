// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/suits/live_suit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <numbers>
#include <set>
#include <thread>

#include "dermis/learn/simulation/adc.hpp"
#include "dermis/learn/simulation/readout_circuit.hpp"
#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/hand_made_model.hpp"

namespace dermis::live::suits {
namespace {

using support::hand_made_model;

using SharedModel = std::shared_ptr<const touch::pipeline::Model>;

constexpr double kCelsius = 25.0;

SharedModel model_of(std::size_t rows, std::size_t cols) {
  return std::make_shared<const touch::pipeline::Model>(hand_made_model(rows, cols));
}

/// What the array reads under the forces.
std::vector<float> counts_under(const touch::pipeline::Model& model, const std::vector<double>& newtons) {
  std::vector<double> siemens(newtons.size());
  for (std::size_t k = 0; k < newtons.size(); ++k) siemens[k] = support::siemens_under(model, k, newtons[k], kCelsius);
  std::vector<double> ratio(newtons.size());
  learn::simulation::ReadoutCircuit::create(model.array)->ratios(siemens, ratio);
  std::vector<float> counts(newtons.size());
  Random random(1);
  learn::simulation::Adc(model.array.readout, 0.0).convert(ratio, 5.0, random, counts);
  return counts;
}

/// 12 N on 3 x 3 taxels around one.
std::vector<double> press_around(const touch::pipeline::Model& model, std::size_t row, std::size_t col) {
  std::vector<double> newtons(model.array.taxel_count(), 0.0);
  for (std::size_t r = row - 1; r <= row + 1; ++r) {
    for (std::size_t c = col - 1; c <= col + 1; ++c)
      newtons[model.array.index(r, c)] = r == row && c == col ? 4.0 : 1.0;
  }
  return newtons;
}

/// Gives `frames` frames of the same counts, or frames without end, and ends as asked. What is measured of it is told
/// by the test that made it.
struct ScriptedSource final : FrameSource {
  ScriptedSource(SharedModel model_given, const std::vector<double>& newtons)
      : model(std::move(model_given)), counts(counts_under(*model, newtons)) {}

  Result<bool> next(RawFrame& frame) override {
    if (stop != nullptr && stop->load()) return false;
    if (delivered == frames) {
      if (!failure.empty()) return failed(failure);
      return false;
    }
    std::this_thread::sleep_for(interval);
    frame.time = Nanos(static_cast<std::int64_t>(delivered % frames_until_sought_back) * 1'000'000);
    frame.temperature_celsius = kCelsius;
    frame.supply_v = 5.0;
    frame.counts = counts;
    frame.acquisition = {};
    frame.acquisition.arrival_steady = std::chrono::steady_clock::now().time_since_epoch();
    ++delivered;
    return true;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override {
    return FrameShape{model->array.rows, model->array.cols};
  }
  [[nodiscard]] SourceStatistics statistics() const override {
    SourceStatistics statistics;
    statistics.frames = delivered;
    return statistics;
  }

  SharedModel model;
  std::vector<float> counts;
  std::uint64_t frames = 50;
  std::uint64_t delivered = 0;
  std::string failure;
  std::uint64_t frames_until_sought_back = ~std::uint64_t{0};
  Nanos interval{};
  const std::atomic<bool>* stop = nullptr;
};

std::unique_ptr<ScriptedSource> source_of(const SharedModel& model, const std::vector<double>& newtons) {
  return std::make_unique<ScriptedSource>(model, newtons);
}

std::unique_ptr<ScriptedSource> endless(const SharedModel& model, const std::vector<double>& newtons,
                                        const std::atomic<bool>& stop) {
  auto source = source_of(model, newtons);
  source->frames = ~std::uint64_t{0};
  source->interval = std::chrono::microseconds(200);
  source->stop = &stop;
  return source;
}

LiveArray array_of(const std::string& name, std::unique_ptr<FrameSource> source, const SharedModel& model,
                   const ArrayShape& shape = FlatShape{}, const Pose& pose = {}, bool mirrored = false) {
  return {name, std::move(source), model, ArraySurface::create(model->array, shape, pose, mirrored).value()};
}

template <typename... Arrays>
std::vector<LiveArray> arrays_of(Arrays... arrays) {
  std::vector<LiveArray> all;
  (all.push_back(std::move(arrays)), ...);
  return all;
}

std::unique_ptr<LiveSuit> start_suit(std::vector<LiveArray> arrays, LiveOptions options) {
  Result<std::unique_ptr<LiveSuit>> suit = LiveSuit::create(std::move(arrays), std::move(options));
  EXPECT_TRUE(suit) << (suit ? "" : suit.error().message);
  (*suit)->start();
  return *std::move(suit);
}

/// Waits for what other threads will do; a test that waits in vain is ended by its time limit.
template <typename Condition>
void wait_for(const Condition& condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void wait_until_ended(const LiveSuit& suit) {
  wait_for([&] { return suit.ended(); });
}

/// Keeps the last results of every array.
class Collector {
 public:
  void operator()(const ArrayResult& result) {
    const std::lock_guard lock(mutex_);
    Kept& kept = kept_.at(result.array);
    ++kept.frames;
    kept.total_n = result.report.total_force_n;
    kept.contacts.assign(result.contacts.begin(), result.contacts.end());
    kept.force_sum = 0.0;
    for (const float newtons : result.force.newtons) kept.force_sum += static_cast<double>(newtons);
    kept.siemens = result.conductance.siemens;
    kept.thread = std::this_thread::get_id();
  }

  struct Kept {
    std::uint64_t frames = 0;
    double total_n = 0.0;
    double force_sum = 0.0;
    std::vector<SuitContact> contacts;
    std::vector<double> siemens;
    std::thread::id thread;
  };
  Kept of(std::size_t array) const {
    const std::lock_guard lock(mutex_);
    return kept_.at(array);
  }

 private:
  mutable std::mutex mutex_;
  std::array<Kept, 4> kept_;
};

LiveOptions options_with(Collector& collector) {
  LiveOptions options;
  options.on_result = [&](const ArrayResult& result) { collector(result); };
  return options;
}

TEST(LiveSuit, arrays_of_different_sizes_work_side_by_side) {
  const SharedModel large = model_of(16, 16);
  const SharedModel small = model_of(6, 9);
  auto many = source_of(large, press_around(*large, 5, 7));
  many->frames = 200;
  auto few = source_of(small, press_around(*small, 2, 4));
  few->frames = 20;
  few->interval = std::chrono::milliseconds(2);
  Collector collector;
  const auto suit =
      start_suit(arrays_of(array_of("large", std::move(many), large), array_of("small", std::move(few), small)),
                 options_with(collector));
  wait_until_ended(*suit);
  suit->stop();
  EXPECT_EQ(collector.of(0).frames, 200U);
  EXPECT_EQ(collector.of(1).frames, 20U);
  EXPECT_NE(collector.of(0).thread, collector.of(1).thread);
  for (const std::size_t array : {0U, 1U}) {
    SCOPED_TRACE(array);
    EXPECT_NEAR(collector.of(array).total_n, 12.0, 0.1);
    ASSERT_EQ(collector.of(array).contacts.size(), 1U);
    EXPECT_EQ(collector.of(array).contacts[0].array, array);
    EXPECT_EQ(suit->statistics(array).frames, collector.of(array).frames);
    EXPECT_EQ(suit->statistics(array).source.frames, collector.of(array).frames);
    EXPECT_EQ(suit->statistics(array).rejected, 0U);
    EXPECT_TRUE(suit->statistics(array).ended);
    EXPECT_EQ(suit->statistics(array).error, "");
    EXPECT_EQ(suit->statistics(array).temperature_celsius, kCelsius);
    EXPECT_EQ(suit->statistics(array).supply_v, 5.0);
  }
}

TEST(LiveSuit, contacts_are_placed_in_the_frame_of_the_suit) {
  const SharedModel model = model_of(12, 16);
  const double radius = 0.05;
  const Pose pose{{1.0, 2.0, 3.0}, {0.0, 0.0, std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0}};
  const std::vector<double> newtons = press_around(*model, 4, 11);
  Collector collector;
  const auto suit = start_suit(
      arrays_of(array_of("flat", source_of(model, newtons), model),
                array_of("mirrored", source_of(model, newtons), model, FlatShape{}, pose, true),
                array_of("bent", source_of(model, newtons), model, CylinderShape{CylinderShape::Axis::y, radius})),
      options_with(collector));
  wait_until_ended(*suit);
  constexpr double kNear = 1e-3;
  for (const std::size_t array : {0U, 1U, 2U}) ASSERT_EQ(collector.of(array).contacts.size(), 1U) << array;
  const SuitContact flat = collector.of(0).contacts[0];
  EXPECT_NEAR(flat.place.position.x, 0.110, kNear);
  EXPECT_NEAR(flat.place.position.y, 0.040, kNear);
  EXPECT_EQ(flat.place.position.z, 0.0);
  const SuitContact mirrored = collector.of(1).contacts[0];
  EXPECT_NEAR(mirrored.place.position.x, 1.0 - 0.040, kNear);
  EXPECT_NEAR(mirrored.place.position.y, 2.0 - 0.110, kNear);
  EXPECT_NEAR(mirrored.place.position.z, 3.0, 1e-12);
  const SuitContact bent = collector.of(2).contacts[0];
  const double angle = (bent.contact.position.x - 0.075) / radius;
  EXPECT_NEAR(bent.place.position.x, 0.075 + radius * std::sin(angle), 1e-12);
  EXPECT_NEAR(bent.place.position.z, radius * std::cos(angle) - radius, 1e-12);
  EXPECT_NEAR(bent.place.normal.x, std::sin(angle), 1e-12);
  EXPECT_NEAR(bent.contact.position.x, 0.110, kNear);
}

TEST(LiveSuit, a_source_that_fails_ends_its_array_alone) {
  const SharedModel model = model_of(6, 6);
  const std::vector<double> newtons = press_around(*model, 2, 2);
  std::atomic<bool> stop = false;
  auto broken = source_of(model, newtons);
  broken->frames = 3;
  broken->failure = "the cable is torn";
  Collector collector;
  LiveOptions options = options_with(collector);
  std::mutex mutex;
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    notices.push_back(line);
  };
  const auto suit = start_suit(
      arrays_of(array_of("broken", std::move(broken), model), array_of("whole", endless(model, newtons, stop), model)),
      std::move(options));
  wait_for([&] { return suit->statistics(0).ended; });
  const std::uint64_t before = collector.of(1).frames;
  wait_for([&] { return collector.of(1).frames > before + 10; });
  EXPECT_EQ(suit->statistics(0).error, "the cable is torn");
  EXPECT_EQ(suit->statistics(0).frames, 3U);
  EXPECT_FALSE(suit->statistics(1).ended);
  EXPECT_FALSE(suit->ended());
  stop = true;
  suit->stop();
  EXPECT_TRUE(suit->ended());
  EXPECT_EQ(suit->statistics(1).error, "");
  EXPECT_EQ(notices, (std::vector<std::string>{"array 'broken': the cable is torn"}));
}

TEST(LiveSuit, stop_ends_arrays_whose_sources_have_more) {
  const SharedModel model = model_of(6, 6);
  const std::atomic<bool> never = false;
  Collector collector;
  const auto suit = start_suit(arrays_of(array_of("a", endless(model, press_around(*model, 2, 2), never), model)),
                               options_with(collector));
  wait_for([&] { return collector.of(0).frames > 0; });
  suit->stop();
  EXPECT_TRUE(suit->ended());
  const std::uint64_t frames = collector.of(0).frames;
  EXPECT_EQ(suit->statistics(0).frames, frames);
  suit->stop();  // twice is once
}

TEST(LiveSuit, a_suit_that_never_started_can_be_stopped) {
  const SharedModel model = model_of(6, 6);
  const auto suit =
      LiveSuit::create(arrays_of(array_of("a", source_of(model, press_around(*model, 2, 2)), model)), LiveOptions{});
  ASSERT_TRUE(suit);
  EXPECT_FALSE((*suit)->ended());
  (*suit)->stop();
}

TEST(LiveSuit, tare_takes_what_an_array_shows_for_nothing_until_it_is_reset) {
  const SharedModel model = model_of(6, 6);
  const std::vector<double> newtons = press_around(*model, 2, 2);
  std::atomic<bool> stop = false;
  Collector collector;
  const auto suit = start_suit(arrays_of(array_of("tared", endless(model, newtons, stop), model),
                                         array_of("other", endless(model, newtons, stop), model)),
                               options_with(collector));
  wait_for([&] { return collector.of(0).force_sum > 11.0 && collector.of(1).force_sum > 11.0; });
  suit->tare(0);
  wait_for([&] { return suit->statistics(0).tare.state == touch::pipeline::Tare::State::refused; });
  EXPECT_GT(collector.of(0).force_sum, 11.0);
  suit->tare(0, touch::pipeline::TareOver::any_load);
  wait_for([&] { return collector.of(0).force_sum < 0.1; });
  EXPECT_GT(collector.of(1).force_sum, 11.0);
  suit->tare({}, touch::pipeline::TareOver::any_load);
  wait_for([&] { return collector.of(1).force_sum < 0.1; });
  suit->reset_tare();
  wait_for([&] { return collector.of(0).force_sum > 11.0 && collector.of(1).force_sum > 11.0; });
  stop = true;
}

TEST(LiveSuit, settings_reach_every_array_at_work) {
  const SharedModel model = model_of(6, 6);
  const std::vector<double> newtons = press_around(*model, 2, 2);
  std::atomic<bool> stop = false;
  Collector collector;
  const auto suit = start_suit(arrays_of(array_of("a", endless(model, newtons, stop), model),
                                         array_of("b", endless(model, newtons, stop), model)),
                               options_with(collector));
  const auto contacts = [&](std::size_t array) { return collector.of(array).contacts.size(); };
  wait_for([&] { return contacts(0) == 1 && contacts(1) == 1; });
  LiveSettings settings = suit->settings();
  EXPECT_TRUE(settings.drift.track);
  settings.contacts.onset_force_n = 100.0;
  settings.drift.track = false;
  suit->set_settings(settings);
  wait_for([&] { return contacts(0) == 0 && contacts(1) == 0; });
  EXPECT_EQ(suit->settings().contacts.onset_force_n, 100.0);
  EXPECT_FALSE(suit->settings().drift.track);
  stop = true;
}

TEST(LiveSuit, takes_another_model_while_it_works) {
  const SharedModel model = model_of(6, 6);
  touch::pipeline::Model twice = *model;
  for (float& gain : twice.networks.gain) gain *= 2.0F;
  std::atomic<bool> stop = false;
  Collector collector;
  const auto suit = start_suit(arrays_of(array_of("a", endless(model, press_around(*model, 2, 2), stop), model)),
                               options_with(collector));
  wait_for([&] { return collector.of(0).total_n > 11.0; });
  ASSERT_TRUE(suit->set_model(0, std::make_shared<const touch::pipeline::Model>(twice)));
  wait_for([&] { return collector.of(0).total_n > 23.0; });
  const Status refused = suit->set_model(0, model_of(6, 7));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "array 'a': the new model is of another size or pitch");
  stop = true;
}

TEST(LiveSuit, refuses_arrays_that_cannot_work) {
  const SharedModel model = model_of(6, 6);
  const SharedModel other = model_of(6, 7);
  const std::vector<double> newtons = press_around(*model, 2, 2);
  const auto message = [](std::vector<LiveArray> arrays, const LiveOptions& options = {}) {
    const auto suit = LiveSuit::create(std::move(arrays), options);
    return suit ? std::string("no error") : suit.error().message;
  };
  EXPECT_EQ(message({}), "a suit needs at least one array");
  EXPECT_EQ(message(arrays_of(array_of("a", source_of(model, newtons), other))),
            "array 'a': the source has 6x6 taxels, its model 6x7");
  LiveArray misfit{"a", source_of(model, newtons), model, ArraySurface::create(other->array).value()};
  EXPECT_EQ(message(arrays_of(std::move(misfit))), "array 'a': the surface has 42 taxels, the model 36");
  auto damaged = std::make_shared<touch::pipeline::Model>(*model);
  damaged->networks.gain[3] = -1.0F;
  EXPECT_EQ(message(arrays_of(array_of("a", source_of(model, newtons), damaged))),
            "array 'a': the model's networks do not fit its array, or hold values out of range");
  LiveOptions options;
  options.settings.contacts.onset_sigma = 0.0;
  EXPECT_TRUE(message(arrays_of(array_of("a", source_of(model, newtons), model)), options)
                  .starts_with("contacts.onset_sigma: "));
}

TEST(LiveSuit, tells_what_is_rejected_and_how_long_frames_took) {
  const SharedModel model = model_of(6, 6);
  auto source = source_of(model, press_around(*model, 2, 2));
  auto damaged = source_of(model, press_around(*model, 2, 2));
  damaged->counts.pop_back();
  const auto suit = start_suit(
      arrays_of(array_of("whole", std::move(source), model), array_of("damaged", std::move(damaged), model)), {});
  wait_until_ended(*suit);
  EXPECT_EQ(suit->statistics(0).rejected, 0U);
  EXPECT_EQ(suit->statistics(1).rejected, 50U);
  EXPECT_GT(suit->statistics(0).latency_p50, Nanos{});
  EXPECT_GE(suit->statistics(0).latency_p99, suit->statistics(0).latency_p50);
}

TEST(LiveSuit, a_recording_that_is_sought_back_begins_anew_with_its_first_frame) {
  const SharedModel model = model_of(6, 6);
  auto source = source_of(model, press_around(*model, 2, 2));
  source->frames = 1500;
  source->frames_until_sought_back = 600;
  std::vector<ContactPhase> phases;
  LiveOptions options;
  options.on_result = [&](const ArrayResult& result) {
    ASSERT_EQ(result.contacts.size(), 1U);
    EXPECT_EQ(result.contacts[0].contact.id, 1 + phases.size() / 600) << "an id is never used again";
    phases.push_back(result.contacts[0].contact.phase);
  };
  const auto suit = start_suit(arrays_of(array_of("a", std::move(source), model)), std::move(options));
  wait_until_ended(*suit);
  EXPECT_EQ(suit->statistics(0).rejected, 0U);
  ASSERT_EQ(phases.size(), 1500U);
  for (std::size_t k = 0; k < phases.size(); ++k) {
    EXPECT_EQ(phases[k], k % 600 == 0 ? ContactPhase::onset : ContactPhase::held) << k;
  }
}

/// Can be polled. Its frames have come already, a millisecond after each other.
struct PolledSource final : FrameSource {
  explicit PolledSource(SharedModel model_given)
      : model(std::move(model_given)), counts(counts_under(*model, press_around(*model, 2, 2))) {}

  Result<bool> next(RawFrame&) override { return failed("nobody waits for this source"); }
  [[nodiscard]] std::optional<Readiness> readiness() const override { return Readiness{}; }
  Result<Polled> poll(RawFrame& frame) override {
    if (delivered == frames) return Polled::end;
    if (delivered > 0 && delivered % at_once == 0 && !std::exchange(has_paused, true)) return Polled::nothing;
    has_paused = false;
    ++delivered;
    frame.time = Nanos(static_cast<std::int64_t>(delivered) * 1'000'000);
    frame.temperature_celsius = kCelsius;
    frame.supply_v = 5.0;
    frame.counts = counts;
    frame.acquisition = {};
    frame.acquisition.arrival_steady = Nanos(std::chrono::hours(1)) + frame.time;
    return Polled::frame;
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override {
    return FrameShape{model->array.rows, model->array.cols};
  }

  SharedModel model;
  std::vector<float> counts;
  std::uint64_t frames = 1000;
  std::uint64_t at_once = 1;
  std::uint64_t delivered = 0;
  bool has_paused = false;
};

TEST(LiveSuit, arrays_that_can_be_polled_share_a_thread_a_core) {
  const SharedModel model = model_of(6, 6);
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  std::vector<LiveArray> arrays;
  for (std::size_t k = 0; k < cores + 2; ++k) {
    arrays.push_back(array_of("a" + std::to_string(k), std::make_unique<PolledSource>(model), model));
  }
  std::mutex mutex;
  std::map<std::thread::id, std::set<std::size_t>> arrays_of_thread;
  LiveOptions options;
  options.on_result = [&](const ArrayResult& result) {
    const std::lock_guard lock(mutex);
    arrays_of_thread[std::this_thread::get_id()].insert(result.array);
  };
  const auto suit = start_suit(std::move(arrays), std::move(options));
  wait_until_ended(*suit);
  EXPECT_EQ(arrays_of_thread.size(), cores);
  for (std::size_t k = 0; k < cores + 2; ++k) {
    EXPECT_EQ(suit->statistics(k).frames, 1000U) << k;
    EXPECT_EQ(suit->statistics(k).skipped, 0U) << k;
  }
}

TEST(LiveSuit, works_off_all_that_has_come_on_the_thread_that_asks_where_there_is_no_other) {
  const SharedModel model = model_of(6, 6);
  auto source = std::make_unique<PolledSource>(model);
  source->at_once = 7;
  Collector collector;
  const auto suit = LiveSuit::create(arrays_of(array_of("a", std::move(source), model)), options_with(collector));
  ASSERT_TRUE(suit) << suit.error().message;
  (*suit)->work();
  EXPECT_EQ(collector.of(0).frames, 7U);
  (*suit)->work();
  EXPECT_EQ(collector.of(0).frames, 14U);
  while (!(*suit)->ended()) (*suit)->work();
  EXPECT_EQ(collector.of(0).frames, 1000U);
  EXPECT_EQ(collector.of(0).thread, std::this_thread::get_id());
  EXPECT_EQ((*suit)->statistics(0).skipped, 0U);
}

TEST(LiveSuit, a_machine_that_does_not_follow_acquires_every_frame_and_finds_contacts_in_the_newest) {
  const SharedModel model = model_of(6, 6);
  auto source = std::make_unique<PolledSource>(model);
  source->at_once = 500;
  std::vector<Nanos> acquired;
  std::vector<Nanos> processed;
  LiveOptions options;
  options.on_frame = [&](std::size_t, const RawFrame& frame) { acquired.push_back(frame.time); };
  options.on_result = [&](const ArrayResult& result) { processed.push_back(result.raw.time); };
  const auto suit = start_suit(arrays_of(array_of("a", std::move(source), model)), std::move(options));
  wait_until_ended(*suit);
  EXPECT_EQ(acquired.size(), 1000U);
  EXPECT_TRUE(std::ranges::is_sorted(acquired));
  EXPECT_TRUE(std::ranges::is_sorted(processed));
  EXPECT_LE(processed.size(), 201U) << "no more wait than those of 100 ms";
  EXPECT_EQ(processed.back(), acquired.back());
  EXPECT_EQ(suit->statistics(0).frames, processed.size());
  EXPECT_EQ(suit->statistics(0).skipped, 1000U - processed.size());
}

/// Can be polled for some frames, and then must be waited for as long.
struct SometimesPolledSource final : FrameSource {
  explicit SometimesPolledSource(std::unique_ptr<ScriptedSource> frames) : source(std::move(frames)) {}

  Result<bool> next(RawFrame& frame) override { return source->next(frame); }
  [[nodiscard]] std::optional<Readiness> readiness() const override {
    return source->delivered / 10 % 2 == 0 ? std::optional(Readiness{}) : std::nullopt;
  }
  Result<Polled> poll(RawFrame& frame) override {
    if (!readiness() || !std::exchange(is_asked_first, !is_asked_first)) return Polled::nothing;
    return FrameSource::poll(frame);
  }
  [[nodiscard]] std::optional<FrameShape> shape() const override { return source->shape(); }

  std::unique_ptr<ScriptedSource> source;
  bool is_asked_first = true;
};

TEST(LiveSuit, a_source_that_must_be_waited_for_meanwhile_holds_no_other_up_and_loses_nothing) {
  const SharedModel model = model_of(6, 6);
  auto source = source_of(model, press_around(*model, 2, 2));
  source->frames = 95;
  std::vector<Nanos> times;
  LiveOptions options;
  options.on_result = [&](const ArrayResult& result) {
    if (result.array == 0) times.push_back(result.raw.time);
  };
  const auto suit =
      start_suit(arrays_of(array_of("sometimes", std::make_unique<SometimesPolledSource>(std::move(source)), model),
                           array_of("polled", std::make_unique<PolledSource>(model), model)),
                 std::move(options));
  wait_until_ended(*suit);
  ASSERT_EQ(times.size(), 95U);
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_EQ(times[k], Nanos(static_cast<std::int64_t>(k) * 1'000'000));
  }
  EXPECT_EQ(suit->statistics(1).frames, 1000U);
}

TEST(LiveSuit, allocates_nothing_after_the_first_frames) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  const SharedModel model = model_of(6, 6);
  std::optional<support::AllocationGuard> guard;
  std::uint64_t frames = 0;
  std::size_t allocations = 0;
  LiveOptions options;
  options.on_result = [&](const ArrayResult&) {
    if (++frames == 10) guard.emplace();
    if (guard) allocations = guard->count();
  };
  const auto suit =
      start_suit(arrays_of(array_of("a", source_of(model, press_around(*model, 2, 2)), model)), std::move(options));
  wait_until_ended(*suit);
  EXPECT_EQ(frames, 50U);
  EXPECT_EQ(allocations, 0U);
}

}  // namespace
}  // namespace dermis::live::suits
