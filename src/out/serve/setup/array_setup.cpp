// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/serve/array_setup.hpp"

#include <fmt/core.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/bytes/files/array_toml.hpp"
#include "dermis/live/sources/array_folder.hpp"
#include "out/serve/requests/array_request.hpp"
#include "out/serve/requests/json_request.hpp"
#include "out/serve/setup/first_look.hpp"
#include "out/serve/setup/known_arrays.hpp"
#include "out/serve/setup/layout_proposals.hpp"
#include "out/serve/setup/press_watch.hpp"
#include "out/serve/setup/setup_json.hpp"
#include "out/serve/setup/source_choice.hpp"
#include "out/serve/setup/touch_watch.hpp"

namespace dermis::out::serve {
namespace {

using live::sources::SourceName;
using nlohmann::ordered_json;
using websocket::Later;

constexpr std::chrono::milliseconds kPeriod{50};
constexpr std::chrono::milliseconds kToAnswer{300};  // until a client has what it asked for
constexpr std::size_t kMostFileName = 255;
constexpr std::size_t kMostText = 65536;  // bytes of places or of a layout
constexpr const char* kNoSource = "choose where the array is first";

}  // namespace

class ArraySetup::Implementation {
 public:
  /// `name`: empty where clients choose it.
  Implementation(std::unique_ptr<websocket::Server> server, std::optional<SourceName> name, const FirstLook& found,
                 live::sources::SourceOptions options)
      : name_(std::move(name)),
        from_(name_ ? name_->text : ""),
        options_(std::move(options)),
        server_(std::move(server)) {
    show(found);
    server_->start({}, services(!name_));
  }

  [[nodiscard]] std::uint16_t port() const noexcept { return server_->port(); }

  DescribedArray run(const std::atomic<bool>& stop) {
    while (!stop) {
      if (const std::optional<DescribedArray> array = described()) {
        std::this_thread::sleep_for(kToAnswer);
        return *array;
      }
      std::this_thread::sleep_for(kPeriod);
    }
    return {};
  }

  [[nodiscard]] std::string source() const { return name_ ? name_->text : std::string(); }

  [[nodiscard]] std::optional<DescribedArray> described() {
    const std::lock_guard lock(mutex_);
    if (described_.model.empty() && described_.suit.empty()) return std::nullopt;
    return described_;
  }

 private:
  using Call = Result<std::string> (Implementation::*)(std::string_view);
  using Begin = Result<Later> (Implementation::*)(std::string_view);

  std::vector<websocket::Service> services(bool with_choice) {
    const auto service = [this](const char* name, Call call) {
      return websocket::Service{name, [this, call](std::string_view request) { return (this->*call)(request); }};
    };
    const auto slow = [this](const char* name, Begin begin) {
      return websocket::Service{.name = name,
                                .begin = [this, begin](std::string_view request) { return (this->*begin)(request); }};
    };
    std::vector<websocket::Service> services = {
        slow("/array/describe", &Implementation::describe),
        slow("/array/use", &Implementation::use),
        service("/array/watch", &Implementation::watch),
        service("/array/touch", &Implementation::touch),
        service("/layout/propose", &Implementation::propose),
        slow("/layout/use", &Implementation::use_layout),
        slow("/source/look", &Implementation::look),
        service("/array/press", &Implementation::press),
        service("/array/pressed", &Implementation::pressed),
        service("/array/skip", &Implementation::skip),
        service("/array/arrange", &Implementation::arrange),
        {"/array/known", [](std::string_view) { return Result<std::string>(known_arrays_json()); }}};
    if (!with_choice) return services;
    services.push_back({"/source/list", [](std::string_view) { return Result<std::string>(source_choices()); }});
    services.push_back(slow("/source/open", &Implementation::open));
    services.push_back(service("/source/leave", &Implementation::leave));
    return services;
  }

  void show(const FirstLook& found) {
    unread_ = found.bytes;
    server_->set_document("/suit.json", "application/json", setup_json(name_, found, layout_));
  }

