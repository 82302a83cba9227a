// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/suit/service_arrays.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "support/reference_array.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

const ServiceArray kSkin{"skin", support::reference_array(2, 2), "models/skin.safetensors"};
const ServiceArray kBack{"back", support::reference_array(2, 2), ""};

TEST(ServiceArrays, are_found_by_name) {
  const ServiceArrays arrays({kSkin, kBack});
  EXPECT_EQ(arrays.find("back").value(), 1U);
  EXPECT_EQ(arrays.find("chest").error().message, "array: there is none of that name");
  EXPECT_EQ(arrays.find("").error().message, "array: there is none of that name") << "which of two?";
}

TEST(ServiceArrays, a_single_one_needs_no_name) {
  const ServiceArrays arrays({kSkin});
  EXPECT_EQ(arrays.find("").value(), 0U);
  EXPECT_FALSE(arrays.find("back"));
}

TEST(ServiceArrays, new_files_lie_beside_the_model_and_have_the_time_in_their_names) {
  EXPECT_TRUE(std::regex_match(kSkin.new_name(), std::regex("skin-[0-9]{8}-[0-9]{6}"))) << kSkin.new_name();
  EXPECT_TRUE(std::regex_match(kSkin.new_name("touches"), std::regex("skin-touches-[0-9]{8}-[0-9]{6}")));
  EXPECT_EQ(kSkin.path_of("a"), "models/a");
  EXPECT_EQ(kBack.path_of("a"), "a");
}

TEST(ServiceArrays, files_of_the_same_second_have_a_number_in_their_names) {
  const support::TemporaryFolder folder;
  ServiceArray skin = kSkin;
  skin.model = folder.file("skin.safetensors");
  std::set<std::string> names;
  for (int k = 0; k < 3; ++k) {
    const std::string name = skin.new_name();
    std::ofstream(skin.path_of(name) + ".frames.csv") << "time_s\n";
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

}  // namespace
}  // namespace dermis::out::serve
