// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/file_on_its_way.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace dermis::out::websocket {

bool FileOnItsWay::open(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error))) return false;
  size_ = std::filesystem::file_size(path, error);
  if (error) return false;
  left_ = size_;
  file_.open(path, std::ios::binary);
  return file_.is_open();
}

bool FileOnItsWay::read_piece() {
  piece_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(left_, kPieceBytes)));
  if (piece_.empty()) return false;
  file_.read(piece_.data(), static_cast<std::streamsize>(piece_.size()));
  left_ -= piece_.size();
  return file_.good();
}

}  // namespace dermis::out::websocket
