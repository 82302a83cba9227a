// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/safetensors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/bytes/files/file_kind.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

static_assert(std::endian::native == std::endian::little, "safetensors are little-endian");

using nlohmann::json;
using Shape = std::vector<std::size_t>;
using Values = decltype(Tensor::values);

constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kAlignment = 8;
constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 22U;
constexpr const char* kMetadata = "__metadata__";
constexpr const char* kChecksum = "checksum";  // a key of the metadata
constexpr const char* kMendDamage = "; restore it from a copy, or make it again";
constexpr std::array<const char*, std::variant_size_v<Values>> kTypeNames{"F32", "F64", "U8", "I64"};  // as in Values

const char* type_name(const Values& values) {
  return kTypeNames[values.index()];
}

std::optional<Values> empty_values(std::string_view type) {
  if (type == "F32") return std::vector<float>{};
  if (type == "F64") return std::vector<double>{};
  if (type == "U8") return std::vector<std::uint8_t>{};
  if (type == "I64") return std::vector<std::int64_t>{};
  return std::nullopt;
}

std::size_t element_bytes(const Values& values) {
  return std::visit([](const auto& elements) { return sizeof(elements[0]); }, values);
}

std::string_view bytes_of(const Values& values) {
  return std::visit(
      [](const auto& elements) {
        return std::string_view(reinterpret_cast<const char*>(elements.data()), elements.size() * sizeof(elements[0]));
      },
      values);
}

void assign_bytes(Values& values, std::string_view bytes) {
  std::visit(
      [bytes](auto& elements) {
        elements.resize(bytes.size() / sizeof(elements[0]));
        if (!bytes.empty()) std::memcpy(elements.data(), bytes.data(), bytes.size());
      },
      values);
}

/// Empty where the product does not fit.
std::optional<std::size_t> shape_product(const Shape& shape) {
  std::size_t product = 1;
  for (const std::size_t size : shape) {
    if (size != 0 && product > std::numeric_limits<std::size_t>::max() / size) return std::nullopt;
    product *= size;
  }
  return product;
}

std::string shape_text(const Shape& shape) {
  std::string text = "[";
  for (const std::size_t size : shape) text += (text.size() > 1 ? ", " : "") + std::to_string(size);
  return text + "]";
}

/// Refuses what the document tree would hide or what is too deep to be a header: names that stand twice, and more than
/// three levels.
class HeaderGuard {
 public:
  bool operator()(int depth, json::parse_event_t event, const json& value) {
    const auto level = static_cast<std::size_t>(depth);
    if (event == json::parse_event_t::object_start || event == json::parse_event_t::array_start) {
      if (level >= kMaxDepth) return fail("its header is nested too deeply");
      names_[level].clear();
    }
    if (event != json::parse_event_t::key || mistake_) return !mistake_;
    const auto& name = value.get_ref<const std::string&>();
    const bool is_new = level <= kMaxDepth && names_[level - 1].insert(name).second;
    return is_new || fail("its header names " + in_quotes(name) + " twice");
  }

  [[nodiscard]] const std::optional<std::string>& mistake() const { return mistake_; }

 private:
  static constexpr std::size_t kMaxDepth = 3;

  bool fail(std::string mistake) {
    if (!mistake_) mistake_ = std::move(mistake);
    return false;
  }

  std::array<std::set<std::string>, kMaxDepth> names_;
  std::optional<std::string> mistake_;
};

struct Entry {
  std::string name;
  Tensor tensor;
  std::size_t begin = 0;  ///< In bytes from the end of the header.
  std::size_t end = 0;
};

/// A list of whole numbers of 0 or more.
std::optional<Shape> sizes_from_json(const json& object, const char* key) {
  const auto list = object.find(key);
  if (list == object.end() || !list->is_array()) return std::nullopt;
  const auto is_size = [](const json& item) { return item.is_number_unsigned(); };
  return std::all_of(list->begin(), list->end(), is_size) ? std::optional(list->get<Shape>()) : std::nullopt;
}

