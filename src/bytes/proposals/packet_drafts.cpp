// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/packet_drafts.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/checksum_search.hpp"
#include "bytes/proposals/packet_fields.hpp"
#include "bytes/proposals/packet_search.hpp"
#include "bytes/proposals/packet_writer.hpp"
#include "bytes/proposals/period.hpp"
#include "bytes/proposals/shapes.hpp"
#include "bytes/proposals/smoothness.hpp"
#include "bytes/proposals/trial.hpp"
#include "bytes/proposals/value_search.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostLeading = 24;
constexpr std::size_t kMostTrailing = 12;
constexpr std::size_t kMostArrays = 16;
constexpr std::size_t kFewestBytes = 8;  // of a frame without a mark

/// Drafts of one way to cut the bytes into packets.
class CutDrafts {
 public:
  CutDrafts(const Packets& packets, std::span<const std::uint8_t> bytes, const Known& known)
      : packets_(packets), bytes_(bytes), known_(known), checksum_(checksum_of(packets, bytes)) {
    end_ = checksum_ ? checksum_->at : packets.size - packets.end_mark_size;
    const std::size_t leading = std::min(end_, packets.mark_size + kMostLeading);
    fields_ = fields_in(packets, packets.mark_size, leading);
    const std::size_t trailing = std::max(leading, end_ - std::min(end_, kMostTrailing));
    for (PacketField& field : fields_in(packets, trailing, end_)) fields_.push_back(std::move(field));
  }

  std::vector<Draft> all() {
    for (const ValueSpan& span : value_spans(packets_, bytes_, packets_.mark_size, end_, fields_, counts())) {
      const PacketField* const turn = number_in_turn(span);
      if (turn == nullptr) {
        add(span, nullptr, "");
        continue;
      }
      add(span, turn, turn->field);
      add(span, turn, turn->field == "row" ? "array" : "row");
      add_parts(span, *turn);
    }
    return std::move(drafts_);
  }

 private:
  /// How many readings a packet may have: of a frame, of several arrays, of a row.
  [[nodiscard]] std::vector<std::size_t> counts() const {
    if (!known_.rows || !known_.cols) return {};
    std::vector<std::size_t> counts;
    const bool has_frame = checksum_ || !packets_.escape.empty() || mark_size() > 0;
    for (std::size_t arrays = 1; arrays <= (has_frame ? 4U : 1U); ++arrays)
      counts.push_back(arrays * *known_.rows * *known_.cols);
    const bool has_rows =
        std::any_of(fields_.begin(), fields_.end(), [](const PacketField& field) { return !field.numbers.empty(); });
    if (has_rows) counts.push_back(*known_.cols);
    for (const PacketField& field : fields_) {
      const std::size_t taxels = *known_.rows * *known_.cols;
      const std::size_t runs = field.numbers.size();
      if (runs < 2) continue;
      for (std::size_t count = (taxels + runs - 1) / runs; count * (runs - 1) < taxels; ++count)
        counts.push_back(count);
    }
    return counts;
  }

  [[nodiscard]] const PacketField* number_in_turn(const ValueSpan& span) const {
    for (const PacketField& field : fields_) {
      const bool is_outside = field.at + field.size <= span.begin || field.at >= span.end;
      if (is_outside && !field.numbers.empty() && !is_low_byte(field, span)) return &field;
    }
    return nullptr;
  }

  /// Its numbers are all multiples of a step that a byte holds: rather a part of a clock than places in runs of others.
  [[nodiscard]] static bool is_low_byte(const PacketField& field, const ValueSpan& span) {
    const std::uint64_t step = field.numbers[1] - field.numbers[0];
    return step > 1 && step * field.numbers.size() == 256 && field.numbers.back() + step == 256 + field.numbers[0] &&
           span.count % step != 0;
  }

