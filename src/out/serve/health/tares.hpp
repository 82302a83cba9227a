// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/health/kept_zero.hpp"
#include "out/serve/parts/part.hpp"

namespace dermis::out::serve {

/// The zeros of the arrays, as clients set them by the parameters of docs/stream.md.
class Tares final : public Part {
 public:
  static constexpr std::size_t kMostLines = 20;

  /// Gets the lines of follow(), where there are some.
  using Notify = std::function<void(const std::vector<std::string>& lines)>;

  /// Gets the line of each change of a zero; not of a tare that was refused.
  using Changed = std::function<void(const std::string& line)>;

  /// `suit` and `live` must outlive it.
  Tares(const ServedSuit& suit, live::suits::LiveSuit& live, Notify notify = {}, Changed changed = {});

  /// "/tare", "/tare/force", ... and "/chest/tare" of each array.
  [[nodiscard]] std::vector<LiveParameter> parameters() override;
  /// Arrays begin at the zeros that were kept of them.
  [[nodiscard]] Status prepare() override;
  void tick(std::int64_t tick) override;
  /// It begins at its own zero.
  void model_changed(std::size_t array) override;

  /// Changes of zeros by clients that are done, a line each: "2026-11-22 10:15:00 UTC: chest was tared by
  /// 127.0.0.1:53412". Call it again and again.
  [[nodiscard]] std::vector<std::string> follow();

 private:
  using Clock = std::chrono::steady_clock;

  struct Zero {
    bool is_tared = false;                   // or is to be
    bool was_tared = false;                  // before the last tare was asked for
    std::uint64_t seen = 0;                  // Tare::number of the last that has ended, 0 while one is taken
    std::string client;                      // who asked for the last; empty: it has ended
    std::string refusal;                     // of the last; empty: it was not refused
    Clock::time_point refused;               // when that was
    std::optional<Clock::time_point> taken;  // by the last, which was not undone
  };

  [[nodiscard]] LiveParameter tare_of(const std::string& name, std::size_t first, std::size_t end);
  [[nodiscard]] std::string refusals() const;
  void tare(std::size_t array, touch::pipeline::TareOver over, const std::string& client);
  void force(const std::string& client);
  void reset(std::size_t array, const std::string& client);
  void undo(const std::string& client);
  void end(std::size_t array, const touch::pipeline::Tare& tare);
  enum class Outcome : std::uint8_t { changed, refused };
  void log(const std::string& what, Outcome outcome = Outcome::changed);
  [[nodiscard]] static bool is_taken(const Zero& zero);
  [[nodiscard]] static bool can_be_undone(const Zero& zero);

  const ServedSuit& suit_;
  live::suits::LiveSuit& live_;
  const Notify notify_;
  const Changed changed_;
  mutable std::mutex mutex_;       // of the following
  std::vector<Zero> zeros_;        // of each array
  std::vector<KeptZero> kept_;     // the same, in its folder
  std::deque<std::string> log_;    // the newest first
  std::vector<std::string> news_;  // that follow() has not returned yet
};

}  // namespace dermis::out::serve
