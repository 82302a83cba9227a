// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/store/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "store/text.hpp"

namespace dermis::store {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

Error cannot_write(const std::string& path, int error_number) {
  return failed("cannot write " + in_quotes(path) + ": " + std::strerror(error_number));
}

bool is_written_directly(const std::string& path) {
  struct stat info {};
  return path == "/dev/stdout" || (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode));
}

int open_directly(const std::string& path) {
  return path == "/dev/stdout" ? ::dup(STDOUT_FILENO) : ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
}

/// The file behind a symbolic link, so that a rename replaces the file and not the link.
std::string resolve(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return target + "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + ".tmp";
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  if (is_written_directly(path)) {
    const int descriptor = open_directly(path);
    if (descriptor < 0) return cannot_write(path, errno);
    return AtomicFile(path, "", descriptor);
  }
  const std::string target = resolve(path);
  std::string temporary;
  int descriptor = -1;
  do {
    temporary = temporary_name(target);
    descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0) return cannot_write(path, errno);
  return AtomicFile(target, std::move(temporary), descriptor);
}

AtomicFile::AtomicFile(std::string target, std::string temporary, int descriptor)
    : target_(std::move(target)), temporary_(std::move(temporary)), descriptor_(descriptor) {
  buffer_.reserve(kBufferBytes);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::move(other.buffer_)),
      first_error_(std::move(other.first_error_)) {}

AtomicFile::~AtomicFile() {
  close();
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty() && !first_error_) {
    const std::size_t taken = std::min(bytes.size(), kBufferBytes - buffer_.size());
    buffer_.append(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    if (buffer_.size() == kBufferBytes) flush();
  }
}

Status AtomicFile::status() const {
  if (first_error_) return *first_error_;
  return Done{};
}

Status AtomicFile::commit() {
  flush();
  if (!temporary_.empty() && !first_error_ && ::fsync(descriptor_) != 0) keep_error(errno);
  close();
  if (first_error_) return *first_error_;
  if (temporary_.empty()) return Done{};
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) return cannot_write(target_, errno);
  temporary_.clear();
  return Done{};
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty() && !first_error_) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written >= 0) {
      rest.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      keep_error(errno);
    }
  }
  buffer_.clear();
}

void AtomicFile::keep_error(int error_number) {
  if (!first_error_) first_error_ = cannot_write(target_, error_number);
}

void AtomicFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor >= 0 && ::close(descriptor) != 0) keep_error(errno);
}

}  // namespace dermis::store
