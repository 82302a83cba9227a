// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "dermis/bytes/files/array_frames.hpp"
#include "dermis/bytes/formats/import_options.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// A variable of real numbers.
struct MatlabVariable {
  std::string name;
  std::vector<std::size_t> sizes;  ///< The first one runs fastest.

  [[nodiscard]] std::size_t value_count() const noexcept;
  [[nodiscard]] std::string sizes_text() const;  ///< "12 x 30 x 14"
};

/// The variables of real numbers at the top of a file of MATLAB.
class MatlabFile {
 public:
  MatlabFile() = default;
  MatlabFile(const MatlabFile&) = delete;
  MatlabFile& operator=(const MatlabFile&) = delete;
  virtual ~MatlabFile() = default;

  [[nodiscard]] const std::vector<MatlabVariable>& variables() const noexcept { return variables_; }

  /// All values of variables()[index], of which there are at most files::kMostArrayValues, in the order of the file.
  [[nodiscard]] virtual Status read(std::size_t index, std::vector<float>& values) = 0;
  [[nodiscard]] virtual Status read(std::size_t index, std::vector<double>& values) = 0;

 protected:
  std::vector<MatlabVariable> variables_;
};

/// The frames in files of MATLAB (.mat). options.array names their variable; empty: the only one that can be, or
/// 'data'. It has three dimensions. options.shape tells which of them counts the frames, or the number of times does.
/// Else it is the one along which readings change clearly least. Two dimensions are frames and taxels, row by row,
/// where options.shape is given. With more dimensions, options.array says which are taken (files/array_frames.hpp).
/// Times are those of a variable t, time, time_s, timestamps or timestamp [s], or of the rate fs; options.rate_hz goes
/// before both. The whole variable is kept in memory. `name` stands for the path in messages.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_matlab(MatlabFile& file, const std::string& name,
                                                               const ImportOptions& options);

/// The same of a file of version 4 or 5 (and 6 and 7, which are 5). `in` must be able to seek.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_matlab(std::unique_ptr<std::istream> in,
                                                               const std::string& name, const ImportOptions& options);

}  // namespace dermis::bytes::formats