Result<Values> parse_type(const json& object, const std::string& who) {
  const auto type = object.find("dtype");
  if (type == object.end() || !type->is_string()) return bad_input(who + " has no dtype");
  const auto& name = type->get_ref<const std::string&>();
  std::optional<Values> values = empty_values(name);
  if (!values) return bad_input(who + " has type " + in_quotes(name) + "; F32, F64, U8 and I64 can be read");
  return *std::move(values);
}

Result<Entry> parse_entry(const std::string& name, const json& object, std::size_t data_bytes) {
  const std::string who = "tensor " + in_quotes(name);
  if (!object.is_object()) return bad_input(who + " is not described by an object");
  Result<Values> values = parse_type(object, who);
  if (!values) return values.error();
  std::optional<Shape> shape = sizes_from_json(object, "shape");
  if (!shape) return bad_input(who + " has no shape of whole numbers");
  const std::optional<Shape> offsets = sizes_from_json(object, "data_offsets");
  if (!offsets || offsets->size() != 2 || (*offsets)[0] > (*offsets)[1]) {
    return bad_input(who + " has no data_offsets [begin, end]");
  }
  const auto [begin, end] = std::pair((*offsets)[0], (*offsets)[1]);
  const std::size_t size = element_bytes(*values);
  if ((end - begin) % size != 0 || shape_product(*shape) != (end - begin) / size) {
    return bad_input(who + " has " + std::to_string(end - begin) + " bytes, which do not fit " + type_name(*values) +
                     " " + shape_text(*shape));
  }
  if (end > data_bytes) {
    return bad_input("is cut short: " + who + " ends at byte " + std::to_string(end) + " of the data, which has " +
                     std::to_string(data_bytes));
  }
  return Entry{name, Tensor{*std::move(shape), *std::move(values)}, begin, end};
}

Status parse_metadata(const json& object, std::map<std::string, std::string>& metadata) {
  if (!object.is_object()) return bad_input("__metadata__ is not an object");
  for (const auto& [key, value] : object.items()) {
    if (!value.is_string()) return bad_input("__metadata__ " + in_quotes(key) + " is not a text");
    metadata[key] = value.get<std::string>();
  }
  return Done{};
}

/// The tensors must follow each other from the first byte of the data to the last.
Status check_layout(std::vector<Entry>& entries, std::size_t data_bytes) {
  std::ranges::sort(entries, {}, [](const Entry& entry) { return std::pair(entry.begin, entry.end); });
  std::size_t expected = 0;
  for (const Entry& entry : entries) {
    if (entry.begin != expected) {
      return bad_input("tensor " + in_quotes(entry.name) + " begins at byte " + std::to_string(entry.begin) +
                       " of the data, not at " + std::to_string(expected) + " where the one before it ends");
    }
    expected = entry.end;
  }
  if (expected != data_bytes) {
    return bad_input("has " + std::to_string(data_bytes - expected) + " bytes after the last tensor");
  }
  return Done{};
}

Result<json> parse_header(std::string_view text) {
  HeaderGuard guard;
  json header = json::parse(text.begin(), text.end(), std::ref(guard), false);
  if (guard.mistake()) return bad_input(*guard.mistake());
  const bool ends_early = text.find('\0') != std::string_view::npos;  // the parser would be content with what is before
  if (header.is_discarded() || ends_early)
    return bad_input("its header is not JSON; it is no safetensors file or is damaged");
  if (!header.is_object()) return bad_input("its header is not a JSON object");
  return header;
}

/// The text of the header; the rest of `bytes` is the data.
Result<std::string_view> take_header(std::string_view& bytes) {
  if (bytes.size() < kLengthBytes) {
    return bad_input("is cut short: has " + std::to_string(bytes.size()) + " bytes, fewer than the length of a header");
  }
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), kLengthBytes);
  bytes.remove_prefix(kLengthBytes);
  if (length > kMaxHeaderBytes) {
    return bad_input("has a header of " + std::to_string(length) + " bytes, at most " +
                     std::to_string(kMaxHeaderBytes) + " can be read; it is no safetensors file or is damaged");
  }
  if (length > bytes.size()) {
    return bad_input("is cut short: its header has " + std::to_string(length) + " bytes, the file only " +
                     std::to_string(bytes.size()) + " after the length");
  }
  const std::string_view header = bytes.substr(0, length);
  bytes.remove_prefix(length);
  return header;
}

