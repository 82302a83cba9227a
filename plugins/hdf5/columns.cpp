// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "columns.hpp"

#include <cmath>

#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr hsize_t kBlockBytes = hsize_t{16} << 20U;
constexpr std::int64_t kLargestExact = std::int64_t{1} << 24U;  ///< Up to here float holds every whole number.

bool is_exact(double /*value*/) {
  return true;
}

bool is_exact(std::int64_t value) {
  return value >= -kLargestExact && value <= kLargestExact;
}

}  // namespace

template <>
hid_t hdf5_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t hdf5_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t hdf5_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t hdf5_type<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}
template <>
hid_t hdf5_type<std::uint32_t>() {
  return H5T_NATIVE_UINT32;
}
template <>
hid_t hdf5_type<std::uint16_t>() {
  return H5T_NATIVE_UINT16;
}
template <>
hid_t hdf5_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

Result<CountsDataset> CountsDataset::open(const Hdf5Input& file, const char* name, std::optional<FrameShape> shape) {
  Result<Hdf5Dataset> dataset = file.dataset(name);
  if (!dataset) return dataset.error();
  const Hdf5Sizes& sizes = dataset->sizes;
  if (sizes.size() == 2 && shape && sizes[1] == shape->taxel_count()) return CountsDataset(*std::move(dataset), *shape);
  if (sizes.size() != 3 || sizes[1] == 0 || sizes[2] == 0 || sizes[1] > kMaxLines || sizes[2] > kMaxLines) {
    return bad_input(dataset->place + " is " + sizes_text(sizes) + "; frames x rows x cols is expected, of at most " +
                     "1024x1024 taxels");
  }
  const FrameShape found{sizes[1], sizes[2]};
  if (shape && *shape != found) {
    return bad_input(file.path() + ": has " + files::size_text(found) + " taxels, the array is " +
                     files::size_text(*shape));
  }
  return CountsDataset(*std::move(dataset), found);
}

Result<CountsDataset> CountsDataset::open_rows(const Hdf5Input& file, const char* name, FrameShape shape) {
  Result<Hdf5Dataset> dataset = file.dataset(name);
  if (!dataset) return dataset.error();
  return CountsDataset(*std::move(dataset), shape);
}

Status CountsDataset::read(hsize_t index, std::vector<float>& counts) {
  if (index - first_ >= count_) {
    const hsize_t most = std::max<hsize_t>(kBlockBytes / (shape_.taxel_count() * sizeof(float)), 1);
    first_ = index;
    count_ = std::min(frames_per_block(dataset_, most), frame_count() - index);
    if (Status done = read_block(); !done) {
      count_ = 0;
      return done;
    }
  }
  const float* const begin = counts_.data() + (index - first_) * shape_.taxel_count();
  counts.assign(begin, begin + shape_.taxel_count());
  return Done{};
}

Status CountsDataset::read_block() {
  counts_.resize(count_ * shape_.taxel_count());
  if (dataset_.type == H5T_INTEGER && dataset_.element_bytes > 2) return read_as(integers_);
  if (dataset_.type == H5T_FLOAT && dataset_.element_bytes > sizeof(float)) return read_as(doubles_);
  return dataset_.read(first_, count_, hdf5_type<float>(), counts_.data());
}

template <typename Wide>
Status CountsDataset::read_as(std::vector<Wide>& wide) {
  wide.resize(counts_.size());
  if (Status done = dataset_.read(first_, count_, hdf5_type<Wide>(), wide.data()); !done) return done;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    if (!is_exact(wide[i])) {
      return bad_input(dataset_.place + ": frame " + std::to_string(first_ + i / shape_.taxel_count()) +
                       " has a count of " + std::to_string(wide[i]) +
                       "; counts beyond 16777216 cannot be held exactly");
    }
    counts_[i] = static_cast<float>(wide[i]);
  }
  return Done{};
}

}  // namespace dermis::bytes::recordings
