// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/device_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "bytes/devices/described_rate.hpp"
#include "bytes/devices/device_connection.hpp"
#include "bytes/devices/frame_clock.hpp"
#include "bytes/devices/shared_stream.hpp"
#include "bytes/devices/undecoded_bytes.hpp"
#include "dermis/bytes/devices/byte_stream.hpp"
#include "dermis/bytes/devices/protocol.hpp"
#include "dermis/bytes/devices/source_uri.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/turned_source.hpp"

namespace dermis::bytes::devices {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only
using State = DeviceConnection::State;

constexpr Nanos kConnectTimeout = 5s;
constexpr Nanos kTick = 50ms;    // without bytes, a connection is looked after so often
constexpr Nanos kPause = 100ms;  // then the decoder gets a pause
constexpr Nanos kSilence = 2s;   // then the user gets a notice
constexpr Nanos kRepeatRequest = 1s;

/// Between two requests at least, where a layout says a rate.
Nanos period_of(const std::optional<double>& rate_hz) {
  return rate_hz ? Nanos(std::llround(1e9 / *rate_hz)) : Nanos{};
}

/// Times of frames as a layout describes them.
struct DescribedTimes {
  bool are_in_file = false;  ///< The file holds the times of its frames.
  std::optional<double> rate_hz{};
};

class DeviceSource final : public FrameSource {
 public:
  DeviceSource(SourceUri uri, const DeviceOptions& options, std::unique_ptr<ByteStream> stream,
               std::unique_ptr<Decoder> decoder, const DescribedTimes& times)
      : uri_(std::move(uri)),
        has_times_(times.are_in_file),
        rate_(times.rate_hz),
        options_(options),
        connection_(uri_, std::move(stream), [this](const std::string& text) { notify(text); }),
        decoder_(std::move(decoder)),
        buffer_(Decoder::kMaxPush),
        requests_{.period = period_of(times.rate_hz)} {}

  /// Opens the stream; a listener waits for its device in next().
  Status open() {
    const Nanos begin = now().steady;
    for (;;) {
      if (Status tried = try_open(kTick); !tried) return tried;
      if (connection_.state() == State::open || uri_.transport == Transport::tcp_listen || is_stopped()) return Done{};
      if (now().steady - begin > kConnectTimeout) {
        return failed(connection_.name() + " does not answer: check the address, and that the device is on");
      }
    }
  }

  Result<bool> next(RawFrame& frame) override {
    for (;;) {
      if (decoder_->next(frame)) return deliver(frame);
      if (is_stopped()) return false;
      if (connection_.state() == State::over) return finished();
      const Status step = connection_.state() == State::open ? receive(until_due(kTick)) : try_open(kTick);
      if (!step) return step.error();
    }
  }

  [[nodiscard]] std::optional<Readiness> readiness() const override {
    const int descriptor = connection_.descriptor();
    if (descriptor < 0) return std::nullopt;
    return Readiness{descriptor, last_read_.at + until_due(kTick)};
  }