Result<SafetensorsFile> parse_bytes(std::string_view bytes) {
  const Result<std::string_view> header_text = take_header(bytes);
  if (!header_text) return header_text.error();
  const Result<json> header = parse_header(*header_text);
  if (!header) return header.error();
  SafetensorsFile file;
  std::vector<Entry> entries;
  for (const auto& [name, object] : header->items()) {
    if (name == kMetadata) {
      if (const Status metadata = parse_metadata(object, file.metadata); !metadata) return metadata.error();
      continue;
    }
    Result<Entry> entry = parse_entry(name, object, bytes.size());
    if (!entry) return entry.error();
    entries.push_back(*std::move(entry));
  }
  if (const Status layout = check_layout(entries, bytes.size()); !layout) return layout.error();
  for (Entry& entry : entries) {
    assign_bytes(entry.tensor.values, bytes.substr(entry.begin, entry.end - entry.begin));
    file.tensors.emplace(std::move(entry.name), std::move(entry.tensor));
  }
  return file;
}

/// A tensor as the header lists it.
struct ListedTensor {
  std::string name;
  const Values* values;
  Shape shape;
  std::size_t bytes;
};

/// Large elements first, so that each tensor is aligned to its element; then by name.
std::vector<ListedTensor> in_file_order(const SafetensorsFile& file) {
  std::vector<ListedTensor> listed;
  for (const auto& [name, tensor] : file.tensors) {
    listed.push_back({name, &tensor.values, tensor.shape, bytes_of(tensor.values).size()});
    assert(listed.back().bytes == shape_product(tensor.shape).value() * element_bytes(tensor.values));
  }
  std::ranges::stable_sort(listed, std::greater(), [](const auto& tensor) { return element_bytes(*tensor.values); });
  return listed;
}

std::string header_of(const std::vector<ListedTensor>& tensors, const std::map<std::string, std::string>& metadata) {
  json header = json::object();
  if (!metadata.empty()) header[kMetadata] = metadata;
  std::size_t offset = 0;
  for (const ListedTensor& tensor : tensors) {
    assert(tensor.name != kMetadata);
    const std::size_t end = offset + tensor.bytes;
    header[tensor.name] = {
        {"dtype", type_name(*tensor.values)}, {"shape", tensor.shape}, {"data_offsets", {offset, end}}};
    offset = end;
  }
  std::string text = header.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + kAlignment - 1) / kAlignment * kAlignment, ' ');
  return text;
}

std::string length_of(const std::string& header) {
  const auto length = static_cast<std::uint64_t>(header.size());
  return {reinterpret_cast<const char*>(&length), kLengthBytes};
}

/// Checksum of the file as it is written without one: a program that writes the same content otherwise keeps it.
std::string checksum_of(const SafetensorsFile& file) {
  ContentHash hash;
  hash.add(header_of(in_file_order(file), file.metadata));
  for (const ListedTensor& tensor : in_file_order(file)) hash.add(bytes_of(*tensor.values));
  return hash.text();
}

/// Takes the checksum out of the metadata, which it is no part of.
Status take_checksum(SafetensorsFile& file) {
  const auto recorded = file.metadata.extract(kChecksum);
  if (recorded.empty()) return Done{};
  if (recorded.mapped() != checksum_of(file)) {
    return bad_input(std::string("is damaged: its checksum differs") + kMendDamage);
  }
  file.has_checksum = true;
  return Done{};
}

}  // namespace

template <typename T>
Result<std::span<const T>> SafetensorsFile::view(const std::string& name, const std::vector<std::size_t>& shape) const {
  const auto found = tensors.find(name);
  if (found == tensors.end()) return bad_input("tensor " + in_quotes(name) + " is missing");
  const Tensor& tensor = found->second;
  const auto* const elements = std::get_if<std::vector<T>>(&tensor.values);
  if (elements == nullptr || tensor.shape != shape) {
    return bad_input("tensor " + in_quotes(name) + " is " + type_name(tensor.values) + " " + shape_text(tensor.shape) +
                     ", expected " + type_name(Values(std::vector<T>{})) + " " + shape_text(shape));
  }
  return std::span<const T>(*elements);
}

