// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The functions of the module, as viewer/src/page calls them. Bytes of the page lie in room that dermis_room() gives.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bindings/browser/opened_files.hpp"
#include "bindings/browser/page_link.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/live/suits/playback.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/out/serve/session.hpp"
#include "live/sources/simulated_source.hpp"

#define DERMIS_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {

using namespace dermis;  // NOLINT(google-build-using-namespace)

constexpr double kSimulatedHz = 100.0;
constexpr std::size_t kSimulatedFrames = 600;  // of the scene, at 100 Hz

/// The page's recordings are in its folder, with this name or another.
constexpr const char* kRecordings = "/recordings/dermis.mcap";

/// All that the page has.
struct Module {
  std::unique_ptr<out::serve::Session> session;
  std::optional<out::serve::ServedSuit> next;  // in the place of the session
  std::optional<browser::OpenedArray> array;   // the last that was opened
  std::string recording;                       // that is played; empty: the session is live
  std::vector<std::uint8_t> room;              // bytes from the page
  std::vector<std::uint8_t> answer;
};

Module& module() {
  static Module module;
  return module;
}

void answer(std::string_view text) {
  module().answer.assign(text.begin(), text.end());
}

std::string text_of(std::size_t size) {
  return {reinterpret_cast<const char*>(module().room.data()), size};
}

Result<out::serve::ServedSuit> simulated(touch::pipeline::Model model) {
  bytes::devices::SourceUri uri;
  uri.text = "sim:contacts";
  uri.transport = bytes::devices::Transport::simulation;
  uri.path = "contacts";
  uri.rate_hz = kSimulatedHz;
  uri.frames = kSimulatedFrames;
  live::sources::SourceOptions options;
  options.array = &model.array;
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_simulation(uri, options);
  if (!source) return source.error();
  return out::serve::suit_of_one(*std::move(source), std::move(model));
}

Status serve(Result<out::serve::ServedSuit> suit) {
  if (!suit) return suit.error();
  Result<std::unique_ptr<out::serve::Session>> session =
      out::serve::Session::create(*std::move(suit), {.recordings = kRecordings});
  if (!session) return session.error();
  module().session = *std::move(session);
  return Done{};
}

Status begin(const std::string& model_file) {
  std::error_code is_there;
  std::filesystem::create_directories(std::filesystem::path(kRecordings).parent_path(), is_there);
  Result<touch::pipeline::Model> model = bytes::models::model_from_bytes(model_file, "the model");
  if (!model) return model.error();
  module().recording.clear();
  return serve(simulated(*std::move(model)));
}

/// A recording is played; an array is that of the recording, or of the simulator.
Status open(const std::string& path) {
  Module& page = module();
  if (!browser::is_recording(path)) {
    Result<browser::OpenedArray> array = browser::open_array(path);
    if (!array) return array.error();
    page.array = *std::move(array);
  }
  const std::string recording = browser::is_recording(path) ? path : page.recording;
  Result<out::serve::ServedSuit> suit =
      recording.empty() ? simulated(page.array->model) : browser::open_recording(recording, page.array);
  if (!suit) return suit.error();
  page.recording = recording;
  page.next = *std::move(suit);
  return Done{};
}

}  // namespace

void browser::serve_next(out::serve::ServedSuit suit) {
  module().recording = suit.playback ? suit.playback->path() : "";
  module().next = std::move(suit);
}

namespace {

/// Returns whether the session is another now.
bool change_session() {
  std::optional<out::serve::ServedSuit> next = std::exchange(module().next, std::nullopt);
  if (!next) return false;
  module().session.reset();
  const Status served = serve(*std::move(next));
  answer(served ? "" : served.error().message);
  return true;
}

}  // namespace

/// Where the page puts `size` bytes for the next call.
DERMIS_EXPORT(dermis_room) std::uint8_t* dermis_room(std::size_t size) {
  module().room.resize(size);
  return module().room.data();
}

/// The answer of the last call: text or bytes.
DERMIS_EXPORT(dermis_answer) const std::uint8_t* dermis_answer() {
  return module().answer.data();
}
DERMIS_EXPORT(dermis_answer_size) std::size_t dermis_answer_size() {
  return module().answer.size();
}

/// A simulated sheet with the model whose bytes are in the room. 0: it could not begin, and the answer says why.
DERMIS_EXPORT(dermis_begin_simulation) int dermis_begin_simulation(std::size_t size) {
  module().session.reset();
  const Status begun = begin(text_of(size));
  answer(begun ? "" : begun.error().message);
  return begun ? 1 : 0;
}

/// The page's viewer begins to listen, as a client of the stream.
DERMIS_EXPORT(dermis_connect) void dermis_connect() {
  if (auto* link = browser::page_link()) link->connect();
}

/// A message of the viewer, in the room. 0: it is none of the protocol, and the answer says why.
DERMIS_EXPORT(dermis_receive) int dermis_receive(std::size_t size, int is_text) {
  auto* const link = browser::page_link();
  const Status received = link != nullptr ? link->receive({module().room.data(), size}, is_text != 0) : Done{};
  answer(received ? "" : received.error().message);
  return received ? 1 : 0;
}

/// Does what is due. Call it 30 times a second or more. 1: the server is another from now on, and its client has to
/// connect; the answer is empty, or says why there is none.
DERMIS_EXPORT(dermis_work) int dermis_work() {
  const bool has_changed = change_session();
  if (module().session) module().session->work();
  return has_changed ? 1 : 0;
}

/// Opens the file whose path is in the room: a recording, a model, an array.toml. 0: it cannot, and the answer says
/// why.
DERMIS_EXPORT(dermis_open) int dermis_open(std::size_t size) {
  const Status opened = open(text_of(size));
  answer(opened ? "" : opened.error().message);
  return opened ? 1 : 0;
}

/// The next message for the viewer becomes the answer. 0: there is none; 1: text; 2: bytes.
DERMIS_EXPORT(dermis_next) int dermis_next() {
  auto* const link = browser::page_link();
  const auto message = link != nullptr ? link->next() : std::nullopt;
  if (!message) return 0;
  std::vector<std::uint8_t>& bytes = module().answer;
  bytes.clear();
  if (message->header) bytes.assign(message->header->begin(), message->header->end());
  bytes.insert(bytes.end(), message->bytes->begin(), message->bytes->end());
  return message->is_text ? 1 : 2;
}

/// A document of the server, whose path is in the room, becomes the answer. 0: there is none.
DERMIS_EXPORT(dermis_document) int dermis_document(std::size_t size) {
  auto* const link = browser::page_link();
  const std::string* const document = link != nullptr ? link->document(text_of(size)) : nullptr;
  if (document != nullptr) answer(*document);
  return document != nullptr ? 1 : 0;
}

/// The place of a file that clients may save, whose path at the server is in the room, becomes the answer. 0: none.
DERMIS_EXPORT(dermis_file) int dermis_file(std::size_t size) {
  auto* const link = browser::page_link();
  const std::string* const file = link != nullptr ? link->file(text_of(size)) : nullptr;
  if (file != nullptr) answer(*file);
  return file != nullptr ? 1 : 0;
}
