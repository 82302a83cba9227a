// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/requests/array_request.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "out/serve/requests/json_request.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::uint64_t kMostBits = 99;  // more than any array may have

Result<std::uint64_t> whole(const JsonRequest& request, const char* field, const char* wanted) {
  const Result<std::optional<std::uint64_t>> number = request.number(field, wanted);
  if (!number) return number.error();
  if (!*number) return bad_field(field, std::string("must be ") + wanted);
  return **number;
}

Result<FrameShape> shape_of(const JsonRequest& request, const char* rows_field = "rows",
                            const char* cols_field = "cols") {
  const auto rows = whole(request, rows_field, "1 to 1024");
  if (!rows) return rows.error();
  const auto cols = whole(request, cols_field, "1 to 1024");
  if (!cols) return cols.error();
  if (*rows < 1 || *rows > kMaxLines) return bad_field(rows_field, "must be 1 to 1024");
  if (*cols < 1 || *cols > kMaxLines) return bad_field(cols_field, "must be 1 to 1024");
  return FrameShape{*rows, *cols};
}

Status read_order(const JsonRequest& request, LineOrder& order) {
  const Result<bool> transpose = request.flag("transpose");
  const Result<bool> flip_rows = request.flag("flip_rows");
  const Result<bool> flip_cols = request.flag("flip_cols");
  for (const auto* flag : {&transpose, &flip_rows, &flip_cols}) {
    if (!*flag) return flag->error();
  }
  order.transpose = *transpose;
  order.flip_rows = *flip_rows;
  order.flip_cols = *flip_cols;
  return Done{};
}

}  // namespace

Result<ArrayDescription> array_request(std::string_view text) {
  const Result<JsonRequest> request = JsonRequest::parse(text);
  if (!request) return request.error();
  const Result<std::string> name = request->file_name("name");
  if (!name) return name.error();
  const Result<FrameShape> shape = shape_of(*request);
  if (!shape) return shape.error();
  const auto pitch_um = whole(*request, "pitch_um", "a whole number of micrometres");
  if (!pitch_um) return pitch_um.error();
  const auto adc_bits = whole(*request, "adc_bits", "1 to 24");
  if (!adc_bits) return adc_bits.error();
  ArrayDescription array;
  array.name = *name;
  array.rows = shape->rows;
  array.cols = shape->cols;
  array.row_pitch_m = array.col_pitch_m = 1e-6 * static_cast<double>(*pitch_um);
  array.readout.circuit = Circuit::automatic;
  array.readout.adc_bits = static_cast<int>(std::min(*adc_bits, kMostBits));
  if (Status order = read_order(*request, array.order); !order) return order.error();
  if (Status valid = array.validate(); !valid) return valid.error();
  return array;
}

Result<FrameShape> sent_shape_request(const JsonRequest& request) {
  return shape_of(request, "sent_rows", "sent_cols");
}

Result<FrameShape> shape_request(std::string_view text) {
  const Result<JsonRequest> request = JsonRequest::parse(text);
  if (!request) return request.error();
  return shape_of(*request);
}

}  // namespace dermis::out::serve
