// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "bindings.hpp"
#include "dermis/bytes/devices/frame_queue.hpp"
#include "dermis/bytes/files/suit_toml.hpp"
#include "dermis/live/sources/open_source.hpp"
#include "frames.hpp"
#include "own_process.hpp"

namespace dermis::python {
namespace {

using bytes::devices::FrameQueue;

constexpr std::size_t kQueuedFrames = 4096;
constexpr Nanos kLook = std::chrono::milliseconds(50);  // so often Ctrl-C is looked for

/// Frames of a source for Python. A device is read by a thread of its own, so that a program that is busy for a moment
/// loses nothing. Threads of Python may use it at once, and close it meanwhile.
class Source {
 public:
  Source(const std::string& from, std::optional<ArrayDescription> array) : uri_(from), array_(std::move(array)) {
    live::sources::SourceOptions options;
    options.stop = &stop_;
    if (array_) options.array = &*array_;
    options.notice = options.loss = [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      notices_.push_back(line);
    };
    Result<std::unique_ptr<FrameSource>> opened = [&] {
      const py::gil_scoped_release release;
      return live::sources::open_source(from, options);
    }();
    source_ = value_or_raise(std::move(opened));
    shape_ = source_->shape();
    is_live_ = source_->is_live();
    if (!is_live_) return;
    queue_.emplace(kQueuedFrames, bytes::devices::Overflow::drop_oldest);
    reader_ = std::thread([this] { read_all(); });
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() { close(); }

  ShapedRaw next() {
    ShapedRaw raw;
    if (!take(raw)) throw py::stop_iteration();
    return raw;
  }

  /// The newest frame of a device, or the next of anything else; none at the end.
  std::optional<ShapedRaw> latest(std::optional<double> timeout_s) {
    ShapedRaw raw;
    if (!take(raw, timeout_s)) return std::nullopt;
    while (is_live_ && queue_->pop(raw.frame, Nanos(0)) == FrameQueue::Pop::frame) continue;
    return raw;
  }

  /// The next frame, or none where none comes within kLook. For asyncio, on a thread of its own.
  std::optional<ShapedRaw> poll() {
    ShapedRaw raw;
    check_open();
    const std::optional<bool> more = is_live_ ? try_pop(raw.frame) : read(raw.frame);
    if (!more) return std::nullopt;
    if (!*more) {
      PyErr_SetNone(PyExc_StopAsyncIteration);
      throw py::error_already_set();
    }
    raw.shape = shape_of(raw.frame);
    return raw;
  }

  void close() {
    if (!process_.is_this()) return;
    const py::gil_scoped_release release;
    stop_ = true;
    if (queue_) queue_->leave();
    const std::lock_guard lock(source_mutex_);
    if (reader_.joinable()) reader_.join();
    source_.reset();
  }

  [[nodiscard]] const std::string& uri() const { return uri_; }
  [[nodiscard]] std::optional<FrameShape> shape() const { return shape_; }
  [[nodiscard]] bool is_live() const { return is_live_; }
  [[nodiscard]] std::uint64_t dropped() const {
    process_.require("the source");
    return queue_ ? queue_->statistics().dropped : 0;
  }
  [[nodiscard]] std::vector<std::string> notices() {
    process_.require("the source");
    const std::lock_guard lock(mutex_);
    return std::exchange(notices_, {});
  }

 private:
  void read_all() {
    RawFrame frame;
    for (;;) {
      const Result<bool> more = source_->next(frame);
      if (!more) {
        const std::lock_guard lock(mutex_);
        error_ = more.error();
      } else if (*more) {
        if (const std::optional<FrameShape> shape = source_->shape()) {
          const std::lock_guard lock(mutex_);
          shape_seen_ = shape;
        }
      }
      if (!more || !*more || !queue_->push(frame)) break;
    }
    queue_->close();
  }

  void check_open() const {
    process_.require("the source");
    if (stop_) throw py::value_error("the source is closed");
  }

  [[nodiscard]] FrameShape shape_of(const RawFrame& frame) const {
    return shape_.value_or(FrameShape{1, frame.counts.size()});
  }

  /// False: there are no more.
  bool take(ShapedRaw& raw, std::optional<double> timeout_s = {}) {
    check_open();
    const bool more = is_live_ ? pop(raw.frame, timeout_s) : read(raw.frame);
    raw.shape = shape_of(raw.frame);
    return more;
  }

  /// Waits for a frame, without a timeout as long as that takes.
  bool pop(RawFrame& frame, std::optional<double> timeout_s) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(timeout_s.value_or(0.0));
    for (;;) {
      if (const std::optional<bool> more = try_pop(frame)) return *more;
      if (!timeout_s || Clock::now() < end) continue;
      PyErr_SetString(PyExc_TimeoutError, ("'" + uri_ + "': no frame came in time").c_str());
      throw py::error_already_set();
    }
  }

