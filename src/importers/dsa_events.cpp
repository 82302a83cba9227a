// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "importers/dsa_events.hpp"

#include <expat.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/files/text.hpp"
#include "importers/bzip2_input.hpp"

namespace dermis::importers {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 16U;
constexpr std::size_t kMostTextBytes = std::size_t{1} << 26U;

struct FreeParser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

}  // namespace

/// expat calls its handlers from within XML_Parse(); the parser stops at each event, and is resumed.
struct DsaEvents::State {
  std::unique_ptr<std::istream> in;
  std::string name;
  Bzip2Input bytes{*in};
  std::unique_ptr<XML_ParserStruct, FreeParser> parser{};
  std::vector<char> piece = std::vector<char>(kPieceBytes);
  std::size_t taken = 0;  ///< Bytes that the parser got.
  bool is_suspended = false;
  bool is_over = false;

  // Of the element that is open.
  std::string text{};
  DsaEvent open{};
  bool has_event = false;
  bool has_doctype = false;
  bool is_text_too_long = false;
  bool is_shape_wrong = false;

  void begin();
  [[nodiscard]] XML_Status advance();
  [[nodiscard]] Status fail(DsaEvent& event);
  void end_element(std::string_view element);
  void deliver(DsaEvent::Kind kind);
};

void DsaEvents::State::begin() {
  parser.reset(XML_ParserCreate(nullptr));
  is_suspended = is_over = has_event = has_doctype = is_text_too_long = is_shape_wrong = false;
  taken = 0;
  open = {};
  XML_SetUserData(parser.get(), this);
  XML_SetElementHandler(
      parser.get(), [](void* data, const XML_Char*, const XML_Char**) { static_cast<State*>(data)->text.clear(); },
      [](void* data, const XML_Char* element) { static_cast<State*>(data)->end_element(element); });
  XML_SetCharacterDataHandler(parser.get(), [](void* data, const XML_Char* text, int size) {
    auto& state = *static_cast<State*>(data);
    for (const char c : std::string_view(text, static_cast<std::size_t>(size))) {
      if (!is_space(c)) state.text += c;
    }
    if (state.text.size() <= kMostTextBytes) return;
    state.is_text_too_long = true;
    XML_StopParser(state.parser.get(), XML_FALSE);
  });
  XML_SetStartDoctypeDeclHandler(parser.get(), [](void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    auto& state = *static_cast<State*>(data);
    state.has_doctype = true;
    XML_StopParser(state.parser.get(), XML_FALSE);
  });
}

void DsaEvents::State::end_element(std::string_view element) {
  if (element == "cells_x") is_shape_wrong = is_shape_wrong || !files::parse_number(text, open.shape.cols);
  if (element == "cells_y") is_shape_wrong = is_shape_wrong || !files::parse_number(text, open.shape.rows);
  if (element == "time_stamp") open.time_ms = text;
  if (element == "frame_data" || element == "temp_data") open.text = std::move(text);
  text.clear();
  if (element == "matrix") deliver(DsaEvent::Kind::matrix);
  if (element == "frame") deliver(DsaEvent::Kind::frame);
  if (element == "temp") deliver(DsaEvent::Kind::temperatures);
}

void DsaEvents::State::deliver(DsaEvent::Kind kind) {
  open.kind = kind;
  has_event = true;
  XML_StopParser(parser.get(), XML_TRUE);
}

XML_Status DsaEvents::State::advance() {
  if (is_suspended) return XML_ResumeParser(parser.get());
  const auto parsed = static_cast<std::size_t>(std::max(XML_GetCurrentByteIndex(parser.get()), XML_Index{0}));
  is_text_too_long = taken > parsed + kMostTextBytes;  // the parser keeps what it cannot parse yet
  if (is_text_too_long) return XML_STATUS_ERROR;
  const std::size_t size = bytes.read(piece);
  taken += size;
  const bool is_last = size < piece.size() && !bytes.is_damaged();
  return XML_Parse(parser.get(), piece.data(), static_cast<int>(size), is_last ? XML_TRUE : XML_FALSE);
}

/// Why expat stopped for good.
Status DsaEvents::State::fail(DsaEvent& event) {
  is_over = true;
  const XML_Error error = XML_GetErrorCode(parser.get());
  const bool is_cut = error == XML_ERROR_NO_ELEMENTS || error == XML_ERROR_UNCLOSED_TOKEN ||
                      error == XML_ERROR_PARTIAL_CHAR || error == XML_ERROR_UNCLOSED_CDATA_SECTION;
  if (is_cut) {
    event = {};
    event.is_cut = true;
    return Done{};
  }
  if (has_doctype) return bad_input("has a document type, which no DSA recording has");
  if (is_text_too_long) return bad_input("has an element of more than 64 MiB");
  return bad_input(std::string("is no XML: ") + XML_ErrorString(error));
}

DsaEvents::DsaEvents(std::unique_ptr<std::istream> in, std::string name)
    : state_(new State{std::move(in), std::move(name)}) {
  state_->begin();
}

DsaEvents::~DsaEvents() = default;

Status DsaEvents::next(DsaEvent& event) {
  State& state = *state_;
  event = {};
  state.has_event = false;
  while (!state.is_over && !state.has_event) {
    const XML_Status status = state.advance();
    XML_ParsingStatus parsing{};
    XML_GetParsingStatus(state.parser.get(), &parsing);
    state.is_suspended = parsing.parsing == XML_SUSPENDED;
    if (status == XML_STATUS_ERROR) {
      if (const Status failed = state.fail(event); !failed) return error(failed.error().message);
    }
    if (state.bytes.is_damaged() && !state.is_suspended) {
      state.is_over = true;
      event.is_cut = true;
    }
    if (parsing.parsing == XML_FINISHED) state.is_over = true;
  }
  if (!state.has_event) return Done{};
  if (state.is_shape_wrong) return error("a matrix has cells_x and cells_y that are no numbers");
  event = std::exchange(state.open, {});
  return Done{};
}

void DsaEvents::rewind() {
  state_->bytes.rewind();
  state_->begin();
}

const std::string& DsaEvents::name() const noexcept {
  return state_->name;
}

std::string DsaEvents::place() const {
  return state_->name + ":" + std::to_string(XML_GetCurrentLineNumber(state_->parser.get()));
}

Error DsaEvents::error(const std::string& message) const {
  return bad_input(place() + ": " + message);
}

}  // namespace dermis::importers