  Result<Later> open(std::string_view request) {
    const Result<SourceName> name = source_request(request);
    if (!name) return name.error();
    return look_at(*name, {});
  }

  Result<Later> look(std::string_view /*request*/) {
    if (!name_) return bad_input(kNoSource);
    return look_at(*name_, layout_);
  }

  /// A source that cannot be opened is not taken. `layout`: that a client has chosen for it; empty: none.
  Later look_at(const SourceName& name, const std::string& layout) {
    close_watches();
    auto look = std::make_shared<SourceLook>(name, options_);
    return [this, name, layout, look]() -> std::optional<Result<std::string>> {
      const std::optional<Result<FirstLook>> found = look->found();
      if (!found) return std::nullopt;
      if (!*found) return found->error();
      name_ = name;
      layout_ = layout;
      if (layout.empty()) from_ = name.text;
      show(**found);
      return json_text(nlohmann::json{{"from", name_->text}});
    };
  }

  /// Another source may be chosen.
  Result<std::string> leave(std::string_view /*request*/) {
    close_watches();
    name_.reset();
    layout_.clear();
    show({});
    return std::string("{}");
  }

  Result<Later> describe(std::string_view request) {
    if (!name_) return bad_input(kNoSource);
    const Result<ArrayDescription> array = array_request(request);
    if (!array) return array.error();
    const Result<std::string> path = new_array_file(array->name, "array.toml");
    if (!path) return path.error();
    return when_it_sends(*array, [this, array = *array, path = *path] { return write(array, path); });
  }

  Result<std::string> write(const ArrayDescription& array, const std::string& path) {
    if (Status made = make_array_folder(array.name); !made) return made.error();
    if (Status written = bytes::files::write_array(path, array); !written) return written.error();
    if (Status kept = live::sources::write_array_source(array.name, *name_); !kept) return kept.error();
    return serve_as({.from = name_->text, .model = path, .is_new = true});
  }

  /// {"file": "mat/mat-20261130-101500.safetensors"}, one of those that are known. Without a source it is looked for
  /// where it was last time, and at the other ports.
  Result<Later> use(std::string_view text) {
    const Result<JsonRequest> request = JsonRequest::parse(text);
    if (!request) return request.error();
    const Result<std::string> file = request->text("file", kMostFileName);
    if (!file) return file.error();
    const Result<KnownArray> known = known_array(*file);
    if (!known) return known.error();
    if (!name_) {
      if (Status found = find_device(*known); !found) return found.error();
    }
    if (name_->kind == live::sources::SourceKind::recording) {
      if (const auto suit = open_suit({.from = name_->text, .model = known->file}, options_); !suit)
        return suit.error();
    }
    return when_it_sends(known->array, [this, known = *known] { return serve_known(known); });
  }

  Result<std::string> serve_known(const KnownArray& known) {
    if (!known.folder) return serve_as({.from = name_->text, .model = known.file});
    if (name_->kind != live::sources::SourceKind::recording) {
      if (Status kept = live::sources::write_array_source(known.folder->path, *name_); !kept) return kept.error();
    }
    if (known.folder->is_suit()) return serve_as({.suit = known.file});
    return serve_as({.from = name_->text, .model = known.file});
  }

  Result<std::string> serve_as(DescribedArray array) {
    const std::lock_guard lock(mutex_);
    described_ = std::move(array);
    return json_text(nlohmann::json{{"file", described_.suit.empty() ? described_.model : described_.suit}});
  }

  Status find_device(const KnownArray& known) {
    if (!known.folder || known.folder->from.empty()) return bad_input(kNoSource);
    const FrameShape sent = known.array.order.sent({known.array.rows, known.array.cols});
    Result<SourceName> found = live::sources::find_source(*known.folder, sent, options_);
    if (!found) return found.error();
    name_ = *std::move(found);
    return Done{};
  }

