// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/bytes/recordings/conversion.hpp"
#include "dermis/bytes/recordings/recording.hpp"
#include "described_file.hpp"
#include "interruption.hpp"
#include "lost_input.hpp"
#include "shape_options.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

using bytes::recordings::FrameFormat;

struct ConvertOptions {
  std::string in;
  std::string out;
  std::string array;
  std::string layout;
  std::optional<double> rate_hz;
  ShapeOptions shape;
};

Status check_rate(const ConvertOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0.0 && *options.rate_hz <= 1e9)) {
    return bad_input("--rate: must be more than 0 and at most 1e9 frames a second");
  }
  return Done{};
}

Status check(const ConvertOptions& options) {
  const Result<FrameFormat> in = bytes::recordings::recognise_frames(options.in);
  if (!in) return in.error();
  const Result<FrameFormat> out = bytes::recordings::output_format(options.out);
  if (!out) return out.error();
  if (options.rate_hz && bytes::recordings::has_times(*in)) {
    return bad_input(fmt::format("--rate: '{}' has times of its own; leave --rate out", options.in));
  }
  return check_rate(options);
}

/// The shape that the frames must have, where one is given.
Result<std::optional<FrameShape>> wanted_shape(const ConvertOptions& options,
                                               const std::optional<ArrayDescription>& array) {
  Result<std::optional<FrameShape>> shape = options.shape.shape();
  if (!shape || !array) return shape;
  const FrameShape of_array{array->rows, array->cols};
  if (*shape && **shape != of_array) {
    return bad_input(fmt::format("--rows, --cols: {} has {}x{} taxels", options.array, array->rows, array->cols));
  }
  return std::optional(of_array);
}

Result<std::optional<ArrayDescription>> read_array(const ConvertOptions& options) {
  if (options.array.empty()) return std::optional<ArrayDescription>();
  Result<ArrayDescription> array = bytes::files::read_array(options.array);
  if (!array) return array.error();
  return std::optional(std::move(*array));
}

Result<std::vector<std::string>> convert_described(const DescribedFile& file, const ConvertOptions& options,
                                                   const bytes::recordings::ConversionOptions& how) {
  const Result<std::unique_ptr<FrameSource>> source = file.open();
  if (!source) return source.error();
  Result<std::vector<std::string>> left_out =
      bytes::recordings::convert_frames(**source, !(*source)->is_live(), options.out, how);
  const SourceStatistics statistics = (*source)->statistics();
  if (left_out && statistics.damaged_frames > 0) {
    print_notice(fmt::format("{}: {} damaged frames are left out", options.in, statistics.damaged_frames));
  }
  return left_out;
}

Status convert(const ConvertOptions& options) {
  DescribedFile file{.name = options.in, .layout = options.layout, .rate_hz = options.rate_hz};
  const bool is_described = file.is_described();
  if (Status checked = is_described ? check_rate(options) : check(options); !checked) return checked;
  const Result<std::optional<ArrayDescription>> array = read_array(options);
  if (!array) return array.error();
  const Result<std::optional<FrameShape>> shape = wanted_shape(options, *array);
  if (!shape) return shape.error();
  file.shape = *shape;
  const bytes::recordings::ConversionOptions how = {
      .input = {.shape = *shape, .rate_hz = options.rate_hz, .notice = print_notice, .loss = note_loss},
      .array = *array ? &**array : nullptr};
  const Result<std::vector<std::string>> left_out =
      is_described ? convert_described(file, options, how)
                   : bytes::recordings::convert_frames(options.in, options.out, how);
  if (!left_out) return left_out.error();
  if (!left_out->empty()) print_notice(fmt::format("{}: left out: {}", options.out, fmt::join(*left_out, ", ")));
  return Done{};
}

}  // namespace

void add_convert(Command& command) {
  auto options = std::make_shared<ConvertOptions>();
  command.input("in", options->in, ".csv, .mcap, .h5, .hdf5, .npy, or a file of another system (docs/frame-files.md)")
      .required();
  command.output("out", options->out, ".csv, .mcap, .h5, .hdf5, .npy or .wiresens.hdf5").required();
  command.input("--array", options->array, "array.toml, to keep with the frames (.mcap, .h5)");
  command.input_file("--layout", options->layout, "layout.toml, which describes the bytes of a file (docs/layouts.md)");
  command.option("--rate", options->rate_hz,
                 "Frames a second of a file without times (.npy, .npz, .mat, .txt, .png, .packed10) [Hz]");
  options->shape.add(command);
  command.action([options] {
    end_when_interrupted();
    return convert(*options);
  });
}

}  // namespace dermis::app
