// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/urdf.hpp"

#include <expat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::formats {
namespace {

constexpr std::size_t kMostBytes = std::size_t{4} << 20U;
constexpr std::size_t kMostLinks = 512;
constexpr std::size_t kMostVisuals = 4096;
constexpr std::size_t kMostNameBytes = 256;
constexpr std::size_t kMostDepth = 64;
constexpr double kFarthest = 1e6;  // [m], [rad]; and of scales

struct FreeParser {
  void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};

using Rgba = std::array<double, 4>;

/// A joint whose links are still names.
struct NamedJoint {
  BodyJoint joint;
  bool has_limits = true;
  std::string parent;
  std::string child;
};

/// The attributes of an element.
class Attributes {
 public:
  explicit Attributes(const XML_Char** attributes) : attributes_(attributes) {}

  [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const {
    for (const XML_Char** at = attributes_; *at != nullptr; at += 2) {
      if (name == *at) return at[1];
    }
    return std::nullopt;
  }

 private:
  const XML_Char** attributes_;
};

/// Exactly as many numbers as there is room for; false: it is something else.
bool read_numbers(std::string_view text, std::span<double> numbers) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::size_t at = 0;
  for (double& number : numbers) {
    at = text.find_first_not_of(kBlanks, at);
    if (at == std::string_view::npos) return false;
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    if (!files::parse_number(text.substr(at, end - at), number)) return false;
    if (!(std::abs(number) <= kFarthest)) return false;
    at = end;
  }
  return text.find_first_not_of(kBlanks, at) == std::string_view::npos;
}

/// Takes the elements of a description one after the other. Only the elements on known paths count: a box of a
/// collision is none of a visual.
class UrdfReader {
 public:
  UrdfReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  Result<Body> read();

 private:
  [[nodiscard]] Error error(const std::string& message) const;
  void fail(const std::string& message);

  void start(std::string_view element, const Attributes& attributes);
  void end();
  void start_link(const Attributes& attributes);
  void start_joint(const Attributes& attributes);
  void start_visual();
  void take_solid(std::string_view element, const Attributes& attributes);
  void take_mesh(const Attributes& attributes);
  void take_origin(const Attributes& attributes, Pose& pose);
  void take_material(const Attributes& attributes);
  void take_color(const Attributes& attributes);
  void take_joint_part(std::string_view part, const Attributes& attributes);
  void take_limit(const Attributes& attributes);

  /// Fails where the attribute is missing.
  [[nodiscard]] std::string needed(const Attributes& attributes, const char* attribute);
  /// Leaves the numbers as they are where the attribute is missing.
  void numbers(const Attributes& attributes, const char* attribute, std::span<double> numbers);
  [[nodiscard]] double size(const Attributes& attributes, const char* attribute);

  [[nodiscard]] Result<Body> finished();

  std::string_view text_;
  std::string name_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  std::optional<Error> failure_;
  std::vector<std::string> path_;  ///< From <robot> to the element that is open.
  Body body_;
  std::vector<NamedJoint> joints_;
  std::map<std::string, Rgba, std::less<>> colors_;             ///< By the names of materials.
  std::vector<std::pair<std::size_t, std::string>> materials_;  ///< Visuals that name one, as they are counted.
  std::vector<std::pair<std::size_t, std::size_t>> visuals_;    ///< Link and place in it.
  std::string material_;                                        ///< The one that is open.
};

Error UrdfReader::error(const std::string& message) const {
  return bad_input(name_ + ":" + std::to_string(XML_GetCurrentLineNumber(parser_.get())) + ": " + message);
}

void UrdfReader::fail(const std::string& message) {
  if (failure_) return;
  failure_ = error(message);
  XML_StopParser(parser_.get(), XML_FALSE);
}

Result<Body> UrdfReader::read() {
  if (text_.size() > kMostBytes) return bad_input(name_ + ": is larger than 4 MiB, which no description of a body is");
  parser_.reset(XML_ParserCreate(nullptr));
  XML_SetUserData(parser_.get(), this);
  XML_SetElementHandler(
      parser_.get(),
      [](void* data, const XML_Char* element, const XML_Char** attributes) {
        static_cast<UrdfReader*>(data)->start(element, Attributes(attributes));
      },
      [](void* data, const XML_Char*) { static_cast<UrdfReader*>(data)->end(); });
  XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    static_cast<UrdfReader*>(data)->fail("has a document type, which no URDF has; remove it");
  });
  const XML_Status status = XML_Parse(parser_.get(), text_.data(), static_cast<int>(text_.size()), XML_TRUE);
  if (failure_) return *failure_;
  if (status != XML_STATUS_OK) {
    return error(std::string("is no XML: ") + XML_ErrorString(XML_GetErrorCode(parser_.get())) +
                 "; a .xacro must be expanded first (xacro robot.xacro > robot.urdf)");
  }
  return finished();
}

