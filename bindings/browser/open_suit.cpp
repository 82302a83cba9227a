// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// open_suit() for a page: one array in a grid, at the board or the simulator.
#include <memory>
#include <utility>

#include "dermis/out/serve/served_suit.hpp"
#include "out/serve/suit/model_or_array.hpp"

namespace dermis::out::serve {

Result<ServedSuit> open_suit(const SuitPlace& place, live::sources::SourceOptions options) {
  if (place.model.empty()) return bad_input("a page cannot serve places in no grid; the command dermis can");
  Result<ModelOrArray> read = read_model_or_array(place.model);
  if (!read) return read.error();
  options.array = &read->array;
  options.guide = std::make_shared<live::sources::GuideVoice>();
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(place.from, options);
  if (!source) return source.error();
  Result<ServedSuit> suit = suit_of_one(*std::move(source), std::move(read->model));
  if (!suit) return suit;
  suit->guide = options.guide;
  ServedArray& array = suit->arrays.front();
  array.description = std::move(read->array);
  array.model_path = place.model;
  array.from = place.from;
  return suit;
}

}  // namespace dermis::out::serve
