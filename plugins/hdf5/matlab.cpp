// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "matlab.hpp"

#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "columns.hpp"

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

  ~MatlabHdf5() override {
    const QuietHdf5 quiet;
    [[maybe_unused]] const Hdf5Input closed = std::move(file_);
  }

  Status read(std::size_t index, std::vector<float>& values) override { return read_all(index, values); }
  Status read(std::size_t index, std::vector<double>& values) override { return read_all(index, values); }

 private:
  template <typename Value>
  Status read_all(std::size_t index, std::vector<Value>& values) {
    const QuietHdf5 quiet;
    const Result<Hdf5Dataset> dataset = file_.dataset(("/" + variables_[index].name).c_str());
    if (!dataset) return dataset.error();
    values.resize(std::accumulate(dataset->sizes.begin(), dataset->sizes.end(), hsize_t{1}, std::multiplies<>()));
    return dataset->read(0, dataset->sizes[0], hdf5_type<Value>(), values.data());
  }

  Hdf5Input file_;
};

}  // namespace

Result<std::unique_ptr<formats::MatlabFile>> open_matlab(const std::string& path) {
  const QuietHdf5 quiet;
  Result<Hdf5Input> file = Hdf5Input::open(path);
  if (!file) return file.error();
  return std::unique_ptr<formats::MatlabFile>(std::make_unique<MatlabHdf5>(*std::move(file)));
}

}  // namespace dermis::bytes::recordings
