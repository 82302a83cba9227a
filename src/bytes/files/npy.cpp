// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/npy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "bytes/files/npy_header.hpp"
#include "dermis/bytes/files/array_frames.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/files/u16_counts.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMaxTableColumns = std::size_t{1} << 20U;

template <typename T>
T item_at(const char* bytes, bool is_big_endian) {
  std::array<char, sizeof(T)> item{};
  std::memcpy(item.data(), bytes, sizeof(T));
  if (is_big_endian) std::reverse(item.begin(), item.end());
  return std::bit_cast<T>(item);
}

/// False where a float does not hold the number exactly; floats are rounded.
template <typename T, typename Number>
bool to_number(T item, Number& number) {
  number = static_cast<Number>(item);
  if constexpr (std::is_integral_v<T> && std::is_same_v<Number, float>) {
    constexpr std::int64_t kLargestExact = std::int64_t{1} << std::numeric_limits<float>::digits;
    return std::cmp_less_equal(item, kLargestExact) && std::cmp_greater_equal(item, -kLargestExact);
  }
  return true;
}

/// Converts all items; the index of the first that cannot be, or the number of items.
template <typename T, typename Number>
std::size_t convert(const std::vector<char>& bytes, bool is_big_endian, std::vector<Number>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!to_number(item_at<T>(bytes.data() + i * sizeof(T), is_big_endian), numbers[i])) return i;
  }
  return numbers.size();
}

template <typename Number>
using Convert = std::size_t (*)(const std::vector<char>&, bool, std::vector<Number>&);

template <typename Number>
Convert<Number> conversion_of(const NpyHeader& header) {
  const bool is_signed = header.kind == 'i';
  if (header.kind == 'f') return header.item_bytes == 4 ? convert<float, Number> : convert<double, Number>;
  switch (header.item_bytes) {
    case 1: return is_signed ? convert<std::int8_t, Number> : convert<std::uint8_t, Number>;
    case 2: return is_signed ? convert<std::int16_t, Number> : convert<std::uint16_t, Number>;
    case 4: return is_signed ? convert<std::int32_t, Number> : convert<std::uint32_t, Number>;
    default: return is_signed ? convert<std::int64_t, Number> : convert<std::uint64_t, Number>;
  }
}

NumberArray array_of(const NpyHeader& header) {
  std::vector<std::size_t> sizes(header.shape.begin(), header.shape.end());
  return header.is_fortran_order ? NumberArray::first_fastest(std::move(sizes))
                                 : NumberArray::last_fastest(std::move(sizes));
}

/// All numbers of an array, as they stand in the file.
template <typename Number>
Result<std::vector<Number>> read_all(std::istream& in, const NpyHeader& header) {
  const std::size_t count = array_of(header).value_count();
  if (count > kMostArrayValues) return bad_input("has more than 67 million values; save it in parts");
  constexpr std::size_t kPiece = std::size_t{1} << 16U;
  std::vector<Number> numbers;
  std::vector<char> bytes;
  std::vector<Number> piece;
  while (numbers.size() < count) {
    piece.resize(std::min(kPiece, count - numbers.size()));
    bytes.resize(piece.size() * header.item_bytes);
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(in.gcount()) != bytes.size()) return bad_input("is cut short; save it again");
    if (conversion_of<Number>(header)(bytes, header.is_big_endian, piece) != piece.size()) {
      return bad_input("has a count beyond 16777216, which cannot be held exactly");
    }
    numbers.insert(numbers.end(), piece.begin(), piece.end());
  }
  if (in.peek() == std::istream::traits_type::eof()) return numbers;
  return bad_input("has bytes after its " + std::to_string(count) + " values; save it again");
}

/// The numbers, where they must be seen to find the frames, and these.
struct Plan {
  FrameAxes axes;
  std::vector<float> values;  // empty: frames are read one by one
};

Result<Plan> plan_of(std::istream& in, const NpyHeader& header, const std::string& name, const NpyInput& input) {
  const NumberArray array = array_of(header);
  const ArrayHints hints{name + (name.find('#') == std::string::npos ? "#" : ""), input.axes, input.shape,
                         input.seconds.size()};
  Plan plan;
  const auto read_values = [&]() -> Status {
    Result<std::vector<float>> values = read_all<float>(in, header);
    if (!values) return values.error();
    plan.values = *std::move(values);
    return Done{};
  };
  if (needs_values(array, hints)) {
    if (Status done = read_values(); !done) return done.error();
  }
  const Result<FrameAxes> axes = frame_axes(array, hints, plan.values);
  if (!axes) return axes.error();
  plan.axes = *axes;
  const NumberArray taken = NumberArray::last_fastest({axes->frames, axes->shape.rows, axes->shape.cols});
  const bool is_whole = taken.value_count() == array.value_count();
  if (plan.values.empty() && !(axes->is_in_order() && is_whole)) {
    if (Status done = read_values(); !done) return done.error();
  }
  return plan;
}

}  // namespace

