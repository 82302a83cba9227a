// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "child_process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "support/temporary_folder.hpp"

namespace dermis::app {
namespace {

using support::TemporaryFolder;

std::optional<ChildProcess> started(const std::vector<std::string>& command) {
  Result<ChildProcess> child = ChildProcess::start(command);
  EXPECT_TRUE(child) << (child ? "" : child.error().message);
  if (!child) return std::nullopt;
  return *std::move(child);
}

int end_of(ChildProcess& child) {
  for (;;) {
    if (const std::optional<int> status = child.exit_status()) return *status;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void wait_for_file(const std::string& path) {
  while (!std::filesystem::exists(path)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(ChildProcess, gives_the_exit_status_of_its_program_again_and_again) {
  auto child = started({"sh", "-c", "exit 7"});
  ASSERT_TRUE(child);
  EXPECT_EQ(end_of(*child), 7);
  EXPECT_EQ(child->exit_status(), 7);
}

TEST(ChildProcess, says_which_signal_ended_its_program) {
  auto child = started({"sh", "-c", "kill -9 $$"});
  ASSERT_TRUE(child);
  EXPECT_EQ(end_of(*child), 128 + SIGKILL);
}

TEST(ChildProcess, names_the_program_that_is_not_there) {
  const Result<ChildProcess> child = ChildProcess::start({"no such program"});
  ASSERT_FALSE(child);
  EXPECT_EQ(child.error().message, "cannot start 'no such program': No such file or directory");
}

TEST(ChildProcess, reads_an_empty_input) {
  auto child = started({"sh", "-c", "read line || exit 5"});
  ASSERT_TRUE(child);
  EXPECT_EQ(end_of(*child), 5);
}

TEST(ChildProcess, may_end_what_must_be_ended_when_it_is_stopped) {
  const TemporaryFolder folder;
  const std::string begun = folder.file("begun");
  const std::string ended = folder.file("ended");
  auto child = started(
      {"sh", "-c",
       "trap 'touch \"" + ended + "\"; exit 0' TERM; touch \"" + begun + "\"; while true; do sleep 0.01; done"});
  ASSERT_TRUE(child);
  wait_for_file(begun);
  EXPECT_FALSE(child->exit_status());
  child->stop();
  EXPECT_EQ(child->exit_status(), 0);
  EXPECT_TRUE(std::filesystem::exists(ended));
}

TEST(ChildProcess, ends_with_its_object_and_so_does_what_it_has_started) {
  const TemporaryFolder folder;
  const std::string number = folder.file("number");
  {
    auto child =
        started({"sh", "-c", "sleep 1000 & echo $! > " + number + ".new; mv " + number + ".new " + number + "; wait"});
    ASSERT_TRUE(child);
    wait_for_file(number);
  }
  const std::string status = "/proc/" + std::to_string(std::stoi(support::read_bytes(number))) + "/stat";
  // Who is killed may still wait to be fetched by its new parent: it is a zombie then.
  const auto is_gone = [&] {
    const std::string text = support::read_bytes(status);
    return text.empty() || text.find(") Z ") != std::string::npos;
  };
  while (!is_gone()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace
}  // namespace dermis::app
