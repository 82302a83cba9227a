// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/mcap.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "dermis/touch/frames/random.hpp"
#include "support/allocation_guard.hpp"
#include "support/full_disk.hpp"
#include "support/mutations.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

struct Message {
  std::string topic;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::vector<std::uint8_t> data;

  bool operator==(const Message&) const = default;
};

struct Content {
  std::vector<Message> messages;
  std::optional<Error> error;
  bool complete = false;
};

Content read_content(std::unique_ptr<std::istream> in, const std::string& name) {
  Content content;
  const auto reader = McapReader::open(std::move(in), name);
  if (!reader) {
    content.error = reader.error();
    return content;
  }
  content.complete = (*reader)->complete();
  McapMessage message;
  while (true) {
    const Result<bool> got_message = (*reader)->next(message);
    if (!got_message) content.error = got_message.error();
    if (!got_message || !*got_message) return content;
    content.messages.push_back({(*reader)->channels().at(message.channel).topic, message.sequence, message.log_time,
                                std::vector<std::uint8_t>(message.data.begin(), message.data.end())});
  }
}

Content content_of(const std::string& bytes) {
  return read_content(std::make_unique<std::istringstream>(bytes), "mutated");
}

constexpr McapCompression kAll[] = {McapCompression::none, McapCompression::lz4, McapCompression::zstd};

/// Five chunks of three messages each, an attachment and metadata.
std::string small_file(McapCompression compression, std::vector<Message>* messages = nullptr) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("small.mcap");
  const auto writer = McapWriter::create(path, compression);
  EXPECT_TRUE(writer);
  (*writer)->add_attachment({"note.txt", "text/plain", "a note"});
  (*writer)->add_metadata({"about", {{"key", "value"}, {"other", ""}}});
  const std::uint16_t first = (*writer)->add_channel({"/first", "cdr", "pkg/msg/A", "ros2msg", "uint8 a\n"});
  const std::uint16_t second = (*writer)->add_channel({"/second", "cdr", "pkg/msg/A", "ros2msg", "uint8 a\n"});
  Random random(1);
  for (std::uint32_t i = 0; i < 15; ++i) {
    Message message{i % 3 == 0 ? "/second" : "/first", i, 1000U + i, {}};
    for (std::uint64_t k = random.below(40); k > 0; --k) {
      message.data.push_back(static_cast<std::uint8_t>(random.below(3)));
    }
    (*writer)->add_message({i % 3 == 0 ? second : first, i, message.log_time, message.log_time, message.data});
    if (messages != nullptr) messages->push_back(message);
    if (i % 3 == 2) {
      EXPECT_TRUE((*writer)->close_chunk());
    }
  }
  EXPECT_TRUE((*writer)->finish());
  EXPECT_EQ(folder.file_count(), 1U);
  return support::read_bytes(path);
}

TEST(Mcap, what_is_written_reads_back) {
  for (const McapCompression compression : kAll) {
    SCOPED_TRACE(to_string(compression));
    std::vector<Message> messages;
    const std::string bytes = small_file(compression, &messages);
    const Content content = content_of(bytes);
    EXPECT_FALSE(content.error);
    EXPECT_TRUE(content.complete);
    EXPECT_EQ(content.messages, messages);

    const auto reader = McapReader::open(std::make_unique<std::istringstream>(bytes), "small");
    ASSERT_TRUE(reader);
    ASSERT_TRUE((*reader)->statistics());
    EXPECT_EQ((*reader)->statistics()->messages, 15U);
    EXPECT_EQ((*reader)->statistics()->chunks, 5U);
    EXPECT_EQ((*reader)->statistics()->first_log_time, 1000U);
    EXPECT_EQ((*reader)->statistics()->last_log_time, 1014U);
    EXPECT_EQ((*reader)->statistics()->channel_messages, (std::map<std::uint16_t, std::uint64_t>{{1, 10}, {2, 5}}));
    ASSERT_EQ((*reader)->channels().size(), 2U);
    EXPECT_EQ((*reader)->channels().at(2), (McapChannel{"/second", "cdr", "pkg/msg/A", "ros2msg", "uint8 a\n"}));
    ASSERT_EQ((*reader)->attachments().size(), 1U);
    EXPECT_EQ((*reader)->attachments()[0], (McapAttachment{"note.txt", "text/plain", "a note"}));
    ASSERT_EQ((*reader)->metadata().size(), 1U);
    EXPECT_EQ((*reader)->metadata()[0], (McapMetadata{"about", {{"key", "value"}, {"other", ""}}}));
    EXPECT_EQ((*reader)->compressions(), std::vector<McapCompression>{compression});
  }
}