void UrdfReader::start(std::string_view element, const Attributes& attributes) {
  if (failure_) return;
  if (path_.size() == kMostDepth) return fail("has elements within elements, more than 64 deep");
  path_.emplace_back(element);
  if (path_.size() == 1) {
    if (element != "robot")
      return fail("begins with <" + std::string(element.substr(0, kMostNameBytes)) + ">, not with <robot>");
    body_.name = std::string(attributes.find("name").value_or("body").substr(0, kMostNameBytes));
    return;
  }
  const std::string& part = path_[1];
  if (path_.size() == 2 && part == "link") return start_link(attributes);
  if (path_.size() == 2 && part == "joint") return start_joint(attributes);
  if (path_.size() == 2 && part == "material") return take_material(attributes);
  if (path_.size() == 3 && part == "material" && element == "color") return take_color(attributes);
  if (part == "joint" && path_.size() == 3) return take_joint_part(element, attributes);
  if (part != "link" || path_.size() < 3 || path_[2] != "visual") return;
  if (path_.size() == 3) return start_visual();
  if (path_.size() == 4 && element == "origin")
    return take_origin(attributes, body_.links.back().visuals.back().link_from_visual);
  if (path_.size() == 4 && element == "material") return take_material(attributes);
  if (path_.size() == 5 && path_[3] == "geometry") return take_solid(element, attributes);
  if (path_.size() == 5 && path_[3] == "material" && element == "color") return take_color(attributes);
}

void UrdfReader::end() {
  if (!path_.empty()) path_.pop_back();
}

void UrdfReader::start_link(const Attributes& attributes) {
  if (body_.links.size() == kMostLinks) return fail("has more than 512 links");
  body_.links.push_back({needed(attributes, "name")});
}

void UrdfReader::start_joint(const Attributes& attributes) {
  if (joints_.size() == kMostLinks) return fail("has more than 512 joints");
  BodyJoint joint;
  joint.name = needed(attributes, "name");
  const std::string type = needed(attributes, "type");
  if (type == "revolute" || type == "continuous") joint.kind = BodyJoint::Kind::turning;
  if (type == "prismatic") joint.kind = BodyJoint::Kind::sliding;
  const bool is_known =
      joint.kind != BodyJoint::Kind::fixed || type == "fixed" || type == "floating" || type == "planar";
  if (!is_known) fail("joint '" + joint.name + "': '" + type + "' is no type of a joint");
  joints_.push_back({std::move(joint), type != "continuous", {}, {}});
}

void UrdfReader::start_visual() {
  if (visuals_.size() == kMostVisuals) return fail("has more than 4096 visuals");
  std::vector<BodyVisual>& visuals = body_.links.back().visuals;
  visuals_.emplace_back(body_.links.size() - 1, visuals.size());
  visuals.emplace_back();
}

void UrdfReader::take_solid(std::string_view element, const Attributes& attributes) {
  BodyVisual& visual = body_.links.back().visuals.back();
  if (element == "box") {
    std::array<double, 3> sides{};
    static_cast<void>(needed(attributes, "size"));
    numbers(attributes, "size", sides);
    for (const double side : sides) {
      if (!(side > 0.0)) return fail("the sides of a box must be more than 0 m");
    }
    visual.solid = BoxSolid{{sides[0], sides[1], sides[2]}};
  } else if (element == "cylinder") {
    visual.solid = CylinderSolid{size(attributes, "radius"), size(attributes, "length")};
  } else if (element == "sphere") {
    visual.solid = SphereSolid{size(attributes, "radius")};
  } else if (element == "mesh") {
    take_mesh(attributes);
  } else {
    fail("a visual is a box, a cylinder, a sphere or a mesh, not a <" + std::string(element.substr(0, kMostNameBytes)) +
         ">");
  }
}

void UrdfReader::take_mesh(const Attributes& attributes) {
  std::array<double, 3> scale{1.0, 1.0, 1.0};
  numbers(attributes, "scale", scale);
  body_.links.back().visuals.back().solid = MeshSolid{needed(attributes, "filename"), {scale[0], scale[1], scale[2]}};
}

void UrdfReader::take_origin(const Attributes& attributes, Pose& pose) {
  std::array<double, 3> place{};
  std::array<double, 3> turn{};
  numbers(attributes, "xyz", place);
  numbers(attributes, "rpy", turn);
  pose = {{place[0], place[1], place[2]}, rotation_of(turn[0], turn[1], turn[2])};
}

