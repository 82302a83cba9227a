// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The functions of the module, as viewer/src/page calls them. Bytes of the page lie in room that dermis_room() gives.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bindings/browser/fit_link.hpp"
#include "bindings/browser/page_link.hpp"
#include "bindings/browser/page_port.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "dermis/out/serve/array_setup.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/out/serve/session.hpp"
#include "live/sources/simulated_source.hpp"

#define DERMIS_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {

using namespace dermis;  // NOLINT(google-build-using-namespace)

constexpr const char* kContacts = "contacts";
constexpr const char* kRehearsal = "rehearsal";
constexpr double kSimulatedHz = 100.0;
constexpr std::size_t kSimulatedFrames = 600;  // of the scene, at 100 Hz
constexpr int kWarning = 1;
constexpr int kError = 2;

/// The page's recordings are in its folder, with this name or another.
constexpr const char* kRecordings = "/recordings/dermis.mcap";

/// All that the page has: a session, or the setup of one.
struct Module {
  std::unique_ptr<out::serve::Session> session;
  std::unique_ptr<out::serve::ArraySetup> setup;
  bool is_other = false;           // than the client was connected to
  std::string failure;             // for the next client
  std::vector<std::uint8_t> room;  // bytes from the page
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

Result<out::serve::ServedSuit> simulated(const std::string& model_file, const std::string& scene) {
  Result<touch::pipeline::Model> model = bytes::models::model_from_bytes(model_file, "the model");
  if (!model) return model.error();
  if (scene == kRehearsal) model = learn::calibration::uncalibrated_model(ArrayDescription(model->array));
  bytes::devices::SourceUri uri;
  uri.text = "sim:" + scene;
  uri.transport = bytes::devices::Transport::simulation;
  uri.path = scene;
  uri.rate_hz = kSimulatedHz;
  uri.frames = kSimulatedFrames;
  live::sources::SourceOptions options;
  options.array = &model->array;
  options.guide = std::make_shared<live::sources::GuideVoice>();
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_simulation(uri, options);
  if (!source) return source.error();
  Result<out::serve::ServedSuit> suit = out::serve::suit_of_one(*std::move(source), *std::move(model));
  if (suit) suit->guide = options.guide;
  return suit;
}

void tell(const std::string& line) {
  if (auto* const link = browser::page_link()) link->tell(kWarning, line);
}

out::serve::SessionOptions session_options() {
  out::serve::SessionOptions options;
  options.server.notice = tell;
  options.recordings = kRecordings;
  return options;
}

Status serve(Result<out::serve::ServedSuit> suit) {
  std::error_code is_there;
  std::filesystem::create_directories(std::filesystem::path(kRecordings).parent_path(), is_there);
  if (!suit) return suit.error();
  Result<std::unique_ptr<out::serve::Session>> session =
      out::serve::Session::create(*std::move(suit), session_options());
  if (!session) return session.error();
  module().session = *std::move(session);
  return Done{};
}

/// Somebody chooses where the array is, and describes it.
void begin_setup() {
  module().session.reset();
  module().setup.reset();
  module().setup = out::serve::ArraySetup::create("", session_options(), {.notice = tell}).value();
  module().is_other = true;
}

/// Where the array cannot be served, its setup begins again.
void serve_described(const out::serve::DescribedArray& array) {
  module().setup.reset();
  module().is_other = true;
  const Status served =
      serve(out::serve::open_suit({.from = array.from, .model = array.model, .suit = array.suit}, {.notice = tell}));
  if (served) return;
  begin_setup();
  module().failure = served.error().message;
}

void tell_dropped() {
  const std::uint64_t dropped = browser::page_port().take_dropped();
  if (dropped > 0) tell("this page was too busy: " + std::to_string(dropped) + " bytes of the board are lost");
}

int answer_of(const Status& done) {
  answer(done ? "" : done.error().message);
  return done ? 1 : 0;
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

/// A simulated sheet with the model whose bytes are in the room. For a rehearsal it has none, and a hand that obeys the
/// guide of a calibration. 0: it could not begin, and the answer says why.
DERMIS_EXPORT(dermis_begin_simulation) int dermis_begin_simulation(std::size_t size, int is_rehearsal) {
  module().setup.reset();
  module().session.reset();
  module().is_other = true;
  return answer_of(serve(simulated(text_of(size), is_rehearsal != 0 ? kRehearsal : kContacts)));
}

/// A page on which somebody chooses an array and describes it, as that of `dermis serve` without arguments.
DERMIS_EXPORT(dermis_begin_setup) void dermis_begin_setup() {
  begin_setup();
}

/// A board is connected, open at that baud. Its name is in the room.
DERMIS_EXPORT(dermis_board) void dermis_board(std::size_t size, unsigned baud) {
  browser::page_port().connect(text_of(size), baud);
}
/// It was unplugged.
DERMIS_EXPORT(dermis_board_lost) void dermis_board_lost() {
  browser::page_port().lose();
}
/// Bytes of the board, in the room.
DERMIS_EXPORT(dermis_bytes) void dermis_bytes(std::size_t size) {
  browser::page_port().receive({module().room.data(), size});
}
/// What the page is to do with the board, one thing at a time. 0: nothing; 1: open it at the baud that is the answer;
/// 2: write the bytes of the answer to it.
DERMIS_EXPORT(dermis_board_request) int dermis_board_request() {
  const auto request = browser::page_port().next_request();
  if (!request) return 0;
  if (const auto* const open = std::get_if<browser::PagePort::Open>(&*request)) {
    answer(std::to_string(open->baud));
    return 1;
  }
  module().answer = std::get<browser::PagePort::Write>(*request);
  return 2;
}

/// The page's viewer begins to listen, as a client of the stream.
DERMIS_EXPORT(dermis_connect) void dermis_connect() {
  auto* const link = browser::page_link();
  if (link == nullptr) return;
  link->connect();
  module().is_other = false;
  if (const std::string failure = std::exchange(module().failure, {}); !failure.empty()) link->tell(kError, failure);
}

/// A message of the viewer, in the room. 0: it is none of the protocol, and the answer says why.
DERMIS_EXPORT(dermis_receive) int dermis_receive(std::size_t size, int is_text) {
  auto* const link = browser::page_link();
  return answer_of(link != nullptr ? link->receive({module().room.data(), size}, is_text != 0) : Done{});
}

/// Does what is due. Call it 30 times a second or more. 1: the server is another one, to which the viewer has to
/// connect.
DERMIS_EXPORT(dermis_work) int dermis_work() {
  const auto described = module().setup ? module().setup->described() : std::nullopt;
  if (described) serve_described(*described);
  if (module().session) module().session->work();
  auto* const link = browser::page_link();
  if (const Status worked = link != nullptr ? link->work() : Done{}; !worked) tell(worked.error().message);
  tell_dropped();
  return module().is_other ? 1 : 0;
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

/// In a copy of the module: the fit that fits.begin() asks for. Its outcome becomes the answer.
DERMIS_EXPORT(dermis_fit) void dermis_fit() {
  if (auto* const link = browser::fit_link()) answer(link->run());
}
/// The answer of dermis_fit() in the copy, in the room.
DERMIS_EXPORT(dermis_fit_done) void dermis_fit_done(std::size_t size) {
  if (auto* const link = browser::fit_link()) link->accept(text_of(size));
}
/// The share of it that is done.
DERMIS_EXPORT(dermis_fit_share) void dermis_fit_share(double share) {
  if (auto* const link = browser::fit_link()) link->accept_share(share);
}
/// The copy has ended without an answer; why is in the room.
DERMIS_EXPORT(dermis_fit_failed) void dermis_fit_failed(std::size_t size) {
  if (auto* const link = browser::fit_link()) link->fail(text_of(size));
}

/// The place of a file that clients may save, whose path at the server is in the room, becomes the answer. 0: none.
DERMIS_EXPORT(dermis_file) int dermis_file(std::size_t size) {
  auto* const link = browser::page_link();
  const std::string* const file = link != nullptr ? link->file(text_of(size)) : nullptr;
  if (file != nullptr) answer(*file);
  return file != nullptr ? 1 : 0;
}
