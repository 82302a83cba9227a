// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/formats/urdf.hpp"
#include "dermis/out/serve/worn_body.hpp"

namespace dermis::out::serve {
namespace {

namespace fs = std::filesystem;

using Notice = std::function<void(const std::string&)>;

constexpr std::size_t kMostFileBytes = 20'000'000;
constexpr std::size_t kMostBytes = 3 * kMostFileBytes;
/// glTF has y up and z forward; the suit has z up and x forward.
constexpr Pose kUpright{{}, {0.5, 0.5, 0.5, 0.5}};

/// ".stl"
std::string ending_of(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return ending;
}

bool is_mesh(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".stl" || ending == ".glb";
}

/// "meshes/hand.stl" of "package://robot/meshes/hand.stl": the folder of the URDF stands for its package.
std::string within_folder(std::string name) {
  constexpr std::string_view kPackage = "package://";
  if (!name.starts_with(kPackage)) return name;
  const std::size_t slash = name.find('/', kPackage.size());
  return slash == std::string::npos ? std::string() : name.substr(slash + 1);
}

/// The bytes of a mesh, which must lie in `folder`, also by its symbolic links.
Result<std::string> read_mesh(const fs::path& folder, const std::string& name) {
  if (!is_mesh(name)) return bad_input("is no .stl or .glb");
  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path file = fs::canonical(root / within_folder(name), error);
  if (error) return bad_input("is not there");
  const bool is_inside = std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
  if (!is_inside) return bad_input("is not in the folder of the body");
  if (!fs::is_regular_file(file, error)) return bad_input("is no file");
  Result<std::string> bytes = bytes::files::read_file(file.string(), kMostFileBytes);
  if (!bytes) return bad_input("cannot be read, or has more than 20 MB");
  return bytes;
}

/// Reads each mesh of a body once.
class MeshReader {
 public:
  MeshReader(std::string body_path, const Notice& notice) : body_path_(std::move(body_path)), notice_(notice) {}

  std::vector<BodyFile> read(const Body& body) {
    for (const BodyLink& link : body.links) {
      for (const BodyVisual& visual : link.visuals) {
        const auto* const mesh = std::get_if<MeshSolid>(&visual.solid);
        if (mesh != nullptr && std::find(names_.begin(), names_.end(), mesh->file) == names_.end()) add(mesh->file);
      }
    }
    return std::move(files_);
  }

 private:
  void add(const std::string& name) {
    names_.push_back(name);
    Result<std::string> bytes = read_mesh(fs::path(body_path_).parent_path(), name);
    if (bytes && bytes_ + bytes->size() > kMostBytes) bytes = bad_input("is beyond the 60 MB that a body may have");
    if (!bytes) {
      if (notice_) notice_(fmt::format("{}: {} {}; it is not shown", body_path_, name, bytes.error().message));
      return;
    }
    bytes_ += bytes->size();
    files_.push_back({name, fmt::format("/body/{}{}", files_.size(), ending_of(name)), *std::move(bytes)});
  }

  const std::string body_path_;
  const Notice& notice_;
  std::vector<std::string> names_;
  std::vector<BodyFile> files_;
  std::size_t bytes_ = 0;
};

/// A body of one link that looks as the mesh does.
Result<BodyParts> body_of_mesh(const std::string& path, double scale) {
  const std::string name = fs::path(path).filename().string();
  Result<std::string> bytes = read_mesh(fs::path(path).parent_path(), name);
  if (!bytes) return bad_input(fmt::format("{}: {}", path, bytes.error().message));
  const Pose pose = ending_of(name) == ".glb" ? kUpright : Pose{};
  const BodyVisual visual{pose, MeshSolid{name, {scale, scale, scale}}, {}};
  Body body{fs::path(path).stem().string(), {{"body", {visual}}}, {}};
  return BodyParts{std::move(body), {{name, "/body/0" + ending_of(name), *std::move(bytes)}}};
}

}  // namespace

Result<BodyParts> read_body(const std::string& path, double scale, const Notice& notice) {
  if (is_mesh(path)) return body_of_mesh(path, scale);
  if (ending_of(path) != ".urdf") return bad_input(path + ": a body is a .urdf, .stl or .glb");
  Result<Body> body = bytes::formats::read_urdf(path);
  if (!body) return body.error();
  std::vector<BodyFile> meshes = MeshReader(path, notice).read(*body);
  return BodyParts{*std::move(body), std::move(meshes)};
}

}  // namespace dermis::out::serve
