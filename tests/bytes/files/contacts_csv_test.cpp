// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/contacts_csv.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "support/temporary_folder.hpp"

namespace dermis::bytes::files {
namespace {

constexpr const char* kHeader =
    "time_s,id,phase,x_mm,y_mm,sigma_x_mm,sigma_y_mm,velocity_x_mm_per_s,velocity_y_mm_per_s,force_n,sigma_force_n,"
    "area_mm2,peak_pressure_kpa,mean_pressure_kpa,major_axis_mm,minor_axis_mm,angle_rad,taxels\n";

Contact some_contact() {
  Contact contact;
  contact.id = 7;
  contact.position = {0.0625, 0.03125};
  contact.sigma_position_m = {0.0005, 0.00025};
  contact.velocity = {-0.5, 0.125};
  contact.force_n = 3.5;
  contact.sigma_force_n = 0.25;
  contact.area_m2 = 2e-4;
  contact.peak_pressure_pa = 64e3;
  contact.mean_pressure_pa = 32e3;
  contact.major_axis_m = 0.0078125;
  contact.minor_axis_m = 0.00390625;
  contact.angle_rad = -0.75;
  contact.taxels = 9;
  return contact;
}

TEST(ContactsCsvWriter, writes_a_line_for_each_contact_of_each_frame) {
  const support::TemporaryFolder folder;
  Result<ContactsCsvWriter> writer = ContactsCsvWriter::create(folder.file("c.csv"));
  ASSERT_TRUE(writer);
  ContactReport report;
  report.time = Nanos(10'000'000);
  ASSERT_TRUE(writer->write(report));
  report.time = Nanos(20'000'000);
  report.contacts = {some_contact(), some_contact()};
  report.contacts[1].id = 8;
  report.contacts[1].phase = ContactPhase::held;
  report.contacts[1].sigma_force_n = std::numeric_limits<double>::infinity();
  ASSERT_TRUE(writer->write(report));
  report.contacts.resize(1);
  report.contacts[0].phase = ContactPhase::release;
  report.contacts[0].force_n = 0.0;
  ASSERT_TRUE(writer->write(report));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(support::read_bytes(folder.file("c.csv")),
            std::string(kHeader) +
                "0.02,7,onset,62.5,31.25,0.5,0.25,-500,125,3.5,0.25,200,64,32,7.8125,3.90625,-0.75,9\n"
                "0.02,8,held,62.5,31.25,0.5,0.25,-500,125,3.5,inf,200,64,32,7.8125,3.90625,-0.75,9\n"
                "0.02,7,release,62.5,31.25,0.5,0.25,-500,125,0,0.25,200,64,32,7.8125,3.90625,-0.75,9\n");
}

TEST(ContactsCsvWriter, leaves_no_file_without_commit) {
  const support::TemporaryFolder folder;
  { ASSERT_TRUE(ContactsCsvWriter::create(folder.file("c.csv"))); }
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace dermis::bytes::files
