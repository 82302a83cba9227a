// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/dds/publisher.hpp"

#include <gtest/gtest.h>

namespace dermis::dds {
namespace {

// What subscribers get: tests/dds/cyclone_test.py.

TEST(PublisherOptions, a_domain_has_ports_of_its_own) {
  EXPECT_TRUE(PublisherOptions{}.validate());
  EXPECT_TRUE(PublisherOptions{.domain = 232}.validate());
  EXPECT_EQ(PublisherOptions{.domain = 233}.validate().error().message, "domain: must be 0 to 232, is 233");
  EXPECT_EQ(Publisher::create({.domain = 233}).error().message, "domain: must be 0 to 232, is 233");
}

}  // namespace
}  // namespace dermis::dds
