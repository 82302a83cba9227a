// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <utility>

#include "bytes/files/known_outputs.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
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

Claims& claims() {
  return process_outputs().claims;
}

std::string key_of(const std::string& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

Result<BegunOutput> begin(const std::string& path) {
  std::string target = resolve(path);
  Result<UnfinishedFile> file = UnfinishedFile::begin(target);
  if (!file) return file.error();
  return BegunOutput{std::move(target), *std::move(file)};
}

Result<BegunOutput> take_claim_or_begin(const std::string& path) {
  const std::lock_guard lock(claims().mutex);
  auto claimed = claims().unopened.extract(key_of(path));
  if (claimed) return std::move(claimed.mapped());
  return begin(path);
}

}  // namespace

Status claim_output(const std::string& path, EarlierFile earlier) {
  if (is_written_directly(path)) return Done{};
  const std::lock_guard lock(claims().mutex);
  if (claims().unopened.contains(key_of(path))) return Done{};
  Result<BegunOutput> begun = begin(path);
  if (!begun) return begun.error();
  if (earlier == EarlierFile::stays_unread) claims().unread.insert(begun->target);
  claims().unopened.emplace(key_of(path), *std::move(begun));
  return Done{};
}

void release_claims() {
  const std::lock_guard lock(claims().mutex);
  claims().unopened.clear();
}

Status check_readable(const std::string& path) {
  const std::lock_guard lock(claims().mutex);
  for (const std::string& target : claims().unread) {
    std::error_code missing;
    if (!UnfinishedFile::is_begun(target) || !std::filesystem::equivalent(path, target, missing)) continue;
    return bad_input(in_quotes(path) + " is read, and would be replaced by the output; name another output");
  }
  return Done{};
}

Result<OutputPlace> open_output(const std::string& path) {
  if (is_written_directly(path)) {
    const int descriptor = open_directly(path);
    if (descriptor < 0) return cannot_write(path, errno);
    return OutputPlace{path, UnfinishedFile(), descriptor};
  }
  Result<BegunOutput> begun = take_claim_or_begin(path);
  if (!begun) return begun.error();
  const int descriptor = begun->file.duplicate_descriptor();
  if (descriptor < 0) return cannot_write(path, errno);
  return OutputPlace{std::move(begun->target), std::move(begun->file), descriptor};
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

}  // namespace dermis::bytes::files