  void add(const ValueSpan& span, const PacketField* turn, const std::string& meaning) {
    if (meaning == "row") return add_rows(span, *turn);
    if (turn != nullptr && turn->numbers.size() > kMostArrays) return;
    const auto shapes = shapes_of({span.count}, span.readings, known_);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const bool are_side_by_side = shapes[k].size() > 1;
      if (are_side_by_side && turn != nullptr) continue;
      Draft draft = begin(span);
      draft.merit +=
          span.merit - 0.1 * static_cast<double>(k) + (turn != nullptr && turn->field == "array" ? 0.1 : 0.0);
      for (const std::uint64_t id : turn != nullptr ? turn->numbers : std::vector<std::uint64_t>()) {
        draft.arrays.push_back({"array_" + std::to_string(id), shapes[k].front(), id});
      }
      for (std::size_t i = 0; are_side_by_side && i < shapes[k].size(); ++i) {
        draft.arrays.push_back({"array_" + std::to_string(i + 1), shapes[k][i]});
      }
      if (draft.arrays.empty()) draft.arrays.push_back({"", shapes[k].front()});
      finish(draft, span, turn, meaning);
    }
  }

  void add_rows(const ValueSpan& span, const PacketField& turn) {
    const FrameShape shape{turn.numbers.size(), span.count};
    if (!is_known(shape, known_) || turn.numbers.front() > 1 ||
        turn.numbers.back() - turn.numbers.front() + 1 != shape.rows)
      return;
    Draft draft = begin(span);
    draft.has_certain_shape = true;
    draft.merit += span.merit + (turn.field == "row" ? 0.2 : 0.0);
    draft.arrays.push_back({"", shape});
    draft.reasons.push_back("byte " + std::to_string(turn.at + 1) + " counts " + std::to_string(shape.rows) + " rows");
    finish(draft, span, &turn, "row");
  }

  /// Runs of taxels, whose numbers are those of their first ones or count the runs. The last may reach beyond the
  /// array.
  void add_parts(ValueSpan span, PacketField turn) {
    const std::size_t runs = turn.numbers.size();
    const std::uint64_t step = turn.numbers[1] - turn.numbers[0];
    for (std::size_t k = 1; k < runs; ++k) {
      if (turn.numbers[k] != turn.numbers[0] + k * step) return;
    }
    const bool do_overlap = step > 1 && step < span.count && span.count % step != 0;
    const std::size_t channels = (runs - 1) * (do_overlap ? step : span.count) + span.count;
    const std::size_t taxels = known_.rows && known_.cols ? *known_.rows * *known_.cols : channels;
    if ((span.count % step != 0 && !do_overlap) || taxels > channels || taxels + span.count <= channels) return;
    const bool are_rows = step == 1 && known_.cols.value_or(span.count) == span.count;
    if (are_rows) return;
    const std::uint64_t factor = do_overlap ? 1 : span.count / step;
    if (factor > 1) turn.options = " *" + std::to_string(factor);
    if (turn.numbers[0] > 0) turn.options += " -" + std::to_string(factor * turn.numbers[0]);
    span.type += " x" + std::to_string(span.count);
    const std::size_t drafts = drafts_.size();
    for (const FrameShape& shape : likely_shapes(readings_of_parts(span, turn, taxels), taxels, known_)) {
      if (drafts_.size() > drafts + 1) break;
      Draft draft = begin(span);
      draft.merit += span.merit + 0.3 - 0.05 * static_cast<double>(drafts_.size() - drafts);
      draft.arrays.push_back({"", shape});
      draft.reasons.push_back("byte " + std::to_string(turn.at + 1) + " tells the first of each " +
                              std::to_string(span.count) + " readings");
      if (do_overlap) draft.reasons.emplace_back("the parts of a frame overlap");
      if (taxels < channels)
        draft.reasons.push_back("the last " + std::to_string(channels - taxels) + " of " + std::to_string(channels) +
                                " readings reach beyond the array");
      finish(draft, span, &turn, "first");
    }
  }

  [[nodiscard]] Readings readings_of_parts(const ValueSpan& span, const PacketField& turn, std::size_t taxels) {
    Draft draft{.arrays = {{"", {1, taxels}}}};
    PacketWriter(packets_, span, checksum_ ? &*checksum_ : nullptr, draft).write(fields_beside(span), &turn, "first");
    const std::optional<Trial> trial = try_layout(toml_of(draft), bytes_);
    return trial ? trial->readings : Readings();
  }

  [[nodiscard]] Draft begin(const ValueSpan& span) const {
    Draft draft;
    draft.look = std::to_string(packets_.packets.size()) + " packets of " + std::to_string(packets_.size) +
                 " bytes, each with " + std::to_string(span.count) + " readings of " + span.type;
    if (!packets_.escape.empty()) {
      draft.keys.emplace_back("escape", files::quoted_toml(packets_.escape));
      draft.reasons.push_back("between two delimiters stand as many bytes each, once their escapes (" +
                              packets_.escape + ") are undone");
      draft.merit += 0.5;
      if (packets_.escape.find('=') != std::string::npos)
        draft.doubts.emplace_back("the bytes that the codes of the escape stand for are those that fit best");
    } else if (mark_size() > 0) {
      const std::span<const std::uint8_t> packet = packets_.packets.front();
      draft.reasons.push_back(
          layouts::hexadecimal(packets_.mark_size > 0 ? packet.first(mark_size()) : packet.last(mark_size())) +
          (packets_.mark_size > 0 ? " comes every " : " ends every ") + std::to_string(packets_.size) + " bytes");
    } else {
      draft.merit -= 0.3;
      draft.reasons.push_back("each " + std::to_string(packets_.size) + " bytes are like those before them");
      draft.doubts.emplace_back("nothing marks where a frame begins: the first byte is taken for the first of a frame");
    }
    if (are_of_seven_bits(span))
      draft.doubts.emplace_back(
          "no byte of the readings has its highest bit: they may be of 7 bits each, "
          "which a layout cannot say");
    if (const std::size_t count = unexplained_beside(span); count > 0)
      draft.doubts.push_back("bytes beside the readings change, and nothing explains them (" + std::to_string(count) +
                             " of a packet): the readings may begin elsewhere, or others stand there");
    draft.is_weak = !checksum_ && packets_.escape.empty() && mark_size() < 2;
    if (!checksum_) return draft;
    draft.reasons.push_back("the " + checksum_->entry + " is right");
    draft.merit += 1.0;
    return draft;
  }

  /// Bytes that change, and are neither readings nor another field.
  [[nodiscard]] std::size_t unexplained_beside(const ValueSpan& span) const {
    std::size_t count = 0;
    for (std::size_t at = packets_.mark_size; at < end_; ++at) {
      const auto holds = [&](const PacketField& field) { return at >= field.at && at < field.at + field.size; };
      const bool is_known = (at >= span.begin && at < span.end) || std::ranges::any_of(fields_, holds);
      count += is_known || is_constant(packets_, at) ? 0 : 1;
    }
    return count;
  }

  /// Both bytes of each reading stay below 128, and both change.
  [[nodiscard]] bool are_of_seven_bits(const ValueSpan& span) const {
    if (!span.type.starts_with("u16")) return false;
    std::array<std::uint8_t, 2> most{};
    std::array<std::uint8_t, 2> least{255, 255};
    for (const Bytes& packet : packets_.packets) {
      for (std::size_t at = span.begin; at < span.end; ++at) {
        const std::size_t half = (at - span.begin) % 2;
        most[half] = std::max(most[half], packet[at]);
        least[half] = std::min(least[half], packet[at]);
      }
    }
    const auto [smaller, larger] = std::minmax(most[0], most[1]);
    return larger < 128 && larger > 119 && smaller > 1 && least[0] < most[0] && least[1] < most[1];
  }

  [[nodiscard]] std::size_t mark_size() const { return std::max(packets_.mark_size, packets_.end_mark_size); }

  /// The fields that stand outside the readings, with the type and place that they have there.
  [[nodiscard]] std::vector<PacketField> fields_beside(const ValueSpan& span) const {
    std::vector<PacketField> beside;
    for (const PacketField& field : fields_) {
      const bool is_outside = field.at + field.size <= span.begin || field.at >= span.end;
      if (is_outside && (beside.empty() || field.at >= beside.back().at + beside.back().size)) beside.push_back(field);
    }
    return beside;
  }

  void finish(Draft& draft, const ValueSpan& span, const PacketField* turn, const std::string& meaning) {
    draft.is_weak = draft.is_weak && turn == nullptr;
    PacketWriter(packets_, span, checksum_ ? &*checksum_ : nullptr, draft).write(fields_beside(span), turn, meaning);
    drafts_.push_back(std::move(draft));
  }

  const Packets& packets_;
  std::span<const std::uint8_t> bytes_;
  const Known& known_;
  std::optional<FoundChecksum> checksum_;
  std::size_t end_ = 0;  // of the bytes before the checksum
  std::vector<PacketField> fields_;
  std::vector<Draft> drafts_;
};

/// Sizes of frames that are nothing but readings.
std::vector<std::size_t> sizes_without_mark(std::span<const std::uint8_t> bytes, const Known& known) {
  const std::size_t taxels = known.rows.value_or(0) * known.cols.value_or(0);
  std::vector<std::size_t> sizes;
  if (taxels > 1) sizes = {taxels, 2 * taxels, 4 * taxels};
  const std::vector<float> numbers(bytes.begin(), bytes.end());
  const std::size_t period = period_of(numbers, kFewestBytes);
  if (period > 0 && std::ranges::find(sizes, period) == sizes.end()) sizes.push_back(period);
  return sizes;
}

}  // namespace

std::vector<Draft> packet_drafts(std::span<const std::uint8_t> bytes, const Known& known) {
  std::vector<Draft> drafts;
  for (const Packets& packets : packets_in(bytes, sizes_without_mark(bytes, known))) {
    for (Draft& draft : CutDrafts(packets, bytes, known).all()) drafts.push_back(std::move(draft));
  }
  return drafts;
}

}  // namespace dermis::bytes::proposals
