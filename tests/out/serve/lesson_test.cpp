// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/teaching/lesson.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "out/serve/named_touches.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kBack = 0;
constexpr std::size_t kSkin = 1;

/// A person who taps two arrays.
class Lessons : public testing::Test {
 protected:
  /// A touch of a tenth of a second between half seconds of rest.
  void tap(std::size_t array) {
    for (int frame = 0; frame < 110; ++frame) {
      time_ += Nanos(10'000'000);
      const double newtons = course(true, 0.01 * (frame - 50));
      const ForceFrame force = force_frame(time_, touch(random_, true, newtons));
      ContactReport report;
      report.total_force_n = newtons;
      lesson_.feed({array, {}, {}, force, report, {}});
    }
  }

  std::vector<std::string> classes_of(std::size_t array) const {
    std::vector<std::string> names;
    for (const ShownExample& example : lesson_.state(array, 0).examples) names.push_back(example.class_name);
    return names;
  }

  const support::TemporaryFolder folder_;
  Lesson lesson_{ServiceArrays({{"back", touched_array(), folder_.file("back.safetensors")},
                                {"skin", touched_array(), folder_.file("skin.safetensors")}})};
  Random random_{5};
  Nanos time_{};
};

TEST_F(Lessons, one_array_listens_at_a_time) {
  lesson_.listen(kSkin, "tap", "1");
  EXPECT_EQ(lesson_.state(kSkin, 0).listening, "tap");
  tap(kSkin);
  tap(kBack);
  lesson_.listen(kBack, "pat", "1");
  EXPECT_EQ(lesson_.state(kSkin, 0).listening, "");
  tap(kSkin);
  tap(kBack);
  EXPECT_EQ(classes_of(kSkin), std::vector<std::string>{"tap"});
  EXPECT_EQ(classes_of(kBack), std::vector<std::string>{"pat"});
}

TEST_F(Lessons, an_id_belongs_to_one_example_of_one_array) {
  lesson_.listen(kSkin, "tap", "1");
  tap(kSkin);
  lesson_.listen(kBack, "tap", "1");
  tap(kBack);
  const auto id = lesson_.state(kBack, 0).examples.at(0).id;
  EXPECT_NE(id, lesson_.state(kSkin, 0).examples.at(0).id);
  EXPECT_FALSE(lesson_.discard(kSkin, id));
  EXPECT_TRUE(lesson_.discard(kBack, id));
  EXPECT_TRUE(classes_of(kBack).empty());
}

}  // namespace
}  // namespace dermis::out::serve
