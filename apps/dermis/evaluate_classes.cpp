// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "evaluate_classes.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "confusion_table.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/learn/recognition/evaluation.hpp"
#include "recognising/force_source.hpp"
#include "source_options.hpp"
#include "touch_finding.hpp"

namespace dermis::app {
namespace {

using learn::recognition::Classes;
using learn::recognition::ClassesEvaluation;

void print_json(const Classes& classes, const ClassesEvaluation& evaluation) {
  const nlohmann::ordered_json json = {{"accuracy", evaluation.accuracy},
                                       {"judged", evaluation.judged},
                                       {"calibration_error", evaluation.calibration_error},
                                       {"called_unknown", evaluation.called_unknown},
                                       {"others", evaluation.others},
                                       {"others_unknown", evaluation.others_unknown},
                                       {"classes", classes.names},
                                       {"confusion", evaluation.confusion}};
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_text(const Classes& classes, const ClassesEvaluation& evaluation) {
  fmt::print("accuracy {:.1f} % of {}, calibration error {:.1f} %, called unknown: {}\n", 100.0 * evaluation.accuracy,
             evaluation.judged, 100.0 * evaluation.calibration_error, evaluation.called_unknown);
  if (evaluation.others > 0) {
    fmt::print("of {} examples of classes that were not learned, {} are called unknown\n", evaluation.others,
               evaluation.others_unknown);
  }
  print_confusion(classes.names, evaluation.confusion);
}

}  // namespace

Status evaluate_classes(const std::string& path, recognising::ExampleOptions examples, bool json) {
  const Result<Classes> classes = learn::recognition::read_classes(path);
  if (!classes) return classes.error();
  if (examples.data.labels.empty()) return bad_input("--labels is required: which frames are of which class");
  if (!examples.in.empty()) {
    if (Status checked = recognising::check_loads(classes->layout, path, examples.model); !checked) return checked;
  }
  examples.arrays = learn::recognition::names_of(classes->layout.arrays);
  Result<learn::recognition::LabelledFrames> data = recognising::read_examples(examples, source_options());
  if (!data) return data.error();
  if (examples.data.rate_hz == 0.0) data->layout.rate_hz = classes->layout.rate_hz;
  const Result<ClassesEvaluation> evaluation = learn::recognition::evaluate_classes(*classes, *data);
  if (!evaluation) return bad_input(path + ": " + evaluation.error().message);
  if (json) {
    print_json(*classes, *evaluation);
    return Done{};
  }
  print_text(*classes, *evaluation);
  if (classes->touches) print_finding(*data, *classes->touches);
  return Done{};
}

}  // namespace dermis::app
