// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::out::datasets {

/// Writes structures in Thrift's compact protocol, which describes the parts of a Parquet file. Fields of a structure
/// come by rising numbers.
class CompactThrift {
 public:
  enum class Type : std::uint8_t { i32 = 5, i64 = 6, text = 8, list = 9, structure = 12 };

  void field(std::int16_t number, std::int32_t value);
  void field(std::int16_t number, std::int64_t value);
  void field(std::int16_t number, std::string_view text);

  /// A structure as a field; end_structure() ends it.
  void begin_structure(std::int16_t number);
  /// A structure as the element of a list.
  void begin_element();
  void end_structure();

  /// So many elements of this type follow.
  void begin_list(std::int16_t number, Type type, std::size_t size);
  void element(std::int32_t value);
  void element(std::string_view text);

  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  void header(std::int16_t number, Type type);
  void put(std::uint64_t varint);
  void put_signed(std::int64_t value);
  void put_text(std::string_view text);

  std::string bytes_;
  std::vector<std::int16_t> last_field_ = {0};  ///< Of the structures that are open.
};

}  // namespace dermis::out::datasets
