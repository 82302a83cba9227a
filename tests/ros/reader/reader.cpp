// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// dermis_reader: takes lines "sensor_msgs/msg/Image HEX" and prints each message as JSON. The type support of ROS 2 for
// introspection tells where each field is in memory; the bytes are taken in the order of CDR.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "rosidl_runtime_c/message_type_support_struct.h"
#include "rosidl_runtime_cpp/message_initialization.hpp"
#include "rosidl_typesupport_interface/macros.h"
#include "rosidl_typesupport_introspection_cpp/field_types.hpp"
#include "rosidl_typesupport_introspection_cpp/message_introspection.hpp"

#define SYMBOL(package, name) \
  ROSIDL_TYPESUPPORT_INTERFACE__MESSAGE_SYMBOL_NAME(rosidl_typesupport_introspection_cpp, package, msg, name)
#define HANDLE(package, name) extern "C" const rosidl_message_type_support_t* SYMBOL(package, name)();
#include "handles.inc"
#undef HANDLE

namespace {

using rosidl_typesupport_introspection_cpp::MessageMember;
using rosidl_typesupport_introspection_cpp::MessageMembers;

using Handle = const rosidl_message_type_support_t* (*)();

const std::map<std::string, Handle>& handles() {
#define HANDLE(package, name) {#package "/msg/" #name, SYMBOL(package, name)},
  static const std::map<std::string, Handle> all = {
#include "handles.inc"
  };
#undef HANDLE
  return all;
}

const MessageMembers& members_of(const rosidl_message_type_support_t* handle) {
  return *static_cast<const MessageMembers*>(handle->data);
}

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::exit(1);
}

/// Little-endian CDR behind its header of four bytes.
class Cdr {
 public:
  explicit Cdr(std::vector<unsigned char> bytes) : bytes_(std::move(bytes)) {
    if (bytes_.size() < 4 || bytes_[1] != 1) fail("no little-endian CDR");
  }

  template <typename T>
  T take() {
    place_ = (place_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }

  std::string take_text() {
    const auto size = take<std::uint32_t>();
    const char* const text = reinterpret_cast<const char*>(take(size));
    if (size == 0 || text[size - 1] != '\0') fail("a text without its end");
    return {text, size - 1};
  }

  void expect_end() const {
    if (place_ + 4 != bytes_.size()) fail("bytes are left over");
  }

 private:
  const unsigned char* take(std::size_t size) {
    if (size > bytes_.size() - 4 - place_) fail("the message is too short");
    place_ += size;
    return bytes_.data() + 4 + place_ - size;
  }

  std::vector<unsigned char> bytes_;
  std::size_t place_ = 0;  // behind the header
};

/// Calls `use` with a null pointer of the type in memory.
template <typename Use>
void with_type(std::uint8_t type, const Use& use) {
  namespace types = rosidl_typesupport_introspection_cpp;
  switch (type) {
    case types::ROS_TYPE_FLOAT: return use(static_cast<float*>(nullptr));
    case types::ROS_TYPE_DOUBLE: return use(static_cast<double*>(nullptr));
    case types::ROS_TYPE_BOOLEAN: return use(static_cast<bool*>(nullptr));
    case types::ROS_TYPE_OCTET:
    case types::ROS_TYPE_UINT8: return use(static_cast<std::uint8_t*>(nullptr));
    case types::ROS_TYPE_INT8: return use(static_cast<std::int8_t*>(nullptr));
    case types::ROS_TYPE_UINT16: return use(static_cast<std::uint16_t*>(nullptr));
    case types::ROS_TYPE_INT16: return use(static_cast<std::int16_t*>(nullptr));
    case types::ROS_TYPE_UINT32: return use(static_cast<std::uint32_t*>(nullptr));
    case types::ROS_TYPE_INT32: return use(static_cast<std::int32_t*>(nullptr));
    case types::ROS_TYPE_UINT64: return use(static_cast<std::uint64_t*>(nullptr));
    case types::ROS_TYPE_INT64: return use(static_cast<std::int64_t*>(nullptr));
    case types::ROS_TYPE_STRING: return use(static_cast<std::string*>(nullptr));
    default: fail("a type that is not read here");
  }
}

void fill(Cdr& cdr, const MessageMembers& members, void* memory);

void fill_one(Cdr& cdr, const MessageMember& member, void* place) {
  if (member.type_id_ == rosidl_typesupport_introspection_cpp::ROS_TYPE_MESSAGE) {
    return fill(cdr, members_of(member.members_), place);
  }
  with_type(member.type_id_, [&](auto* type) {
    using T = std::remove_pointer_t<decltype(type)>;
    if constexpr (std::is_same_v<T, std::string>) {
      *static_cast<T*>(place) = cdr.take_text();
    } else {
      *static_cast<T*>(place) = cdr.take<T>();
    }
  });
}

void fill(Cdr& cdr, const MessageMembers& members, void* memory) {
  for (std::uint32_t k = 0; k < members.member_count_; ++k) {
    const MessageMember& member = members.members_[k];
    void* const place = static_cast<char*>(memory) + member.offset_;
    if (!member.is_array_) {
      fill_one(cdr, member, place);
      continue;
    }
    member.resize_function(place, cdr.take<std::uint32_t>());
    for (std::size_t i = 0; i < member.size_function(place); ++i) fill_one(cdr, member, member.get_function(place, i));
  }
}

void print_text(const std::string& text) {
  std::putchar('"');
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') std::putchar('\\');
    std::putchar(letter);
  }
  std::putchar('"');
}

