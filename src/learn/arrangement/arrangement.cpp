// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/arrangement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace dermis::learn::arrangement {
namespace {

constexpr double kAlike = 0.8;  // of the change of the channel that answered
constexpr std::size_t kMostListed = 12;

using Channels = std::vector<std::optional<std::size_t>>;

std::string short_words(const Places& places, std::size_t place) {
  const std::string& name = places.places[place].name;
  return fmt::format("place {}", place + 1) + (name.empty() ? "" : " (" + name + ")");
}

/// "channel 3 never answered", "channels 3, 5 and 8 never answered"
std::string never_answered(const char* what, const std::vector<std::size_t>& numbers) {
  std::string list;
  const std::size_t listed = std::min(numbers.size(), kMostListed);
  for (std::size_t k = 0; k < listed; ++k) {
    const bool is_last = k + 1 == numbers.size();
    list += (k == 0 ? "" : is_last ? " and " : ", ") + std::to_string(numbers[k]);
  }
  if (listed < numbers.size()) list += fmt::format(" and {} more", numbers.size() - listed);
  return fmt::format("{}{} {} never answered", what, numbers.size() > 1 ? "s" : "", list);
}

class Arranging {
 public:
  Arranging(const Places& places, const Answers& answers, FrameShape sent)
      : places_(places), answers_(answers), sent_(sent), place_of_(sent.taxel_count()) {}

  Channels channels() {
    Channels channels(answers_.size());
    for (std::size_t place = 0; place < answers_.size(); ++place) {
      if (!answers_[place]) {
        remarks_.push_back(short_words(places_, place) + " never answered");
        continue;
      }
      if (takes(place, *answers_[place])) channels[place] = answers_[place]->channel;
    }
    return channels;
  }

  /// In their order.
  [[nodiscard]] std::vector<std::size_t> silent_channels() const {
    std::vector<std::size_t> silent;
    for (std::size_t channel = 0; channel < place_of_.size(); ++channel)
      if (!place_of_[channel]) silent.push_back(channel);
    return silent;
  }

  std::vector<std::string> remarks() {
    const std::vector<std::size_t> silent = silent_channels();
    if (!silent.empty()) remarks_.push_back(never_answered("channel", silent));
    return std::move(remarks_);
  }

  void remark(std::string words) { remarks_.push_back(std::move(words)); }

 private:
  /// Whether the channel is that of this place alone so far.
  bool takes(std::size_t place, const Press& press) {
    std::optional<std::size_t>& other = place_of_[press.channel];
    if (other) {
      remarks_.push_back(
          fmt::format("{} and {} are both answered by {}: they share it, or one was pressed twice; it is "
                      "that of the first",
                      short_words(places_, *other), short_words(places_, place), channel_words(press.channel, sent_)));
      return false;
    }
    other = place;
    if (press.second_share > kAlike) {
      remarks_.push_back(
          fmt::format("{} was answered by {}, and nearly as much by {} ({:.0f} %): press it again, on its "
                      "middle, if in doubt",
                      short_words(places_, place), channel_words(press.channel, sent_),
                      channel_words(press.second, sent_), 100.0 * press.second_share));
    }
    return true;
  }

