// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/parts/part_list.hpp"

#include <iterator>
#include <ranges>
#include <utility>

namespace dermis::out::serve {

void PartList::add(std::unique_ptr<Part> part) {
  std::ranges::move(part->parameters(), std::back_inserter(parameters_));
  parts_.push_back(std::move(part));
}

Status PartList::prepare() {
  for (const auto& part : parts_) {
    if (Status prepared = part->prepare(); !prepared) return prepared;
  }
  return Done{};
}

void PartList::keep(std::size_t array, const RawFrame& frame) const {
  for (const auto& part : parts_) part->keep(array, frame);
}

void PartList::hear(const live::suits::ArrayResult& result) const {
  for (const auto& part : parts_) part->hear(result);
}

void PartList::tick(std::int64_t tick) const {
  for (const auto& part : parts_) part->tick(tick);
}

void PartList::model_changed(std::size_t array) const {
  for (const auto& part : parts_) part->model_changed(array);
}

Status PartList::use_classes(std::size_t array, const learn::recognition::Classes& classes) const {
  for (const auto& part : parts_) {
    if (Status used = part->use_classes(array, classes); !used) return used;
  }
  return Done{};
}

std::vector<bytes::ros_messages::Diagnosis> PartList::diagnoses() const {
  std::vector<bytes::ros_messages::Diagnosis> diagnoses;
  for (const auto& part : std::views::reverse(parts_)) part->diagnose(diagnoses);
  return diagnoses;
}

void PartList::report(live::fleet::RobotHealth& health) const {
  for (const auto& part : parts_) part->report(health);
}

void PartList::finish() const {
  for (const auto& part : parts_) part->finish();
}

std::vector<websocket::Service> PartList::services() const {
  std::vector<websocket::Service> services;
  for (const auto& part : parts_) std::ranges::move(part->services(), std::back_inserter(services));
  return services;
}

std::vector<websocket::Parameter> PartList::parameters() const {
  std::vector<websocket::Parameter> all;
  for (const LiveParameter& parameter : parameters_) all.push_back({parameter.name, parameter.value()});
  return all;
}

Status PartList::set(const websocket::Parameter& parameter, const std::string& client) const {
  const std::string& name = parameter.name;
  const auto* const number = std::get_if<double>(&parameter.value);
  const auto* const on = std::get_if<bool>(&parameter.value);
  if (number == nullptr && on == nullptr) return bad_input(name + ": takes a number or true and false");
  for (const LiveParameter& one : parameters_) {
    if (one.name != name) continue;
    if (number != nullptr && one.set_number) return one.set_number(*number);
    if (on != nullptr && one.set_switch) return one.set_switch(*on, client);
  }
  return bad_input(name + ": there is no such parameter that " +
                   (number != nullptr ? "takes a number" : "is true or false"));
}

}  // namespace dermis::out::serve
