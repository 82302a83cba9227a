// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/force_source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "dermis/bytes/bodies/suit.hpp"
#include "dermis/bytes/files/suit_toml.hpp"

namespace dermis::recognising {
namespace {

using learn::recognition::Layout;

/// The arrays of a recording that holds several, by the models of a suit.
Result<std::vector<ArrayForceInput>> arrays_of_suit(const ForceInput& input, const std::string& example) {
  const Result<SuitDescription> suit = bytes::files::read_suit(input.model);
  if (!suit) {
    return bad_field("model", fmt::format("{} holds several arrays; name one, as '{}#{}', or give the suit.toml: {}",
                                          input.from, input.from, example, suit.error().message));
  }
  std::vector<std::string> names = input.arrays;
  if (names.empty()) {
    for (const SuitArray& array : suit->arrays) names.push_back(array.name);
  }
  std::vector<ArrayForceInput> arrays;
  for (const std::string& name : names) {
    const auto found = std::find_if(suit->arrays.begin(), suit->arrays.end(),
                                    [&](const SuitArray& array) { return array.name == name; });
    if (found == suit->arrays.end()) return bad_input(fmt::format("{}: has no array '{}'", input.model, name));
    arrays.push_back({.from = input.from + "#" + name, .model = found->model, .source = {}, .name = name});
  }
  return arrays;
}

/// The sources to be opened: the one that `from` names, or each array of a recording with several.
Result<std::vector<ArrayForceInput>> arrays_of(const ForceInput& input, const live::sources::SourceName& from) {
  std::vector<ArrayForceInput> arrays = {{.from = input.from, .model = input.model, .source = input.source}};
  arrays.front().tare = input.tare;
  arrays.front().tare_force = input.tare_force;
  if (input.arrays.size() == 1) return arrays;
  const Result<std::vector<std::string>> held = live::sources::several_arrays(from);
  if (!held) return held.error();
  if (held->empty()) return arrays;
  arrays.clear();
  if (input.model.empty()) {
    for (const std::string& name : input.arrays.empty() ? *held : input.arrays) {
      arrays.push_back({.from = input.from + "#" + name, .source = {}, .name = name});
    }
  } else {
    Result<std::vector<ArrayForceInput>> of_suit = arrays_of_suit(input, held->front());
    if (!of_suit) return of_suit.error();
    arrays = *std::move(of_suit);
  }
  for (ArrayForceInput& array : arrays) {
    array.tare = input.tare;
    array.tare_force = input.tare_force;
    array.source = input.source;
    array.source.array = nullptr;
  }
  return arrays;
}

}  // namespace

Status check_loads(const Layout& examples, const std::string& classes, const std::string& model) {
  if (examples.has_forces() && model.empty()) {
    return bad_field("model", "the classes of " + classes + " were learned from forces; name the model of the array");
  }
  if (!examples.has_forces() && !model.empty()) {
    return bad_field("model", "the classes of " + classes +
                                  " were learned from readings, not from forces; leave it out, or learn with a model");
  }
  return Done{};
}

ForceSource::ForceSource(ArrayForces first) : first_(std::move(first)) {}

Result<ForceSource> ForceSource::open(const ForceInput& input) {
  const Result<live::sources::SourceName> from = live::sources::SourceName::parse(input.from);
  if (!from) return from.error();
  const Result<std::vector<ArrayForceInput>> arrays = arrays_of(input, *from);
  if (!arrays) return arrays.error();
  Result<ArrayForces> first = ArrayForces::open(arrays->front());
  if (!first) return first.error();
  ForceSource source(*std::move(first));
  source.from_ = *from;
  for (std::size_t i = 1; i < arrays->size(); ++i) {
    Result<HeldForces> other = HeldForces::open((*arrays)[i]);
    if (!other) return other.error();
    source.others_.push_back(*std::move(other));
  }
  if (input.extra.empty()) return source;
  if (source.is_live()) return bad_field("extra", "'" + input.from + "' is a device; record it first");
  Result<FurtherReadings> further = FurtherReadings::read(input.extra, from->short_name());
  if (!further) return further.error();
  source.further_ = *std::move(further);
  return source;
}

Result<bool> ForceSource::next() {
  Result<bool> more = first_.next();
  if (!more || !*more) return more;
  loads_ = first_.loads();
  for (HeldForces& other : others_) {
    if (Status moved = other.move_to(first_.time()); !moved) return moved.error();
    loads_.insert(loads_.end(), other.loads().begin(), other.loads().end());
  }
  if (further_) further_->move_to(first_.time());
  if (is_tare()) std::fill(loads_.begin(), loads_.end(), 0.0F);
  return true;
}

bool ForceSource::is_tare() const noexcept {
  return first_.is_tare() ||
         std::any_of(others_.begin(), others_.end(), [](const HeldForces& other) { return other.is_tare(); });
}

std::span<const float> ForceSource::extras() const noexcept {
  return further_ ? std::span<const float>(further_->values()) : std::span<const float>();
}

std::vector<std::string> ForceSource::extra_names() const {
  return further_ ? further_->names() : std::vector<std::string>();
}

std::optional<Layout> ForceSource::layout() const {
  const std::optional<learn::recognition::SensedArray> first = first_.array();
  if (!first) return std::nullopt;
  Layout layout{.arrays = {*first}, .readings = first->taxel_count()};
  for (const HeldForces& other : others_) {
    learn::recognition::SensedArray array = other.array();
    array.first_column = layout.readings;
    layout.readings += array.taxel_count();
    layout.arrays.push_back(std::move(array));
  }
  layout.extras = extras().size();
  layout.quantity = first_.quantity();
  return layout;
}

std::vector<std::string> ForceSource::describe_troubles() const {
  std::vector<std::string> lines;
  for (const HeldForces& other : others_) {
    if (other.silent() == 0) continue;
    lines.push_back(fmt::format("{}: {} frames have none of '{}' in the half second before; it has no load there",
                                from_.text, other.silent(), other.array().name));
  }
  if (const auto missing = further_ ? further_->describe_missing() : std::nullopt) lines.push_back(*missing);
  return lines;
}

}  // namespace dermis::recognising