  /// After a frame of such an array: a source without one is not served, as its map would stay blank. Those of
  /// recordings are turned already.
  Later when_it_sends(const ArrayDescription& array, std::function<Result<std::string>()> then) {
    const FrameShape shape{array.rows, array.cols};
    const FrameShape sent = name_->kind == live::sources::SourceKind::recording ? shape : array.order.sent(shape);
    if (!watch_ || watch_->shape() != sent) begin_watch(sent);
    const auto end = std::chrono::steady_clock::now() + kPatience;
    return [this, sent, end, then = std::move(then)]() -> std::optional<Result<std::string>> {
      const TouchWatch::Seen seen = watch_->seen();
      if (seen.frames > 0) return then();
      if (!seen.problem.empty()) return bad_input(seen.problem);
      const bool is_stopped = options_.stop != nullptr && *options_.stop;
      if (!is_stopped && std::chrono::steady_clock::now() <= end) return std::nullopt;
      return bad_input(fmt::format("no frame of {}x{} readings came within 8 s", sent.rows, sent.cols));
    };
  }

  /// A device can be opened once.
  void close_watches() {
    watch_.reset();
    pressing_.reset();
  }

  void begin_watch(FrameShape shape) {
    close_watches();
    watch_ = std::make_unique<TouchWatch>(*name_, shape, options_);
  }

  /// Layouts of the bytes of which no frame was made; `text` has what the client knows of the array.
  Result<std::string> propose(std::string_view text) {
    const Result<JsonRequest> request = JsonRequest::parse(text);
    if (!request) return request.error();
    const Result<bytes::proposals::Known> known = known_request(*request);
    if (!known) return known.error();
    return layout_proposals(unread_, *known);
  }

  /// {"name": "mat", "place": 0} and what the client knows, or {"name": "mat", "layout": [line, ...]}: writes that
  /// layout, by which the source is then read.
  Result<Later> use_layout(std::string_view text) {
    if (!name_ || !name_->uri) return bad_input(kNoSource);
    const Result<JsonRequest> request = JsonRequest::parse(text, kMostText);
    if (!request) return request.error();
    const Result<std::string> name = request->file_name("name");
    if (!name) return name.error();
    const Result<std::string> layout = wanted_layout(*request, unread_);
    if (!layout) return layout.error();
    if (Status made = make_array_folder(*name); !made) return made.error();
    const std::string file = *name + "/layout.toml";
    const Result<std::string> array = write_layout(*layout, file);
    if (!array) return array.error();
    const Result<SourceName> described = SourceName::parse(read_by_layout(from_, file, *array));
    if (!described) return described.error();
    return look_at(*described, *layout);
  }

  /// From now on touch() gives the sent readings; `request` has their shape.
  Result<std::string> watch(std::string_view request) {
    if (!name_) return bad_input(kNoSource);
    const Result<FrameShape> shape = shape_request(request);
    if (!shape) return shape.error();
    begin_watch(*shape);
    return std::string("{}");
  }

  Result<std::string> touch(std::string_view /*request*/) {
    if (!watch_) return bad_input("nothing is watched");
    const TouchWatch::Seen seen = watch_->seen();
    const std::size_t cols = watch_->shape().cols;
    ordered_json answer;
    answer["ready"] = seen.is_ready;
    answer["touched"] = seen.taxel ? ordered_json{*seen.taxel / cols, *seen.taxel % cols} : ordered_json();
    answer["problem"] = seen.problem;
    answer["counts"] = counts_json(seen.counts);
    return json_text(answer);
  }

  /// {"sent_rows": 1, "sent_cols": 54} and the places: somebody begins to press them.
  Result<std::string> press(std::string_view text) {
    if (!name_) return bad_input(kNoSource);
    const Result<JsonRequest> request = JsonRequest::parse(text, kMostText);
    if (!request) return request.error();
    const Result<FrameShape> sent = sent_shape_request(*request);
    if (!sent) return sent.error();
    Result<learn::arrangement::Places> places = press_places_request(*request);
    if (!places) return places.error();
    close_watches();
    pressing_ = std::make_unique<PressWatch>(*name_, *sent, *std::move(places), options_);
    return pressed({});
  }

