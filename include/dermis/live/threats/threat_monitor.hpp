// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "dermis/live/threats/threat_limits.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::threats {

/// The window of force_rate.
inline constexpr Nanos kRateWindow = std::chrono::milliseconds(30);

/// A value is beyond a limit only where so many standard deviations less still are.
inline constexpr double kThreatSigmas = 2.0;

/// A value that is compared with a limit.
struct ThreatValue {
  double value = 0.0;      ///< In the unit of the quantity.
  double sigma = 0.0;      ///< Standard deviation; 0 where `value` is a lower bound (a taxel is saturated).
  PlaneVector position{};  ///< Where, in the plane of the array: of the contact, the taxel, the centre of pressure [m].
  std::uint32_t contact = 0;  ///< Id of the contact; 0 where it is of none.

  /// The least value within the uncertainty.
  [[nodiscard]] double least() const noexcept { return value - kThreatSigmas * sigma; }

  bool operator==(const ThreatValue&) const = default;
};

/// "contact force 25.1 ± 0.3 N, limit 20, at x 12.0 mm, y 40.0 mm": for logs; pressures in kPa.
[[nodiscard]] std::string describe(const ThreatLimit& limit, const ThreatValue& value);

enum class ThreatPhase : std::uint8_t {
  clear,     ///< Below the limit.
  crossed,   ///< Beyond it, not yet as long as it must last.
  standing,  ///< A threat.
};

/// How one limit stands in one array.
struct ThreatState {
  std::size_t limit = 0;  ///< Place in ThreatLimits::limits.
  ThreatPhase phase = ThreatPhase::clear;
  bool changed = false;  ///< The threat began or ended with the last frame.
  Nanos crossed{};       ///< Time of the first frame beyond the limit, by the clock of the sensor.
  ThreatValue now{};     ///< Of the last frame,
  ThreatValue worst{};   ///< and the largest since it was crossed.
};

/// Holds the forces of one array against limits, frame by frame. Taxels without force (dead, on faulty lines) cannot
/// threaten: who relies on it looks at the status of the frame, too. Not thread-safe: one per stream of frames.
class ThreatMonitor {
 public:
  /// For the array of that name: the limits without a zone and those of zones on it. Fails where a pressure is limited
  /// and the array does not tell the area of its taxels, or where a zone lies outside of it. `limits` must be valid.
  [[nodiscard]] static Result<ThreatMonitor> create(const ThreatLimits& limits, std::string_view name,
                                                    const ArrayDescription& array);
  ThreatMonitor(ThreatMonitor&&) noexcept;
  ThreatMonitor& operator=(ThreatMonitor&&) noexcept;
  ~ThreatMonitor();

  /// `report` is what touch::contacts::ContactTracker made of the frame. A frame that is rejected changes nothing.
  /// Whether a threat began or ended. Never allocates.
  bool process(const ForceFrame& force, const ContactReport& report) noexcept;

  /// One for each limit that concerns this array, in their order.
  [[nodiscard]] std::span<const ThreatState> states() const noexcept;

  /// Ends the threats that are latched; they come back where the limit is still exceeded.
  void reset() noexcept;

 private:
  class Implementation;
  explicit ThreatMonitor(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::threats
