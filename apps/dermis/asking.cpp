// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "asking.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "dermis/bytes/layouts/layout.hpp"
#include "stop_flag.hpp"

namespace dermis::app {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only
using bytes::devices::ByteStream;
using std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr Nanos kListens = 2500ms;  // a board that begins anew when it is opened needs as long
constexpr Nanos kAnswers = 400ms;   // within which one begins
constexpr Nanos kQuiet = 60ms;      // after which it is over
constexpr Nanos kShows = 1s;        // whether it goes on
constexpr int kRequests = 60;       // whose answers are described
constexpr std::size_t kFewest = 4;  // bytes of an answer
constexpr std::size_t kMost = 65536;
constexpr std::size_t kMostOfGreeting = 200;  // bytes within kShows of a device that waits

/// The last is that of a finger of 25 taxels.
const std::vector<std::string>& usual_asks() {
  static const std::vector<std::string> kAsks = {"\n",
                                                 "\r\n",
                                                 "r",
                                                 "s",
                                                 "a",
                                                 "A",
                                                 "?",
                                                 "1",
                                                 "g",
                                                 "R",
                                                 "S",
                                                 "start\n",
                                                 "r\n",
                                                 "START\r\n",
                                                 "read\n",
                                                 "go\n",
                                                 "start_reading\n",
                                                 "\x01",
                                                 "\x55",
                                                 "\xFF",
                                                 std::string("\xAA\x01\0\0\0\0\0\xFF", 8)};
  return kAsks;
}

/// The texts to try; a text of the user has the escapes of TOML.
Result<std::vector<std::string>> asks_of(const std::string& asks) {
  if (asks == kUsualAsks) return usual_asks();
  const Result<bytes::layouts::Layout> layout = bytes::layouts::layout_from_toml(
      "[layout]\nrows = 1\ncols = 1\nline = \"{values}\"\nstart = \"" + asks + "\"\n", "--ask");
  if (!layout || layout->start.empty()) return bad_input("--ask: must be bytes, as --ask='\\xAA\\x01' or --ask='r\\n'");
  return std::vector<std::string>{layout->start};
}

bool is_echo(const Bytes& bytes, const std::string& ask) {
  constexpr std::size_t kLineEnd = 2;
  return bytes.size() <= ask.size() + kLineEnd && bytes.size() >= ask.size() &&
         std::equal(ask.begin(), ask.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

/// The device says again what it said before it was asked.
bool is_greeting(const Bytes& bytes, const Bytes& before) {
  const auto size = static_cast<std::ptrdiff_t>(std::min(bytes.size(), std::max<std::size_t>(before.size() / 2, 1)));
  return !before.empty() &&
         std::search(before.begin(), before.end(), bytes.begin(), bytes.begin() + size) != before.end();
}

class Asking {
 public:
  explicit Asking(ByteStream& stream) : stream_(stream) {}

  /// The bytes that come within `longest`, or until `quiet` after the last of them.
  Bytes listen(Nanos longest, Nanos quiet) {
    Bytes bytes;
    Bytes piece(kMost);
    const auto end = steady_clock::now() + longest;
    for (auto last = end; steady_clock::now() < std::min(end, last) && bytes.size() < kMost && !stop_flag();) {
      const ByteStream::Transferred came = stream_.read(piece, 10ms);
      bytes.insert(bytes.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(came.bytes));
      if (came.bytes > 0) last = steady_clock::now() + quiet;
      if (came.end != ByteStream::End::none) break;
    }
    return bytes;
  }

  Bytes answer_to(const std::string& ask) {
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(ask.data()), ask.size());
    (void)stream_.write(bytes, 100ms);
    return listen(kAnswers, kQuiet);
  }

  /// The answer of the device to these bytes. `before`: what it said within kListens unasked.
  bool try_ask(const std::string& ask, const Bytes& before, Asked& asked) {
    Bytes bytes = answer_to(ask);
    if (bytes.size() < kFewest || is_echo(bytes, ask) || is_greeting(bytes, before)) return false;
    const Bytes more = listen(kShows, kShows);
    if (more.size() > std::max(2 * before.size(), bytes.size() / 4)) {
      bytes.insert(bytes.end(), more.begin(), more.end());
      const Bytes rest = listen(kListens, kShows);
      bytes.insert(bytes.end(), rest.begin(), rest.end());
      asked = {std::move(bytes), ask, ""};
      return true;
    }
    asked = {std::move(bytes), "", ask};
    for (int k = 0; k < kRequests && asked.bytes.size() < kMost && !stop_flag(); ++k) {
      const Bytes again = answer_to(ask);
      if (again.empty()) return k > kRequests / 2;
      asked.bytes.insert(asked.bytes.end(), again.begin(), again.end());
    }
    return true;
  }

 private:
  ByteStream& stream_;
};

}  // namespace

Result<Asked> ask_device(ByteStream& stream, const std::string& asks) {
  const Result<std::vector<std::string>> texts = asks_of(asks);
  if (!texts) return texts.error();
  Asking asking(stream);
  Bytes before = asking.listen(kListens, kListens);
  const std::size_t usual = before.size() * kShows.count() / kListens.count();
  if (asks == kUsualAsks && usual > kMostOfGreeting) return Asked{.bytes = std::move(before)};
  Asked asked;
  for (const std::string& text : *texts) {
    if (asking.try_ask(text, before, asked)) return asked;
    if (stop_flag()) break;
  }
  if (!before.empty() && asks == kUsualAsks) return Asked{.bytes = std::move(before)};
  return bad_input(stream.name() +
                   " answers to nothing that boards usually wait for: name the bytes, as --ask='\\xAA\\x01'");
}

}  // namespace dermis::app
