// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/system/secret.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <string>

#include "support/temporary_folder.hpp"

namespace dermis {
namespace {

constexpr const char* kVariable = "DERMIS_TEST_SECRET";
constexpr const char* kFolder = "CREDENTIALS_DIRECTORY";

class Secret : public testing::Test {
 protected:
  Secret() { TearDown(); }
  void TearDown() override {
    ::unsetenv(kVariable);
    ::unsetenv(kFolder);
  }

  std::string written(const std::string& name, const std::string& bytes, mode_t mode = 0600) {
    support::write_bytes(folder_.file(name), bytes);
    ::chmod(folder_.file(name).c_str(), mode);
    return folder_.file(name);
  }
  static Result<std::string> read(const std::string& file = "") { return read_secret({file, kVariable, "token"}); }
  static std::string error_of(const std::string& file) {
    const Result<std::string> secret = read(file);
    EXPECT_FALSE(secret);
    if (secret) return "";
    EXPECT_EQ(secret.error().kind, ErrorKind::bad_input);
    EXPECT_NE(secret.error().message.find(file), std::string::npos) << secret.error().message;
    EXPECT_EQ(secret.error().message.find("hidden"), std::string::npos) << secret.error().message;
    return secret.error().message;
  }

  support::TemporaryFolder folder_;
};

TEST_F(Secret, is_empty_where_no_place_has_one) {
  EXPECT_EQ(*read(), "");
  ::setenv(kVariable, "", 1);
  ::setenv(kFolder, folder_.file("").c_str(), 1);
  EXPECT_EQ(*read(), "");
}

TEST_F(Secret, is_the_only_line_of_a_file) {
  EXPECT_EQ(*read(written("one", "hidden-1")), "hidden-1");
  EXPECT_EQ(*read(written("line", "hidden-2\n")), "hidden-2");
  EXPECT_EQ(*read(written("dos", "hidden 3\r\n")), "hidden 3");
  EXPECT_EQ(*read(written("long", std::string(4096, 'x'))), std::string(4096, 'x'));
}

TEST_F(Secret, a_file_counts_before_the_environment_and_that_before_systemd) {
  written("token", "of systemd", 0440);
  ::setenv(kFolder, folder_.file("").c_str(), 1);
  EXPECT_EQ(*read(), "of systemd");
  ::setenv(kVariable, "of the environment", 1);
  EXPECT_EQ(*read(), "of the environment");
  EXPECT_EQ(*read(written("named", "of the file")), "of the file");
}

TEST_F(Secret, a_file_that_every_user_may_read_or_change_is_refused) {
  for (const mode_t mode : {0604U, 0602U, 0644U}) {
    EXPECT_NE(error_of(written("open", "hidden", mode)).find("chmod o="), std::string::npos);
  }
  EXPECT_EQ(*read(written("of_a_group", "hidden", 0640)), "hidden");
}

TEST_F(Secret, a_file_with_anything_else_is_refused_without_showing_it) {
  for (const char* const bytes : {"", "\n", "hidden\nhidden\n", "hidden\thidden", "\x01hidden"}) {
    EXPECT_NE(error_of(written("wrong", bytes)).find("only line"), std::string::npos);
  }
  EXPECT_NE(error_of(written("wrong", std::string(4097, 'x'))).find("only line"), std::string::npos);
  EXPECT_NE(error_of(folder_.file("none")).find("No such file"), std::string::npos);
  EXPECT_NE(error_of(folder_.file("")).find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace dermis
