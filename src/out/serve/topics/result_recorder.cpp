// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "out/serve/parts/part_makers.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/topics/contacts_in_suit.hpp"
#include "out/serve/topics/pace.hpp"

namespace dermis::out::serve {
namespace {

constexpr double kRateHz = 60.0;  // as the page shows them at first

/// Forces and contacts go into the recording, so that it shows them as they were. In them are tare, drift and all that
/// the pipeline knew by then.
class ResultRecorder final : public Part {
 public:
  explicit ResultRecorder(Host& host) : recorder_(host.recorder), models_(host.models) {
    for (std::size_t k = 0; k < host.suit.arrays.size(); ++k) arrays_.emplace_back(host.suit, k);
    for (std::size_t k = 0; k < arrays_.size(); ++k) model_changed(k);
  }

  void model_changed(std::size_t array) override {
    arrays_[array].is_calibrated = !learn::calibration::is_uncalibrated(*models_.of(array));
  }

  void hear(const live::suits::ArrayResult& result) override {
    Array& array = arrays_[result.array];
    if (!recorder_.recording() || !array.is_calibrated) return;
    const bool is_due = array.pace.is_due(result.raw.time, kRateHz);
    if (is_due) write_force(array, result);
    if (is_due || begins_or_ends(result.report)) write_contacts(array, result);
  }

 private:
  /// Used by the thread of the array alone.
  struct Array {
    Array(const ServedSuit& suit, std::size_t index)
        : served(suit.arrays[index]),
          force_topic("/" + served.name + "/force"),
          contacts_topic("/" + served.name + "/contacts"),
          contacts(suit, index) {}

    const ServedArray& served;
    const std::string force_topic;
    const std::string contacts_topic;
    ContactsInSuit contacts;
    std::atomic<bool> is_calibrated = false;
    Pace pace{};
    std::vector<std::uint8_t> message{};
  };

  void write_force(Array& array, const live::suits::ArrayResult& result) {
    const ArrayDescription& description = array.served.model->array;
    bytes::ros_messages::encode_grid(result.force, {description.rows, description.cols},
                                     {description.row_pitch_m, description.col_pitch_m}, array.served.name,
                                     array.message);
    recorder_.write({array.force_topic, bytes::ros_messages::grid_type(), result.raw.time, array.message, true});
  }

  void write_contacts(Array& array, const live::suits::ArrayResult& result) {
    array.contacts.take(result);
    array.contacts.encode(result, array.message);
    recorder_.write({array.contacts_topic, bytes::ros_messages::contacts_type(), result.raw.time, array.message, true});
  }

  SuitRecorder& recorder_;
  const ModelsInUse& models_;
  std::deque<Array> arrays_;
};

}  // namespace

Result<std::unique_ptr<Part>> make_result_recorder(Host& host) {
  return std::unique_ptr<Part>(std::make_unique<ResultRecorder>(host));
}

}  // namespace dermis::out::serve
