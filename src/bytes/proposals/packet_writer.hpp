// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bytes/proposals/checksum_search.hpp"
#include "bytes/proposals/draft.hpp"
#include "bytes/proposals/packet_fields.hpp"
#include "bytes/proposals/packet_search.hpp"
#include "bytes/proposals/value_search.hpp"

namespace dermis::bytes::proposals {

/// Writes the packet of a draft whose arrays are known.
class PacketWriter {
 public:
  /// `checksum`: null where there is none.
  PacketWriter(const Packets& packets, const ValueSpan& span, const FoundChecksum* checksum, Draft& draft)
      : packets_(packets), span_(span), checksum_(checksum), draft_(draft) {}

  /// `fields`: those beside the readings, in order. `turn`: that of them which is an array or a row, as `meaning` says;
  /// null: none is.
  void write(const std::vector<PacketField>& fields, const PacketField* turn, const std::string& meaning);

 private:
  void add(const std::string& entry, std::size_t size, layouts::Role role);
  void add_constant(std::size_t end);
  void add_values(bool are_named);
  void add_field(const PacketField& field, const std::string& name);
  void add_trailer();

  const Packets& packets_;
  const ValueSpan& span_;
  const FoundChecksum* checksum_;
  Draft& draft_;
  std::size_t at_ = 0;
};

}  // namespace dermis::bytes::proposals
