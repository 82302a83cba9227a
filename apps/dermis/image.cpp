// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/out/report/frame_picture.hpp"
#include "seconds.hpp"
#include "source_options.hpp"
#include "stop_flag.hpp"
#include "views/array_view.hpp"
#include "views/view_pictures.hpp"

namespace dermis::app {
namespace {

using views::ArrayView;
using views::PictureRange;

struct ImageOptions {
  std::string in;
  std::string model;
  std::string out;
  std::optional<std::size_t> frame;
  std::optional<double> at_s;
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::optional<double> high;
};

Result<PictureRange> range_of(const ImageOptions& options) {
  PictureRange range;
  range.number = options.frame;
  if (const std::optional<double> from = options.at_s ? options.at_s : options.from_s) {
    const Result<Nanos> time = nanos_from_seconds(*from, options.at_s ? "--at" : "--from");
    if (!time) return time.error();
    range.from = *time;
  }
  if (!options.to_s) return range;
  const Result<Nanos> time = nanos_from_seconds(*options.to_s, "--to");
  if (!time) return time.error();
  if (*time <= range.from) return bad_input("--to: must be later than --from");
  range.to = *time;
  return range;
}

Status check(const ImageOptions& options) {
  if (options.out == kStandardOutput) return bad_input("--out: '-' is no file; name one");
  const bool is_film = options.to_s.has_value();
  const bool has_ending =
      is_film ? options.out.ends_with(".gif") : options.out.ends_with(".png") || options.out.ends_with(".svg");
  if (!has_ending) {
    return bad_input("--out: '" + options.out + "': must end in " +
                     (is_film ? ".gif, as a film does" : ".png or .svg; a film (.gif) needs --from and --to"));
  }
  if (options.high && !(*options.high > 0.0 && std::isfinite(*options.high))) {
    return bad_input("--high: must be more than 0");
  }
  return Done{};
}

Result<std::string> bytes_of(const ImageOptions& options, const std::vector<out::report::FramePicture>& pictures) {
  if (options.to_s) {
    return out::report::frame_film(pictures,
                                   std::chrono::duration_cast<std::chrono::milliseconds>(views::kPictureTime));
  }
  if (options.out.ends_with(".svg")) return out::report::svg_document(out::report::frame_drawing(pictures.front()));
  return out::report::frame_png(pictures.front());
}

Status image(const ImageOptions& options) {
  if (Status possible = check(options); !possible) return possible;
  const Result<PictureRange> range = range_of(options);
  if (!range) return range.error();
  const Result<std::unique_ptr<ArrayView>> view = ArrayView::open(options.in, options.model, source_options());
  if (!view) return view.error();
  const Result<std::vector<out::report::FramePicture>> pictures =
      views::draw_pictures(**view, *range, options.high, &stop_flag());
  if (!pictures) return pictures.error();
  const Result<std::string> bytes = bytes_of(options, *pictures);
  if (!bytes) return bytes.error();
  Result<bytes::files::AtomicFile> file = bytes::files::AtomicFile::create(options.out);
  if (!file) return file.error();
  file->write(*bytes);
  if (Status committed = file->commit(); !committed) return committed;
  return (*view)->verdict();
}

}  // namespace

void add_image(Command& command) {
  auto options = std::make_shared<ImageOptions>();
  command.input("--in", options->in, "A recording, another file of frames, or the URI of a device").required();
  command.input_file(
      "--model", options->model,
      "Model file, or array.toml where readings are forces: draws newtons and contacts instead of counts");
  command.output("--out", options->out, "Picture to write: .png or .svg, or a film: .gif").required();
  const Option frame = command.option("--frame", options->frame, "Number of the frame, from 0");
  const Option at = command.option("--at", options->at_s, "The frame at this time after the first [s]").excludes(frame);
  const Option from = command.option("--from", options->from_s, "Start of a film, after the first frame [s]")
                          .excludes(frame)
                          .excludes(at);
  const Option to = command.option("--to", options->to_s, "Its end [s]").excludes(frame).excludes(at);
  from.needs(to);
  command.option(
      "--high", options->high,
      "End of the colour scale [N, or counts]; by default the next of 1, 2, 5, 10, ... N, or all counts of the ADC");
  command.action([options] { return image(*options); });
}

}  // namespace dermis::app
