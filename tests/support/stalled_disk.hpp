// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>
#include <thread>

namespace dermis::support {

/// A pipe in the place of a file: what is written to it finds a disk that stands still, until it flows.
class StalledDisk {
 public:
  explicit StalledDisk(const std::string& path) {
    EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    EXPECT_GE(descriptor_, 0);
  }
  StalledDisk(const StalledDisk&) = delete;
  StalledDisk& operator=(const StalledDisk&) = delete;
  ~StalledDisk() {
    if (flowing_.joinable()) flowing_.join();
    ::close(descriptor_);
  }

  /// From now on all that is written goes into this file, until the writer closes the pipe.
  void flow_into(const std::string& file) {
    EXPECT_EQ(::fcntl(descriptor_, F_SETFL, 0), 0);
    flowing_ = std::thread([this, file] {
      std::ofstream out(file, std::ios::binary);
      std::array<char, 65536> bytes{};
      for (ssize_t got = 1; got > 0;) {
        got = ::read(descriptor_, bytes.data(), bytes.size());
        if (got > 0) out.write(bytes.data(), got);
      }
    });
  }
  void await_end() { flowing_.join(); }

 private:
  int descriptor_ = -1;
  std::thread flowing_;
};

}  // namespace dermis::support