  const Places& places_;
  const Answers& answers_;
  FrameShape sent_;
  std::vector<std::optional<std::size_t>> place_of_;  // of each channel
  std::vector<std::string> remarks_;
};

bool is_in_order(const std::vector<std::size_t>& lines) {
  for (std::size_t k = 0; k < lines.size(); ++k)
    if (lines[k] != k) return false;
  return true;
}

/// Whole lines in another order; empty where that does not give these readings.
std::optional<LineOrder> lines_in_order(const std::vector<std::size_t>& readings, FrameShape array, FrameShape sent,
                                        bool transpose) {
  LineOrder order{.transpose = transpose};
  const auto sent_row = [&](std::size_t taxel) { return readings[taxel] / sent.cols; };
  const auto sent_col = [&](std::size_t taxel) { return readings[taxel] % sent.cols; };
  for (std::size_t row = 0; row < array.rows; ++row)
    order.row_order.push_back(transpose ? sent_col(row * array.cols) : sent_row(row * array.cols));
  for (std::size_t col = 0; col < array.cols; ++col)
    order.col_order.push_back(transpose ? sent_row(col) : sent_col(col));
  if (is_in_order(order.row_order)) order.row_order.clear();
  if (is_in_order(order.col_order)) order.col_order.clear();
  const Result<FrameShape> turned = order.turned(sent);
  const bool fits = order.validate() && turned && *turned == array && order.sent_places(sent) == readings;
  return fits ? std::optional(order) : std::nullopt;
}

LineOrder order_of(const std::vector<std::size_t>& readings, FrameShape array, FrameShape sent) {
  if (readings.size() == sent.taxel_count()) {
    for (const bool transpose : {false, true})
      if (const auto lines = lines_in_order(readings, array, sent, transpose)) return *lines;
  }
  return {.taxel_order = readings, .taxel_rows = array.rows, .taxels_sent = sent};
}

/// The fewest usual bits that hold such a reading.
int bits_for(double most_counts) {
  for (const int bits : {8, 10, 12, 14, 16, 18, 20})
    if (most_counts <= std::exp2(bits) - 1.0) return bits;
  return 24;
}

bool falls(const Answers& answers) {
  std::ptrdiff_t rising = 0;
  for (const std::optional<Press>& answer : answers)
    if (answer) rising += answer->change > 0.0 ? 1 : -1;
  return rising < 0;
}

/// Fills places without a channel with those that are left, so that the grid is whole; they are absent.
void fill_grid(const Channels& channels, std::vector<std::size_t> left, ArrayDescription& array,
               std::vector<std::size_t>& readings) {
  std::reverse(left.begin(), left.end());
  for (std::size_t place = 0; place < channels.size(); ++place) {
    if (!channels[place]) array.absent.push_back(place);
    readings.push_back(channels[place] ? *channels[place] : left.back());
    if (!channels[place]) left.pop_back();
  }
}

}  // namespace

Result<Arrangement> arrange(const Places& places, const Answers& answers, FrameShape sent, double most_counts,
                            const std::string& name) {
  Arranging arranging(places, answers, sent);
  Arrangement made;
  made.channels = arranging.channels();
  const auto answered = static_cast<std::size_t>(std::count_if(
      made.channels.begin(), made.channels.end(), [](const auto& channel) { return channel.has_value(); }));
  if (answered == 0) return bad_input("no channel answered at any place");
  made.array.name = name;
  made.array.row_pitch_m = made.array.col_pitch_m = places.pitch_m;
  made.array.readout.adc_bits = bits_for(most_counts);
  made.array.readout.pressure_raises_reading = !falls(answers);
  const bool is_grid = places.grid && places.places.size() <= sent.taxel_count();
  made.array.readout.circuit = is_grid ? Circuit::automatic : Circuit::none;
  if (places.grid && !is_grid)
    arranging.remark("the board has fewer channels than the grid: its taxels stand in a row");
  std::vector<std::size_t> readings;
  if (is_grid) fill_grid(made.channels, arranging.silent_channels(), made.array, readings);
  for (std::size_t place = 0; place < made.channels.size(); ++place) {
    if (!is_grid && made.channels[place]) readings.push_back(*made.channels[place]);
    if (is_grid || made.channels[place]) made.positions.push_back(places.places[place].position);
  }
  const FrameShape shape = is_grid ? *places.grid : FrameShape{1, readings.size()};
  made.array.rows = shape.rows;
  made.array.cols = shape.cols;
  made.array.order = order_of(readings, shape, sent);
  made.remarks = arranging.remarks();
  if (const Status valid = made.array.validate(); !valid) return valid.error();
  return made;
}

}  // namespace dermis::learn::arrangement