template Result<std::span<const float>> SafetensorsFile::view(const std::string&, const Shape&) const;
template Result<std::span<const double>> SafetensorsFile::view(const std::string&, const Shape&) const;
template Result<std::span<const std::uint8_t>> SafetensorsFile::view(const std::string&, const Shape&) const;
template Result<std::span<const std::int64_t>> SafetensorsFile::view(const std::string&, const Shape&) const;

Result<SafetensorsFile> read_safetensors(const std::string& path, std::size_t most_bytes) {
  const Result<std::string> bytes = read_file(path, most_bytes);
  if (!bytes) return bytes.error();
  return safetensors_from_bytes(*bytes, path);
}

Result<SafetensorsFile> safetensors_from_bytes(std::string_view bytes, const std::string& name) {
  if (const auto other = wrong_kind(bytes, kSafetensorsKind)) return bad_input(name + ": " + *other);
  Result<SafetensorsFile> file = parse_bytes(bytes);
  if (!file) return bad_input(name + ": " + file.error().message);
  if (const Status whole = take_checksum(*file); !whole) return bad_input(name + ": " + whole.error().message);
  return file;
}

Status check_format(const SafetensorsFile& file, const FileFormat& format) {
  const auto recorded = file.metadata.find("format");
  if (recorded == file.metadata.end()) return bad_input(format.otherwise);
  if (recorded->second == format.without_checksum) return Done{};
  if (recorded->second != format.name) return bad_input(format.otherwise);
  if (!file.has_checksum) return bad_input(std::string("is damaged: it has lost its checksum") + kMendDamage);
  return Done{};
}

std::optional<std::string> checksum_note(const std::string& path, const FileFormat& format) {
  std::error_code error;
  if (path.ends_with(".toml") || !std::filesystem::is_regular_file(path, error)) return std::nullopt;
  const Result<SafetensorsFile> file = read_safetensors(path);
  if (!file || file->has_checksum) return std::nullopt;
  const auto recorded = file->metadata.find("format");
  if (recorded == file->metadata.end() || recorded->second != format.without_checksum) return std::nullopt;
  return path + ": is of an older dermis and has no checksum, so damage to it would not show";
}

Result<std::string> safetensors_to_bytes(const SafetensorsFile& file, const std::string& name) {
  std::map<std::string, std::string> metadata = file.metadata;
  metadata[kChecksum] = checksum_of(file);
  const std::string header = header_of(in_file_order(file), metadata);
  if (header.size() > kMaxHeaderBytes)
    return failed("cannot write " + in_quotes(name) + ": its header would be too long");
  std::string bytes = length_of(header) + header;
  for (const ListedTensor& tensor : in_file_order(file)) bytes += bytes_of(*tensor.values);
  return bytes;
}

Status write_safetensors(const std::string& path, const SafetensorsFile& file) {
  const Result<std::string> bytes = safetensors_to_bytes(file, path);
  if (!bytes) return bytes.error();
  Result<AtomicFile> out = AtomicFile::create(path);
  if (!out) return out.error();
  out->write(*bytes);
  return out->commit();
}

SafetensorsBeginning begin_safetensors(const SafetensorsFile& file, const std::vector<std::string>& names,
                                       const Shape& shape) {
  std::vector<ListedTensor> tensors = in_file_order(file);
  const Values floats = std::vector<float>{};
  for (const std::string& name : names) {
    tensors.push_back({name, &floats, shape, shape_product(shape).value() * sizeof(float)});
  }
  SafetensorsBeginning beginning;
  beginning.hash.add(header_of(tensors, file.metadata));
  std::map<std::string, std::string> metadata = file.metadata;
  metadata[kChecksum] = ContentHash().text();  // of as many characters as any
  const std::string header = header_of(tensors, metadata);
  beginning.bytes = length_of(header) + header;
  beginning.header_bytes = beginning.bytes.size();
  beginning.checksum = beginning.bytes.find(metadata[kChecksum]);
  for (const ListedTensor& tensor : in_file_order(file)) {
    assert(element_bytes(*tensor.values) == kAlignment);
    beginning.bytes += bytes_of(*tensor.values);
  }
  return beginning;
}

}  // namespace dermis::bytes::files
