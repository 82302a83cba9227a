// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "dermis/bytes/files/content_hash.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// A dense row-major array. The number of `values` is the product of `shape` (1 for an empty shape). Their type is that
/// in the file: F32, F64, U8 or I64.
struct Tensor {
  std::vector<std::size_t> shape;
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint8_t>, std::vector<std::int64_t>> values;

  bool operator==(const Tensor&) const = default;
};

/// The content of a safetensors file (https://huggingface.co/docs/safetensors): named tensors and a map of texts.
struct SafetensorsFile {
  std::map<std::string, std::string> metadata;
  std::map<std::string, Tensor> tensors;
  bool has_checksum = false;  ///< It was read, and its content fits the checksum in it.

  /// The elements of a tensor, which must have this shape and element type (float, double, std::uint8_t or
  /// std::int64_t). They live as long as the tensor. Errors name the tensor, without a path.
  template <typename T>
  [[nodiscard]] Result<std::span<const T>> view(const std::string& name, const std::vector<std::size_t>& shape) const;

  /// By content.
  bool operator==(const SafetensorsFile& other) const { return metadata == other.metadata && tensors == other.tensors; }
};

/// `values` as the tensor `name` of the file.
template <typename T>
void put_tensor(SafetensorsFile& file, const std::string& name, std::vector<std::size_t> shape,
                const std::vector<T>& values) {
  file.tensors[name] = {std::move(shape), values};
}

/// Copies tensors out of a file and keeps the first error.
class TensorReader {
 public:
  /// `file` is to outlive it.
  explicit TensorReader(const SafetensorsFile& file) : file_(file) {}

  /// See SafetensorsFile::view(). Where that fails, `values` stay as they were.
  template <typename T>
  void get(const std::string& name, const std::vector<std::size_t>& shape, std::vector<T>& values) {
    const Result<std::span<const T>> view = file_.view<T>(name, shape);
    if (view) {
      values.assign(view->begin(), view->end());
    } else if (!first_error_) {
      first_error_ = view.error();
    }
  }

  [[nodiscard]] const std::optional<Error>& first_error() const { return first_error_; }

 private:
  const SafetensorsFile& file_;
  std::optional<Error> first_error_;
};

/// Reads a file of at most `most_bytes` with a header of at most 4 MiB. The tensors must fill the file without gap or
/// overlap. Metadata and tensors must fit the checksum, if there is one.
[[nodiscard]] Result<SafetensorsFile> read_safetensors(const std::string& path,
                                                       std::size_t most_bytes = std::size_t{1} << 30U);
/// The same from memory; `name` stands for the path in messages.
[[nodiscard]] Result<SafetensorsFile> safetensors_from_bytes(std::string_view bytes, const std::string& name);

/// The metadata "format" of a file of ours.
struct FileFormat {
  const char* name;              ///< Such a file has a checksum.
  const char* without_checksum;  ///< The same from before there were checksums.
  const char* otherwise;         ///< The error of any other file.
};

/// Checks that the file is of the format and has not lost its checksum. The error names no path.
[[nodiscard]] Status check_format(const SafetensorsFile& file, const FileFormat& format);

/// A line for the reader of a file of ours that is older than the checksums: damage to it does not show. It is empty
/// for every other file.
[[nodiscard]] std::optional<std::string> checksum_note(const std::string& path, const FileFormat& format);

/// Writes the file atomically, with a checksum as its metadata "checksum". The same content gives the same bytes;
/// tensors are aligned to their element size.
[[nodiscard]] Status write_safetensors(const std::string& path, const SafetensorsFile& file);
/// The bytes that it writes; `name` stands for the path in messages.
[[nodiscard]] Result<std::string> safetensors_to_bytes(const SafetensorsFile& file, const std::string& name);

/// The part of a file before large tensors that are written piece by piece.
struct SafetensorsBeginning {
  std::string bytes;             ///< Length, header and the first tensors; the large ones follow.
  std::size_t header_bytes = 0;  ///< Of those, length and header.
  std::size_t checksum = 0;      ///< Where the text of the checksum is in the header, to be put in.
  ContentHash hash;              ///< It becomes the checksum: all that follows the header is to be added.
};

/// The beginning of the file that write_safetensors() makes of `file` and of tensors of F32 with these names, sorted,
/// which all have this shape. The tensors of `file` have elements of eight bytes.
[[nodiscard]] SafetensorsBeginning begin_safetensors(const SafetensorsFile& file, const std::vector<std::string>& names,
                                                     const std::vector<std::size_t>& shape);

}  // namespace dermis::bytes::files