  /// Empty where no frame comes within kLook; false: there are no more.
  std::optional<bool> try_pop(RawFrame& frame) {
    const FrameQueue::Pop popped = [&] {
      const py::gil_scoped_release release;
      return queue_->pop(frame, kLook);
    }();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const std::lock_guard lock(mutex_);
    if (!shape_) shape_ = shape_seen_;
    if (popped == FrameQueue::Pop::frame) return true;
    if (popped == FrameQueue::Pop::timeout) return std::nullopt;
    if (error_) raise(*error_);
    return false;
  }

  bool read(RawFrame& frame) {
    std::optional<FrameShape> shape;
    Result<bool> more = [&]() -> Result<bool> {
      const py::gil_scoped_release release;
      const std::lock_guard lock(source_mutex_);
      if (!source_) return false;
      Result<bool> is_read = source_->next(frame);
      shape = source_->shape();
      return is_read;
    }();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!shape_) shape_ = shape;
    return value_or_raise(std::move(more));
  }

  const OwnProcess process_;
  std::string uri_;
  std::optional<ArrayDescription> array_;
  std::atomic<bool> stop_ = false;  // it is closed
  std::mutex source_mutex_;         // of source_ where nobody else reads it, and of its end
  std::unique_ptr<FrameSource> source_;
  bool is_live_ = false;
  std::optional<FrameShape> shape_;
  std::optional<FrameQueue> queue_;
  std::thread reader_;
  std::mutex mutex_;  // of what the reader says
  std::optional<FrameShape> shape_seen_;
  std::optional<Error> error_;
  std::vector<std::string> notices_;
};

}  // namespace

void bind_sources(py::module_& module) {
  py::class_<Source, HeldByItsProcess<Source>>(module, "Source")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Source::next)
      .def("latest", &Source::latest, py::arg("timeout_s") = py::none())
      .def("_poll", &Source::poll)
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Source& source, const py::args&) { source.close(); })
      .def("close", &Source::close)
      .def_property_readonly("shape",
                             [](const Source& source) -> std::optional<std::pair<std::size_t, std::size_t>> {
                               const std::optional<FrameShape> shape = source.shape();
                               if (!shape) return std::nullopt;
                               return std::pair(shape->rows, shape->cols);
                             })
      .def_property_readonly("uri", &Source::uri)
      .def_property_readonly("is_live", &Source::is_live)
      .def_property_readonly("dropped", &Source::dropped)
      .def("notices", &Source::notices);
  module.def(
      "open",
      [](const py::object& uri, const py::object& array) {
        std::optional<ArrayDescription> description;
        if (!array.is_none()) description = array_of(array);
        return HeldByItsProcess<Source>(new Source(path_of(uri), std::move(description)));
      },
      py::arg("uri"), py::arg("array") = py::none());
  module.def(
      "read_suit",
      [](const py::object& path) {
        py::list arrays;
        for (const SuitArray& array : value_or_raise(bytes::files::read_suit(path_of(path))).arrays) {
          arrays.append(py::make_tuple(array.name, array.from, array.model));
        }
        return arrays;
      },
      py::arg("path"));
}

}  // namespace dermis::python