TEST(Mcap, a_file_that_is_cut_reads_up_to_its_last_whole_record) {
  for (const McapCompression compression : kAll) {
    SCOPED_TRACE(to_string(compression));
    std::vector<Message> messages;
    const std::string bytes = small_file(compression, &messages);
    std::size_t before = 0;
    for (std::size_t size = 8; size < bytes.size(); ++size) {
      const Content content = content_of(bytes.substr(0, size));
      ASSERT_FALSE(content.error) << size << ": " << content.error->message;
      ASSERT_FALSE(content.complete);
      const std::size_t count = content.messages.size();
      ASSERT_TRUE(count >= before && count % 3 == 0);
      ASSERT_TRUE(std::equal(content.messages.begin(), content.messages.end(), messages.begin()));
      before = count;
    }
    EXPECT_EQ(before, messages.size());
  }
}

TEST(Mcap, no_byte_that_changes_goes_unseen) {
  for (const McapCompression compression : kAll) {
    SCOPED_TRACE(to_string(compression));
    std::vector<Message> messages;
    const std::string bytes = small_file(compression, &messages);
    for (std::size_t place = 0; place < bytes.size(); ++place) {
      for (const int flip : {0x01, 0x80, 0xFF}) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ flip);
        const Content content = content_of(damaged);
        // Without its last bytes a file is one that was cut; what it holds was checked on the way.
        ASSERT_TRUE(content.error || content.messages == messages) << "byte " << place << " flipped by " << flip;
      }
    }
  }
}

TEST(Mcap, damaged_files_give_messages_or_a_one_line_error) {
  for (const McapCompression compression : kAll) {
    const std::string bytes = small_file(compression);
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
      const Content content = content_of(support::mutated(bytes, seed));
      if (!content.error) continue;
      EXPECT_EQ(content.error->kind, ErrorKind::bad_input) << "seed " << seed;
      EXPECT_TRUE(content.error->message.starts_with("mutated:")) << content.error->message;
      EXPECT_EQ(content.error->message.find('\n'), std::string::npos) << "seed " << seed;
    }
  }
}

std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (; bytes > 0; --bytes, value >>= 8U) text.push_back(static_cast<char>(value));
  return text;
}

std::string record_of(char opcode, const std::string& body) {
  return opcode + little_endian(body.size(), 8) + body;
}

const std::string kMagic = "\x89MCAP0\r\n";

TEST(Mcap, sizes_that_a_file_only_claims_take_no_memory) {
  const std::string zstd_frame("\x28\xB5\x2F\xFD\x00\x58\x01\x00\x00", 9);  // of no bytes
  const std::uint64_t claimed = std::uint64_t{64} << 20U;
  std::string chunk = little_endian(0, 16) + little_endian(claimed, 8) + little_endian(0, 4) + little_endian(4, 4) +
                      "zstd" + little_endian(zstd_frame.size(), 8) + zstd_frame;
  Content content = content_of(kMagic + record_of(6, chunk));
  ASSERT_TRUE(content.error);
  EXPECT_NE(content.error->message.find("byte 8: the chunk is damaged"), std::string::npos) << content.error->message;

  chunk.replace(16, 8, little_endian(claimed + 1, 8));
  content = content_of(kMagic + record_of(6, chunk));
  ASSERT_TRUE(content.error);
  EXPECT_NE(content.error->message.find("at most 64 MiB"), std::string::npos) << content.error->message;

  content = content_of(kMagic + std::string(1, 6) + little_endian(~std::uint64_t{0}, 8));
  EXPECT_FALSE(content.error) << "a record that goes on behind the end of the file is one that was cut";
  EXPECT_TRUE(content.messages.empty());
}