  Result<Polled> poll(RawFrame& frame) override {
    for (;;) {
      if (decoder_->next(frame)) return polled(deliver(frame));
      if (is_stopped()) return Polled::end;
      if (connection_.state() == State::over) return polled(finished());
      if (std::exchange(last_read_.has_all, false)) return Polled::nothing;
      const bool was_open = connection_.state() == State::open;
      if (Status step = was_open ? receive(Nanos{}) : try_open(Nanos{}); !step) return step.error();
      if (!was_open) return Polled::nothing;
    }
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override {
    const std::optional<FrameShape> known = decoder_->shape();
    return known ? known : options_.shape;
  }

  /// A file with times of its own is read at any pace.
  [[nodiscard]] bool is_live() const override { return !uri_.rate_hz && !has_times_; }

  [[nodiscard]] SourceStatistics statistics() const override {
    const DecoderCounts& counts = decoder_->counts();
    SourceStatistics statistics;
    statistics.frames = frames_;
    statistics.lost_frames = counts.lost_frames;
    statistics.damaged_frames = counts.damaged_frames;
    statistics.late_frames = counts.late_frames;
    statistics.repeated_frames = counts.repeated_frames;
    statistics.skipped_bytes = counts.skipped_bytes;
    statistics.reconnections = connection_.reconnections();
    clock_.describe(statistics);
    return statistics;
  }

 private:
  [[nodiscard]] bool is_stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  [[nodiscard]] static Result<Polled> polled(const Result<bool>& more) {
    if (!more) return more.error();
    return *more ? Polled::frame : Polled::end;
  }

  [[nodiscard]] Result<bool> finished() const {
    const bool never_comes_back = uri_.transport == Transport::file || uri_.transport == Transport::standard_input;
    const std::string advice = decoder_->advice();
    if (!rate_.was_due()) tell_rate();
    if (frames_ > 0 && !advice.empty()) return bad_input("'" + uri_.text + "': " + advice);
    if (frames_ > 0 || !never_comes_back) return false;
    if (clock_.received_bytes() == 0) return bad_input("'" + uri_.text + "': there is not a single byte");
    return undecoded_.error(uri_);
  }

  void notify(const std::string& text) const {
    if (options_.notice) options_.notice(text);
  }

  Status try_open(Nanos wait) {
    if (Status tried = connection_.try_open(wait); !tried) return tried;
    if (connection_.state() == State::open) start();
    return Done{};
  }

  void start() {
    last_activity_ = now().steady;
    noticed_.is_silence = false;
    clock_.restart();
    undecoded_.clear();
    request();
  }

  /// At most so long that a request is not late.
  [[nodiscard]] Nanos until_due(Nanos longest) const {
    return requests_.is_due ? std::clamp(requests_.next - now().steady, Nanos{}, longest) : longest;
  }

  /// The device is asked as soon as the rate allows it.
  void request() {
    const std::string_view text = decoder_->request();
    const Nanos time = now().steady;
    requests_.is_due = !text.empty() && time < requests_.next;
    if (text.empty() || requests_.is_due) return;
    requests_.next = (time < requests_.next + requests_.period ? requests_.next : time) + requests_.period;
    connection_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    requests_.last = time;
  }

  Result<bool> deliver(RawFrame& frame) {
    const std::optional<FrameShape> is = decoder_->shape();
    if (options_.shape && is && *is != *options_.shape) {
      return bad_input("'" + uri_.text + "': the device sends frames of " + shape_text(*is) + " taxels, expected are " +
                       shape_text(*options_.shape));
    }
    clock_.stamp(decoder_->frame_end(), frame);
    if (uri_.rate_hz) frame.time = time_in_file();
    if (has_times_ && frame.acquisition.device_time) frame.time = *frame.acquisition.device_time;
    if (frames_++ == 0) tell_detected_protocol();
    rate_.add(frame.time);
    if (rate_.is_due()) tell_rate();
    undecoded_.clear();
    if (!decoder_->request().empty()) request();
    return true;
  }

  [[nodiscard]] Nanos time_in_file() const {
    return Nanos(std::llround(1e9 * static_cast<double>(frames_) / *uri_.rate_hz));
  }

  void tell_detected_protocol() const {
    const std::string_view protocol = decoder_->detected_protocol();
    if (!protocol.empty()) notify("these bytes are " + std::string(protocol) + ", " + shape_text(*decoder_->shape()));
  }

  void tell_rate() const {
    const std::string difference = rate_.difference();
    if (!difference.empty()) notify("'" + uri_.text + "': " + difference);
  }

  /// The device has answered, but not with a frame: it waits to be asked again.
  void request_after_damage() {
    const std::uint64_t damaged = decoder_->counts().damaged_frames;
    if (std::exchange(damaged_frames_, damaged) != damaged || requests_.is_due) request();
  }

  Status receive(Nanos timeout) {
    request_after_damage();
    const Result<std::size_t> read = connection_.read(buffer_, timeout, frames_ > 0);
    const Stamp stamp = now();
    last_read_ = {stamp.steady, !read || *read == 0 || (uri_.transport != Transport::udp && *read < buffer_.size())};
    if (read && *read > 0) decode(std::span(buffer_).first(*read), stamp);
    if (!read || connection_.state() != State::open) {
      decoder_->finish();
      return read ? Status(Done{}) : Status(read.error());
    }
    if (*read == 0) wait_on(stamp.steady);
    const bool has_pace = uri_.transport != Transport::file;
    if (has_pace && undecoded_.are_too_many(shape(), stamp.steady)) return undecoded_.error(uri_);
    return Done{};
  }

  void decode(std::span<const std::uint8_t> bytes, const Stamp& stamp) {
    if (options_.received) options_.received(bytes);
    clock_.add(bytes.size(), stamp);
    decoder_->push(bytes);
    undecoded_.add(bytes, stamp.steady);
    last_activity_ = stamp.steady;
    noticed_ = {};
  }

  void wait_on(Nanos at) {
    if (!noticed_.is_pause && at - last_activity_ >= kPause) {
      noticed_.is_pause = true;
      decoder_->idle();
    }
    if (!decoder_->request().empty() && at - requests_.last >= std::max(kRepeatRequest, requests_.period)) request();
    if (noticed_.is_silence || at - last_activity_ < kSilence) return;
    noticed_.is_silence = true;
    const bool is_serial = uri_.transport == Transport::serial;
    notify("no bytes from " + connection_.name() + " for 2 s: is the device powered and sending" +
           (is_serial ? ", and is baud=" + std::to_string(uri_.baud) + " its baud?" : "?"));
  }

  SourceUri uri_;
  bool has_times_;  ///< The file holds the times of its frames.
  DescribedRate rate_;
  DeviceOptions options_;
  DeviceConnection connection_;
  std::unique_ptr<Decoder> decoder_;
  std::vector<std::uint8_t> buffer_;
  FrameClock clock_;
  UndecodedBytes undecoded_;
  std::uint64_t frames_ = 0;
  std::uint64_t damaged_frames_ = 0;  // when last asked for
  Nanos last_activity_{};
  struct {
    Nanos period{};  // between two, at least
    Nanos last{};
    Nanos next{};         // not before
    bool is_due = false;  // It waits until the rate allows it.
  } requests_;
  struct {
    bool is_pause = false;  // since the last byte
    bool is_silence = false;
  } noticed_;
  struct {
    Nanos at{};
    bool has_all = false;  // that had come; of datagrams nobody knows
  } last_read_;
};

/// A file without times has the rate of its layout.
Result<DescribedTimes> read_times(SourceUri& uri) {
  if (!uri.protocol.has_layout()) return DescribedTimes{};
  const Result<layouts::Layout> layout = read_layout(uri.protocol);
  if (!layout) return layout.error();
  if (uri.transport != Transport::file) return DescribedTimes{false, layout->rate_hz};
  if (layout->has_times() && uri.rate_hz) return bad_input("rate: the layout has times; leave rate out");
  if (!layout->has_times() && !uri.rate_hz) uri.rate_hz = layout->rate_hz;
  return DescribedTimes{layout->has_times(), layout->has_times() ? layout->rate_hz : std::nullopt};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> open_device(SourceUri uri, const DeviceOptions& options) {
  ProtocolOptions& protocol = uri.protocol;
  DeviceOptions sent = options;
  if (options.shape) sent.shape = uri.order.sent(*options.shape);
  if (sent.shape && protocol.shape && *protocol.shape != *sent.shape) {
    return bad_input("'" + uri.text + "': rows and cols are " + shape_text(*protocol.shape) + ", expected are " +
                     shape_text(*sent.shape));
  }
  if (!protocol.shape) protocol.shape = sent.shape;
  const Result<DescribedTimes> times = read_times(uri);
  if (!times) return bad_input("'" + uri.text + "': " + times.error().message);
  Result<std::unique_ptr<Decoder>> decoder = make_decoder(protocol);
  if (!decoder) return bad_input("'" + uri.text + "': " + decoder.error().message);
  const bool is_shared = !protocol.array.empty() && uri.transport != Transport::file;
  Result<std::unique_ptr<ByteStream>> stream = is_shared ? make_shared_source_stream(uri) : make_source_stream(uri);
  if (!stream) return stream.error();
  const LineOrder order = uri.order;
  const std::string name = uri.text;
  auto source = std::make_unique<DeviceSource>(std::move(uri), sent, std::move(*stream), std::move(*decoder), *times);
  if (const Status opened = source->open(); !opened) return opened.error();
  return turned_source(std::move(source), order, name);
}

Result<std::unique_ptr<FrameSource>> open_device(const std::string& uri, const DeviceOptions& options) {
  Result<SourceUri> parsed = parse_source_uri(uri);
  if (!parsed) return parsed.error();
  return open_device(*std::move(parsed), options);
}

}  // namespace dermis::bytes::devices
