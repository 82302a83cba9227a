// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/system/plugin.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(Plugin, a_function_is_found_in_its_library) {
  const Result<void*> found = find_plugin_function({"a test", "libc.so.6", "of every machine"}, "abs");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(reinterpret_cast<int (*)(int)>(*found)(-3), 3);
}

TEST(Plugin, a_library_that_is_not_there_is_named_with_the_mend) {
  const Result<void*> found = find_plugin_function({"a test", "libdermis_none.so", "of a build with NONE"}, "f");
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(found.error().message.find("a test needs libdermis_none.so of a build with NONE: libdermis_none.so: "), 0U)
      << found.error().message;
}

TEST(Plugin, a_function_that_is_not_there_is_named) {
  const Result<void*> found = find_plugin_function({"a test", "libc.so.6", "of every machine"}, "dermis_none");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("dermis_none"), std::string::npos) << found.error().message;
}

}  // namespace
}  // namespace dermis
