// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/acquisition/device_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "acquisition/arrival_meter.hpp"
#include "acquisition/chunk_stamps.hpp"
#include "dermis/acquisition/byte_stream.hpp"
#include "dermis/acquisition/clock_mapping.hpp"
#include "dermis/acquisition/protocol.hpp"
#include "dermis/acquisition/source_uri.hpp"

namespace dermis::acquisition {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr Nanos kTick = 50ms;  // so often the stop flag is looked at
constexpr Nanos kReopenPeriod = 100ms;
constexpr Nanos kConnectTimeout = 5s;
constexpr Nanos kPause = 100ms;  // then the decoder is told
constexpr Nanos kSilence = 2s;   // then the user is told
constexpr Nanos kRepeatRequest = 1s;
constexpr Nanos kUndecodable = 5s;  // then the protocol is not the one that was named
constexpr std::size_t kMaxSample = std::size_t{256} << 10U;
constexpr std::size_t kUnknownFrameBytes = 4096;
constexpr std::size_t kMostBytesPerTaxel = 6;  // "65535 "

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

Stamp now() {
  return {steady_now(), std::chrono::system_clock::now().time_since_epoch()};
}

std::string seconds_text(Nanos time) {
  std::string text = std::to_string(std::chrono::duration<double>(time).count());
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

std::string shape_text(const FrameShape& shape) {
  return std::to_string(shape.rows) + "x" + std::to_string(shape.cols);
}

class DeviceSource final : public FrameSource {
 public:
  DeviceSource(SourceUri uri, const DeviceOptions& options, std::unique_ptr<ByteStream> stream,
               std::unique_ptr<Decoder> decoder)
      : uri_(std::move(uri)),
        options_(options),
        stream_(std::move(stream)),
        decoder_(std::move(decoder)),
        buffer_(Decoder::kMaxPush),
        utc_minus_steady_([] {
          const Stamp stamp = now();
          return stamp.utc - stamp.steady;
        }()) {}

  /// Opens the stream; a listener waits for its device in next().
  Status open() {
    const Nanos begin = steady_now();
    for (;;) {
      const Result<bool> opened = stream_->open(kTick);
      if (!opened) return opened.error();
      if (*opened) {
        start();
        return Done{};
      }
      state_ = State::waiting;
      last_activity_ = begin;
      if (uri_.transport == Transport::tcp_listen || is_stopped()) return Done{};
      if (steady_now() - begin > kConnectTimeout) {
        return failed(stream_->name() + " does not answer: check the address, and that the device is on");
      }
    }
  }

  Result<bool> next(RawFrame& frame) override {
    for (;;) {
      if (decoder_->next(frame)) return deliver(frame);
      if (is_stopped()) return false;
      Status step = Done{};
      switch (state_) {
        case State::open: step = receive(); break;
        case State::waiting: step = wait_for_first(); break;
        case State::away: step = wait_for_return(); break;
        case State::over: return finished();
      }
      if (!step) return step.error();
    }
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override {
    const std::optional<FrameShape> known = decoder_->shape();
    return known ? known : options_.shape;
  }

  /// A file with times of its own is read at any pace.
  [[nodiscard]] bool is_live() const override { return !uri_.rate_hz; }

  [[nodiscard]] SourceStatistics statistics() const override {
    const DecoderCounts& counts = decoder_->counts();
    SourceStatistics statistics;
    statistics.frames = frames_;
    statistics.lost_frames = counts.lost_frames;
    statistics.damaged_frames = counts.damaged_frames;
    statistics.skipped_bytes = counts.skipped_bytes;
    statistics.reconnections = reconnections_;
    statistics.rate_hz = meter_.rate_hz();
    statistics.jitter = meter_.jitter();
    statistics.clock_drift_ppm = clock_.drift_ppm();
    return statistics;
  }

 private:
  enum class State {
    waiting,  ///< Nobody has connected yet.
    open,
    away,  ///< Unplugged or closed: it may come back.
    over,
  };

  [[nodiscard]] bool is_stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  [[nodiscard]] Result<bool> finished() const {
    const bool never_comes_back = uri_.transport == Transport::file || uri_.transport == Transport::standard_input;
    if (frames_ > 0 || !never_comes_back) return false;
    if (position_ == 0) return bad_input("'" + uri_.text + "': there is not a single byte");
    return undecodable();
  }

  void notify(const std::string& text) const {
    if (options_.notice) options_.notice(text);
  }

  void start() {
    state_ = State::open;
    last_activity_ = steady_now();
    silence_noticed_ = false;
    clock_.restart();
    forget_sample();
    request();
  }

  void request() {
    const std::string_view text = decoder_->request();
    if (text.empty()) return;
    request_.assign(text.begin(), text.end());
    (void)stream_->write(request_, kTick);  // one that is lost is repeated
    last_request_ = steady_now();
  }

  Result<bool> deliver(RawFrame& frame) {
    const std::optional<FrameShape> is = decoder_->shape();
    if (options_.shape && is && *is != *options_.shape) {
      return bad_input("'" + uri_.text + "': the device sends frames of " + shape_text(*is) + " taxels, expected are " +
                       shape_text(*options_.shape));
    }
    const Stamp arrival = stamps_.of(decoder_->frame_end());
    frame.acquisition.arrival_steady = arrival.steady;
    frame.acquisition.arrival_utc = arrival.utc;
    const std::optional<Nanos> device_time = frame.acquisition.device_time;
    const Nanos taken = device_time ? clock_.map(*device_time, arrival.steady) : arrival.steady;
    // Frames that came together, and a clock that was found to run slower, must not bring time to stand or go back.
    last_taken_ = std::max(taken, last_taken_ + 1ns);
    frame.time = uri_.rate_hz ? time_in_file() : last_taken_ + utc_minus_steady_;
    meter_.add(arrival.steady);
    if (frames_++ == 0) tell_what_was_recognised();
    forget_sample();
    if (!decoder_->request().empty()) request();
    return true;
  }

  [[nodiscard]] Nanos time_in_file() const {
    return Nanos(std::llround(1e9 * static_cast<double>(frames_) / *uri_.rate_hz));
  }

  void tell_what_was_recognised() const {
    const std::string_view protocol = decoder_->recognised();
    if (!protocol.empty()) notify("these bytes are " + std::string(protocol) + ", " + shape_text(*decoder_->shape()));
  }

  /// The device has answered, but not with a frame: it waits to be asked again.
  void request_after_damage() {
    const std::uint64_t damaged = decoder_->counts().damaged_frames;
    if (std::exchange(damaged_frames_, damaged) != damaged) request();
  }

  Status receive() {
    request_after_damage();
    const ByteStream::Transferred read = stream_->read(buffer_, kTick);
    const Stamp stamp = now();
    if (read.bytes > 0) decode(std::span(buffer_).first(read.bytes), stamp);
    if (read.bytes == 0) wait_on(stamp.steady);
    if (read.end != ByteStream::End::none) return end(read.end);
    return check_decodable(stamp.steady);
  }

  void decode(std::span<const std::uint8_t> bytes, const Stamp& stamp) {
    position_ += bytes.size();
    stamps_.add(position_, stamp);
    decoder_->push(bytes);
    last_activity_ = stamp.steady;
    pause_noticed_ = silence_noticed_ = false;
    if (sample_.empty()) sample_begin_ = stamp.steady;
    undecoded_bytes_ += bytes.size();
    const std::size_t room = kMaxSample - sample_.size();
    sample_.insert(sample_.end(), bytes.begin(),
                   bytes.begin() + static_cast<std::ptrdiff_t>(std::min(room, bytes.size())));
  }

  void wait_on(Nanos at) {
    if (!pause_noticed_ && at - last_activity_ >= kPause) {
      pause_noticed_ = true;
      decoder_->idle();
    }
    if (!decoder_->request().empty() && at - last_request_ >= kRepeatRequest) request();
    if (silence_noticed_ || at - last_activity_ < kSilence) return;
    silence_noticed_ = true;
    const bool is_serial = uri_.transport == Transport::serial;
    notify("no bytes from " + stream_->name() + " for 2 s: is the device powered and sending" +
           (is_serial ? ", and is baud=" + std::to_string(uri_.baud) + " its baud?" : "?"));
  }

  // ------------------------------------------------------------------------------------------- undecodable bytes

  void forget_sample() {
    sample_.clear();
    undecoded_bytes_ = 0;
  }

  Status check_decodable(Nanos at) const {
    const std::optional<FrameShape> known = shape();
    const std::size_t frame = known ? known->taxel_count() * kMostBytesPerTaxel : kUnknownFrameBytes;
    const std::size_t enough = std::min(4 * frame, kMaxSample);
    if (undecoded_bytes_ < enough || at - sample_begin_ < kUndecodable) return Done{};
    return undecodable();
  }

  [[nodiscard]] Error undecodable() const {
    const ProtocolOptions& protocol = uri_.protocol;
    std::string text = "'" + uri_.text + "': these bytes are not " + protocol.name;
    if (protocol.name == "auto") text = "'" + uri_.text + "': these bytes are of no known protocol";
    if (protocol.shape) text += " " + shape_text(*protocol.shape);
    const std::string looks_like = recognise_protocol(sample_);
    if (looks_like.empty()) {
      return bad_input(text + (uri_.transport == Transport::serial
                                   ? ": check protocol= and baud=" + std::to_string(uri_.baud)
                                   : ": check protocol="));
    }
    if (looks_like != protocol.name)
      return bad_input(text + "; they look like " + looks_like + ": protocol=" + looks_like);
    return bad_input(text + "; they look like " + looks_like + " of another size: check rows and cols");
  }

  // ------------------------------------------------------------------------------------------- ends and returns

  Status end(ByteStream::End how) {
    decoder_->finish();
    const bool may_return = uri_.transport == Transport::serial || uri_.transport == Transport::tcp ||
                            uri_.transport == Transport::tcp_listen;
    if (!may_return) {
      state_ = State::over;
      if (how == ByteStream::End::lost) return failed("cannot read " + stream_->name());
      return Done{};
    }
    if (uri_.transport == Transport::tcp_listen && frames_ == 0) {  // somebody, but not the device
      state_ = State::waiting;
      last_activity_ = steady_now();
      return Done{};
    }
    how_it_ended_ = how;
    state_ = State::away;
    left_at_ = steady_now();
    if (uri_.reconnect > Nanos{}) {
      notify(stream_->name() + what_happened() + ": waiting up to " + seconds_text(uri_.reconnect) +
             " for it to come back");
    }
    return Done{};
  }

  [[nodiscard]] std::string what_happened() const {
    if (uri_.transport == Transport::serial) return " is unplugged";
    return how_it_ended_ == ByteStream::End::closed ? " has closed the connection" : " is cut off";
  }

  Status wait_for_first() {
    const Result<bool> opened = stream_->open(kTick);
    if (!opened) return opened.error();
    if (*opened) {
      start();
      return Done{};
    }
    if (!silence_noticed_ && steady_now() - last_activity_ >= kSilence) {
      silence_noticed_ = true;
      notify("listening on " + stream_->name() + ": no device has connected yet");
    }
    return Done{};
  }

  Status wait_for_return() {
    if (steady_now() - left_at_ >= uri_.reconnect) return give_up();
    std::this_thread::sleep_for(kReopenPeriod / 2);
    if (is_stopped()) return Done{};
    const Result<bool> opened = stream_->open(kTick);
    if (!opened || !*opened) return Done{};
    ++reconnections_;
    notify(stream_->name() + " is back");
    start();
    return Done{};
  }

  Status give_up() {
    state_ = State::over;
    if (how_it_ended_ == ByteStream::End::closed) return Done{};
    const std::string place = stream_->name() + what_happened();
    if (uri_.reconnect == Nanos{}) return failed(place + ": reconnect_s=10 would wait for it");
    return failed(place + " and did not come back within " + seconds_text(uri_.reconnect) +
                  ": check cable and power, and begin again");
  }

  SourceUri uri_;
  DeviceOptions options_;
  std::unique_ptr<ByteStream> stream_;
  std::unique_ptr<Decoder> decoder_;
  State state_ = State::open;

  std::vector<std::uint8_t> buffer_;
  std::uint64_t position_ = 0;  // bytes received
  ChunkStamps stamps_;
  ClockMapping clock_;
  ArrivalMeter meter_;
  Nanos utc_minus_steady_;
  Nanos last_taken_{};  // host's steady clock
  std::uint64_t frames_ = 0;
  std::uint64_t reconnections_ = 0;
  std::uint64_t damaged_frames_ = 0;  // when last asked for

  Nanos last_activity_{};
  std::vector<std::uint8_t> request_;
  Nanos last_request_{};
  bool pause_noticed_ = false;  // since the last byte
  bool silence_noticed_ = false;

  std::vector<std::uint8_t> sample_;  // the first bytes since the last frame
  Nanos sample_begin_{};
  std::uint64_t undecoded_bytes_ = 0;

  ByteStream::End how_it_ended_ = ByteStream::End::none;
  Nanos left_at_{};
};

}  // namespace

Result<std::unique_ptr<FrameSource>> open_device(SourceUri uri, const DeviceOptions& options) {
  ProtocolOptions& protocol = uri.protocol;
  if (options.shape && protocol.shape && *protocol.shape != *options.shape) {
    return bad_input("'" + uri.text + "': rows and cols are " + shape_text(*protocol.shape) + ", expected are " +
                     shape_text(*options.shape));
  }
  if (!protocol.shape) protocol.shape = options.shape;
  Result<std::unique_ptr<Decoder>> decoder = make_decoder(protocol);
  if (!decoder) return bad_input("'" + uri.text + "': " + decoder.error().message);
  Result<std::unique_ptr<ByteStream>> stream = make_source_stream(uri);
  if (!stream) return stream.error();
  auto source = std::make_unique<DeviceSource>(std::move(uri), options, std::move(*stream), std::move(*decoder));
  if (const Status opened = source->open(); !opened) return opened.error();
  return std::unique_ptr<FrameSource>(std::move(source));
}

Result<std::unique_ptr<FrameSource>> open_device(const std::string& uri, const DeviceOptions& options) {
  Result<SourceUri> parsed = parse_source_uri(uri);
  if (!parsed) return parsed.error();
  return open_device(*std::move(parsed), options);
}

}  // namespace dermis::acquisition
