// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/files/output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include "dermis/files/text.hpp"

namespace dermis::files {
namespace {

bool is_written_directly(const std::string& path) {
  struct stat info {};
  return path == "/dev/stdout" || (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode));
}

int open_directly(const std::string& path) {
  return path == "/dev/stdout" ? ::dup(STDOUT_FILENO) : ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
}

std::string resolve(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(path, error);
  return error ? path : real.string();
}

/// The next one. Not thread-safe.
std::string temporary_name(const std::string& target) {
  static unsigned counter = 0;
  return target + "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + ".tmp";
}

/// Those of the process.
struct UnfinishedFiles {
  std::mutex mutex;
  std::set<std::string> paths;
};

UnfinishedFiles& unfinished_files() {
  static UnfinishedFiles files;
  return files;
}

}  // namespace

std::pair<UnfinishedFile, int> UnfinishedFile::create_beside(const std::string& target) {
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard lock(files.mutex);
  UnfinishedFile file;
  int descriptor = -1;
  do {
    file.path_ = temporary_name(target);
    descriptor = ::open(file.path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0) {
    file.path_.clear();
  } else {
    files.paths.insert(file.path_);
  }
  return {std::move(file), descriptor};
}

UnfinishedFile& UnfinishedFile::operator=(UnfinishedFile&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

UnfinishedFile::~UnfinishedFile() {
  if (!exists()) return;
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard lock(files.mutex);
  std::remove(path_.c_str());
  files.paths.erase(path_);
}

Status UnfinishedFile::take_place_of(const std::string& target) {
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard lock(files.mutex);
  if (std::rename(path_.c_str(), target.c_str()) != 0) return cannot_write(target, errno);
  files.paths.erase(path_);
  path_.clear();
  return Done{};
}

void remove_unfinished_files() {
  UnfinishedFiles& files = unfinished_files();
  files.mutex.lock();
  for (const std::string& path : files.paths) std::remove(path.c_str());
}

Error cannot_write(const std::string& path, int error_number) {
  return failed("cannot write " + in_quotes(path) + ": " + std::strerror(error_number));
}

Result<OutputPlace> open_output(const std::string& path) {
  if (is_written_directly(path)) {
    const int descriptor = open_directly(path);
    if (descriptor < 0) return cannot_write(path, errno);
    return OutputPlace{path, UnfinishedFile(), descriptor};
  }
  const std::string target = resolve(path);
  auto [unfinished, descriptor] = UnfinishedFile::create_beside(target);
  if (descriptor < 0) return cannot_write(path, errno);
  return OutputPlace{target, std::move(unfinished), descriptor};
}

int write_all(int descriptor, std::span<const std::byte> bytes, std::optional<std::uint64_t> offset) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::span<const std::byte> rest = bytes.subspan(done);
    const ssize_t written = offset ? ::pwrite(descriptor, rest.data(), rest.size(), static_cast<off_t>(*offset + done))
                                   : ::write(descriptor, rest.data(), rest.size());
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

void synchronise_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

}  // namespace dermis::files