TEST(Mcap, other_files_are_refused) {
  for (const std::string& bytes : {std::string(), std::string("\x89MCAP"), std::string("time_s,r0c0\n0,1\n")}) {
    const Content content = content_of(bytes);
    ASSERT_TRUE(content.error);
    EXPECT_EQ(content.error->message, "mutated: is no MCAP file: it begins with other bytes");
  }
  const auto absent = McapReader::open("/nowhere/rec.mcap");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::bad_input);
}

TEST(Mcap, unknown_compressions_and_channels_are_named) {
  const std::string chunk = little_endian(0, 16) + little_endian(0, 8) + little_endian(0, 4) + little_endian(3, 4) +
                            "bz2" + little_endian(0, 8);
  const Content bz2 = content_of(kMagic + record_of(6, chunk));
  ASSERT_TRUE(bz2.error);
  EXPECT_NE(bz2.error->message.find("'bz2'"), std::string::npos) << bz2.error->message;

  const Content unknown = content_of(kMagic + record_of(5, little_endian(7, 2) + little_endian(0, 20)));
  ASSERT_TRUE(unknown.error);
  EXPECT_NE(unknown.error->message.find("channel 7"), std::string::npos) << unknown.error->message;
}

TEST(Mcap, the_file_appears_when_it_is_told_to) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  support::write_bytes(path, "what was there");
  {
    const auto writer = McapWriter::create(path, McapCompression::lz4);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->close_chunk());
    EXPECT_EQ(support::read_bytes(path), "what was there");
  }
  EXPECT_EQ(support::read_bytes(path), "what was there");
  EXPECT_EQ(folder.file_count(), 1U);
  {
    const auto writer = McapWriter::create(path, McapCompression::lz4);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->close_chunk());
    ASSERT_TRUE((*writer)->appear());
    EXPECT_TRUE((*writer)->synchronise());
    EXPECT_TRUE(support::read_bytes(path).starts_with(kMagic));
  }
  EXPECT_TRUE(support::read_bytes(path).starts_with(kMagic));
  EXPECT_EQ(folder.file_count(), 1U);
}

/// A message a chunk, in a file that others see from the first chunk on. Its second channel is declared late.
Status write_growing_file(const std::string& path, std::uint32_t messages) {
  const auto writer = McapWriter::create(path, McapCompression::none);
  if (!writer) return writer.error();
  std::uint16_t channel = (*writer)->add_channel({"/first", "cdr", "pkg/msg/A", "ros2msg", "uint8 a\n"});
  const std::vector<std::uint8_t> data(50, 1);
  for (std::uint32_t i = 0; i < messages; ++i) {
    if (i == messages / 2) channel = (*writer)->add_channel({"/second", "cdr", "pkg/msg/B", "ros2msg", "uint8 b\n"});
    (*writer)->add_message({channel, i, 1000U + i, 1000U + i, data});
    if ((*writer)->close_chunk()) static_cast<void>((*writer)->appear());
  }
  (*writer)->add_metadata({"totals", {{"messages", std::to_string(messages)}}});
  return (*writer)->finish();
}

/// Returns the number of its messages.
std::size_t expect_complete(const std::string& path) {
  const auto reader = McapReader::open(path);
  EXPECT_TRUE(reader && (*reader)->statistics());
  if (!reader || !(*reader)->statistics()) return 0;
  const Content content = content_of(support::read_bytes(path));
  EXPECT_FALSE(content.error) << content.error->message;
  EXPECT_TRUE(content.complete);
  EXPECT_EQ((*reader)->statistics()->messages, content.messages.size());
  EXPECT_EQ((*reader)->statistics()->chunks, content.messages.size());
  for (std::size_t i = 0; i < content.messages.size(); ++i) EXPECT_EQ(content.messages[i].sequence, i);
  return content.messages.size();
}

