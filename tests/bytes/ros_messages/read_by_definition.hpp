// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bytes/ros_messages/cdr.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::bytes::ros_messages {

/// Reads a message by the definition of its type, field by field, as others read it. Throws where the message is longer
/// or shorter than its definition says.
class DefinitionReader {
 public:
  explicit DefinitionReader(const MessageType& type) {
    std::istringstream lines(type.definition);
    std::string name;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("MSG: ")) {
        name = line.substr(5);
        continue;
      }
      std::istringstream words(line.substr(0, line.find('#')));
      Field field;
      const bool is_field = words >> field.type >> field.name && field.name.find('=') == std::string::npos;
      if (is_field) fields_[name].push_back(field);
    }
  }

  [[nodiscard]] nlohmann::json read(std::span<const std::uint8_t> message) const {
    CdrReader reader(message);
    nlohmann::json value = read(reader, "");
    if (!reader.good()) throw std::runtime_error("the message is shorter than its definition");
    static_cast<void>(reader.read<std::uint8_t>());
    if (reader.good()) throw std::runtime_error("the message is longer than its definition");
    return value;
  }

 private:
  struct Field {
    std::string type;
    std::string name;
  };

  [[nodiscard]] nlohmann::json read(CdrReader& reader, const std::string& type) const {
    if (type == "bool") return reader.read<std::uint8_t>() != 0;
    if (type == "uint8" || type == "byte") return reader.read<std::uint8_t>();
    if (type == "uint16") return reader.read<std::uint16_t>();
    if (type == "int32") return reader.read<std::int32_t>();
    if (type == "uint32") return reader.read<std::uint32_t>();
    if (type == "int64") return reader.read<std::int64_t>();
    if (type == "uint64") return reader.read<std::uint64_t>();
    if (type == "float32") return reader.read<float>();
    if (type == "float64") return reader.read<double>();
    if (type == "string") return std::string(reader.read_text());
    nlohmann::json value = nlohmann::json::object();
    for (const Field& field : fields_.at(type)) {
      value[field.name] = field.type.ends_with("[]")
                              ? read_sequence(reader, field.type.substr(0, field.type.size() - 2))
                              : read(reader, field.type);
    }
    return value;
  }

  [[nodiscard]] nlohmann::json read_sequence(CdrReader& reader, const std::string& type) const {
    nlohmann::json values = nlohmann::json::array();
    for (auto left = reader.read<std::uint32_t>(); left > 0 && reader.good(); --left)
      values.push_back(read(reader, type));
    return values;
  }

  std::map<std::string, std::vector<Field>> fields_;  ///< Of each type; of the message itself under "".
};

[[nodiscard]] inline nlohmann::json read_by_definition(const MessageType& type, std::span<const std::uint8_t> message) {
  return DefinitionReader(type).read(message);
}

}  // namespace dermis::bytes::ros_messages
