// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/hum_meter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kMostPlaces = 64;
constexpr std::size_t kFirstBin = 4;   // below it are touches, and what drifts
constexpr double kAboveFloor = 25.0;   // squares of amplitudes: noise reaches 10 in a taxel, less in the middle of many
constexpr double kPure = 0.6;          // of all that stands above the floor is in one line
constexpr double kClear = 4.0;         // times the floor: it stands above
constexpr std::size_t kWidth = 2;      // bins on each side of a line
constexpr double kFewestCounts = 1.0;  // amplitude
constexpr double kSameBin = 0.4;       // from window to window: the rhythm of a hand changes more
constexpr double kNearMains = 1.5;     // bins
constexpr double kAgree = 0.75;        // of the windows that show hum are of one frequency,
constexpr double kFewestShow = 0.3;    // and so many of all: touches hide it in others
constexpr double kValley = 0.25;       // of the line: readings that drift fall off without one
constexpr std::size_t kClearBin = 8;   // from here on the lowest bins do not reach
constexpr double kSlowestHz = 5.0;     // frames a second
constexpr double kMainsHz[] = {50.0, 60.0, 100.0, 120.0, 150.0, 180.0};

double median(std::vector<double> values) {
  return values.empty() ? 0.0 : upper_median(std::move(values));
}

/// Where a frequency shows at this rate, 0 to half of it.
double alias(double hz, double rate_hz) {
  return std::abs(hz - std::round(hz / rate_hz) * rate_hz);
}

}  // namespace

HumMeter::HumMeter(std::size_t taxels)
    : stride_((taxels + kMostPlaces - 1) / kMostPlaces), places_((taxels + stride_ - 1) / stride_) {}

void HumMeter::add(std::span<const float> counts, Nanos time) {
  std::vector<float>& frame = window_.emplace_back(places_);
  for (std::size_t place = 0; place < places_; ++place) frame[place] = counts[place * stride_];
  times_s_.push_back(std::chrono::duration<double>(time).count());
  if (window_.size() < kFrames) return;
  judge_window();
  window_.clear();
  times_s_.clear();
}

/// The half that moves least: what is pressed tells nothing.
std::vector<std::size_t> HumMeter::quiet_places() const {
  std::vector<std::size_t> places;
  std::vector<float> range(places_);
  for (std::size_t place = 0; place < places_; ++place) {
    float least = window_.front()[place];
    float most = least;
    for (const std::vector<float>& frame : window_) {
      least = std::min(least, frame[place]);
      most = std::max(most, frame[place]);
    }
    range[place] = most - least;
    if (range[place] > 0.0F) places.push_back(place);
  }
  std::sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) { return range[a] < range[b]; });
  if (2 * places.size() < places_) return {};  // a readout that cuts off what is at rest
  places.resize((places.size() + 1) / 2);
  return places;
}

/// The middle of the taxels' squared amplitudes at each frequency, by a Hann window.
HumMeter::Spectrum HumMeter::spectrum(const std::vector<std::size_t>& places) const {
  constexpr double kTurn = 2.0 * std::numbers::pi / kFrames;
  std::array<std::complex<double>, kFrames> turns;
  for (std::size_t k = 0; k < kFrames; ++k) turns[k] = std::polar(1.0, kTurn * static_cast<double>(k));
  std::vector<std::vector<double>> squares(kBins);
  for (const std::size_t place : places) {
    std::array<double, kFrames> weighted{};
    double mean = 0.0;
    for (const std::vector<float>& frame : window_) mean += static_cast<double>(frame[place]) / kFrames;
    for (std::size_t k = 0; k < kFrames; ++k) {
      weighted[k] = (1.0 - turns[k].real()) * (static_cast<double>(window_[k][place]) - mean);
    }
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      std::complex<double> sum;
      for (std::size_t k = 0; k < kFrames; ++k) sum += weighted[k] * turns[bin * k % kFrames];
      const double amplitude = (2 * bin == kFrames ? 1.0 : 2.0) / kFrames * std::abs(sum);
      squares[bin].push_back(amplitude * amplitude);
    }
  }
  Spectrum middle{};
  for (std::size_t bin = 1; bin < kBins; ++bin) middle[bin] = median(squares[bin]);
  return middle;
}

