// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/system/secret.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

namespace dermis {
namespace {

constexpr std::size_t kMostBytes = 4096;

struct Close {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};

std::string value_of(const std::string& variable) {
  const char* const value = std::getenv(variable.c_str());
  return value == nullptr ? "" : value;
}

bool may_all_use(std::FILE* file) {
  struct stat status {};
  return ::fstat(::fileno(file), &status) == 0 && (status.st_mode & (S_IROTH | S_IWOTH)) != 0;
}

Result<std::string> read_secret_file(const std::string& path) {
  const auto wrong = [&](const std::string& why) { return bad_input("'" + path + "': " + why); };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "re"));
  if (!file) return wrong(std::string("cannot be read: ") + std::strerror(errno));
  if (may_all_use(file.get())) return wrong("every user may read the secret in it, or change it: chmod o= it");
  std::array<char, kMostBytes + 1> bytes{};
  const std::size_t size = std::fread(bytes.data(), 1, bytes.size(), file.get());
  if (std::ferror(file.get()) != 0) return wrong(std::string("cannot be read: ") + std::strerror(errno));
  std::string_view text(bytes.data(), size);
  while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
  const bool is_one_line =
      std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; });
  if (text.empty() || size > kMostBytes || !is_one_line) return wrong("must hold a secret as its only line");
  return std::string(text);
}

}  // namespace

Result<std::string> read_secret(const SecretPlaces& places) {
  if (!places.file.empty()) return read_secret_file(places.file);
  if (std::string secret = value_of(places.environment); !secret.empty()) return secret;
  const std::string folder = value_of("CREDENTIALS_DIRECTORY");
  const std::string path = folder + "/" + places.credential;
  struct stat status {};
  if (folder.empty() || ::stat(path.c_str(), &status) != 0) return std::string();
  return read_secret_file(path);
}

}  // namespace dermis
