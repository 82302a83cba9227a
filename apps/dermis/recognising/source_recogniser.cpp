// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/source_recogniser.hpp"

#include <utility>

#include "dermis/learn/recognition/classes_file.hpp"

namespace dermis::recognising {
namespace {

using learn::recognition::Classes;
using learn::recognition::Layout;
using learn::recognition::Recognition;
using learn::recognition::StreamRecogniser;

/// The array of the source's frames: those of the examples, side by side.
ArrayDescription array_of(const Layout& layout) {
  ArrayDescription array;
  const bool is_one = layout.arrays.size() == 1 && layout.arrays.front().taxel_count() == layout.readings;
  array.name = layout.arrays.front().name;
  array.rows = is_one ? layout.arrays.front().rows : 1;
  array.cols = is_one ? layout.arrays.front().cols : layout.readings;
  return array;
}

/// Whether these classes can name touches of `input`.
Status check_classes(const Classes& classes, const RecognitionInput& input) {
  if (classes.layout.extras > 0 && input.loads.extra.empty()) {
    return bad_field("extra", "the classes of " + input.classes + " need " + std::to_string(classes.layout.extras) +
                                  " further readings beside each frame; name their table, or learn classes without");
  }
  if (Status checked = check_loads(classes.layout, input.classes, input.loads.model); !checked) return checked;
  if (classes.layout.rate_hz == 0.0 && input.rate_hz > 0.0) {
    return bad_field("rate", input.classes + " does not know the rate of its examples; learn its classes with one");
  }
  return Done{};
}

/// The layout of the source's frames.
Layout layout_of(const ForceSource& source, const Classes& classes, double rate_hz) {
  Layout layout = classes.layout;
  const std::optional<Layout> found = source.layout();
  if (found && (found->arrays.size() > 1 || layout.has_forces())) {
    layout.arrays = found->arrays;
    layout.readings = found->readings;
  }
  layout.extras = source.extra_names().size();
  if (rate_hz > 0.0) layout.rate_hz = rate_hz;
  return layout;
}

}  // namespace

Result<SourceRecogniser> SourceRecogniser::open(const RecognitionInput& input) {
  if (!learn::recognition::is_rate(input.rate_hz)) return bad_field("rate", "must be 0.001 to 1e6");
  Result<Classes> classes = learn::recognition::read_classes(input.classes);
  if (!classes) return classes.error();
  if (Status checked = check_classes(*classes, input); !checked) return checked.error();
  const ArrayDescription array = array_of(classes->layout);
  ForceInput loads = input.loads;
  loads.source.array = &array;
  loads.arrays = learn::recognition::names_of(classes->layout.arrays);
  Result<ForceSource> source = ForceSource::open(loads);
  if (!source) return source.error();
  const Layout layout = layout_of(*source, *classes, input.rate_hz);
  Result<StreamRecogniser> recogniser = StreamRecogniser::create(*std::move(classes), layout);
  if (!recogniser) return bad_input(input.classes + ": " + recogniser.error().message);
  return SourceRecogniser(*std::move(source), *std::move(recogniser), layout.rate_hz > 0.0, input.loads.source);
}

SourceRecogniser::SourceRecogniser(ForceSource source, StreamRecogniser recogniser, bool knows_rate,
                                   const live::sources::SourceOptions& options)
    : source_(std::move(source)),
      recogniser_(std::move(recogniser)),
      knows_rate_(knows_rate),
      stop_(options.stop),
      notice_(options.notice) {}

Result<std::optional<SourceRecognition>> SourceRecogniser::next() {
  std::optional<Recognition> found;
  while (!found && !has_ended_) {
    const Result<bool> more = next_frame();
    if (!more) return more.error();
    has_ended_ = !*more;
    if (has_ended_) {
      tell_troubles();
      found = recogniser_.finish();
    } else if (source_.is_tare()) {
      ++tare_frames_;
    } else {
      found = recogniser_.next(source_.loads(), source_.extras());
    }
  }
  if (!found) return std::optional<SourceRecognition>();
  return std::optional(of_source(*found));
}

Result<bool> SourceRecogniser::next_frame() {
  if (stop_ != nullptr && stop_->load()) return false;
  return source_.next();
}

void SourceRecogniser::tell_troubles() const {
  if (!notice_) return;
  for (const std::string& line : source_.describe_troubles()) notice_(line);
}

SourceRecognition SourceRecogniser::of_source(Recognition recognition) const {
  recognition.frames.first += tare_frames_;
  recognition.frames.last += tare_frames_;
  return {recognition, source_.time()};
}

}  // namespace dermis::recognising