void HumMeter::judge_window() {
  ++windows_;
  const double seconds = times_s_.back() - times_s_.front();
  const double rate_hz = seconds > 0.0 ? (kFrames - 1) / seconds : 0.0;
  const std::vector<std::size_t> places = quiet_places();
  if (places.empty() || rate_hz < kSlowestHz) return;
  const Spectrum squares = spectrum(places);
  const auto first = squares.begin() + kFirstBin;
  const double floor = median({first, squares.end()});
  const auto peak = std::max_element(first, squares.end());
  if (*peak < kFewestCounts * kFewestCounts || *peak < kAboveFloor * floor) return;
  if (!is_line(squares, static_cast<std::size_t>(peak - squares.begin()), floor)) return;
  const double lower = std::sqrt(peak[-1]);
  const double upper = peak + 1 < squares.end() ? std::sqrt(peak[1]) : 0.0;
  const double height = std::sqrt(*peak);
  const double off = 0.5 * (upper - lower) / (2.0 * height - lower - upper);
  count(static_cast<double>(peak - squares.begin()) + off, height, rate_hz);
}

/// It stands alone, and clear of the lowest frequencies.
bool HumMeter::is_line(const Spectrum& squares, std::size_t peak, double floor) {
  const auto at = squares.begin() + static_cast<std::ptrdiff_t>(peak);
  if (*std::min_element(at - 3, at) > kValley * *at) return false;
  const auto above = [&](double sum, double square) { return sum + (square > kClear * floor ? square : 0.0); };
  const double of_line = std::accumulate(at - kWidth, std::min(squares.end(), at + kWidth + 1), 0.0, above);
  const std::size_t from = peak < kClearBin ? 1 : kFirstBin;
  return of_line >=
         kPure * std::accumulate(squares.begin() + static_cast<std::ptrdiff_t>(from), squares.end(), 0.0, above);
}

void HumMeter::count(double bin, double counts, double rate_hz) {
  const auto known = std::find_if(hums_.begin(), hums_.end(), [&](const Hum& hum) {
    return std::abs(hum.bin / static_cast<double>(hum.windows) - bin) <= kSameBin;
  });
  Hum& hum = known == hums_.end() ? hums_.emplace_back() : *known;
  ++hum.windows;
  hum.bin += bin;
  hum.counts += counts;
  hum.rate_hz += rate_hz;
}

std::optional<std::string> HumMeter::finding() const {
  const auto most =
      std::max_element(hums_.begin(), hums_.end(), [](const Hum& a, const Hum& b) { return a.windows < b.windows; });
  if (most == hums_.end()) return std::nullopt;
  const auto windows = static_cast<double>(most->windows);
  const auto shown = static_cast<double>(std::accumulate(
      hums_.begin(), hums_.end(), std::size_t{0}, [](std::size_t sum, const Hum& hum) { return sum + hum.windows; }));
  if (most->windows == 1 && most->bin < static_cast<double>(kClearBin)) return std::nullopt;
  if (windows < kAgree * shown || windows < kFewestShow * static_cast<double>(windows_)) return std::nullopt;
  const double rate_hz = most->rate_hz / windows;
  const double hz = most->bin / windows * rate_hz / kFrames;
  std::string mains;
  for (const double of_mains : kMainsHz) {
    const bool is_it = std::abs(alias(of_mains, rate_hz) - hz) < kNearMains * rate_hz / kFrames;
    if (is_it && mains.empty())
      mains = fmt::format(" ({:.0f} Hz of the mains, as {:.1f} frames a second show it)", of_mains, rate_hz);
  }
  return fmt::format(
      "hum of {:.1f} counts at {:.2f} Hz{} in most taxels, touched or not: a laptop's charger is the usual cause; pull "
      "it out, or ground the electronics",
      most->counts / windows, hz, mains);
}

}  // namespace dermis::learn::health
