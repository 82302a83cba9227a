// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/bodies/suit.hpp"

#include <algorithm>
#include <set>
#include <string_view>

namespace dermis {
namespace {

constexpr std::size_t kMostArrays = 256;
constexpr std::size_t kLongestName = 64;
constexpr std::string_view kSuitFrame = "suit";  // the frame in which all arrays sit

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_name_character(char c) {
  return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
}

Status check_name(const std::string& name) {
  const bool is_name = !name.empty() && name.size() <= kLongestName && is_letter(name.front()) &&
                       std::all_of(name.begin(), name.end(), is_name_character);
  if (!is_name) return bad_input("name: must be a letter, then up to 63 letters, digits or '_'");
  if (name == kSuitFrame) return bad_input("name: 'suit' is the name of the whole; take another");
  return Done{};
}

Status check_array(const SuitArray& array) {
  if (Status name = check_name(array.name); !name) return name;
  if (array.from.empty()) return bad_input("from: must be a device, a simulation or a file of frames");
  if (array.model.empty()) return bad_input("model: must be the path of a model file");
  return validate(array.shape, array.base_from_array);
}

}  // namespace

Status SuitDescription::validate() const {
  if (!(body_scale > 0.0)) return bad_input("body_scale: must be more than 0");
  if (arrays.empty() || arrays.size() > kMostArrays) return bad_input("array: must be 1 to 256 arrays");
  std::set<std::string_view> names;
  for (const SuitArray& array : arrays) {
    const std::string place = "array '" + array.name + "': ";
    if (const Status valid = check_array(array); !valid) return bad_input(place + valid.error().message);
    if (!array.link.empty() && body.empty()) return bad_input(place + "link: needs the body of the suit");
    if (!names.insert(array.name).second) return bad_input(place + "name: is taken by another array");
  }
  return Done{};
}

}  // namespace dermis
