// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/descriptor_stream.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "bytes/devices/serial_settings.hpp"
#include "dermis/bytes/files/output_place.hpp"

namespace dermis::bytes::devices {
namespace {

int milliseconds(Nanos timeout) {
  const auto whole = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  return static_cast<int>(std::clamp<long long>(whole, 0, 1'000'000));
}

/// The result of poll() on the descriptor within the time.
short poll_for(int descriptor, short events, Nanos timeout) {
  pollfd request{descriptor, events, 0};
  return ::poll(&request, 1, milliseconds(timeout)) > 0 ? request.revents : short{0};
}

bool is_to_be_repeated(int error) {
  return error == EINTR || error == EAGAIN || error == EWOULDBLOCK;
}

ByteStream::Transferred read_from(int descriptor, std::span<std::uint8_t> into, Nanos timeout) {
  if (poll_for(descriptor, POLLIN, timeout) == 0) return {};
  const ssize_t count = ::read(descriptor, into.data(), into.size());
  if (count > 0) return {static_cast<std::size_t>(count), ByteStream::End::none};
  if (count == 0) return {0, ByteStream::End::closed};
  return {0, is_to_be_repeated(errno) ? ByteStream::End::none : ByteStream::End::lost};
}

ByteStream::Transferred write_to(int descriptor, std::span<const std::uint8_t> bytes, Nanos timeout) {
  const short ready = poll_for(descriptor, POLLOUT, timeout);
  if (ready == 0) return {};
  if ((ready & POLLHUP) != 0) return {0, ByteStream::End::closed};
  const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
  if (count >= 0) return {static_cast<std::size_t>(count), ByteStream::End::none};
  if (is_to_be_repeated(errno)) return {};
  return {0, errno == EPIPE ? ByteStream::End::closed : ByteStream::End::lost};
}

class FileStream final : public ByteStream {
 public:
  explicit FileStream(std::string path) : path_(std::move(path)) {}
  ~FileStream() override {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  Result<bool> open(Nanos /*timeout*/) override {
    if (Status readable = files::check_readable(path_); !readable) return readable.error();
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe without a writer is waited for
    if (descriptor_ < 0) return bad_input("cannot open '" + path_ + "': " + std::strerror(errno));
    struct stat info {};
    const bool is_folder = ::fstat(descriptor_, &info) == 0 && S_ISDIR(info.st_mode);
    if (is_folder) return bad_input("cannot read '" + path_ + "': it is a folder; name a file of bytes");
    return true;
  }
  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    return read_from(descriptor_, into, timeout);
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos /*timeout*/) override { return {bytes.size()}; }
  [[nodiscard]] std::string name() const override { return path_; }

 private:
  std::string path_;
  int descriptor_ = -1;
};

/// One that the process was started with; it stays open.
class StandardStream final : public ByteStream {
 public:
  StandardStream(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}

  Result<bool> open(Nanos /*timeout*/) override { return true; }
  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    return descriptor_ == STDIN_FILENO ? read_from(descriptor_, into, timeout) : Transferred{};
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) override {
    return descriptor_ == STDIN_FILENO ? Transferred{bytes.size()} : write_to(descriptor_, bytes, timeout);
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  int descriptor_;
  std::string name_;
};

class PseudoTerminal final : public ByteStream {
 public:
  PseudoTerminal() = default;
  ~PseudoTerminal() override {
    if (master_ >= 0) ::close(master_);
  }

  Status create() {
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    std::array<char, 128> name{};
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
        ::ptsname_r(master_, name.data(), name.size()) != 0) {
      return failed(std::string("cannot make a pseudo-terminal: ") + std::strerror(errno));
    }
    name_ = name.data();
    // Opened and closed once, a slave that nobody has open gives POLLHUP.
    const int slave = ::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    const bool is_raw = slave >= 0 && set_raw_8n1(slave, kBaud);
    const int error = errno;
    if (slave >= 0) ::close(slave);
    if (!is_raw) return failed("cannot make '" + name_ + "' raw: " + std::strerror(error));
    return Done{};
  }

  Result<bool> open(Nanos timeout) override {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (!is_read_by_somebody()) {
      if (std::chrono::steady_clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }
  Transferred read(std::span<std::uint8_t> into, Nanos timeout) override {
    const Transferred read = read_from(master_, into, timeout);
    return {read.bytes, is_read_by_somebody() ? End::none : End::closed};
  }
  Transferred write(std::span<const std::uint8_t> bytes, Nanos timeout) override {
    return write_to(master_, bytes, timeout);
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  [[nodiscard]] bool is_read_by_somebody() const { return (poll_for(master_, 0, Nanos{}) & POLLHUP) == 0; }

  static constexpr unsigned kBaud = 115'200;  // of no meaning to it
  int master_ = -1;
  std::string name_;
};

}  // namespace

std::unique_ptr<ByteStream> make_file_stream(const std::string& path) {
  return std::make_unique<FileStream>(path);
}

std::unique_ptr<ByteStream> make_standard_input() {
  return std::make_unique<StandardStream>(STDIN_FILENO, "stdin");
}

std::unique_ptr<ByteStream> make_standard_output() {
  return std::make_unique<StandardStream>(STDOUT_FILENO, "stdout");
}

Result<std::unique_ptr<ByteStream>> make_pseudo_terminal() {
  auto terminal = std::make_unique<PseudoTerminal>();
  if (const Status created = terminal->create(); !created) return created.error();
  return std::unique_ptr<ByteStream>(std::move(terminal));
}

}  // namespace dermis::bytes::devices
