// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/plan_request.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::learn::calibration {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = 256UL * 1024;
constexpr std::size_t kMostShown = 100;
constexpr double kMostSeconds = 3600.0;  // validate() says what is sensible

Error wrong(const char* field, const char* wanted) {
  return bad_input(std::string(field) + ": must be " + wanted);
}

Status read_seconds(const json& request, const char* field, std::optional<double>& seconds) {
  const auto found = request.find(field);
  if (found == request.end()) return Done{};
  if (!found->is_number() || !(std::abs(found->get<double>()) <= kMostSeconds)) return wrong(field, "seconds");
  seconds = found->get<double>();
  return Done{};
}

Status read_weights(const json& request, PlanRequest& plan) {
  const auto found = request.find("weights_n");
  if (found == request.end()) return Done{};
  const bool are_numbers = found->is_array() && std::all_of(found->begin(), found->end(),
                                                            [](const json& value) { return value.is_number(); });
  if (!are_numbers) return wrong("weights_n", "a list of newtons");
  plan.weights_n = found->get<std::vector<double>>();
  return Done{};
}

Status read_taxels(const json& request, PlanRequest& plan) {
  constexpr const char* kWanted = "\"all\", a list of row-major taxels or {\"stride\": 1 ... 1024}";
  const auto found = request.find("taxels");
  if (found == request.end()) return Done{};
  if (*found == "all") {
    plan.stride = 1;
    return Done{};
  }
  const auto is_index = [](const json& value) { return value.is_number_unsigned(); };
  if (found->is_array() && std::all_of(found->begin(), found->end(), is_index)) {
    plan.taxels = found->get<std::vector<std::size_t>>();
    return Done{};
  }
  const bool is_stride = found->is_object() && found->size() == 1 && found->contains("stride") &&
                         is_index(found->front()) && found->front() >= 1 && found->front() <= kMaxLines;
  if (!is_stride) return wrong("taxels", kWanted);
  plan.stride = found->front().get<std::size_t>();
  return Done{};
}

Status check_fields(const json& request) {
  const std::set<std::string> known = {"array", "weights_n", "taxels", "unloaded_s", "hold_s"};
  for (const auto& [name, value] : request.items()) {
    if (known.contains(name)) continue;
    std::string shown = name.substr(0, kMostShown);
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    const std::string nearest = nearest_name(shown, known);
    return bad_input("'" + shown + "' is not known" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  }
  return Done{};
}

Nanos to_nanos(double seconds) {
  return Nanos(std::llround(1e9 * seconds));
}

}  // namespace

Result<CalibrationPlan> PlanRequest::plan(const ArrayDescription& array) const {
  CalibrationPlan plan = default_plan(array);
  if (weights_n) plan.weights_n = *weights_n;
  if (taxels) plan.taxels = *taxels;
  if (stride) plan.taxels = taxels_with_stride(array, *stride);
  if (unloaded_s) plan.unloaded_time = to_nanos(*unloaded_s);
  if (hold_s) plan.hold_time = to_nanos(*hold_s);
  if (Status valid = plan.validate(array); !valid) return valid.error();
  return plan;
}

Result<PlanRequest> plan_request_from_json(std::string_view text) {
  if (text.size() > kMostBytes) return bad_input("the request is too long");
  const json request = json::parse(text, nullptr, false);
  if (!request.is_object()) return bad_input("the request is not a JSON object");
  if (Status checked = check_fields(request); !checked) return checked.error();
  PlanRequest plan;
  if (const auto array = request.find("array"); array != request.end()) {
    if (!array->is_string()) return wrong("array", "the name of an array");
    plan.array = array->get<std::string>();
  }
  if (Status read = read_weights(request, plan); !read) return read.error();
  if (Status read = read_taxels(request, plan); !read) return read.error();
  if (Status read = read_seconds(request, "unloaded_s", plan.unloaded_s); !read) return read.error();
  if (Status read = read_seconds(request, "hold_s", plan.hold_s); !read) return read.error();
  return plan;
}

}  // namespace dermis::learn::calibration
