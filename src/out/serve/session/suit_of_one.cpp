// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cctype>
#include <utility>

#include "dermis/out/serve/served_suit.hpp"
#include "out/serve/session/topic_name.hpp"

namespace dermis::out::serve {

std::string topic_name(const std::string& name) {
  std::string topic;
  for (const char letter : name) {
    topic += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  }
  const bool begins_with_letter = !topic.empty() && std::isalpha(static_cast<unsigned char>(topic.front())) != 0;
  return begins_with_letter ? topic : "array_" + topic;
}

Result<ServedSuit> suit_of_one(std::unique_ptr<FrameSource> source, touch::pipeline::Model model) {
  Result<ArraySurface> surface = ArraySurface::create(model.array);
  if (!surface) return surface.error();
  ArrayDescription description = model.array;
  std::string name = topic_name(description.name);
  ServedSuit suit;
  suit.arrays.push_back({.name = std::move(name),
                         .source = std::move(source),
                         .model = std::make_shared<const touch::pipeline::Model>(std::move(model)),
                         .surface = *std::move(surface),
                         .description = std::move(description)});
  return suit;
}

}  // namespace dermis::out::serve