void print(const MessageMembers& members, const void* memory);

void print_one(const MessageMember& member, const void* place) {
  if (member.type_id_ == rosidl_typesupport_introspection_cpp::ROS_TYPE_MESSAGE) {
    return print(members_of(member.members_), place);
  }
  with_type(member.type_id_, [&](auto* type) {
    using T = std::remove_pointer_t<decltype(type)>;
    const T& value = *static_cast<const T*>(place);
    if constexpr (std::is_same_v<T, std::string>) {
      print_text(value);
    } else if constexpr (std::is_same_v<T, bool>) {
      std::fputs(value ? "true" : "false", stdout);
    } else if constexpr (std::is_floating_point_v<T>) {
      std::printf("%.17g", static_cast<double>(value));
    } else if constexpr (std::is_unsigned_v<T>) {
      std::printf("%llu", static_cast<unsigned long long>(value));
    } else {
      std::printf("%lld", static_cast<long long>(value));
    }
  });
}

void print(const MessageMembers& members, const void* memory) {
  for (std::uint32_t k = 0; k < members.member_count_; ++k) {
    const MessageMember& member = members.members_[k];
    const void* const place = static_cast<const char*>(memory) + member.offset_;
    std::printf("%s\"%s\":", k > 0 ? "," : "{", member.name_);
    if (!member.is_array_) {
      print_one(member, place);
      continue;
    }
    std::putchar('[');
    for (std::size_t i = 0; i < member.size_function(place); ++i) {
      if (i > 0) std::putchar(',');
      print_one(member, member.get_const_function(place, i));
    }
    std::putchar(']');
  }
  std::putchar('}');
}

std::vector<unsigned char> bytes_of(const std::string& hex) {
  std::vector<unsigned char> bytes;
  for (std::size_t k = 0; k + 1 < hex.size(); k += 2) {
    bytes.push_back(static_cast<unsigned char>(std::stoi(hex.substr(k, 2), nullptr, 16)));
  }
  return bytes;
}

}  // namespace

int main() {
  std::string type;
  std::string hex;
  while (std::cin >> type >> hex) {
    const auto found = handles().find(type);
    if (found == handles().end()) fail("no type " + type);
    const MessageMembers& members = members_of(found->second());
    std::vector<std::max_align_t> memory(members.size_of_ / sizeof(std::max_align_t) + 1);
    members.init_function(memory.data(), rosidl_runtime_cpp::MessageInitialization::ALL);
    Cdr cdr(bytes_of(hex));
    fill(cdr, members, memory.data());
    cdr.expect_end();
    print(members, memory.data());
    std::putchar('\n');
    members.fini_function(memory.data());
  }
  return 0;
}
