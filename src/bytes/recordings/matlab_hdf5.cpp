// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/matlab_hdf5.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "bytes/recordings/hdf5_columns.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/formats/matlab.hpp"

namespace dermis::bytes::recordings {
namespace {

/// Its datasets have the order of sizes turned round, and the values in the order of MATLAB.
class MatlabHdf5 final : public formats::MatlabFile {
 public:
  explicit MatlabHdf5(Hdf5Input file) : file_(std::move(file)) {
    for (Hdf5DatasetName& dataset : file_.datasets()) {
      const bool is_at_top = dataset.path.rfind('/') == 0;
      if (!is_at_top || dataset.sizes.size() < 2) continue;
      variables_.push_back({dataset.path.substr(1), {dataset.sizes.rbegin(), dataset.sizes.rend()}});
    }
  }

  Status read(std::size_t index, std::vector<float>& values) override { return read_all(index, values); }
  Status read(std::size_t index, std::vector<double>& values) override { return read_all(index, values); }

 private:
  template <typename Value>
  Status read_all(std::size_t index, std::vector<Value>& values) {
    const formats::MatlabVariable& variable = variables_[index];
    const Result<Hdf5Dataset> dataset = file_.dataset(("/" + variable.name).c_str());
    if (!dataset) return dataset.error();
    values.resize(variable.value_count());
    return dataset->read(0, dataset->sizes[0], hdf5_type<Value>(), values.data());
  }

  Hdf5Input file_;
};

}  // namespace

bool is_matlab_hdf5(const std::string& path) {
  constexpr std::string_view kBeginning = "MATLAB 7.3";
  return files::first_bytes_of(path, kBeginning.size()) == kBeginning;
}

Result<std::unique_ptr<FrameSource>> open_matlab_hdf5(const std::string& path, const formats::ImportOptions& options) {
  const QuietHdf5 quiet;
  Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  MatlabHdf5 matlab(*std::move(file));
  return formats::open_matlab(matlab, path, options);
}

}  // namespace dermis::bytes::recordings
