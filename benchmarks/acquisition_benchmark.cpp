// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Bytes of devices to frames, one thread: what a decoder takes a second, in pieces as a serial port gives them at most.
// Readings are random in 0 ... 199, which all protocols carry; half of the bytes of 16-bit readings are then zeros,
// which is the hardest for the stuffing of the protocol dermis. Beside it what copying the same bytes takes, and what a
// layout takes that says the same.
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/quantile.hpp"
#include "dermis/touch/frames/random.hpp"
#include "rows.hpp"

namespace dermis {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBytes = std::size_t{1} << 22U;

/// What says the same as the protocols of these names.
const std::map<std::string, std::string> kLayouts = {
    {"3dvitac", "line = \"{values}\"\nframe_end = \"\"\n"},
    {"csv", "line = \"{values}\"\nframe_end = \"\"\n"},
    {"m1616", "packet = [\"AA AB AC\", \"values u16be\", \"skip 4\"]\n"},
};

struct Stream {
  FrameShape shape;
  std::vector<RawFrame> frames;
  std::vector<std::uint8_t> bytes;
};

/// 32x32, or what the protocol has.
Stream make_stream(const std::string& protocol) {
  Stream stream;
  std::unique_ptr<bytes::devices::Encoder> encoder;
  for (const FrameShape& shape :
       {FrameShape{32, 32}, FrameShape{16, 16}, FrameShape{56, 28}, FrameShape{24, 32}, FrameShape{1, 64}}) {
    auto made = bytes::devices::make_encoder({.name = protocol, .shape = shape});
    if (!made) continue;
    stream.shape = shape;
    encoder = std::move(made).value();
    break;
  }
  if (!encoder) std::abort();
  Random random(1);
  while (stream.bytes.size() < kBytes) {
    RawFrame& frame = stream.frames.emplace_back();
    frame.counts.resize(stream.shape.taxel_count());
    for (float& count : frame.counts) count = static_cast<float>(random.below(200));
    encoder->encode(frame, stream.bytes);
  }
  encoder->finish(stream.bytes);
  return stream;
}

using MakeDecoder = std::function<std::unique_ptr<bytes::layouts::Decoder>(const FrameShape&)>;

MakeDecoder of_protocol(const std::string& name) {
  return
      [name](const FrameShape& shape) { return bytes::devices::make_decoder({.name = name, .shape = shape}).value(); };
}

MakeDecoder of_layout(const std::string& keys) {
  return [keys](const FrameShape& shape) {
    const std::string size = fmt::format("[layout]\nrows = {}\ncols = {}\n", shape.rows, shape.cols);
    bytes::layouts::Layout layout = bytes::layouts::layout_from_toml(size + keys, "layout").value();
    return bytes::layouts::make_decoder(std::make_shared<const bytes::layouts::Layout>(std::move(layout)), 0, false);
  };
}

/// Calls `take` with each frame.
template <typename Take>
void decode(const MakeDecoder& make_decoder, const Stream& stream, Take take) {
  const auto decoder = make_decoder(stream.shape);
  RawFrame frame;
  std::span<const std::uint8_t> bytes = stream.bytes;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes.size(), 4096);
    decoder->push(bytes.first(size));
    bytes = bytes.subspan(size);
    while (decoder->next(frame)) take(frame);
  }
  decoder->finish();
  while (decoder->next(frame)) take(frame);
}

bool decodes_all(const MakeDecoder& make_decoder, const Stream& stream) {
  std::size_t k = 0;
  bool all_equal = true;
  decode(make_decoder, stream, [&](const RawFrame& frame) {
    all_equal = all_equal && k < stream.frames.size() && frame.counts == stream.frames[k].counts;
    ++k;
  });
  return all_equal && k == stream.frames.size();
}

/// Reports the median speed of work(), which takes all bytes of the stream.
template <typename Work>
void measure(benchmark::State& state, const Stream& stream, bool checked, Work work) {
  std::vector<double> speeds;
  for (auto _ : state) {
    const auto start = Clock::now();
    work();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    state.SetIterationTime(seconds);
    speeds.push_back(1e-6 * static_cast<double>(stream.bytes.size()) / seconds);
  }
  state.counters["median"] = upper_median(std::move(speeds));
  state.counters["checked"] = checked ? 1 : 0;
}

void register_decoder(const std::string& protocol, const std::string& engine, const MakeDecoder& make_decoder) {
  const auto decoding = [protocol, make_decoder](benchmark::State& state) {
    const Stream stream = make_stream(protocol);
    float last = 0.0F;
    measure(state, stream, decodes_all(make_decoder, stream), [&] {
      decode(make_decoder, stream, [&](const RawFrame& frame) { last = frame.counts.back(); });
      benchmark::DoNotOptimize(last);
    });
  };
  benchmark::RegisterBenchmark(("decode_" + protocol + "|" + engine).c_str(), decoding)->UseManualTime();
}

void register_protocol(const std::string& protocol) {
  const auto copying = [protocol](benchmark::State& state) {
    const Stream stream = make_stream(protocol);
    std::vector<std::uint8_t> copy(stream.bytes.size());
    measure(state, stream, true, [&] {
      std::memcpy(copy.data(), stream.bytes.data(), copy.size());
      benchmark::DoNotOptimize(copy.data());
    });
  };
  register_decoder(protocol, "dermis", of_protocol(protocol));
  if (const auto same = kLayouts.find(protocol); same != kLayouts.end()) {
    register_decoder(protocol, "layout", of_layout(same->second));
  }
  benchmark::RegisterBenchmark(("decode_" + protocol + "|memcpy").c_str(), copying)->UseManualTime();
}

/// Prints a line a benchmark and keeps the rows of the JSON file.
class TableReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override {
    fmt::print("one thread\n{:<24}{:<10}{:>10}{:>9}\n", "work", "engine", "MB/s", "checked");
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) report(run);
  }

  [[nodiscard]] const nlohmann::ordered_json& rows() const { return rows_; }

 private:
  void report(const Run& run) {
    const std::string& name = run.run_name.function_name;
    const std::string work = name.substr(0, name.find('|'));
    const std::string engine = name.substr(name.find('|') + 1);
    const double median = run.counters.at("median").value;
    const bool checked = run.counters.at("checked").value == 1.0;
    fmt::print("{:<24}{:<10}{:>10.0f}{:>9}\n", work, engine, median, checked ? "yes" : "NO");
    rows_.push_back({{"work", work},
                     {"engine", engine},
                     {"threads", 1},
                     {"median", median},
                     {"unit", "MB/s"},
                     {"checked", checked}});
  }

  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace
}  // namespace dermis

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const std::string& protocol : dermis::bytes::devices::protocol_names()) {
    if (protocol != "auto") dermis::register_protocol(protocol);
  }
  dermis::TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return dermis::benchmarks::write_rows("acquisition", reporter.rows()) ? 0 : 1;
}
