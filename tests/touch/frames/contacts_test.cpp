// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/contacts.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(Contacts, nothing_is_touched_by_default) {
  const ContactReport report;
  EXPECT_TRUE(report.contacts.empty());
  EXPECT_EQ(report.total_force_n, 0.0);
  EXPECT_FALSE(report.centre_of_pressure.has_value());
}

TEST(Contacts, reports_are_equal_when_all_their_contacts_are) {
  ContactReport report;
  report.contacts.resize(2);
  report.contacts[1].position = {0.01, 0.02};
  ContactReport other = report;
  EXPECT_EQ(report, other);
  other.contacts[1].position.y = 0.03;
  EXPECT_NE(report, other);
}

}  // namespace
}  // namespace dermis
