// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "pressing.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "dermis/bytes/files/output_place.hpp"
#include "dermis/learn/arrangement/arrangement.hpp"
#include "dermis/learn/arrangement/press_guide.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "dermis/live/sources/recorded_order.hpp"
#include "dermis/live/sources/source_name.hpp"
#include "dermis/touch/frames/millimetres.hpp"
#include "source_options.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using bytes::devices::Transport;
using learn::arrangement::Answers;
using learn::arrangement::Arrangement;
using learn::arrangement::channel_words;
using learn::arrangement::place_words;
using learn::arrangement::Places;
using learn::arrangement::PressGuide;
using live::sources::SourceKind;
using live::sources::SourceName;

constexpr std::size_t kMostReadings = 67'000'000;  // of a recording
constexpr Nanos kUsualStep = std::chrono::milliseconds(10);

/// The presses, and the frames that show them.
struct Pressed {
  Answers answers;
  FrameShape sent;
  double most_counts = 0.0;
  std::vector<std::string> remarks{};
};

/// Keys that were typed, without waiting for them.
class Keys {
 public:
  /// `is_free`: the standard input has no frames.
  explicit Keys(bool is_free) : is_open_(is_free) {}

  std::string typed() {
    std::string text;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (is_open_ && ::poll(&input, 1, 0) > 0) {
      std::array<char, 64> piece{};
      const ssize_t size = ::read(STDIN_FILENO, piece.data(), piece.size());
      if (size <= 0) is_open_ = false;
      text.append(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    }
    return text;
  }

 private:
  bool is_open_;
};

/// Says what a person is to do, and what came of it.
class Leading {
 public:
  Leading(const Places& places, bool has_keys) : places_(places), keys_(has_keys), guide_(places.places.size()) {
    print_notice("take your hands off for a second");
  }

  void add(const RawFrame& frame, FrameShape sent) {
    const bool was_ready = guide_.is_ready();
    const std::size_t before = guide_.place();
    const bool has_ended = guide_.add(frame.counts, frame.time);
    if (has_ended) say_press(before, sent);
    const bool has_typed = take_keys();
    if (!guide_.is_done() && guide_.is_ready() && (has_ended || has_typed || !was_ready)) ask();
  }

  [[nodiscard]] const PressGuide& guide() const { return guide_; }

 private:
  void ask() {
    print_notice("press " + place_words(places_, guide_.place()) + (has_asked_ ? "" : kHelp));
    has_asked_ = true;
  }

  void say_press(std::size_t place, FrameShape sent) {
    if (const std::optional<std::size_t> other = guide_.repeated()) {
      const std::size_t channel = guide_.answers()[*other]->channel;
      return print_notice(fmt::format("{} again: it answered at place {} already; if that is right, press once more",
                                      channel_words(channel, sent), *other + 1));
    }
    if (place < guide_.place()) print_notice("  " + channel_words(guide_.answers()[place]->channel, sent));
  }

  bool take_keys() {
    const std::string typed = keys_.typed();
    bool is_back = false;
    bool has_acted = false;
    for (const char key : typed) {
      if (key == 'b') is_back = true;
      if (key != '\n' || !guide_.is_ready() || guide_.is_done()) continue;
      is_back ? guide_.back() : guide_.skip();
      is_back = false;
      has_acted = true;
    }
    return has_acted;
  }

  static constexpr const char* kHelp = ", and let go (Enter: nothing answers there; b and Enter: the last one again)";
  const Places& places_;
  Keys keys_;
  PressGuide guide_;
  bool has_asked_ = false;
};

Status check_channels(const std::string& source, FrameShape sent) {
  if (sent.taxel_count() <= learn::arrangement::kMostChannels) return Done{};
  return bad_input(fmt::format("'{}': has {} channels, more than {}", source, sent.taxel_count(),
                               learn::arrangement::kMostChannels));
}

Result<Pressed> lead(const PressingOptions& options, FrameSource& source, const Places& places, bool has_keys) {
  Leading leading(places, has_keys);
  RawFrame frame;
  while (!leading.guide().is_done()) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) {
      return failed(fmt::format("'{}': ended after {} of {} places", options.source, leading.guide().place(),
                                places.places.size()));
    }
    if (Status few = check_channels(options.source, *source.shape()); !few) return few.error();
    leading.add(frame, *source.shape());
  }
  return Pressed{leading.guide().answers(), *source.shape(), leading.guide().most_counts()};
}

double largest_of(const std::vector<RawFrame>& frames) {
  double most = 0.0;
  for (const RawFrame& frame : frames)
    for (const float count : frame.counts)
      if (std::isfinite(count)) most = std::max(most, static_cast<double>(count));
  return most;
}