void UrdfReader::take_material(const Attributes& attributes) {
  material_ = std::string(attributes.find("name").value_or(""));
  if (material_.size() > kMostNameBytes) return fail("has a name of more than 256 bytes");
  if (path_.size() > 2 && !material_.empty()) materials_.emplace_back(visuals_.size() - 1, material_);
}

void UrdfReader::take_color(const Attributes& attributes) {
  Rgba rgba{};
  static_cast<void>(needed(attributes, "rgba"));
  numbers(attributes, "rgba", rgba);
  for (const double part : rgba) {
    if (!(part >= 0.0 && part <= 1.0)) return fail("rgba: must be four numbers from 0 to 1");
  }
  if (path_.size() > 3) body_.links.back().visuals.back().rgba = rgba;
  if (!material_.empty()) colors_.emplace(material_, rgba);
}

void UrdfReader::take_joint_part(std::string_view part, const Attributes& attributes) {
  NamedJoint& named = joints_.back();
  if (part == "origin") return take_origin(attributes, named.joint.parent_from_child);
  if (part == "limit") return take_limit(attributes);
  if (part == "parent") named.parent = needed(attributes, "link");
  if (part == "child") named.child = needed(attributes, "link");
  if (part != "axis") return;
  std::array<double, 3> axis{1.0, 0.0, 0.0};
  numbers(attributes, "xyz", axis);
  named.joint.axis = {axis[0], axis[1], axis[2]};
}

/// With one limit given, the other is 0, as URDF says.
void UrdfReader::take_limit(const Attributes& attributes) {
  if (!attributes.find("lower") && !attributes.find("upper")) return;
  std::array<double, 1> lowest{};
  std::array<double, 1> highest{};
  numbers(attributes, "lower", lowest);
  numbers(attributes, "upper", highest);
  if (!joints_.back().has_limits) return;
  joints_.back().joint.lowest = lowest[0];
  joints_.back().joint.highest = highest[0];
}

std::string UrdfReader::needed(const Attributes& attributes, const char* attribute) {
  const std::optional<std::string_view> value = attributes.find(attribute);
  if (!value || value->empty()) {
    fail("<" + path_.back().substr(0, kMostNameBytes) + "> needs " + attribute + "=\"...\"");
    return {};
  }
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20U; };
  if (std::any_of(value->begin(), value->end(), is_control))
    fail("has a name of several lines or with control characters");
  if (value->size() > kMostNameBytes) fail("has a name of more than 256 bytes");
  return std::string(value->substr(0, kMostNameBytes));
}

void UrdfReader::numbers(const Attributes& attributes, const char* attribute, std::span<double> numbers) {
  const std::optional<std::string_view> text = attributes.find(attribute);
  if (!text || read_numbers(*text, numbers)) return;
  const std::string wanted = numbers.size() == 1 ? "one number" : std::to_string(numbers.size()) + " numbers";
  fail(std::string(attribute) + ": must be " + wanted + " between blanks, of at most 1e6");
}

double UrdfReader::size(const Attributes& attributes, const char* attribute) {
  std::array<double, 1> metres{};
  static_cast<void>(needed(attributes, attribute));
  numbers(attributes, attribute, metres);
  if (!(metres[0] > 0.0)) fail(std::string(attribute) + ": must be more than 0 m");
  return metres[0];
}

Result<Body> UrdfReader::finished() {
  std::map<std::string_view, std::size_t> links;
  for (std::size_t k = 0; k < body_.links.size(); ++k) links.emplace(body_.links[k].name, k);
  for (NamedJoint& named : joints_) {
    const auto parent = links.find(named.parent);
    const auto child = links.find(named.child);
    if (parent == links.end() || child == links.end()) {
      const std::string& missing = parent == links.end() ? named.parent : named.child;
      return bad_input(name_ + ": joint '" + named.joint.name + "': there is no link '" + missing + "'");
    }
    named.joint.parent = parent->second;
    named.joint.child = child->second;
    body_.joints.push_back(std::move(named.joint));
  }
  for (const auto& [visual, material] : materials_) {
    BodyVisual& seen = body_.links[visuals_[visual].first].visuals[visuals_[visual].second];
    const auto color = colors_.find(material);
    if (!seen.rgba && color != colors_.end()) seen.rgba = color->second;
  }
  Result<Body> body = make_body(std::move(body_));
  if (!body) return bad_input(name_ + ": " + body.error().message);
  return body;
}

}  // namespace

Result<Body> body_from_urdf(std::string_view text, const std::string& name) {
  return UrdfReader(text, name).read();
}

Result<Body> read_urdf(const std::string& path) {
  const Result<std::string> text = files::read_file(path, kMostBytes);
  if (!text) return text.error();
  return body_from_urdf(*text, path);
}

}  // namespace dermis::bytes::formats
