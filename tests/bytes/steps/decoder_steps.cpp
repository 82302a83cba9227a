// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// How often decoders look at each byte, of random layouts and of all protocols, on bytes that are hard for them. A look
// is a byte that is read, by their code (which is compiled as for ThreadSanitizer) or by the C library. Larger numbers,
// as readings and what is known of the layout, are none; but all work has a bound, too: the basic blocks that run.
// "auto" has as much for each protocol that it tries. Fails beyond kMostLooks and kMostBlocks.
//   decoder_steps LAYOUTS [SEED]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "random_layout.hpp"

namespace {
std::uint64_t looks = 0;
std::uint64_t blocks = 0;
}  // namespace

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming,bugprone-macro-parentheses): of the compiler
void __sanitizer_cov_trace_pc();
void __sanitizer_cov_trace_pc() {
  ++blocks;
}
#define DERMIS_LOOK(name, size)     \
  void __tsan_##name(const void*);  \
  void __tsan_##name(const void*) { \
    looks += size;                  \
  }
DERMIS_LOOK(read1, 1)
DERMIS_LOOK(read2, 0)
DERMIS_LOOK(read4, 0)
DERMIS_LOOK(read8, 0)
DERMIS_LOOK(read16, 0)
DERMIS_LOOK(unaligned_read2, 0)
DERMIS_LOOK(unaligned_read4, 0)
DERMIS_LOOK(unaligned_read8, 0)
DERMIS_LOOK(unaligned_read16, 0)
DERMIS_LOOK(write1, 0)
DERMIS_LOOK(write2, 0)
DERMIS_LOOK(write4, 0)
DERMIS_LOOK(write8, 0)
DERMIS_LOOK(write16, 0)
DERMIS_LOOK(unaligned_write2, 0)
DERMIS_LOOK(unaligned_write4, 0)
DERMIS_LOOK(unaligned_write8, 0)
DERMIS_LOOK(unaligned_write16, 0)
DERMIS_LOOK(vptr_read, 0)
#undef DERMIS_LOOK
void __tsan_read_range(const void*, std::size_t);
void __tsan_read_range(const void*, std::size_t) {}
void __tsan_write_range(const void*, std::size_t);
void __tsan_write_range(const void*, std::size_t) {}
void __tsan_init();
void __tsan_init() {}
void __tsan_vptr_update(void*, void*);
void __tsan_vptr_update(void*, void*) {}
std::uint8_t __tsan_atomic8_load(const std::uint8_t* from, int);
std::uint8_t __tsan_atomic8_load(const std::uint8_t* from, int) {
  return __atomic_load_n(from, __ATOMIC_SEQ_CST);
}
std::uint32_t __tsan_atomic32_fetch_add(std::uint32_t* to, std::uint32_t value, int);
std::uint32_t __tsan_atomic32_fetch_add(std::uint32_t* to, std::uint32_t value, int) {
  return __atomic_fetch_add(to, value, __ATOMIC_SEQ_CST);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming,bugprone-macro-parentheses)

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): of the linker
void* __real_memchr(const void* bytes, int byte, std::size_t size);
void* __wrap_memchr(const void* bytes, int byte, std::size_t size);
int __real_memcmp(const void* a, const void* b, std::size_t size);
int __wrap_memcmp(const void* a, const void* b, std::size_t size);
void* __real_memcpy(void* to, const void* from, std::size_t size);
void* __wrap_memcpy(void* to, const void* from, std::size_t size);
void* __real_memmove(void* to, const void* from, std::size_t size);
void* __wrap_memmove(void* to, const void* from, std::size_t size);
void* __real_memset(void* to, int byte, std::size_t size);
void* __wrap_memset(void* to, int byte, std::size_t size);

void* __wrap_memchr(const void* bytes, int byte, std::size_t size) {
  void* const found = __real_memchr(bytes, byte, size);
  looks +=
      (found == nullptr ? size : static_cast<std::size_t>(static_cast<char*>(found) - static_cast<const char*>(bytes)));
  return found;
}
int __wrap_memcmp(const void* a, const void* b, std::size_t size) {
  looks += size;
  return __real_memcmp(a, b, size);
}
void* __wrap_memcpy(void* to, const void* from, std::size_t size) {
  blocks += size / 8;
  return __real_memcpy(to, from, size);
}
void* __wrap_memmove(void* to, const void* from, std::size_t size) {
  blocks += size / 8;
  return __real_memmove(to, from, size);
}
void* __wrap_memset(void* to, int byte, std::size_t size) {
  blocks += size / 8;
  return __real_memset(to, byte, size);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}

