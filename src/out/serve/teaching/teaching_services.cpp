// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/teaching/teaching_services.hpp"

#include <optional>
#include <utility>

#include "dermis/learn/recognition/learning.hpp"
#include "out/serve/parts/part_makers.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;

}  // namespace

TeachingServices::TeachingServices(ServiceArrays arrays, UseClasses use_classes)
    : use_classes_(std::move(use_classes)), lesson_(std::move(arrays)) {}

std::vector<websocket::Service> TeachingServices::services() {
  return {of_array("/recognition/listen", &TeachingServices::listen),
          of_array("/recognition/examples", &TeachingServices::examples),
          of_array("/recognition/throw_away", &TeachingServices::throw_away),
          of_array("/recognition/saved", &TeachingServices::saved),
          of_array("/recognition/load", &TeachingServices::load),
          of_array("/recognition/train", &TeachingServices::train)};
}

/// All requests name their array: {"array": "chest"}.
websocket::Service TeachingServices::of_array(const char* name, Answer answer) {
  return {name, [this, answer](std::string_view text) -> Result<std::string> {
            const Result<JsonRequest> request = JsonRequest::parse(text);
            if (!request) return request.error();
            const Result<std::string> array_name = request->text("array");
            if (!array_name) return array_name.error();
            const Result<std::size_t> array = lesson_.arrays().find(*array_name);
            if (!array) return array.error();
            return (this->*answer)(*array, *request);
          }};
}

Result<std::string> TeachingServices::listen(std::size_t array, const JsonRequest& request) {
  Result<std::string> class_name = request.text("class");
  if (!class_name) return class_name.error();
  if (*class_name == "unknown") return bad_field("class", "'unknown' is what is none of the classes");
  Result<std::string> session = request.text("session");
  if (!session) return session.error();
  lesson_.listen(array, *std::move(class_name), session->empty() ? "1" : *std::move(session));
  return std::string("{}");
}

Result<std::string> TeachingServices::examples(std::size_t array, const JsonRequest& request) {
  const Result<std::optional<std::uint64_t>> known = request.number("known", "the id of an example, or 0");
  if (!known) return known.error();
  const LessonState state = lesson_.state(array, known->value_or(0));
  json examples = json::array();
  for (const ShownExample& example : state.examples) {
    json& one = examples.emplace_back();
    one = {{"id", example.id}, {"class", example.class_name}, {"session", example.session}};
    if (!example.picture.empty()) one["picture"] = example.picture;
  }
  return json_text(
      json{{"listening", state.listening}, {"touched", state.is_touched}, {"examples", std::move(examples)}});
}

Result<std::string> TeachingServices::throw_away(std::size_t array, const JsonRequest& request) {
  const Result<std::optional<std::uint64_t>> id = request.number("example", "the id of one");
  if (!id) return id.error();
  if (!*id) return bad_field("example", "must be the id of one");
  if (Status discarded = lesson_.discard(array, **id); !discarded) return discarded.error();
  return std::string("{}");
}

Result<std::string> TeachingServices::saved(std::size_t array, const JsonRequest& /*request*/) {
  return json_text(json{{"files", lesson_.saved_files(array)}});
}

Result<std::string> TeachingServices::load(std::size_t array, const JsonRequest& request) {
  const Result<std::string> file = request.text("file", JsonRequest::kMostBytes);
  if (!file) return file.error();
  const Result<std::size_t> loaded = lesson_.load(array, *file);
  if (!loaded) return loaded.error();
  return json_text(json{{"examples", *loaded}});
}

Result<std::string> TeachingServices::train(std::size_t array, const JsonRequest& /*request*/) {
  Result<LearnedLesson> lesson = lesson_.learn(array);
  if (!lesson) return lesson.error();
  learn::recognition::Learned& learned = lesson->learned;
  const json answer = {{"file", lesson->name + ".safetensors"},
                       {"classes", learned.classes.names},
                       {"accuracy", learned.report.accuracy},
                       {"judged", learned.report.judged},
                       {"advice", learn::recognition::advice(learned)}};
  if (Status used = use_classes_(array, std::move(learned.classes)); !used) return used.error();
  return json_text(answer);
}

Result<std::unique_ptr<Part>> make_teaching(Host& host) {
  return std::unique_ptr<Part>(std::make_unique<TeachingServices>(
      service_arrays(host.suit), [&host](std::size_t array, learn::recognition::Classes classes) {
        return host.use_classes(array, std::move(classes));
      }));
}

}  // namespace dermis::out::serve
