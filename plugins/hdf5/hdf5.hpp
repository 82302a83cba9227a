// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/touch/frames/result.hpp"

/// A thin layer over the C library of HDF5 1.10. Every entry of this project into that library holds a QuietHdf5.
namespace dermis::bytes::recordings {

/// While it lives, HDF5 prints nothing of its errors in this thread.
class QuietHdf5 {
 public:
  QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;
  ~QuietHdf5();

 private:
  H5E_auto2_t print_ = nullptr;
  void* print_data_ = nullptr;
};

/// The last failure of HDF5 in this thread, at its root.
[[nodiscard]] std::string hdf5_reason();

/// An identifier of HDF5 and how to close it.
class Hdf5Id {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Id() = default;
  Hdf5Id(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Id() { static_cast<void>(close()); }

  [[nodiscard]] hid_t get() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ >= 0; }
  bool close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

using Hdf5Sizes = std::vector<hsize_t>;

/// "500 x 8 x 8"
[[nodiscard]] std::string sizes_text(const Hdf5Sizes& sizes);

/// A dataset that is read: of at most 8 dimensions, stored in the file itself, in chunks of at most 64 MiB.
struct Hdf5Dataset {
  Hdf5Id id;
  std::string place;  ///< "file.h5: dataset 'counts'", for messages.
  Hdf5Sizes sizes;
  Hdf5Sizes chunk;                  ///< Empty where the dataset is not chunked.
  H5T_class_t type = H5T_NO_CLASS;  ///< Of its elements.
  std::size_t element_bytes = 0;

  /// Elements [first, first + count) along the first dimension, converted to `memory_type`.
  [[nodiscard]] Status read(hsize_t first, hsize_t count, hid_t memory_type, void* values) const;
};

struct Hdf5DatasetName {
  std::string path;  ///< "/observations/tactile"
  Hdf5Sizes sizes;
};

/// A file that is read.
class Hdf5Input {
 public:
  [[nodiscard]] static Result<Hdf5Input> open(const std::string& path);

  /// Whether there is an object of that name, with the groups on the way to it; links out of the file count as absent.
  [[nodiscard]] bool contains(const char* name) const;
  [[nodiscard]] Result<Hdf5Dataset> dataset(const char* name) const;
  /// The datasets of numbers in all groups, at most 1000.
  [[nodiscard]] std::vector<Hdf5DatasetName> datasets() const;
  /// "; it has: '/observations/tactile' (500 x 8 x 8), ..." of the datasets that frames may be in; few are named.
  [[nodiscard]] std::string datasets_text() const;
  /// A text attribute of the root group of at most 1 MiB; empty where it is absent or no text.
  [[nodiscard]] std::string text(const char* name) const;
  /// A dataset cannot hold more elements than this: all bytes of the file, as far as deflate can compress them.
  [[nodiscard]] hsize_t max_elements() const noexcept { return max_elements_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  Hdf5Input(Hdf5Id file, std::string path, hsize_t max_elements)
      : file_(std::move(file)), path_(std::move(path)), max_elements_(max_elements) {}
  Hdf5Id file_;
  std::string path_;
  hsize_t max_elements_;
};

enum class Hdf5Packing { plain, deflated };

/// A file that is written; it takes its place at commit() (AtomicFile). Errors of the disk never reach HDF5, which
/// would not survive them at the end of the process (seen with 1.10.8): they are kept here.
class Hdf5Output {
 public:
  [[nodiscard]] static Result<Hdf5Output> create(const std::string& path);

  /// An empty dataset whose first dimension grows; chunks of `frames_per_chunk` along it, shuffled and deflated where
  /// packed.
  [[nodiscard]] Hdf5Id create_dataset(const char* name, hid_t file_type, const Hdf5Sizes& other_sizes,
                                      hsize_t frames_per_chunk, Hdf5Packing packing = Hdf5Packing::deflated) const;
  /// An attribute of the file ("/"), a group or a dataset.
  [[nodiscard]] Status set(const char* object, const char* name, hid_t type, const void* value) const;
  [[nodiscard]] Status set_text(const char* object, const char* name, const std::string& text) const;

  /// Appends `count` elements along the first dimension, which has `first`.
  [[nodiscard]] Status append(const Hdf5Id& dataset, hsize_t first, hsize_t count, hid_t memory_type,
                              const void* values) const;
  [[nodiscard]] Status read_back(const Hdf5Id& dataset, hsize_t first, hsize_t count, hid_t memory_type,
                                 void* values) const;
  [[nodiscard]] hid_t id() const noexcept { return file_.get(); }
  /// The first error of the disk.
  [[nodiscard]] Status status() const { return target_->status(); }
  /// The first error of the disk, or else what HDF5 says of its last failure.
  [[nodiscard]] Error failure() const;
  [[nodiscard]] Status commit();

 private:
  Hdf5Output(std::unique_ptr<files::AtomicFile> target, Hdf5Id file, std::string path)
      : target_(std::move(target)), file_(std::move(file)), path_(std::move(path)) {}
  std::unique_ptr<files::AtomicFile> target_;  ///< Outlives file_, which writes into it when it is closed.
  Hdf5Id file_;
  std::string path_;
};

}  // namespace dermis::bytes::recordings
