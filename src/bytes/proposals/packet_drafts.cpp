// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/packet_drafts.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "bytes/proposals/byte_text.hpp"
#include "bytes/proposals/checksum_search.hpp"
#include "bytes/proposals/packet_fields.hpp"
#include "bytes/proposals/packet_search.hpp"
#include "bytes/proposals/packet_writer.hpp"
#include "bytes/proposals/shapes.hpp"
#include "bytes/proposals/value_search.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kMostLeading = 24;
constexpr std::size_t kMostTrailing = 12;
constexpr std::size_t kMostArrays = 16;

/// Drafts of one way to cut the bytes into packets.
class CutDrafts {
 public:
  CutDrafts(const Packets& packets, std::span<const std::uint8_t> bytes, const Known& known)
      : packets_(packets), bytes_(bytes), known_(known), checksum_(checksum_of(packets, bytes)) {
    end_ = checksum_ ? checksum_->at : packets.size;
    const std::size_t leading = std::min(end_, packets.mark_size + kMostLeading);
    fields_ = fields_in(packets, packets.mark_size, leading);
    if (end_ > leading + kMostTrailing) {
      for (PacketField& field : fields_in(packets, end_ - kMostTrailing, end_)) fields_.push_back(std::move(field));
    }
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
    }
    return std::move(drafts_);
  }

 private:
  /// How many readings a packet may have: of a frame, of several arrays, of a row.
  [[nodiscard]] std::vector<std::size_t> counts() const {
    if (!known_.rows || !known_.cols) return {};
    std::vector<std::size_t> counts;
    for (std::size_t arrays = 1; arrays <= 4; ++arrays) counts.push_back(arrays * *known_.rows * *known_.cols);
    const bool has_rows =
        std::any_of(fields_.begin(), fields_.end(), [](const PacketField& field) { return !field.numbers.empty(); });
    if (has_rows) counts.push_back(*known_.cols);
    return counts;
  }

  [[nodiscard]] const PacketField* number_in_turn(const ValueSpan& span) const {
    for (const PacketField& field : fields_) {
      if (!field.numbers.empty() && (field.at + field.size <= span.begin || field.at >= span.end)) return &field;
    }
    return nullptr;
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

  [[nodiscard]] Draft begin(const ValueSpan& span) const {
    Draft draft;
    draft.look = std::to_string(packets_.packets.size()) + " packets of " + std::to_string(packets_.size) +
                 " bytes, each with " + std::to_string(span.count) + " readings of " + span.type;
    if (!packets_.escape.empty()) {
      draft.keys.emplace_back("escape", files::quoted_toml(packets_.escape));
      draft.reasons.push_back("between two delimiters stand as many bytes each, once their escapes (" +
                              packets_.escape + ") are undone");
      draft.merit += 0.5;
    } else {
      draft.reasons.push_back(layouts::hexadecimal(std::span(packets_.packets.front()).first(packets_.mark_size)) +
                              " comes every " + std::to_string(packets_.size) + " bytes");
    }
    draft.is_weak = !checksum_ && packets_.escape.empty() && packets_.mark_size < 2;
    if (!checksum_) return draft;
    draft.reasons.push_back("the " + checksum_->entry + " is right");
    draft.merit += 1.0;
    return draft;
  }

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

}  // namespace

std::vector<Draft> packet_drafts(std::span<const std::uint8_t> bytes, const Known& known) {
  std::vector<Draft> drafts;
  for (const Packets& packets : packets_in(bytes)) {
    for (Draft& draft : CutDrafts(packets, bytes, known).all()) drafts.push_back(std::move(draft));
  }
  return drafts;
}

}  // namespace dermis::bytes::proposals