void expect_complete_files_or_none(std::uint32_t messages, std::size_t step) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  ASSERT_TRUE(write_growing_file(path, messages));
  ASSERT_EQ(expect_complete(path), messages);
  const std::size_t whole = support::read_bytes(path).size();
  std::size_t most_messages = 0;
  for (std::size_t missing = whole; missing > 0; missing -= std::min(step, missing)) {
    const std::size_t size = whole - missing;
    SCOPED_TRACE(size);
    std::filesystem::remove(path);
    {
      const support::SmallDisk disk(size);
      ASSERT_FALSE(write_growing_file(path, messages));
    }
    ASSERT_EQ(folder.file_count(), std::filesystem::exists(path) ? 1U : 0U);
    if (!std::filesystem::exists(path)) {
      ASSERT_EQ(most_messages, 0U) << "less room had been enough";
      continue;
    }
    const std::size_t read = expect_complete(path);
    ASSERT_GT(read, 0U);
    most_messages = std::max(most_messages, read);
  }
  EXPECT_GT(most_messages, 0.9 * messages) << "no more is given up than the end needs";
}

TEST(Mcap, a_full_disk_of_any_size_leaves_a_complete_file_or_none) {
  expect_complete_files_or_none(12, 11);
}

TEST(Mcap, a_full_disk_leaves_a_complete_file_though_the_index_is_long) {
  expect_complete_files_or_none(2500, 33'331);
}

TEST(Mcap, a_long_index_takes_no_memory_and_no_file_that_others_see) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  const support::TemporaryFolder folder;
  const auto writer = McapWriter::create(folder.file("rec.mcap"), McapCompression::lz4);
  ASSERT_TRUE(writer);
  const std::uint16_t channel = (*writer)->add_channel({"/first", "cdr", "pkg/msg/A", "ros2msg", "uint8 a\n"});
  const std::vector<std::uint8_t> data(50, 1);
  const auto bytes_in_use_after = [&](std::uint32_t chunks) {
    for (std::uint32_t i = 0; i < chunks; ++i) {
      (*writer)->add_message({channel, i, 1000U + i, 1000U + i, data});
      EXPECT_TRUE((*writer)->close_chunk());
    }
#if __GLIBC_PREREQ(2, 33)
    const auto heap = ::mallinfo2();
#else
    const auto heap = ::mallinfo();
#endif
    return static_cast<std::size_t>(heap.uordblks) + static_cast<std::size_t>(heap.hblkhd);
  };
  const std::size_t early = bytes_in_use_after(5'000);
  EXPECT_LE(bytes_in_use_after(20'000), early + std::size_t{64} * 1024);
  EXPECT_EQ(folder.file_count(), 1U);
  EXPECT_TRUE((*writer)->finish());
}

TEST(Mcap, an_index_that_cannot_be_spilled_ends_a_recording_that_is_complete) {
  const support::TemporaryFolder folder;
  const std::string path = folder.file("rec.mcap");
  const auto writer = McapWriter::create(path, McapCompression::none);
  ASSERT_TRUE(writer);
  const std::uint16_t channel = (*writer)->add_channel({"/first", "cdr", "pkg/msg/A", "ros2msg", "uint8 a\n"});
  const std::vector<std::uint8_t> data(50, 1);
  ASSERT_TRUE((*writer)->close_chunk());
  ASSERT_TRUE((*writer)->appear());
  std::uint32_t chunks = 0;
  Status written = Done{};
  {
    const support::NoMoreFiles none;
    for (; chunks < 10'000 && written; ++chunks) {
      (*writer)->add_message({channel, chunks, 1000U + chunks, 1000U + chunks, data});
      written = (*writer)->close_chunk();
    }
  }
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("rec.mcap"), std::string::npos) << written.error().message;
  EXPECT_FALSE((*writer)->finish());
  EXPECT_EQ(expect_complete(path), chunks);
}

TEST(Mcap, a_folder_that_is_not_there_is_named) {
  const auto writer = McapWriter::create("/nowhere/rec.mcap", McapCompression::none);
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().message.find("/nowhere/rec.mcap"), std::string::npos);
}

}  // namespace
}  // namespace dermis::bytes::recordings
