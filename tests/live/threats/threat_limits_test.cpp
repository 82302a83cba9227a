// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/threats/threat_limits.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::live::threats {
namespace {

constexpr const char* kComplete = R"([[zone]]
name = "throat"
array = "chest"
rows = [0, 3]
cols = [5, 10]

[[threat]]
name = "clamped"
quantity = "contact_force"
limit_n = 65.5
lasts_s = 0.5
release_share = 0.7
latched = true
zone = "throat"

[[threat]]
name = "hit"
quantity = "force_rate"
limit_n_per_s = 2000

[[threat]]
name = "needle"
quantity = "sharp_pressure"
limit_kpa = 150
least_force_n = 2
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kComplete;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

std::string error_of(const std::string& text) {
  const Result<ThreatLimits> limits = threat_limits_from_toml(text, "t.toml");
  if (limits) return "no error";
  EXPECT_EQ(limits.error().kind, ErrorKind::bad_input);
  return limits.error().message;
}

TEST(ThreatLimits, reads_every_key) {
  const Result<ThreatLimits> limits = threat_limits_from_toml(kComplete, "t.toml");
  ASSERT_TRUE(limits) << limits.error().message;
  const ThreatLimits expected{
      .zones = {{"throat", "chest", 0, 3, 5, 10}},
      .limits = {{"clamped", ThreatQuantity::contact_force, 65.5, 0.5, 0.7, 3.0, true, "throat"},
                 {"hit", ThreatQuantity::force_rate, 2000.0},
                 {"needle", ThreatQuantity::sharp_pressure, 150e3, 0.0, 0.8, 2.0, false, ""}}};
  EXPECT_EQ(*limits, expected);
  EXPECT_EQ(limits->zone("throat"), limits->zones.data());
  EXPECT_EQ(limits->zone("nose"), nullptr);
}

TEST(ThreatLimits, names_the_line_and_the_mend_of_what_is_wrong) {
  EXPECT_EQ(error_of(""), "t.toml: no [[threat]]: name at least one limit");
  EXPECT_EQ(error_of(with("limit_n = 65.5", "limit_kpa = 65.5")),
            "t.toml:10: threat[0].limit_kpa: is not the unit of contact_force; use limit_n");
  EXPECT_EQ(error_of(with("limit_n = 65.5\n", "")), "t.toml: threat[0].limit_n: is missing; it has no default");
  EXPECT_EQ(error_of(with("[0, 3]", "[3]")), "t.toml:4: zone[0].rows: must be the first and the last, as [0, 5]");
  EXPECT_EQ(error_of(with("[0, 3]", "[3, 0]")), "t.toml:4: zone[0].rows: must be the first and the last, as [0, 5]");
  EXPECT_EQ(error_of(with("zone = \"throat\"", "zone = \"nose\"")),
            "t.toml: threat 'clamped': there is no zone 'nose'");
  EXPECT_EQ(error_of(with("\"hit\"", "\"clamped\"")),
            "t.toml: threat 'clamped': stands twice; name one of them otherwise");
  EXPECT_EQ(error_of(with("2000", "0")), "t.toml: threat 'hit': the limit must be more than 0");
  EXPECT_EQ(error_of(with("lasts_s = 0.5", "lasts_s = -1")), "t.toml: threat 'clamped': lasts_s must be 0 to 1e6");
  EXPECT_EQ(error_of(with("release_share = 0.7", "release_share = 2")),
            "t.toml: threat 'clamped': release_share must be 0.1 to 1");
  EXPECT_EQ(error_of(with("least_force_n = 2", "least_force_n = 0")),
            "t.toml: threat 'needle': least_force_n must be more than 0");
}

TEST(ThreatLimits, names_a_key_that_it_does_not_know) {
  EXPECT_NE(error_of(with("latched", "latchd")).find("latched"), std::string::npos);
  EXPECT_NE(error_of(with("\"force_rate\"", "\"force_rat\"")).find("force_rate"), std::string::npos);
}

TEST(ThreatLimits, tells_the_unit_of_every_quantity) {
  EXPECT_EQ(threat_quantity_names().size(), static_cast<std::size_t>(ThreatQuantity::sharp_pressure) + 1);
  EXPECT_STREQ(unit_of(ThreatQuantity::total_force), "N");
  EXPECT_STREQ(unit_of(ThreatQuantity::force_rate), "N/s");
  EXPECT_STREQ(unit_of(ThreatQuantity::taxel_pressure), "Pa");
}

TEST(ThreatLimits, reads_files) {
  const support::TemporaryFolder folder;
  support::write_bytes(folder.file("t.toml"), kComplete);
  EXPECT_TRUE(read_threat_limits(folder.file("t.toml")));
  const Result<ThreatLimits> none = read_threat_limits(folder.file("none.toml"));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "cannot open '" + folder.file("none.toml") + "': No such file or directory");
}

TEST(ThreatLimits, gives_a_value_or_a_one_line_error_for_mutations) {
  support::expect_value_or_one_line_error(
      kComplete, 3000, [](const std::string& mutated) { return threat_limits_from_toml(mutated, "mutated"); });
}

}  // namespace
}  // namespace dermis::live::threats
