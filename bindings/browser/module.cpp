// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The functions of the module, as viewer/src/try calls them. Bytes of the page lie in room that dermis_room() gives.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bindings/browser/fit_link.hpp"
#include "bindings/browser/opened_files.hpp"
#include "bindings/browser/page_link.hpp"
#include "bindings/browser/page_port.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/calibration/uncalibrated_model.hpp"
#include "dermis/live/suits/playback.hpp"
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
  std::optional<out::serve::ServedSuit> next;   // in the place of the session
  std::optional<touch::pipeline::Model> sheet;  // that is simulated where no board is served
  std::string scene = kContacts;                // of the sheet
  std::optional<out::serve::SuitPlace> board;   // that was served last
  FrameShape board_shape;                       // of its array
  std::optional<browser::OpenedArray> array;    // the last that was opened
  std::string recording;                        // that is played; empty: the session is live
  bool is_other = false;                        // than the client was connected to
  std::string failure;                          // for the next client
  std::vector<std::uint8_t> room;               // bytes from the page
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

Result<out::serve::ServedSuit> simulated_sheet() {
  touch::pipeline::Model model = *module().sheet;
  const std::string& scene = module().scene;
  if (scene == kRehearsal) model = learn::calibration::uncalibrated_model(ArrayDescription(model.array));
  bytes::devices::SourceUri uri;
  uri.text = "sim:" + scene;
  uri.transport = bytes::devices::Transport::simulation;
  uri.path = scene;
  uri.rate_hz = kSimulatedHz;
  uri.frames = kSimulatedFrames;
  live::sources::SourceOptions options;
  options.array = &model.array;
  options.guide = std::make_shared<live::sources::GuideVoice>();
  Result<std::unique_ptr<FrameSource>> source = live::sources::open_simulation(uri, options);
  if (!source) return source.error();
  Result<out::serve::ServedSuit> suit = out::serve::suit_of_one(*std::move(source), std::move(model));
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
  module().next.reset();
  module().recording.clear();
  module().setup = out::serve::ArraySetup::create("", session_options(), {.notice = tell}).value();
  module().is_other = true;
}

/// `suit()` is served from now on. Where it cannot be, somebody has to choose and describe an array.
template <typename Suit>
void change_session(const Suit& suit) {
  module().setup.reset();
  module().session.reset();
  module().is_other = true;
  const Status served = serve(suit());
  if (served) return;
  begin_setup();
  module().failure = served.error().message;
}

void serve_board(out::serve::SuitPlace place) {
  module().board = std::move(place);
  module().recording.clear();
  change_session([] {
    Result<out::serve::ServedSuit> suit = out::serve::open_suit(*module().board, {.notice = tell});
    if (suit) module().board_shape = {suit->arrays[0].description.rows, suit->arrays[0].description.cols};
    return suit;
  });
}

/// The board, else the sheet.
void go_live() {
  if (module().board) return serve_board(*module().board);
  module().recording.clear();
  change_session(simulated_sheet);
}

/// The board by another array: that which is being described, else the one that is served.
Status serve_board_as(const browser::OpenedArray& array) {
  const Module& page = module();
  const std::string chosen = page.setup ? page.setup->source() : std::string();
  if (!page.setup && page.board && array.shape() != page.board_shape) {
    return bad_input(fmt::format("{}: is of {}x{} taxels, the board's array of {}x{}", array.path, array.shape().rows,
                                 array.shape().cols, page.board_shape.rows, page.board_shape.cols));
  }
  const std::string served = page.board ? page.board->from : browser::page_port().uri();
  serve_board({.from = chosen.empty() ? served : chosen, .model = array.path});
  return Done{};
}

Status open_recording(const std::string& path) {
  Result<out::serve::ServedSuit> suit = browser::open_recording(path, module().array);
  if (!suit) return suit.error();
  module().recording = path;
  module().next = *std::move(suit);
  return Done{};
}

/// An array for the recording that is played, for the board, or for the sheet.
Status open_array(const std::string& path) {
  Module& page = module();
  Result<browser::OpenedArray> array = browser::open_array(path);
  if (!array) return array.error();
  page.array = *std::move(array);
  if (!page.recording.empty()) return open_recording(page.recording);
  if (browser::page_port().is_there()) return serve_board_as(*page.array);
  page.sheet = page.array->model;
  page.scene = kContacts;
  Result<out::serve::ServedSuit> suit = simulated_sheet();
  if (!suit) return suit.error();
  page.next = *std::move(suit);
  return Done{};
}

/// Once a second at most.
void tell_dropped() {
  static std::chrono::steady_clock::time_point told;
  const auto now = std::chrono::steady_clock::now();
  if (now - told < std::chrono::seconds(1)) return;
  const std::uint64_t dropped = browser::page_port().take_dropped();
  if (dropped == 0) return;
  told = now;
  tell("this page was too busy: " + std::to_string(dropped) + " bytes of the board are lost");
}

int answer_of(const Status& done) {
  answer(done ? "" : done.error().message);
  return done ? 1 : 0;
}

}  // namespace

void browser::serve_next(out::serve::ServedSuit suit) {
  module().recording = suit.playback ? suit.playback->path() : "";
  module().next = std::move(suit);
}

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
  Result<touch::pipeline::Model> model = bytes::models::model_from_bytes(text_of(size), "the model");
  if (!model) return answer_of(model.error());
  module().sheet = *std::move(model);
  module().scene = is_rehearsal != 0 ? kRehearsal : kContacts;
  module().is_other = true;
  return answer_of(serve(simulated_sheet()));
}

/// Ends the recording that is played: the board that was served last is live, else the sheet.
DERMIS_EXPORT(dermis_go_live) void dermis_go_live() {
  go_live();
}

/// Opens the file whose path is in the room: a recording, a model, an array.toml. 0: it cannot, and the answer says
/// why.
DERMIS_EXPORT(dermis_open) int dermis_open(std::size_t size) {
  const std::string path = text_of(size);
  return answer_of(browser::is_recording(path) ? open_recording(path) : open_array(path));
}

/// A page on which somebody chooses an array and describes it, as that of `dermis serve` without arguments.
DERMIS_EXPORT(dermis_begin_setup) void dermis_begin_setup() {
  module().board.reset();
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
/// The next thing that the page is to do with the board. 0: nothing; 1: open it at the baud that is the answer;
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
  if (const auto array = module().setup ? module().setup->described() : std::nullopt) {
    serve_board({.from = array->from, .model = array->model, .suit = array->suit});
  }
  if (auto next = std::exchange(module().next, std::nullopt)) {
    change_session([&]() -> Result<out::serve::ServedSuit> { return *std::move(next); });
  }
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
