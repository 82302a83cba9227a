// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/job.hpp"

#include <gtest/gtest.h>

#include "support/mutations.hpp"

namespace dermis::live::fleet {
namespace {

const Job kJob{"first", {"run", "--model", "chest.safetensors", "--in", "day/rec.mcap#chest", "--out", "forces.csv"}};

TEST(Job, commands_that_read_and_write_files_are_jobs) {
  EXPECT_TRUE(check_job(kJob));
  EXPECT_TRUE(check_job({"", {"simulate", "--scene", "contacts", "--seed", "-3", "--out", "sim"}}));
}

TEST(Job, other_commands_are_refused) {
  for (const char* command : {"watch", "serve", "record", "emulate", "work", "fleet", "sh", "/bin/sh", "", "RUN"}) {
    EXPECT_FALSE(check_job({"", {command}})) << command;
  }
  EXPECT_FALSE(check_job({"", {}}));
}

TEST(Job, no_word_leads_out_of_the_folder) {
  for (const char* word : {"/etc/passwd",
                           "../model",
                           "a/../../b",
                           "--out=/etc/cron.d/x",
                           "-o/etc/x",
                           "~/.ssh/id",
                           "serial:///dev/ttyACM0",
                           "tcp://host:1",
                           "nats://hub?robot=r&array=a",
                           "file:/etc/passwd",
                           "sim:contacts?array=/etc/x",
                           "sim:contacts",
                           "dds://0/rt/touch",
                           "modbus-tcp://hand",
                           "modbus-rtu:a",
                           "[/etc/passwd]",
                           "[a,/etc/passwd]",
                           "--in=[/etc/passwd]",
                           "--",
                           "--force",
                           "sim:contacts?array=%2Fetc",
                           "stdin:",
                           "a\nb"}) {
    EXPECT_FALSE(check_job({"", {"run", "--in", word}})) << word;
  }
}

TEST(Job, a_range_of_a_stream_is_read_from_the_server_of_the_worker) {
  const std::string range = "nats://?robot=anna&array=chest&from=1&to=last";
  EXPECT_TRUE(check_job({"", {"dataset", range, "--out", "touch"}}));
  EXPECT_TRUE(is_range(range));
  EXPECT_FALSE(is_range("nats://hub?robot=anna&array=chest&from=1&to=last"));
  EXPECT_EQ(range_at({.url = "tls://hub", .ca = "/keys/ca.pem", .key = "/keys/worker.seed"}, range),
            "tls://hub?robot=anna&array=chest&from=1&to=last&ca=/keys/ca.pem&key=/keys/worker.seed");
  EXPECT_EQ(range_at({.url = "nats://hub:4222"}, range), "nats://hub:4222?robot=anna&array=chest&from=1&to=last");
}

TEST(Job, a_range_is_read_and_not_written) {
  const std::string range = "nats://?robot=anna&array=chest&from=1&to=last";
  EXPECT_TRUE(check_job({"", {"run", "--out", "a.csv", "--in", range}}));
  EXPECT_TRUE(check_job({"", {"calibrate", "--frames", range}}));
  EXPECT_TRUE(check_job({"", {"dataset", "--out=touch", range}}));
  EXPECT_EQ(check_job({"", {"dataset", "a.mcap", "--out", range}}).error().message,
            "words: '" + range + "' is no recording to read");
  EXPECT_FALSE(check_job({"", {"dataset", "a.mcap", "--out=" + range}}));
}

TEST(Job, a_range_without_an_end_or_with_a_key_is_refused) {
  const auto message_of = [](const std::string& range) {
    return check_job({"", {"run", "--in", range}}).error().message;
  };
  EXPECT_EQ(message_of("nats://?robot=r&array=a"), "words: 'nats://?robot=r&array=a' has no end; add to=");
  EXPECT_EQ(message_of("nats://?robot=r&array=a&from=1&to=9&key=/etc/shadow"),
            "words: 'nats://?robot=r&array=a&from=1&to=9&key=/etc/shadow' names a key or certificates; the worker has "
            "its own");
  EXPECT_EQ(message_of("nats://?robot=../a&array=a&from=1&to=9"),
            "'nats://HUB?robot=../a&array=a&from=1&to=9': robot: '../a' must be 1 to 64 letters, digits, '_' or '-'");
}

TEST(Job, names_are_of_one_line) {
  EXPECT_FALSE(check_job({"a\nb", kJob.words}));
  EXPECT_FALSE(check_job({"\x1b[2J", kJob.words}));
}

TEST(Job, survives_its_message) {
  const Result<Job> read = job_from_json(job_to_json(kJob));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, kJob);
}

TEST(Job, any_message_is_a_job_that_may_be_done_or_an_error_of_one_line) {
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    const Result<Job> read = job_from_json(support::mutated(job_to_json(kJob), seed));
    if (read) {
      EXPECT_TRUE(check_job(*read)) << "seed " << seed;
    } else {
      EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << "seed " << seed;
    }
  }
  EXPECT_FALSE(job_from_json(std::string(100'000, '[')));
}

TEST(Job, a_file_holds_many) {
  const auto jobs = parse_jobs(R"([[job]]
name = "first"
words = ["run", "--model", "chest.safetensors", "--in", "day/rec.mcap#chest", "--out", "forces.csv"]
[[job]]
words = ["convert", "a.mcap", "a.csv"]
)",
                               "jobs.toml");
  ASSERT_TRUE(jobs) << jobs.error().message;
  ASSERT_EQ(jobs->size(), 2U);
  EXPECT_EQ(jobs->front(), kJob);
  EXPECT_EQ(jobs->back().name, "jobs.toml 2");
}

TEST(Job, errors_of_a_file_name_the_line) {
  const auto error = [](const char* text) { return parse_jobs(text, "jobs.toml").error().message; };
  EXPECT_EQ(error(""), "jobs.toml: has no [[job]]");
  EXPECT_EQ(error("[[job]]\nwords = [\"sh\"]\n").find("jobs.toml:2: job[0].words: "), 0U);
  EXPECT_NE(error("[[job]]\nwodrs = [\"run\"]\n").find("words"), std::string::npos);
}

}  // namespace
}  // namespace dermis::live::fleet
