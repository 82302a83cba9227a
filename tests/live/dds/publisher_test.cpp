// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/dds/publisher.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace dermis::live::dds {
namespace {

// What subscribers get: tests/live/dds/cyclone_test.py.

TEST(PublisherOptions, a_domain_has_ports_of_its_own) {
  EXPECT_TRUE(PublisherOptions{}.validate());
  EXPECT_TRUE(PublisherOptions{.domain = 232}.validate());
  EXPECT_EQ(PublisherOptions{.domain = 233}.validate().error().message, "domain: must be 0 to 232, is 233");
  EXPECT_EQ(Publisher::create({.domain = 233}).error().message, "domain: must be 0 to 232, is 233");
}

/// Sets a variable of the environment and takes it away again.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { unsetenv(name_); }

 private:
  const char* name_;
};

TEST(PublisherOptions, are_those_of_the_nodes_of_the_same_shell) {
  EXPECT_EQ(options_of_environment()->domain, 0U);
  const Variable domain("ROS_DOMAIN_ID", "42");
  const Variable range("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
  EXPECT_EQ(options_of_environment()->domain, 42U);
  EXPECT_EQ(options_of_environment(7)->domain, 7U);
  EXPECT_TRUE(options_of_environment()->loopback_only);
  EXPECT_EQ(options_of_environment(1ULL << 40U).error().message, "domain: must be 0 to 232, is 4294967295");
}

TEST(PublisherOptions, an_environment_without_a_domain_is_refused) {
  const Variable domain("ROS_DOMAIN_ID", "4x");
  EXPECT_EQ(options_of_environment().error().message, "ROS_DOMAIN_ID: must be 0 to 232, is '4x'");
}

}  // namespace
}  // namespace dermis::live::dds
