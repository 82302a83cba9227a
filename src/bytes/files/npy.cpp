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
#include <utility>
#include <vector>

#include "bytes/files/npy_header.hpp"
#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/files/u16_counts.hpp"
#include "dermis/touch/frames/array_description.hpp"

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
template <typename T>
bool to_count(T item, float& count) {
  count = static_cast<float>(item);
  if constexpr (std::is_integral_v<T>) {
    constexpr std::int64_t kLargestExact = std::int64_t{1} << std::numeric_limits<float>::digits;
    return std::cmp_less_equal(item, kLargestExact) && std::cmp_greater_equal(item, -kLargestExact);
  }
  return true;
}

/// Converts all items; the index of the first that cannot be, or the number of items.
template <typename T>
std::size_t convert(const std::vector<char>& bytes, bool is_big_endian, std::vector<float>& counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!to_count(item_at<T>(bytes.data() + i * sizeof(T), is_big_endian), counts[i])) return i;
  }
  return counts.size();
}

using Convert = std::size_t (*)(const std::vector<char>&, bool, std::vector<float>&);

Convert conversion_of(const NpyHeader& header) {
  const bool is_signed = header.kind == 'i';
  if (header.kind == 'f') return header.item_bytes == 4 ? convert<float> : convert<double>;
  switch (header.item_bytes) {
    case 1: return is_signed ? convert<std::int8_t> : convert<std::uint8_t>;
    case 2: return is_signed ? convert<std::int16_t> : convert<std::uint16_t>;
    case 4: return is_signed ? convert<std::int32_t> : convert<std::uint32_t>;
    default: return is_signed ? convert<std::int64_t> : convert<std::uint64_t>;
  }
}

/// The shape of a frame, or why there is none.
Result<FrameShape> frame_shape(const NpyHeader& header, const std::optional<FrameShape>& wanted) {
  const std::vector<std::uint64_t>& sizes = header.shape;
  if (header.is_fortran_order) return bad_input("is in Fortran order; save numpy.ascontiguousarray of it");
  if (sizes.size() == 2) {
    if (!wanted) return bad_input("has frames of " + std::to_string(sizes[1]) + " numbers; say how many rows and cols");
    if (sizes[1] == wanted->taxel_count()) return *wanted;
    return bad_input("has frames of " + std::to_string(sizes[1]) + " numbers, the array is " + size_text(*wanted));
  }
  if (sizes.size() != 3) {
    return bad_input("has " + std::to_string(sizes.size()) + " dimensions; frames x rows x cols is expected");
  }
  if (sizes[1] == 0 || sizes[2] == 0 || sizes[1] > kMaxLines || sizes[2] > kMaxLines) {
    return bad_input("has frames of " + std::to_string(sizes[1]) + "x" + std::to_string(sizes[2]) +
                     " taxels; 1x1 to 1024x1024 can be read");
  }
  const FrameShape shape{sizes[1], sizes[2]};
  if (wanted && *wanted != shape) {
    return bad_input("has " + size_text(shape) + " taxels, the array is " + size_text(*wanted));
  }
  return shape;
}

}  // namespace

struct NpyReader::State {
  std::unique_ptr<std::istream> in;
  std::string name;
  NpyHeader header;
  FrameShape shape;
  double rate_hz;
  Convert convert;
  std::uint64_t next = 0;
  std::vector<char> bytes{};

  Error error(const std::string& message) const { return bad_input(name + ": " + message); }
  std::string place() const { return "frame " + std::to_string(next) + " of " + std::to_string(header.shape[0]); }
  Status read(RawFrame& frame);
};

Status NpyReader::State::read(RawFrame& frame) {
  bytes.resize(shape.taxel_count() * header.item_bytes);
  in->read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in->bad()) return read_failure(name);
  if (static_cast<std::size_t>(in->gcount()) != bytes.size()) {
    return error("is cut short in " + place() + "; save it again");
  }
  const std::optional<Nanos> time = nanos_from_seconds(static_cast<double>(next) / rate_hz);
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
  assert(input.rate_hz > 0.0);
  Result<NpyHeader> header = read_npy_header(*in);
  if (in->bad()) return read_failure(name);
  if (!header) return bad_input(name + ": " + header.error().message);
  const Result<FrameShape> shape = frame_shape(*header, input.shape);
  if (!shape) return bad_input(name + ": " + shape.error().message);
  const Convert convert = conversion_of(*header);
  return std::unique_ptr<NpyReader>(new NpyReader(
      std::make_unique<State>(State{std::move(in), name, *std::move(header), *shape, input.rate_hz, convert})));
}

Result<bool> NpyReader::next(RawFrame& frame) {
  if (state_->next == state_->header.shape[0]) {
    if (state_->in->peek() == std::istream::traits_type::eof()) return false;
    return state_->error("has bytes after its " + std::to_string(state_->next) + " frames; save it again");
  }
  if (const Status read = state_->read(frame); !read) return read.error();
  ++state_->next;
  return true;
}

std::optional<FrameShape> NpyReader::shape() const {
  return state_->shape;
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
  std::optional<FrameShape> shape;  // of three dimensions, that in the file
  if (header->shape.size() == 2) {
    if (header->shape[1] == 0 || header->shape[1] > kMaxTableColumns) {
      return bad_input(name + ": has " + std::to_string(header->shape[1]) + " columns; 1 to 1048576 can be read");
    }
    shape = {1, static_cast<std::size_t>(header->shape[1])};
  }
  in->clear();
  in->seekg(start);
  Result<std::unique_ptr<NpyReader>> reader = NpyReader::open(std::move(in), name, {.rate_hz = 1.0, .shape = shape});
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