namespace dermis::bytes {
namespace {

constexpr double kMostLooks = 64.0;     // a byte
constexpr double kMostBlocks = 1024.0;  // a byte
constexpr double kOnce = 1U << 18U;     // tables of a decoder

struct Work {
  double looks = 0.0;  ///< A byte.
  double blocks = 0.0;
};

struct Measured {
  Work most;
  double sum = 0.0;  ///< Of looks.
  std::size_t runs = 0;
  std::size_t beyond = 0;

  void add(const Work& work, const std::string& what, double times = 1.0) {
    ++runs;
    sum += work.looks;
    most = {std::max(most.looks, work.looks), std::max(most.blocks, work.blocks)};
    if (work.looks <= times * kMostLooks && work.blocks <= times * kMostBlocks) return;
    if (++beyond <= 20) std::printf("%.1f looks, %.1f blocks a byte: %s\n", work.looks, work.blocks, what.c_str());
  }
};

Work work_of(layouts::Decoder& decoder, const std::vector<std::uint8_t>& bytes, std::size_t piece) {
  looks = blocks = 0;
  RawFrame frame;
  const auto drain = [&] {
    while (decoder.next(frame)) {
    }
  };
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.push(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
    drain();
  }
  decoder.finish();
  drain();
  const auto each = [&](std::uint64_t all) {
    return std::max(0.0, static_cast<double>(all) - kOnce) / static_cast<double>(bytes.size());
  };
  return {each(looks), each(blocks)};
}

std::size_t any_piece(Random& random) {
  return std::size_t{1} << random.below(17);
}

std::size_t any_size(Random& random) {
  return std::size_t{1} << (14 + random.below(6));
}

void measure_layout(Random& random, Measured& measured) {
  const std::string toml = random_layout(random);
  auto layout = layouts::layout_from_toml(toml, "layout");
  if (!layout) return;
  const auto shared = std::make_shared<const layouts::Layout>(*std::move(layout));
  for (const bool is_whole_file : {false, true}) {
    const std::vector<std::uint8_t> bytes = hard_bytes(*shared, any_size(random), random);
    const std::size_t piece = any_piece(random);
    const auto decoder = layouts::make_decoder(shared, 0, is_whole_file);
    measured.add(work_of(*decoder, bytes, piece), std::to_string(bytes.size()) + " bytes in pieces of " +
                                                      std::to_string(piece) + ", file " +
                                                      std::to_string(is_whole_file) + ": " + toml);
  }
}

void measure_protocol(const std::string& name, Random& random, Measured& measured) {
  devices::ProtocolOptions options;
  options.name = name;
  if (random.below(2) == 0) options.shape = FrameShape{1 + random.below(64), 1 + random.below(64)};
  options.delimited = random.below(2) == 0;
  options.nodes_per_packet = 1 + random.below(200);
  const auto decoder = devices::make_decoder(options);
  if (!decoder) return;
  const auto words = layouts::layout_from_toml(
      random.below(2) == 0
          ? "[layout]\nrows = 1\ncols = 1\npacket = [\"AA 55 00 77 72 3C 01 0B FF FE\", \"values u8\"]\n"
          : "[layout]\nrows = 1\ncols = 1\nline = \"{values}\"\n",
      "words");
  const std::vector<std::uint8_t> bytes = hard_bytes(*words, any_size(random), random);
  const std::size_t piece = any_piece(random);
  measured.add(work_of(**decoder, bytes, piece), name + " in pieces of " + std::to_string(piece),
               name == "auto" ? static_cast<double>(devices::protocol_names().size()) : 1.0);
}

bool report(const std::string& what, const Measured& measured) {
  std::printf("%-14s %6zu runs, %5.1f looks a byte on average, at most %5.1f (and %6.1f blocks), %zu beyond\n",
              what.c_str(), measured.runs, measured.sum / static_cast<double>(std::max<std::size_t>(measured.runs, 1)),
              measured.most.looks, measured.most.blocks, measured.beyond);
  return measured.beyond == 0;
}

bool measure_all(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::printf("seed %lu\n", seed);
  Measured of_layouts;
  for (std::size_t tried = 0; of_layouts.runs < 2 * count && tried < 100 * count; ++tried)
    measure_layout(random, of_layouts);
  bool is_good = report("layouts", of_layouts);
  for (const std::string& name : devices::protocol_names()) {
    Measured of_protocol;
    for (std::size_t k = 0; k < count / 20; ++k) measure_protocol(name, random, of_protocol);
    is_good = report(name, of_protocol) && is_good;
  }
  return is_good;
}

}  // namespace
}  // namespace dermis::bytes

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 500;
  const std::uint64_t seed = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1;
  return dermis::bytes::measure_all(count, seed) ? 0 : 1;
}
