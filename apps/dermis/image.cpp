// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "array_view.hpp"
#include "commands.hpp"
#include "dermis/files/atomic_file.hpp"
#include "dermis/report/frame_picture.hpp"
#include "seconds.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

constexpr Nanos kPictureTime = std::chrono::milliseconds(40);
constexpr std::size_t kMostPictures = 1500;

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

/// Which frames are to be drawn, by their times after the first.
struct Range {
  std::optional<std::size_t> number;
  Nanos from{};
  std::optional<Nanos> to;  ///< Of an animation.
};

Result<Range> range_of(const ImageOptions& options) {
  Range range;
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
  if (range.to && !options.out.ends_with(".png")) {
    return bad_input("--out: only .png can move; leave --from and --to out for one frame (--at)");
  }
  return range;
}

Status check(const ImageOptions& options) {
  if (!options.out.ends_with(".png") && !options.out.ends_with(".svg")) {
    return bad_input("--out: '" + options.out + "': must end in .png or .svg");
  }
  if (options.high && !(*options.high > 0.0 && std::isfinite(*options.high))) {
    return bad_input("--high: must be more than 0");
  }
  return Done{};
}

double seconds_of(Nanos time) {
  return std::chrono::duration<double>(time).count();
}

report::FramePicture picture_of(const ArrayView& view, Nanos since_first) {
  report::FramePicture picture;
  picture.title = view.name();
  picture.subtitle = fmt::format("{:.3f} s", seconds_of(since_first));
  if (view.has_model()) {
    const std::size_t count = view.contacts().contacts.size();
    picture.subtitle += fmt::format(", {} {}", count, count == 1 ? "contact" : "contacts");
    if (count > 0) picture.subtitle += fmt::format(", {:.3g} N", view.contacts().total_force_n);
  }
  picture.rows = view.shape().rows;
  picture.cols = view.shape().cols;
  picture.row_pitch_m = view.row_pitch_m();
  picture.col_pitch_m = view.col_pitch_m();
  picture.values = view.values();
  picture.unit = view.unit();
  picture.contacts = view.contacts().contacts;
  return picture;
}

/// Goes to the first frame that is to be drawn; its time after the first frame.
Result<Nanos> go_to(const ImageOptions& options, const Range& range, ArrayView& view, Nanos& first) {
  for (std::size_t number = 0; !stop_flag().load(); ++number) {
    const Result<bool> more = view.next();
    if (!more) return more.error();
    if (!*more) {
      return bad_input(
          fmt::format("{}: has {} frames, which end before the one that is asked for", options.in, number));
    }
    if (number == 0) first = view.raw().time;
    const bool is_found = range.number ? number == *range.number : view.raw().time - first >= range.from;
    if (is_found) return view.raw().time - first;
  }
  return failed("interrupted");
}

/// A picture every 40 ms of the recording: the last frame before that moment.
Result<std::vector<report::FramePicture>> pictures_of(const Range& range, ArrayView& view, Nanos first) {
  std::vector<report::FramePicture> pictures;
  report::FramePicture shown = picture_of(view, view.raw().time - first);
  for (Nanos moment = range.from; moment < *range.to;) {
    if (pictures.size() == kMostPictures) {
      return bad_input(fmt::format("--to: at most {} s are drawn", seconds_of(kMostPictures * kPictureTime)));
    }
    pictures.push_back(shown);
    moment += kPictureTime;
    while (view.raw().time - first < moment) {
      shown = picture_of(view, view.raw().time - first);
      const Result<bool> more = view.next();
      if (!more) return more.error();
      if (!*more || stop_flag().load()) return pictures;
    }
  }
  return pictures;
}

/// One for all pictures: a colour has one meaning.
void set_scale(const ImageOptions& options, const ArrayView& view, std::vector<report::FramePicture>& pictures) {
  double largest = 0.0;
  for (const report::FramePicture& picture : pictures) largest = std::max(largest, largest_of(picture.values));
  for (report::FramePicture& picture : pictures) picture.high = options.high.value_or(view.scale(largest));
}

std::string bytes_of(const ImageOptions& options, const std::vector<report::FramePicture>& pictures) {
  if (options.out.ends_with(".svg")) return report::svg_document(report::frame_drawing(pictures.front()));
  if (!options.to_s) return report::png(report::frame_pixels(pictures.front()));
  report::AnimatedPng moving;
  for (const report::FramePicture& picture : pictures) {
    moving.add(report::frame_pixels(picture), static_cast<unsigned>(kPictureTime / std::chrono::milliseconds(1)));
  }
  return std::move(moving).take();
}

Status image(const ImageOptions& options) {
  if (Status possible = check(options); !possible) return possible;
  const Result<Range> range = range_of(options);
  if (!range) return range.error();
  const Result<std::unique_ptr<ArrayView>> view = ArrayView::open(options.in, options.model);
  if (!view) return view.error();
  Nanos first{};
  const Result<Nanos> found = go_to(options, *range, **view, first);
  if (!found) return found.error();
  std::vector<report::FramePicture> pictures;
  if (range->to) {
    Result<std::vector<report::FramePicture>> drawn = pictures_of(*range, **view, first);
    if (!drawn) return drawn.error();
    pictures = *std::move(drawn);
  } else {
    pictures.push_back(picture_of(**view, *found));
  }
  set_scale(options, **view, pictures);
  Result<files::AtomicFile> file = files::AtomicFile::create(options.out);
  if (!file) return file.error();
  file->write(bytes_of(options, pictures));
  return file->commit();
}

}  // namespace

void add_image(Command& command) {
  auto options = std::make_shared<ImageOptions>();
  command.option("--in", options->in, "A recording, another file of frames, or the URI of a device").required();
  command.option("--model", options->model,
                 "Model file, or array.toml where readings are forces: draws newtons and contacts instead of counts");
  command.option("--out", options->out, "Picture to write: .png or .svg").required();
  const Option frame = command.option("--frame", options->frame, "Number of the frame, from 0").not_negative();
  const Option at = command.option("--at", options->at_s, "The frame at this time after the first [s]").excludes(frame);
  const Option from = command.option("--from", options->from_s, "Begin of an animation after the first frame [s]")
                          .excludes(frame)
                          .excludes(at);
  const Option to = command.option("--to", options->to_s, "Its end [s]").excludes(frame).excludes(at);
  from.needs(to);
  command.option(
      "--high", options->high,
      "End of the colour scale [N, or counts]; without it, 1, 2, 5, 10, ... N that cover what is drawn, or all "
      "counts of the ADC");
  command.action([options] { return image(*options); });
}

}  // namespace dermis::app
