// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr const char* kTemporary = ".tmp";

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
  return target + "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + kTemporary;
}

/// Those of the process.
struct UnfinishedFiles {
  std::mutex mutex;
  std::set<std::string> paths;
  /// In each folder that was written to: the names that looked like temporary files when that began.
  std::map<std::string, std::vector<std::string>> seen;
};

UnfinishedFiles& unfinished_files() {
  static UnfinishedFiles files;
  return files;
}

std::vector<std::string> temporary_names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    std::string name = entry->path().filename().string();
    const bool is_file = entry->symlink_status(gone).type() == std::filesystem::file_type::regular;
    if (is_file && name.ends_with(kTemporary)) names.push_back(std::move(name));
  }
  return names;
}

/// Takes the digits at the beginning of the text and what must follow them; empty if they are not there.
std::optional<std::uint32_t> take_number(std::string_view& text, std::string_view then) {
  std::uint32_t number = 0;
  const std::size_t digits = number_at(text, number);
  if (digits == 0 || (digits > 1 && text.front() == '0')) return std::nullopt;
  text.remove_prefix(digits);
  if (!text.starts_with(then)) return std::nullopt;
  text.remove_prefix(then.size());
  return number;
}

/// The process that began `name` as a temporary file of the target `of`; empty: it is no such name.
std::optional<pid_t> writer_of(std::string_view name, std::string_view of) {
  if (!name.starts_with(of) || !name.substr(of.size()).starts_with('.')) return std::nullopt;
  name.remove_prefix(of.size() + 1);
  const std::optional<std::uint32_t> process = take_number(name, ".");
  if (!process || !take_number(name, kTemporary) || !name.empty()) return std::nullopt;
  const bool is_possible = *process > 0 && std::in_range<pid_t>(*process);
  return is_possible ? std::optional(static_cast<pid_t>(*process)) : std::nullopt;
}

bool has_ended(pid_t process) {
  return ::kill(process, 0) != 0 && errno == ESRCH;
}

/// Removes the temporary files of the target whose process was killed. A folder is looked through before this process
/// begins one in it. So a file with the number of this process is of an older one.
void remove_left_over(const std::string& target) {
  const std::filesystem::path path(target);
  std::error_code missing;
  const std::filesystem::path folder =
      std::filesystem::canonical(path.has_parent_path() ? path.parent_path() : ".", missing);
  if (missing) return;
  UnfinishedFiles& files = unfinished_files();
  const std::lock_guard lock(files.mutex);
  const auto [seen, is_new] = files.seen.try_emplace(folder.string());
  if (is_new) seen->second = temporary_names_in(folder.string());
  std::erase_if(seen->second, [&](const std::string& name) {
    const std::optional<pid_t> process = writer_of(name, path.filename().string());
    const bool is_left_over = process && (*process == ::getpid() || has_ended(*process));
    return is_left_over && std::remove((folder / name).c_str()) == 0;
  });
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
  remove_left_over(target);
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

}  // namespace dermis::bytes::files
