// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/formats/dsa_events.hpp"

#include <expat.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "bytes/formats/bzip2_input.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;
constexpr std::size_t kMostTextBytes = std::size_t{1} << 26U;
constexpr std::size_t kMostUnparsedBytes = std::size_t{1} << 20U;  // expat begins a token again with each piece
constexpr std::size_t kMostNameBytes = std::size_t{1} << 16U;      // expat keeps each name
constexpr std::size_t kMostDepth = 32;

struct FreeParser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

}  // namespace

/// expat calls its handlers from within XML_Parse(); the parser stops at each event, and is resumed.
struct DsaEvents::State {
  /// The event that is being read.
  struct Event {
    DsaEvent read{};
    bool is_complete = false;
    bool is_shape_wrong = false;
  };

  std::unique_ptr<std::istream> in;
  std::string name;
  Bzip2Input bytes{*in};
  std::unique_ptr<XML_ParserStruct, FreeParser> parser{};
  std::vector<char> piece = std::vector<char>(kPieceBytes);
  std::size_t taken = 0;  ///< Bytes that the parser got.
  bool is_suspended = false;
  bool is_over = false;
  const char* refusal = nullptr;  ///< Why no DSA recording is so.
  std::size_t depth = 0;
  std::set<std::string, std::less<>> names{};  ///< Of elements and attributes.
  std::size_t name_bytes = 0;

  std::string text{};  ///< Of the element that is open.
  Event event{};

  void begin();
  [[nodiscard]] XML_Status advance();
  [[nodiscard]] Status fail(DsaEvent& failed);
  [[nodiscard]] Error error(const std::string& message) const;
  void refuse(const char* why);
  void add_name(std::string_view name);
  void start_element(std::string_view element, const XML_Char** attributes);
  void end_element(std::string_view element);
  void deliver(DsaEvent::Kind kind);
};

void DsaEvents::State::begin() {
  parser.reset(XML_ParserCreate(nullptr));
  is_suspended = is_over = false;
  refusal = nullptr;
  taken = depth = name_bytes = 0;
  names.clear();
  event = {};
  XML_SetUserData(parser.get(), this);
  XML_SetElementHandler(
      parser.get(),
      [](void* data, const XML_Char* element, const XML_Char** attributes) {
        static_cast<State*>(data)->start_element(element, attributes);
      },
      [](void* data, const XML_Char* element) { static_cast<State*>(data)->end_element(element); });
  XML_SetCharacterDataHandler(parser.get(), [](void* data, const XML_Char* text, int size) {
    auto& state = *static_cast<State*>(data);
    for (const char c : std::string_view(text, static_cast<std::size_t>(size))) {
      if (!is_space(c)) state.text += c;
    }
    if (state.text.size() > kMostTextBytes) state.refuse("has an element of more than 64 MiB");
  });
  XML_SetStartDoctypeDeclHandler(parser.get(), [](void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    static_cast<State*>(data)->refuse("has a document type, which no DSA recording has");
  });
}

void DsaEvents::State::refuse(const char* why) {
  refusal = why;
  XML_StopParser(parser.get(), XML_FALSE);
}

void DsaEvents::State::add_name(std::string_view name) {
  if (names.find(name) != names.end()) return;
  names.emplace(name);
  name_bytes += name.size();
  if (name_bytes > kMostNameBytes) refuse("has names of elements and attributes of more than 64 KiB");
}

void DsaEvents::State::start_element(std::string_view element, const XML_Char** attributes) {
  text.clear();
  add_name(element);
  for (; *attributes != nullptr; attributes += 2) add_name(*attributes);
  if (++depth > kMostDepth) refuse("has elements more than 32 deep in each other, which no DSA recording has");
}

