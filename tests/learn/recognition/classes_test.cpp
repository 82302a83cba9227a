// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/classes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "small_classes.hpp"

namespace dermis::learn::recognition {
namespace {

std::string error_after(const std::function<void(Classes&)>& change) {
  static const Classes kGood = support::small_classes();
  Classes classes = kGood;
  change(classes);
  const Status status = classes.validate();
  return status ? "no error" : status.error().message;
}

TEST(Classes, that_were_learned_are_valid) {
  EXPECT_EQ(error_after([](Classes&) {}), "no error");
}

TEST(Classes, with_tables_that_do_not_fit_together_are_refused) {
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].axes.pop_back(); }),
            "expert 'place' has tables of the wrong size");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[1].class_means.push_back(0.0F); }),
            "expert 'form' has tables of the wrong size");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].columns.back() = 1000000; }),
            "expert 'place' names features that do not exist");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].columns.front() = -1; }),
            "expert 'place' names features that do not exist");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts.back().centres.pop_back(); }),
            "expert 'course' has tables of the wrong size");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts.back().influences.clear(); }),
            "expert 'course' has tables of the wrong size");
  EXPECT_EQ(error_after([](Classes& classes) { classes.examples.pop_back(); }), "each class must have examples");
}

TEST(Classes, with_values_that_are_no_numbers_are_refused) {
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].mean[0] = NAN; }),
            "expert 'place' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].weight = -1.0; }),
            "expert 'place' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].axes[0] = 1e30F; }),
            "expert 'place' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].class_means[0] = -1e30F; }),
            "expert 'place' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts.back().width = -1.0; }),
            "expert 'course' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts.back().centres[0] = 1e30F; }),
            "expert 'course' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts.back().influences[0] = NAN; }),
            "expert 'course' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.doubt_weight = 1e300; }), "the unknown score is out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].distances.clear(); }),
            "expert 'place' holds values out of range");
  EXPECT_EQ(error_after([](Classes& classes) { classes.doubts = {1.0F, 0.0F}; }), "the unknown score is out of range");
}

TEST(Classes, with_names_that_are_no_plain_text_are_refused) {
  EXPECT_EQ(error_after([](Classes& classes) { classes.names[0] = "a\nb"; }),
            "class 'a?b' must be UTF-8 without control characters");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts[0].name = "a\nb"; }),
            "the name of an expert must be UTF-8 without control characters");
  EXPECT_EQ(error_after([](Classes& classes) { classes.layout.arrays[0].name = "a\nb"; }),
            "array 'a?b': its name must be UTF-8 without control characters");
}

TEST(Classes, need_two_names_or_more_that_differ) {
  EXPECT_EQ(error_after([](Classes& classes) { classes.names[1] = classes.names[0]; }),
            "the names of the classes must be sorted and distinct");
  EXPECT_EQ(error_after([](Classes& classes) { classes.names[3] = "unknown"; }),
            "class 'unknown' is the answer for what is like no class; give it another name");
  EXPECT_EQ(error_after([](Classes& classes) { classes.names.resize(1); }), "there must be 2 to 1000 classes");
  EXPECT_EQ(error_after([](Classes& classes) { classes.experts.clear(); }), "there must be 1 to 8 experts");
}

}  // namespace
}  // namespace dermis::learn::recognition
