// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/origin_toml.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "dermis/bytes/files/atomic_file.hpp"
#include "dermis/bytes/files/config_table.hpp"
#include "dermis/bytes/files/content_hash.hpp"

namespace dermis::bytes::files {
namespace {

constexpr const char* kSource = "frames.source";
constexpr const char* kHash = "frames.hash";

std::string place_beside(const std::string& frames_path) {
  return (std::filesystem::path(frames_path).parent_path() / "origin.toml").string();
}

Result<FramesOrigin> read(Result<ConfigFile> file) {
  if (!file) return file.error();
  FramesOrigin origin;
  file->require(kSource);
  file->require(kHash);
  file->text(kSource, origin.source);
  file->text(kHash, origin.hash);
  if (Status finished = file->finish(); !finished) return finished.error();
  return origin;
}

}  // namespace

std::string to_toml(const FramesOrigin& origin) {
  return fmt::format(
      "# Written by dermis simulate. The frames with this hash are simulated.\n"
      "[frames]\nsource = \"{}\"\nhash = \"{}\"\n",
      origin.source, origin.hash);
}

Result<FramesOrigin> origin_from_toml(std::string_view text, const std::string& name) {
  return read(ConfigFile::parse(text, name));
}

Status write_origin(const std::string& frames_path, const std::string& source) {
  const Result<std::string> hash = content_hash(frames_path);
  if (!hash) return hash.error();
  Result<AtomicFile> file = AtomicFile::create(place_beside(frames_path));
  if (!file) return file.error();
  file->write(to_toml({source, *hash}));
  return file->commit();
}

std::string simulated_source(const std::string& frames_path) {
  const Result<FramesOrigin> origin = read(ConfigFile::read(place_beside(frames_path)));
  if (!origin) return {};
  const Result<std::string> hash = content_hash(frames_path);
  return hash && *hash == origin->hash ? origin->source : std::string();
}

}  // namespace dermis::bytes::files