struct NpyReader::State {
  std::unique_ptr<std::istream> in;
  std::string name;
  NpyHeader header;
  FrameAxes axes;
  NpyInput input;
  Convert<float> convert;
  std::unique_ptr<FrameSource> loaded{};  // instead of the stream
  std::uint64_t next = 0;
  std::vector<char> bytes{};

  Error error(const std::string& message) const { return bad_input(name + ": " + message); }
  std::string place() const { return "frame " + std::to_string(next) + " of " + std::to_string(axes.frames); }
  Status read(RawFrame& frame);
};

Status NpyReader::State::read(RawFrame& frame) {
  const FrameShape shape = axes.shape;
  bytes.resize(shape.taxel_count() * header.item_bytes);
  in->read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in->bad()) return read_failure(name);
  if (static_cast<std::size_t>(in->gcount()) != bytes.size()) {
    return error("is cut short in " + place() + "; save it again");
  }
  const std::optional<Nanos> time =
      nanos_from_seconds(input.seconds.empty() ? static_cast<double>(next) / input.rate_hz : input.seconds[next]);
  if (!time) return error(place() + " would be later than 9e9 seconds; give a higher rate");
  frame.time = *time;
  frame.counts.resize(shape.taxel_count());
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.acquisition = {};
  const std::size_t converted = convert(bytes, header.is_big_endian, frame.counts);
  if (converted == frame.counts.size()) return Done{};
  return error(place() + " has a count at " + taxel_name(converted / shape.cols, converted % shape.cols) +
               " beyond 16777216, which cannot be held exactly");
}

NpyReader::NpyReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

NpyReader::~NpyReader() = default;

Result<std::unique_ptr<NpyReader>> NpyReader::open(const std::string& path, const NpyInput& input) {
  Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path, input);
}

Result<std::unique_ptr<NpyReader>> NpyReader::open(std::unique_ptr<std::istream> in, const std::string& name,
                                                   const NpyInput& input) {
  assert(input.rate_hz > 0.0 || !input.seconds.empty());
  Result<NpyHeader> header = read_npy_header(*in);
  if (in->bad()) return read_failure(name);
  if (!header) return bad_input(name + ": " + header.error().message);
  Result<Plan> plan = plan_of(*in, *header, name, input);
  if (in->bad()) return read_failure(name);
  if (!plan) return bad_input(name + ": " + plan.error().message);
  if (!input.seconds.empty() && input.seconds.size() != plan->axes.frames) {
    return bad_input(name + ": has " + std::to_string(plan->axes.frames) + " frames and " +
                     std::to_string(input.seconds.size()) + " times; give a rate");
  }
  const Convert<float> convert = conversion_of<float>(*header);
  auto state = std::make_unique<State>(State{std::move(in), name, *std::move(header), plan->axes, input, convert});
  if (!plan->values.empty()) {
    ArrayTimes times{input.seconds, input.seconds.empty() ? std::optional(input.rate_hz) : std::nullopt};
    state->loaded = frames_of_array(name, plan->axes, std::move(plan->values), std::move(times));
  }
  return std::unique_ptr<NpyReader>(new NpyReader(std::move(state)));
}

Result<bool> NpyReader::next(RawFrame& frame) {
  if (state_->loaded) return state_->loaded->next(frame);
  if (state_->next == state_->axes.frames) {
    if (state_->in->peek() == std::istream::traits_type::eof()) return false;
    return state_->error("has bytes after its " + std::to_string(state_->next) + " frames; save it again");
  }
  if (const Status read = state_->read(frame); !read) return read.error();
  ++state_->next;
  return true;
}

std::optional<FrameShape> NpyReader::shape() const {
  return state_->axes.shape;
}

Result<NpyTable> read_npy_table(const std::string& path) {
  Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read_npy_table(*std::move(in), path);
}