void DsaEvents::State::end_element(std::string_view element) {
  --depth;
  if (element == "cells_x")
    event.is_shape_wrong = event.is_shape_wrong || !files::parse_number(text, event.read.shape.cols);
  if (element == "cells_y")
    event.is_shape_wrong = event.is_shape_wrong || !files::parse_number(text, event.read.shape.rows);
  if (element == "time_stamp") event.read.time_ms = text;
  if (element == "frame_data" || element == "temp_data") event.read.text = std::move(text);
  text.clear();
  if (element == "matrix") deliver(DsaEvent::Kind::matrix);
  if (element == "frame") deliver(DsaEvent::Kind::frame);
  if (element == "temp") deliver(DsaEvent::Kind::temperatures);
}

void DsaEvents::State::deliver(DsaEvent::Kind kind) {
  event.read.kind = kind;
  event.is_complete = true;
  XML_StopParser(parser.get(), XML_TRUE);
}

XML_Status DsaEvents::State::advance() {
  if (is_suspended) return XML_ResumeParser(parser.get());
  const auto parsed = static_cast<std::size_t>(std::max(XML_GetCurrentByteIndex(parser.get()), XML_Index{0}));
  if (taken > parsed + kMostUnparsedBytes) {
    refusal = "has a tag or a comment of more than 1 MiB";
    return XML_STATUS_ERROR;
  }
  const std::size_t size = bytes.read(piece);
  if (in->bad()) return XML_STATUS_ERROR;
  taken += size;
  const bool is_last = size < piece.size() && !bytes.is_damaged();
  return XML_Parse(parser.get(), piece.data(), static_cast<int>(size), is_last ? XML_TRUE : XML_FALSE);
}

/// Why there is nothing more to parse.
Status DsaEvents::State::fail(DsaEvent& failed) {
  is_over = true;
  if (in->bad()) return files::read_failure(name);
  if (refusal != nullptr) return error(refusal);
  const XML_Error code = XML_GetErrorCode(parser.get());
  const bool is_cut = code == XML_ERROR_NO_ELEMENTS || code == XML_ERROR_UNCLOSED_TOKEN ||
                      code == XML_ERROR_PARTIAL_CHAR || code == XML_ERROR_UNCLOSED_CDATA_SECTION;
  if (!is_cut) return error(std::string("is no XML: ") + XML_ErrorString(code));
  failed = {};
  failed.is_cut = true;
  return Done{};
}

Error DsaEvents::State::error(const std::string& message) const {
  return bad_input(name + ":" + std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": " + message);
}

DsaEvents::DsaEvents(std::unique_ptr<std::istream> in, std::string name)
    : state_(new State{std::move(in), std::move(name)}) {
  state_->begin();
}

DsaEvents::~DsaEvents() = default;

Status DsaEvents::next(DsaEvent& event) {
  State& state = *state_;
  event = {};
  state.event.is_complete = false;
  while (!state.is_over && !state.event.is_complete) {
    const XML_Status status = state.advance();
    XML_ParsingStatus parsing{};
    XML_GetParsingStatus(state.parser.get(), &parsing);
    state.is_suspended = parsing.parsing == XML_SUSPENDED;
    if (status == XML_STATUS_ERROR) {
      if (Status failed = state.fail(event); !failed) return failed;
    }
    if (state.bytes.is_damaged() && !state.is_suspended) {
      state.is_over = true;
      event.is_cut = true;
    }
    if (parsing.parsing == XML_FINISHED) state.is_over = true;
  }
  if (!state.event.is_complete) return Done{};
  if (state.event.is_shape_wrong) return error("a matrix has cells_x and cells_y that are no numbers");
  event = std::exchange(state.event.read, {});
  return Done{};
}

Status DsaEvents::rewind() {
  if (!state_->bytes.rewind()) return bad_input(name() + ": cannot be read from a pipe; save it as a file");
  state_->begin();
  return Done{};
}

const std::string& DsaEvents::name() const noexcept {
  return state_->name;
}

std::string DsaEvents::place() const {
  return state_->name + ":" + std::to_string(XML_GetCurrentLineNumber(state_->parser.get()));
}

Error DsaEvents::error(const std::string& message) const {
  return state_->error(message);
}

}  // namespace dermis::bytes::formats
