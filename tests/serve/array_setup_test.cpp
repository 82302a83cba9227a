// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/serve/array_setup.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "dermis/files/array_toml.hpp"
#include "serve/stream_client.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::serve {
namespace {

SessionOptions any_port() {
  SessionOptions options;
  options.server.port = 0;
  return options;
}

/// In a folder of its own, which is the current one meanwhile.
class ArraySetupTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(folder_.file("")); }
  void TearDown() override { std::filesystem::current_path(before_); }

 private:
  support::TemporaryFolder folder_;
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(ArraySetupTest, writes_the_array_that_a_client_describes) {
  const auto setup = ArraySetup::create("sim:idle?rate=100&rows=3&cols=4", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  const std::atomic<bool> stop = false;
  std::string path;
  std::thread work([&] { path = (*setup)->run(stop); });

  StreamClient client((*setup)->port());
  const auto answer = [&](const std::string& request) { return client.call("/array/describe", request); };
  EXPECT_NE(answer("[]").find("JSON"), std::string::npos);
  EXPECT_NE(answer(R"({"name":"../mat","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})").find("name"),
            std::string::npos);
  EXPECT_NE(answer(R"({"name":"mat","rows":0,"cols":4,"pitch_um":8000,"adc_bits":10})").find("rows"),
            std::string::npos);
  EXPECT_NE(answer(R"({"name":"mat","rows":3,"cols":4,"pitch_um":8000})").find("adc_bits"), std::string::npos);
  std::ofstream("there.toml") << "mine";
  EXPECT_NE(answer(R"({"name":"there","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})").find("there already"),
            std::string::npos);
  EXPECT_NE(answer(R"({"name":"mat","rows":3,"cols":4,"pitch_um":8000,"adc_bits":10})").find("mat.toml"),
            std::string::npos);
  work.join();

  EXPECT_EQ(path, "mat.toml");
  const Result<ArrayDescription> array = files::read_array(path);
  ASSERT_TRUE(array) << array.error().message;
  EXPECT_EQ(array->name, "mat");
  EXPECT_EQ((FrameShape{array->rows, array->cols}), (FrameShape{3, 4}));
  EXPECT_DOUBLE_EQ(array->row_pitch_m, 0.008);
  EXPECT_EQ(array->readout.adc_bits, 10);
  EXPECT_EQ(array->readout.circuit, Circuit::automatic);
}

TEST_F(ArraySetupTest, ends_with_nothing_where_it_is_stopped) {
  const auto setup = ArraySetup::create("sim:idle?rate=100&rows=3&cols=4", any_port(), {});
  ASSERT_TRUE(setup) << setup.error().message;
  const std::atomic<bool> stop = true;
  EXPECT_EQ((*setup)->run(stop), "");
}

TEST_F(ArraySetupTest, is_not_for_a_source_that_cannot_be) {
  EXPECT_FALSE(ArraySetup::create("serial:///dev/no_such_tty", any_port(), {}));
  EXPECT_FALSE(ArraySetup::create("sim:idle?bogus=1", any_port(), {}));
}

TEST_F(ArraySetupTest, serves_bytes_of_which_no_frame_can_be_made) {
  std::ofstream file("bytes");
  for (int line = 0; line < 20; ++line) file << "1,2,3,4,5,6\n";
  file.close();
  EXPECT_TRUE(ArraySetup::create("file:bytes", any_port(), {}));
}

}  // namespace
}  // namespace dermis::serve