Result<std::vector<RawFrame>> frames_of(const PressingOptions& options, FrameSource& source) {
  std::vector<RawFrame> frames;
  for (RawFrame frame;;) {
    const Result<bool> more = source.next(frame);
    if (!more) return more.error();
    if (!*more) break;
    if (Status few = check_channels(options.source, *source.shape()); !few) return few.error();
    if ((frames.size() + 1) * frame.counts.size() > kMostReadings)
      return bad_input("'" + options.source + "': has more readings than the presses of one person; cut it");
    if (source.is_live()) frame.time = static_cast<std::int64_t>(frames.size()) * kUsualStep;  // it has no times
    frames.push_back(frame);
  }
  if (frames.empty()) return bad_input("'" + options.source + "': has no frames");
  return frames;
}

Result<Pressed> find(const PressingOptions& options, FrameSource& source, const Places& places) {
  const Result<std::vector<RawFrame>> frames = frames_of(options, source);
  if (!frames) return frames.error();
  auto answers = learn::arrangement::answers_of(learn::arrangement::find_presses(*frames), places.places.size());
  if (!answers) return bad_input("'" + options.source + "': " + answers.error().message);
  return Pressed{std::move(answers->answers), *source.shape(), largest_of(*frames), std::move(answers->remarks)};
}

/// The source as the array has its taxels: frames of files are turned by their URI alone, those of devices by
/// array.toml.
std::string turned_source_of(const SourceName& name, const LineOrder& order) {
  if (name.kind != SourceKind::recording && name.kind != SourceKind::file) return name.text;
  std::string parameters = live::sources::order_parameters(order);
  if (parameters.empty()) return name.text;
  const bool has_shape = name.uri && name.uri->protocol.shape;
  if (has_shape && parameters.starts_with("rows=")) parameters.erase(0, parameters.find("taxel_order="));
  if (name.uri) return name.text + (name.text.find('?') == std::string::npos ? "?" : "&") + parameters;
  std::string path;
  for (const char c : name.text) path += c == '%' ? "%25" : c == '?' ? "%3F" : std::string(1, c);
  return "file:" + path + "?" + parameters;
}

void print_json(const std::string& from, const Arrangement& made) {
  nlohmann::ordered_json json = {{"source", from}, {"channels", nlohmann::ordered_json::array()}};
  for (const std::optional<std::size_t>& channel : made.channels)
    json["channels"].push_back(channel ? nlohmann::ordered_json(*channel) : nlohmann::ordered_json());
  json["rows"] = made.array.rows;
  json["cols"] = made.array.cols;
  json["positions_mm"] = nlohmann::ordered_json::array();
  for (const Vector3& place : made.positions) {
    json["positions_mm"].push_back(
        {place.x * kMillimetresPerMetre, place.y * kMillimetresPerMetre, place.z * kMillimetresPerMetre});
  }
  json["remarks"] = made.remarks;
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_text(const Places& places, const std::string& from, const Pressed& pressed, const Arrangement& made) {
  for (std::size_t place = 0; place < made.channels.size(); ++place) {
    const std::optional<std::size_t>& channel = made.channels[place];
    fmt::print("{}: {}\n", place_words(places, place),
               channel ? channel_words(*channel, pressed.sent) : "no channel of its own");
  }
  for (const std::string& remark : made.remarks) fmt::print("{}\n", remark);
  fmt::print("frames in this order: {}\n", from);
}

/// Files beside the one of --out, which the command line has looked at already.
Status check_out(const PressingOptions& options) {
  if (options.out.empty()) return Done{};
  if (!options.out.ends_with(".toml")) return bad_input("--out: name an array.toml, as hand.toml");
  return Done{};
}

std::string name_of(const PressingOptions& options) {
  return options.out.empty() ? "array" : std::filesystem::path(options.out).stem().string();
}

}  // namespace

Status describe_pressing(const PressingOptions& options) {
  if (Status out = check_out(options); !out) return out;
  const Result<Places> places = learn::arrangement::read_press_places(options.places, options.pitch_mm);
  if (!places) return places.error();
  const Result<SourceName> name = SourceName::parse(options.source);
  if (!name) return name.error();
  if (name->kind == SourceKind::file && name->uri && !name->uri->order.is_plain())
    return bad_input("'" + options.source + "': --press finds the order: leave that of the URI out");
  const Result<std::unique_ptr<FrameSource>> source = live::sources::open_source(*name, source_options());
  if (!source) return source.error();
  const bool is_file = name->uri && name->uri->transport == Transport::file;
  const bool has_keys = !name->uri || name->uri->transport != Transport::standard_input;
  Result<Pressed> pressed =
      (*source)->is_live() && !is_file ? lead(options, **source, *places, has_keys) : find(options, **source, *places);
  if (!pressed) return pressed.error();
  Result<Arrangement> made =
      learn::arrangement::arrange(*places, pressed->answers, pressed->sent, pressed->most_counts, name_of(options));
  if (!made) return bad_input("'" + options.source + "': " + made.error().message);
  made->remarks.insert(made->remarks.begin(), pressed->remarks.begin(), pressed->remarks.end());
  const std::string from = turned_source_of(*name, made->array.order);
  options.json ? print_json(from, *made) : print_text(*places, from, *pressed, *made);
  return options.out.empty() ? Status(Done{}) : learn::arrangement::write_arrangement(options.out, *made, from);
}

}  // namespace dermis::app
