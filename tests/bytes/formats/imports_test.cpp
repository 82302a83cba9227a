// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/formats/imports.hpp"

#include <gtest/gtest.h>

#include "bytes/formats/imported.hpp"

namespace dermis::bytes::formats {
namespace {

TEST(Imports, refuse_what_is_not_of_their_format_and_say_so_in_one_line) {
  for (const Importer::Open open :
       {open_dsa, open_novel_asc, open_novel_lst, open_npz, open_tekscan, open_text_matrix, open_xsensor}) {
    Importer importer(open, {.rate_hz = 50.0});
    for (const std::string bytes : {"", "no numbers\n", "\x89PNG\r\n"}) {
      const std::string error = importer.error(bytes);
      EXPECT_TRUE(error.starts_with("f:")) << error;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
}

}  // namespace
}  // namespace dermis::bytes::formats
