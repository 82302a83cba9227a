// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The functions of std::filesystem::path that the library of WASI lacks: texts of POSIX, which have no root but "/".
#include <algorithm>
#include <filesystem>
#include <vector>

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM

namespace {

using View = string_view;

size_t first_behind(View text, size_t at, char c) {
  return min(text.find_first_not_of(c, at), text.size());
}

View extension_of(View name) {
  const size_t dot = name.rfind('.');
  return name == "." || name == ".." || dot == 0 || dot == View::npos ? View() : name.substr(dot);
}

}  // namespace

View path::__root_name() const {
  return {};
}

View path::__root_directory() const {
  return View(__pn_).substr(0, __pn_.starts_with('/') ? 1 : 0);
}

View path::__root_path_raw() const {
  return __root_directory();
}

View path::__relative_path() const {
  return View(__pn_).substr(first_behind(__pn_, 0, '/'));
}

View path::__filename() const {
  const View text(__pn_);
  return text.substr(text.rfind('/') + 1);
}

View path::__parent_path() const {
  const View text(__pn_);
  if (__relative_path().empty()) return text;
  const size_t last = text.find_last_not_of('/', text.size() - __filename().size() - 1);
  const bool has_name = __filename().size() == text.size();
  return has_name ? View() : last == View::npos ? __root_directory() : text.substr(0, last + 1);
}

View path::__extension() const {
  return extension_of(__filename());
}

View path::__stem() const {
  return __filename().substr(0, __filename().size() - __extension().size());
}

path& path::replace_extension(const path& extension) {
  __pn_.resize(__pn_.size() - __extension().size());
  if (!extension.empty() && !extension.__pn_.starts_with('.')) __pn_ += '.';
  __pn_ += extension.__pn_;
  return *this;
}

/// By elements, as "a//b" is "a/b".
int path::__compare(View other) const {
  const path right(other);
  if (has_root_directory() != right.has_root_directory()) return has_root_directory() ? 1 : -1;
  path::iterator one = begin();
  path::iterator two = right.begin();
  for (; one != end() && two != right.end(); ++one, ++two) {
    if (const int order = one->native().compare(two->native()); order != 0) return order;
  }
  return (one != end() ? 1 : 0) - (two != right.end() ? 1 : 0);
}

path path::lexically_normal() const {
  if (empty()) return {};
  vector<path> names;
  bool is_folder = false;
  for (const path& name : relative_path()) {
    const bool goes_up = name == "..";
    const bool is_undone = goes_up && !names.empty() && names.back() != "..";
    is_folder = name.empty() || name == "." || is_undone;
    if (is_undone)
      names.pop_back();
    else if (!is_folder && !(goes_up && is_absolute()))
      names.push_back(name);
  }
  path normal = root_path();
  for (const path& name : names) normal /= name;
  if (is_folder && !names.empty() && names.back() != "..") normal /= "";
  return normal.empty() ? path(".") : normal;
}

path path::lexically_relative(const path& base) const {
  if (is_absolute() != base.is_absolute()) return {};
  const auto [mine, others] = mismatch(begin(), end(), base.begin(), base.end());
  if (mine == end() && others == base.end()) return ".";
  ptrdiff_t up = 0;
  for (auto name = others; name != base.end(); ++name) up += *name == ".." ? -1 : name->empty() || *name == "." ? 0 : 1;
  if (up < 0) return {};
  if (up == 0 && (mine == end() || mine->empty())) return ".";
  path relative;
  for (; up > 0; --up) relative /= "..";
  for (auto name = mine; name != end(); ++name) relative /= *name;
  return relative;
}

path::iterator path::begin() const {
  iterator first;
  first.__path_ptr_ = this;
  first.__state_ = iterator::_BeforeBegin;
  first.__entry_ = View(__pn_).substr(0, 0);
  return first.__increment();
}

path::iterator path::end() const {
  iterator end;
  end.__path_ptr_ = this;
  end.__state_ = iterator::_AtEnd;
  end.__entry_ = View(__pn_).substr(__pn_.size());
  return end;
}

/// To the root, each name, and the nothing behind a last "/".
path::iterator& path::iterator::__increment() {
  const View text(__path_ptr_->native());
  const size_t here = static_cast<size_t>(__entry_.data() - text.data()) + __entry_.size();
  const size_t next = first_behind(text, here, '/');
  if (__state_ == _BeforeBegin && next > 0) {
    __state_ = _InRootDir;
    __entry_ = text.substr(0, 1);
  } else if (next < text.size()) {
    __state_ = _InFilenames;
    __entry_ = text.substr(next, min(text.find('/', next), text.size()) - next);
  } else if (__state_ == _InFilenames && here < next) {
    __state_ = _InTrailingSep;
    __entry_ = text.substr(text.size() - 1, 0);
  } else {
    __state_ = _AtEnd;
    __entry_ = text.substr(text.size());
  }
  __stashed_elem_.__assign_view(__entry_);
  return *this;
}

_LIBCPP_END_NAMESPACE_FILESYSTEM
