// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "hdf5.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <system_error>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"
#include "driver.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kMaxDimensions = 8;
constexpr hsize_t kMaxDatasetChunkBytes = hsize_t{64} << 20U;
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20U;
constexpr unsigned kDeflateLevel = 1;
constexpr hsize_t kDeflateRatio = 1032;  ///< The most that deflate can compress (zlib, "Technical Details").

herr_t keep_innermost(unsigned /*depth*/, const H5E_error2_t* error, void* reason) {
  if (error->desc != nullptr && *error->desc != '\0') *static_cast<std::string*>(reason) = error->desc;
  return 1;  // the walk begins at the innermost: one step is enough
}

}  // namespace

std::string sizes_text(const Hdf5Sizes& sizes) {
  std::string text;
  for (const hsize_t size : sizes) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

namespace {

hsize_t product(const Hdf5Sizes& sizes) {
  hsize_t result = 1;
  for (const hsize_t size : sizes) {
    if (__builtin_mul_overflow(result, size, &result)) return HSIZE_UNDEF;
  }
  return result;
}

std::string read_text(hid_t attribute) {
  const Hdf5Id type(H5Aget_type(attribute), H5Tclose);
  const Hdf5Id space(H5Aget_space(attribute), H5Sclose);
  if (!type || !space || H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) {
    return {};
  }
  const Hdf5Id memory_type(H5Tcopy(type.get()), H5Tclose);
  if (H5Tis_variable_str(type.get()) > 0) {
    char* bytes = nullptr;
    if (H5Aread(attribute, memory_type.get(), static_cast<void*>(&bytes)) < 0 || bytes == nullptr) return {};
    std::string text(bytes, std::find(bytes, bytes + std::char_traits<char>::length(bytes), '\0'));
    H5free_memory(bytes);
    return text.size() > kMaxTextBytes ? std::string() : text;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size == 0 || size > kMaxTextBytes) return {};
  std::string text(size, '\0');
  if (H5Aread(attribute, memory_type.get(), text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

/// Where the elements lie, or why they cannot be read.
Status read_layout(hid_t dataset, Hdf5Dataset& read) {
  const Hdf5Id plan(H5Dget_create_plist(dataset), H5Pclose);
  if (!plan) return bad_input(read.place + ": " + hdf5_reason());
  const H5D_layout_t layout = H5Pget_layout(plan.get());
  if (layout == H5D_VIRTUAL || H5Pget_external_count(plan.get()) > 0) {
    return bad_input(read.place + " lies in other files; copy it into one file with h5repack");
  }
  if (layout != H5D_CHUNKED) return Done{};
  read.chunk.resize(read.sizes.size());
  if (H5Pget_chunk(plan.get(), static_cast<int>(read.chunk.size()), read.chunk.data()) < 0) {
    return bad_input(read.place + ": " + hdf5_reason());
  }
  const hsize_t elements = product(read.chunk);
  if (elements > kMaxDatasetChunkBytes / read.element_bytes) {
    return bad_input(read.place + " has chunks of more than 64 MiB; write smaller ones with h5repack");
  }
  return Done{};
}

/// Bytes of the chunks that lie side by side in one layer of the first dimension.
std::size_t layer_bytes(const Hdf5Dataset& dataset) {
  hsize_t bytes = dataset.element_bytes * product(dataset.chunk);
  for (std::size_t i = 1; i < dataset.sizes.size(); ++i) {
    bytes *= (dataset.sizes[i] + dataset.chunk[i] - 1) / dataset.chunk[i];
    if (bytes > kMaxDatasetChunkBytes) return kMaxDatasetChunkBytes;
  }
  return bytes;
}

/// Elements [first, first + count) along the first dimension of a dataset.
struct Block {
  Hdf5Sizes file_sizes;
  Hdf5Sizes start;
  Hdf5Sizes sizes;

  [[nodiscard]] Hdf5Id in_file(hid_t dataset) const {
    Hdf5Id space(H5Dget_space(dataset), H5Sclose);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, sizes.data(), nullptr);
    return space;
  }
  [[nodiscard]] Hdf5Id in_memory() const {
    return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
  }
};

std::optional<Block> block_of(hid_t dataset, hsize_t first, hsize_t count) {
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  const int dimensions = H5Sget_simple_extent_ndims(space.get());
  if (dimensions < 1) return std::nullopt;
  Hdf5Sizes file_sizes(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(space.get(), file_sizes.data(), nullptr);
  Block block{file_sizes, Hdf5Sizes(file_sizes.size(), 0), file_sizes};
  block.start[0] = first;
  block.sizes[0] = count;
  return block;
}

struct FoundDatasets {
  const Hdf5Input& file;
  std::vector<Hdf5DatasetName> datasets;
  std::size_t visited = 0;
};

herr_t find_dataset(hid_t /*root*/, const char* name, const H5O_info_t* info, void* to) {
  constexpr std::size_t kMostDatasets = 1000;
  constexpr std::size_t kMostVisited = 10000;
  auto& found = *static_cast<FoundDatasets*>(to);
  if (++found.visited > kMostVisited || found.datasets.size() == kMostDatasets) return 1;
  if (info->type != H5O_TYPE_DATASET) return 0;
  std::string path = std::string("/") + name;
  Result<Hdf5Dataset> dataset = found.file.dataset(path.c_str());
  if (dataset) found.datasets.push_back({std::move(path), std::move(dataset->sizes)});
  return 0;
}

hid_t open_with_cache(hid_t file, const char* name, std::size_t cache_bytes) {
  const Hdf5Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), H5D_CHUNK_CACHE_NSLOTS_DEFAULT, cache_bytes, H5D_CHUNK_CACHE_W0_DEFAULT);
  return H5Dopen2(file, name, access.get());
}

}  // namespace

QuietHdf5::QuietHdf5() {
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() {
  H5Eset_auto2(H5E_DEFAULT, print_, print_data_);
}

std::string hdf5_reason() {
  std::string reason = "HDF5 cannot read it";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  return reason;
}

Status Hdf5Dataset::read(hsize_t first, hsize_t count, hid_t memory_type, void* values) const {
  const std::optional<Block> block = block_of(id.get(), first, count);
  if (!block) return bad_input(place + " cannot be read: " + hdf5_reason());
  const Hdf5Id in_file = block->in_file(id.get());
  const Hdf5Id in_memory = block->in_memory();
  if (H5Dread(id.get(), memory_type, in_memory.get(), in_file.get(), H5P_DEFAULT, values) < 0) {
    return bad_input(place + " cannot be read: " + hdf5_reason());
  }
  return Done{};
}

Result<Hdf5Input> Hdf5Input::open(const std::string& path) {
  const Result<std::unique_ptr<std::istream>> readable = files::open_input(path);  // for the system's own message
  if (!readable) return readable.error();
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return bad_input(path + ": HDF5 needs a regular file");
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access.get(), false, true);  // folders that cannot lock can be read too
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file) {
    return bad_input(path + ": is no HDF5 file or was not closed (" + hdf5_reason() +
                     "); a file that is still being written must be closed by its program first");
  }
  return Hdf5Input(std::move(file), path, size * kDeflateRatio);
}

bool Hdf5Input::contains(const char* name) const {
  const std::string_view path = name;
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part(path.substr(0, end));
    H5L_info_t link{};
    if (H5Lexists(file_.get(), part.c_str(), H5P_DEFAULT) <= 0 ||
        H5Lget_info(file_.get(), part.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD) {
      return false;
    }
    if (end == std::string_view::npos) return true;
  }
}

std::vector<Hdf5DatasetName> Hdf5Input::datasets() const {
  FoundDatasets found{*this, {}};
  H5Ovisit2(file_.get(), H5_INDEX_NAME, H5_ITER_INC, find_dataset, &found, H5O_INFO_BASIC);
  return std::move(found.datasets);
}

std::string Hdf5Input::datasets_text() const {
  constexpr std::size_t kMostNames = 50;
  std::string names;
  std::size_t named = 0;
  for (const Hdf5DatasetName& dataset : datasets()) {
    if (dataset.sizes.size() < 2 || named++ == kMostNames) continue;
    names += (names.empty() ? "" : ", ") + files::in_quotes(dataset.path) + " (" + sizes_text(dataset.sizes) + ")";
  }
  return names.empty() ? "; it has none of two dimensions or more" : "; it has: " + names;
}

Result<Hdf5Dataset> Hdf5Input::dataset(const char* name) const {
  Hdf5Dataset read;
  read.place = path_ + ": dataset " + files::in_quotes(name);
  if (!contains(name)) return bad_input(read.place + " is missing");
  read.id = Hdf5Id(H5Dopen2(file_.get(), name, H5P_DEFAULT), H5Dclose);
  const Hdf5Id space(H5Dget_space(read.id.get()), H5Sclose);
  const Hdf5Id type(H5Dget_type(read.id.get()), H5Tclose);
  if (!read.id || !space || !type) return bad_input(read.place + ": " + hdf5_reason());
  const int dimensions = H5Sget_simple_extent_ndims(space.get());
  if (dimensions < 1 || static_cast<std::size_t>(dimensions) > kMaxDimensions) {
    return bad_input(read.place + " has " + std::to_string(std::max(dimensions, 0)) + " dimensions");
  }
  read.sizes.resize(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(space.get(), read.sizes.data(), nullptr);
  read.type = H5Tget_class(type.get());
  read.element_bytes = H5Tget_size(type.get());
  const bool is_number = (read.type == H5T_INTEGER || read.type == H5T_FLOAT) && read.element_bytes <= 8;
  if (!is_number || read.element_bytes == 0) return bad_input(read.place + " does not hold numbers of 8 to 64 bits");
  if (product(read.sizes) > max_elements_) {
    return bad_input(read.place + " is said to be larger than the file can hold; the file is damaged");
  }
  if (const Status layout = read_layout(read.id.get(), read); !layout) return layout.error();
  if (!read.chunk.empty()) read.id = Hdf5Id(open_with_cache(file_.get(), name, layer_bytes(read)), H5Dclose);
  if (!read.id) return bad_input(read.place + ": " + hdf5_reason());
  return read;
}

std::string Hdf5Input::text(const char* name) const {
  if (H5Aexists(file_.get(), name) <= 0) return {};
  const Hdf5Id attribute(H5Aopen(file_.get(), name, H5P_DEFAULT), H5Aclose);
  return attribute ? read_text(attribute.get()) : std::string();
}

Result<Hdf5Output> Hdf5Output::create(const std::string& path) {
  Result<files::AtomicFile> opened = files::AtomicFile::create(path);
  if (!opened) return opened.error();
  auto target = std::make_unique<files::AtomicFile>(*std::move(opened));
  target->write_at(0, {});  // a pipe is refused before HDF5 sees it
  if (Status usable = target->status(); !usable) return usable.error();
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  Hdf5Id file;
  if (set_atomic_file_driver(access.get(), *target)) {
    file = Hdf5Id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  }
  if (!file) return failed("cannot write " + files::in_quotes(path) + ": " + hdf5_reason());
  return Hdf5Output(std::move(target), std::move(file), path);
}

Hdf5Id Hdf5Output::create_dataset(const char* name, hid_t file_type, const Hdf5Sizes& other_sizes,
                                  hsize_t frames_per_chunk, Hdf5Packing packing) const {
  Hdf5Sizes sizes{0};
  Hdf5Sizes limits{H5S_UNLIMITED};
  Hdf5Sizes chunk{frames_per_chunk};
  for (Hdf5Sizes* const list : {&sizes, &limits, &chunk}) {
    list->insert(list->end(), other_sizes.begin(), other_sizes.end());
  }
  const Hdf5Id space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), limits.data()), H5Sclose);
  const Hdf5Id plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Hdf5Id way(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_chunk(plan.get(), static_cast<int>(chunk.size()), chunk.data());
  if (packing == Hdf5Packing::deflated) {
    H5Pset_shuffle(plan.get());
    H5Pset_deflate(plan.get(), kDeflateLevel);
  }
  H5Pset_fletcher32(plan.get());  // HDF5 then refuses a chunk with a flipped bit
  H5Pset_create_intermediate_group(way.get(), 1);
  return {H5Dcreate2(file_.get(), name, file_type, space.get(), way.get(), plan.get(), H5P_DEFAULT), H5Dclose};
}

