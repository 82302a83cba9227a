// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <array>
#include <string_view>

#include "dermis/live/buses/can_map.hpp"

namespace dermis::live::buses {
namespace {

/// Hands of LinkerHand. The API reference of its SDKs (linker-bot, 2025 and 2026) makes sizes sure. A finger has 12 x 6
/// taxels, that of an O6 10 x 4. Values are bytes. No document says the identifiers, the questions and the places of
/// rows. They are those that the public SDKs use on the bus. Not sure is which end of a finger is row 0. One SDK alone
/// reads matrices of 23 x 9 and 28 x 20. No hand was on our desks.
struct Finger {
  std::string_view name;
  std::string_view command;
};
constexpr std::array<Finger, 5> kFingers{
    {{"thumb", "B1"}, {"index", "B2"}, {"middle", "B3"}, {"ring", "B4"}, {"little", "B5"}}};

struct Hand {
  std::string_view name;
  std::string_view finger;   ///< The keys of a finger.
  std::string_view request;  ///< Behind its command.
  std::string_view palm;     ///< The keys of the palm; empty: it has none.
};
constexpr std::array<Hand, 3> kHands{
    {{"linkerhand-12x6", "rows = 12\ncols = 6\nrow = \"high nibble 1\"\n", " C6", ""},
     {"linkerhand-10x4", "rows = 10\ncols = 4\nrow = \"high nibble 1\"\n", " A4", ""},
     {"linkerhand-23x9", "rows = 23\ncols = 9\nrow = \"byte 1\"\ncol = \"byte 2\"\n", " 17 09 01",
      "name = \"palm\"\nbegins = \"B6\"\nrequest = \"B6 1C 14 01\"\n"
      "rows = 28\ncols = 20\nrow = \"byte 1\"\ncol = \"byte 2\"\n"}}};

struct Side {
  std::string_view name;
  std::string_view id;
};
constexpr std::array<Side, 2> kSides{{{"-right", "0x27"}, {"-left", "0x28"}}};

/// `name = "thumb"`, `begins = "B1"` and so on.
std::string keys_of(const Hand& hand, const Finger& finger) {
  const std::string command(finger.command);
  std::string keys = "name = \"" + std::string(finger.name) + "\"\n";
  keys.append("begins = \"" + command + "\"\n");
  keys.append("request = \"" + command + std::string(hand.request) + "\"\n");
  return keys.append(hand.finger);
}

std::string map_of(const Hand& hand, const Side& side) {
  const std::string head = "[[can.array]]\nid = " + std::string(side.id) + "\n";
  std::string map;
  for (const Finger& finger : kFingers) map.append(head).append(keys_of(hand, finger));
  return hand.palm.empty() ? map : map.append(head).append(hand.palm);
}

}  // namespace

std::vector<std::string> known_can_maps() {
  std::vector<std::string> names;
  for (const Hand& hand : kHands) {
    for (const Side& side : kSides) names.push_back(std::string(hand.name) + std::string(side.name));
  }
  return names;
}

std::string known_can_map(const std::string& name) {
  for (const Hand& hand : kHands) {
    for (const Side& side : kSides) {
      if (name == std::string(hand.name) + std::string(side.name)) return map_of(hand, side);
    }
  }
  return {};
}

}  // namespace dermis::live::buses
