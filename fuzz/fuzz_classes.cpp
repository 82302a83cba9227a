// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "check_error.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/learn/recognition/stream_recogniser.hpp"

// Classes that can be read can be used, or it is said why not: on an empty frame. What they allocate is held against
// the memory limit of the fuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostReadings = 4096;  // of which a frame is quickly looked at
  auto classes = dermis::learn::recognition::classes_from_bytes({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!classes) {
    dermis::fuzz::check_error(classes.error());
    return 0;
  }
  const dermis::learn::recognition::Layout layout = classes->layout;
  auto stream = dermis::learn::recognition::StreamRecogniser::create(*classes, layout);
  if (!stream) dermis::fuzz::check_error(stream.error());
  if (layout.readings > kMostReadings) return 0;
  const std::size_t class_count = classes->names.size();
  auto recogniser = dermis::learn::recognition::Recogniser::create(*std::move(classes), layout, 1);
  if (!recogniser) std::abort();
  const std::vector<float> frame(layout.readings);
  const std::vector<float> extras(layout.extras);
  const auto answer = recogniser->recognise({frame, extras});
  if (answer.likeliest >= class_count || !(answer.probabilities[answer.likeliest] > 0.0)) std::abort();
  return 0;
}