Result<NpyTable> read_npy_table(std::unique_ptr<std::istream> in, const std::string& name) {
  const std::istream::pos_type start = in->tellg();
  const Result<NpyHeader> header = read_npy_header(*in);
  if (in->bad()) return read_failure(name);
  if (!header) return bad_input(name + ": " + header.error().message);
  NpyInput input{.rate_hz = 1.0};
  if (header->shape.size() == 3) input.axes = "frames, rows, cols";
  if (header->shape.size() == 2) {
    if (header->shape[1] == 0 || header->shape[1] > kMaxTableColumns) {
      return bad_input(name + ": has " + std::to_string(header->shape[1]) + " columns; 1 to 1048576 can be read");
    }
    input.shape = {1, static_cast<std::size_t>(header->shape[1])};
  }
  in->clear();
  in->seekg(start);
  Result<std::unique_ptr<NpyReader>> reader = NpyReader::open(std::move(in), name, input);
  if (!reader) return reader.error();
  NpyTable table{0, (*reader)->shape()->taxel_count(), {}};
  RawFrame frame;
  while (true) {
    const Result<bool> more = (*reader)->next(frame);
    if (!more) return more.error();
    if (!*more) return table;
    table.values.insert(table.values.end(), frame.counts.begin(), frame.counts.end());
    ++table.rows;
  }
}

Result<std::vector<double>> read_npy_numbers(std::istream& in) {
  const Result<NpyHeader> header = read_npy_header(in);
  if (!header) return header.error();
  return read_all<double>(in, *header);
}

struct NpyWriter::State {
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

  AtomicFile file;
  FrameShape shape;
  bool is_u16 = true;
  std::uint64_t frames = 0;
  std::uint64_t written_items = 0;
  std::string waiting{};

  std::size_t item_bytes() const { return is_u16 ? sizeof(std::uint16_t) : sizeof(float); }
  void append(const std::vector<float>& counts);
  void flush();
  void widen();
};

void NpyWriter::State::append(const std::vector<float>& counts) {
  const auto append_item = [this](auto item) { waiting.append(reinterpret_cast<const char*>(&item), sizeof(item)); };
  for (const float count : counts) {
    if (is_u16) {
      append_item(static_cast<std::uint16_t>(count));
    } else {
      append_item(count);
    }
  }
  if (waiting.size() >= kBufferBytes) flush();
}

void NpyWriter::State::flush() {
  file.write_at(kNpyHeaderBytes + written_items * item_bytes(), waiting);
  written_items += waiting.size() / item_bytes();
  waiting.clear();
}

/// All counts so far from u16 to f32, from the last to the first: what is overwritten was read before.
void NpyWriter::State::widen() {
  flush();
  constexpr std::uint64_t kBlockItems = kBufferBytes / sizeof(float);
  std::vector<std::uint16_t> narrow;
  for (std::uint64_t end = written_items; end > 0 && file.status();) {
    const std::uint64_t begin = end - std::min(end, kBlockItems);
    narrow.resize(end - begin);
    file.read_at(kNpyHeaderBytes + begin * sizeof(std::uint16_t),
                 {reinterpret_cast<char*>(narrow.data()), narrow.size() * sizeof(std::uint16_t)});
    const std::vector<float> wide(narrow.begin(), narrow.end());
    file.write_at(kNpyHeaderBytes + begin * sizeof(float),
                  {reinterpret_cast<const char*>(wide.data()), wide.size() * sizeof(float)});
    end = begin;
  }
  is_u16 = false;
}

NpyWriter::NpyWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}

NpyWriter::~NpyWriter() = default;

Result<std::unique_ptr<NpyWriter>> NpyWriter::create(const std::string& path, FrameShape shape) {
  assert(shape.taxel_count() > 0);
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->write_at(0, npy_header("<u2", 0, shape.rows, shape.cols));
  if (const Status written = file->status(); !written) return written.error();
  return std::unique_ptr<NpyWriter>(new NpyWriter(std::make_unique<State>(State{*std::move(file), shape})));
}

Status NpyWriter::write(const RawFrame& frame) {
  assert(frame.counts.size() == state_->shape.taxel_count());
  if (state_->is_u16 && !fit_u16(frame.counts)) state_->widen();
  state_->append(frame.counts);
  ++state_->frames;
  return state_->file.status();
}

Status NpyWriter::commit() {
  State& state = *state_;
  state.flush();
  state.file.write_at(0, npy_header(state.is_u16 ? "<u2" : "<f4", state.frames, state.shape.rows, state.shape.cols));
  return state.file.commit();
}

}  // namespace dermis::bytes::files
