// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "views/view_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace dermis::views {
namespace {

using out::report::FramePicture;

double seconds_of(Nanos time) {
  return std::chrono::duration<double>(time).count();
}

bool is_set(const std::atomic<bool>* stop) {
  return stop != nullptr && stop->load();
}

FramePicture picture_of(const ArrayView& view, Nanos since_first) {
  FramePicture picture;
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
  picture.places = view.places();
  picture.contacts = view.contacts().contacts;
  return picture;
}

/// Goes to the first frame that is to be drawn; the time of the first frame of all.
Result<Nanos> go_to(const PictureRange& range, ArrayView& view, const std::atomic<bool>* stop) {
  Nanos first{};
  for (std::size_t number = 0; !is_set(stop); ++number) {
    const Result<bool> more = view.next();
    if (!more) return more.error();
    if (!*more) {
      return bad_input(
          fmt::format("{}: has {} frames, which end before the one that is asked for", view.from(), number));
    }
    if (number == 0) first = view.raw().time;
    const bool is_found = range.number ? number == *range.number : view.raw().time - first >= range.from;
    if (is_found) return first;
  }
  return failed("interrupted");
}

Result<std::vector<FramePicture>> film_of(const PictureRange& range, ArrayView& view, Nanos first,
                                          const std::atomic<bool>* stop) {
  std::vector<FramePicture> pictures;
  FramePicture shown = picture_of(view, view.raw().time - first);
  for (Nanos moment = range.from; moment < *range.to;) {
    if (pictures.size() == kMostPictures) {
      return bad_field("to", fmt::format("at most {} s are drawn", seconds_of(kMostPictures * kPictureTime)));
    }
    pictures.push_back(shown);
    moment += kPictureTime;
    while (view.raw().time - first < moment) {
      shown = picture_of(view, view.raw().time - first);
      const Result<bool> more = view.next();
      if (!more) return more.error();
      if (!*more || is_set(stop)) return pictures;
    }
  }
  return pictures;
}

}  // namespace

Result<std::vector<FramePicture>> draw_pictures(ArrayView& view, const PictureRange& range, std::optional<double> high,
                                                const std::atomic<bool>* stop) {
  const Result<Nanos> first = go_to(range, view, stop);
  if (!first) return first.error();
  std::vector<FramePicture> pictures;
  if (range.to) {
    Result<std::vector<FramePicture>> drawn = film_of(range, view, *first, stop);
    if (!drawn) return drawn.error();
    pictures = *std::move(drawn);
  } else {
    pictures.push_back(picture_of(view, view.raw().time - *first));
  }
  double largest = 0.0;
  for (const FramePicture& picture : pictures) largest = std::max(largest, out::report::largest_of(picture.values));
  for (FramePicture& picture : pictures) picture.high = high.value_or(view.scale(largest));
  return pictures;
}

}  // namespace dermis::views