Status Hdf5Output::set(const char* object, const char* name, hid_t type, const void* value) const {
  const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id attribute(
      H5Acreate_by_name(file_.get(), object, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute || H5Awrite(attribute.get(), type, value) < 0) return failure();
  return status();
}

Status Hdf5Output::set_text(const char* object, const char* name, const std::string& text) const {
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const char* const bytes = text.c_str();
  return set(object, name, type.get(), static_cast<const void*>(&bytes));
}

Error Hdf5Output::failure() const {
  if (const Status disk = target_->status(); !disk) return disk.error();
  return failed("cannot write " + files::in_quotes(path_) + ": " + hdf5_reason());
}

Status Hdf5Output::append(const Hdf5Id& dataset, hsize_t first, hsize_t count, hid_t memory_type,
                          const void* values) const {
  std::optional<Block> block = block_of(dataset.get(), first, count);
  if (!block) return failure();
  block->file_sizes[0] = first + count;
  if (H5Dset_extent(dataset.get(), block->file_sizes.data()) < 0) return failure();
  const Hdf5Id in_file = block->in_file(dataset.get());
  const Hdf5Id in_memory = block->in_memory();
  if (H5Dwrite(dataset.get(), memory_type, in_memory.get(), in_file.get(), H5P_DEFAULT, values) < 0) return failure();
  return status();
}

Status Hdf5Output::read_back(const Hdf5Id& dataset, hsize_t first, hsize_t count, hid_t memory_type,
                             void* values) const {
  const std::optional<Block> block = block_of(dataset.get(), first, count);
  if (!block) return failure();
  const Hdf5Id in_file = block->in_file(dataset.get());
  const Hdf5Id in_memory = block->in_memory();
  if (H5Dread(dataset.get(), memory_type, in_memory.get(), in_file.get(), H5P_DEFAULT, values) < 0) return failure();
  return status();
}

Status Hdf5Output::commit() {
  if (!file_.close()) return failure();
  return target_->commit();
}

}  // namespace dermis::bytes::recordings