  Result<std::string> pressed(std::string_view /*request*/) {
    if (!pressing_) return bad_input("nothing is pressed");
    return json_text(pressing_->progress());
  }

  /// {"back": true}: the last place again; else nothing answers at this one.
  Result<std::string> skip(std::string_view text) {
    if (!pressing_) return bad_input("nothing is pressed");
    const Result<JsonRequest> request = JsonRequest::parse(text);
    if (!request) return request.error();
    const Result<bool> is_back = request->flag("back");
    if (!is_back) return is_back.error();
    *is_back ? pressing_->back() : pressing_->skip();
    return pressed({});
  }

  /// {"name": "hand"}: writes what was found, and the array is served by it.
  Result<std::string> arrange(std::string_view text) {
    if (!pressing_) return bad_input("nothing is pressed");
    const Result<JsonRequest> request = JsonRequest::parse(text);
    if (!request) return request.error();
    const Result<std::string> name = request->file_name("name");
    if (!name) return name.error();
    Result<std::string> path = new_array_file(*name, "array.toml");
    if (!path) return path;
    const learn::arrangement::ArrangementFiles files = learn::arrangement::arrangement_files(*path);
    const Result<learn::arrangement::Arrangement> made = pressing_->arrange(*name);
    if (!made) return made.error();
    if (Status folder = make_array_folder(*name); !folder) return folder.error();
    if (Status written = learn::arrangement::write_arrangement(files.array, *made, name_->text); !written)
      return written.error();
    if (Status kept = live::sources::write_array_source(*name, *name_); !kept) return kept.error();
    close_watches();
    const std::lock_guard lock(mutex_);
    described_ = {.suit = files.suit, .is_new = true};
    return json_text(nlohmann::json{{"file", files.suit}, {"remarks", made->remarks}});
  }

  std::mutex mutex_;
  DescribedArray described_;
  std::optional<SourceName> name_;  // this and the rest: of the services, which are called one at a time
  std::string from_;                // its text, without layout_
  live::sources::SourceOptions options_;
  std::string layout_;                    // that a client has chosen; empty: none
  std::vector<std::uint8_t> unread_;      // of which no frame was made
  std::unique_ptr<TouchWatch> watch_;     // null: nobody asked for it
  std::unique_ptr<PressWatch> pressing_;  // the same
  std::unique_ptr<websocket::Server> server_;
};

Result<std::unique_ptr<ArraySetup>> ArraySetup::create(const std::string& from, const SessionOptions& options,
                                                       live::sources::SourceOptions source_options) {
  if (from.empty() && !options.server.is_local()) {
    return bad_input("host: others reach this server, so clients may not choose a device; name its URI");
  }
  std::optional<SourceName> name;
  FirstLook found;
  if (!from.empty()) {
    Result<SourceName> parsed = SourceName::parse(from);
    if (!parsed) return parsed.error();
    name = *std::move(parsed);
    Result<FirstLook> looked = first_look(*name, source_options);
    if (!looked) return looked.error();
    found = *std::move(looked);
  }
  Result<std::unique_ptr<websocket::Server>> server = websocket::Server::create(options.server, options.page);
  if (!server) return server.error();
  return std::unique_ptr<ArraySetup>(new ArraySetup(
      std::make_unique<Implementation>(*std::move(server), std::move(name), found, std::move(source_options))));
}

ArraySetup::ArraySetup(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

ArraySetup::~ArraySetup() = default;

std::uint16_t ArraySetup::port() const noexcept {
  return implementation_->port();
}

DescribedArray ArraySetup::run(const std::atomic<bool>& stop) {
  return implementation_->run(stop);
}

std::optional<DescribedArray> ArraySetup::described() {
  return implementation_->described();
}

std::string ArraySetup::source() const {
  return implementation_->source();
}

}  // namespace dermis::out::serve
