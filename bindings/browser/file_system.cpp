// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The functions of std::filesystem that the library of WASI lacks. The files of a page have neither links nor owners.
#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM

using FileInfo = struct ::stat;

namespace {

void tell(error_code* told, const path& place, int error) {
  const error_code code(error, generic_category());
  if (told != nullptr)
    *told = code;
  else if (error != 0)
    __throw_filesystem_error("the system refuses", place, code);
}

/// `done`: what a function of POSIX returns. Whether it was done.
bool tell_if_refused(error_code* told, const path& place, int done) {
  tell(told, place, done < 0 ? errno : 0);
  return done >= 0;
}

file_type type_of(const FileInfo& info) {
  return S_ISDIR(info.st_mode) ? file_type::directory : S_ISREG(info.st_mode) ? file_type::regular : file_type::unknown;
}

file_time_type time_of(const timespec& time) {
  return file_time_type(chrono::seconds(time.tv_sec) + chrono::nanoseconds(time.tv_nsec));
}

}  // namespace

filesystem_error::~filesystem_error() = default;

void filesystem_error::__create_what(int /*paths*/) {
  __storage_->__what_ = string(system_error::what()) + ": " + path1().string();
}

file_time_type _FilesystemClock::now() noexcept {
  return file_time_type(chrono::system_clock::now().time_since_epoch());
}

file_status __status(const path& place, error_code* told) {
  FileInfo info{};
  const bool is_there = ::stat(place.c_str(), &info) == 0;
  const bool is_missing = !is_there && (errno == ENOENT || errno == ENOTDIR);
  if (told != nullptr)
    *told = error_code(is_there ? 0 : errno, generic_category());
  else if (!is_there && !is_missing)
    tell(told, place, errno);
  if (is_there) return file_status(type_of(info), perms::all);
  return file_status(is_missing ? file_type::not_found : file_type::none);
}

file_status __symlink_status(const path& place, error_code* told) {
  return __status(place, told);
}

path __current_path(error_code* told) {
  tell(told, {}, 0);
  return "/";
}

path __absolute(const path& place, error_code* told) {
  return __current_path(told) / place;
}

path __weakly_canonical(const path& place, error_code* told) {
  path plain = __absolute(place, told).lexically_normal();
  return plain.has_filename() ? plain : plain.parent_path();
}

path __canonical(const path& place, error_code* told) {
  FileInfo info{};
  return tell_if_refused(told, place, ::stat(place.c_str(), &info)) ? __weakly_canonical(place, told) : path();
}

bool __equivalent(const path& one, const path& two, error_code* told) {
  FileInfo first{};
  FileInfo second{};
  const bool are_there = tell_if_refused(told, one, ::stat(one.c_str(), &first)) &&
                         tell_if_refused(told, two, ::stat(two.c_str(), &second));
  return are_there && first.st_ino == second.st_ino;
}

uintmax_t __file_size(const path& place, error_code* told) {
  FileInfo info{};
  const bool is_there = tell_if_refused(told, place, ::stat(place.c_str(), &info));
  return is_there ? static_cast<uintmax_t>(info.st_size) : static_cast<uintmax_t>(-1);
}

file_time_type __last_write_time(const path& place, error_code* told) {
  FileInfo info{};
  return tell_if_refused(told, place, ::stat(place.c_str(), &info)) ? time_of(info.st_mtim) : file_time_type::min();
}

void __last_write_time(const path& place, file_time_type time, error_code* told) {
  const auto since = time.time_since_epoch();
  const auto whole = chrono::floor<chrono::seconds>(since);
  const timespec modified{static_cast<time_t>(whole.count()), static_cast<long>((since - whole).count())};
  const timespec times[2] = {modified, modified};
  tell_if_refused(told, place, ::utimensat(AT_FDCWD, place.c_str(), times, 0));
}

bool __create_directory(const path& place, error_code* told) {
  const bool is_made = ::mkdir(place.c_str(), 0777) == 0;
  const bool was_there = !is_made && errno == EEXIST && is_directory(place);
  tell(told, place, is_made || was_there ? 0 : errno);
  return is_made;
}

bool __create_directories(const path& place, error_code* told) {
  const path parent = place.parent_path();
  if (!parent.empty() && parent != place && !is_directory(parent)) {
    __create_directories(parent, told);
    if (told != nullptr && *told) return false;
  }
  return __create_directory(place.has_filename() ? place : parent, told);
}

void __rename(const path& from, const path& to, error_code* told) {
  tell_if_refused(told, from, ::rename(from.c_str(), to.c_str()));
}

bool __remove(const path& place, error_code* told) {
  const int done = is_directory(place) ? ::rmdir(place.c_str()) : ::unlink(place.c_str());
  if (done < 0 && errno == ENOENT) {
    tell(told, place, 0);
    return false;
  }
  return tell_if_refused(told, place, done);
}

uintmax_t __remove_all(const path& place, error_code* told) {
  error_code missing;
  uintmax_t removed = 0;
  if (is_directory(place, missing)) {
    for (directory_iterator entry(place, missing); entry != directory_iterator(); entry.increment(missing)) {
      removed += __remove_all(entry->path(), told);
    }
  }
  return removed + (__remove(place, told) ? 1 : 0);
}

bool __fs_is_empty(const path& place, error_code* told) {
  return is_directory(place) ? directory_iterator(place) == directory_iterator() : __file_size(place, told) == 0;
}

/// A page learns what is free when it is used up.
space_info __space(const path& place, error_code* told) {
  constexpr auto kUnknown = static_cast<uintmax_t>(-1);
  tell(told, place, ENOSYS);
  return {kUnknown, kUnknown, kUnknown};
}

path __temp_directory_path(error_code* told) {
  return __current_path(told);
}

error_code directory_entry::__do_refresh() noexcept {
  __data_.__reset();
  error_code told;
  __status(__p_, &told);
  return told;
}

/// All entries, as they were when it was opened.
class __dir_stream {
 public:
  vector<directory_entry> entries;
  size_t at = 0;
};

directory_iterator::directory_iterator(const path& place, error_code* told, directory_options) {
  const unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(place.c_str()), &::closedir);
  if (!tell_if_refused(told, place, folder ? 0 : -1)) return;
  auto stream = make_shared<__dir_stream>();
  while (const dirent* const entry = ::readdir(folder.get())) {
    const path name(entry->d_name);
    if (name != "." && name != "..") stream->entries.emplace_back(place / name);
  }
  if (!stream->entries.empty()) __imp_ = std::move(stream);
}

directory_iterator& directory_iterator::__increment(error_code* told) {
  tell(told, {}, 0);
  if (++__imp_->at == __imp_->entries.size()) __imp_.reset();
  return *this;
}

const directory_entry& directory_iterator::__dereference() const {
  return __imp_->entries[__imp_->at];
}

_LIBCPP_END_NAMESPACE_FILESYSTEM
