// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/turned_source.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace dermis {
namespace {

class TurnedSource final : public FrameSource {
 public:
  TurnedSource(std::unique_ptr<FrameSource> source, LineOrder order, std::string name)
      : source_(std::move(source)), order_(std::move(order)), name_(std::move(name)) {}

  Result<bool> next(RawFrame& frame) override {
    Result<bool> more = source_->next(frame);
    if (!more || !*more) return more;
    if (Status turned = turn(frame); !turned) return turned.error();
    return true;
  }

  [[nodiscard]] std::optional<Readiness> readiness() const override { return source_->readiness(); }

  Result<Polled> poll(RawFrame& frame) override {
    Result<Polled> polled = source_->poll(frame);
    if (!polled || *polled != Polled::frame) return polled;
    if (Status turned = turn(frame); !turned) return turned.error();
    return polled;
  }

  [[nodiscard]] std::optional<FrameShape> shape() const override {
    const std::optional<FrameShape> sent = source_->shape();
    if (!sent) return std::nullopt;
    const Result<FrameShape> turned = order_.turned(*sent);
    return turned ? std::optional(*turned) : std::nullopt;
  }

  [[nodiscard]] SourceStatistics statistics() const override { return source_->statistics(); }
  [[nodiscard]] bool is_live() const override { return source_->is_live(); }
  [[nodiscard]] std::string place() const override { return source_->place(); }

 private:
  Status turn(RawFrame& frame) {
    if (Status known = learn_shape(); !known) return known;
    if (frame.counts.size() != shape_->taxel_count()) {
      return bad_input("'" + name_ + "': a frame has " + std::to_string(frame.counts.size()) +
                       " readings, its source says " + std::to_string(shape_->taxel_count()));
    }
    sent_.swap(frame.counts);
    frame.counts.resize(places_.size());
    for (std::size_t taxel = 0; taxel < places_.size(); ++taxel) frame.counts[taxel] = sent_[places_[taxel]];
    return Done{};
  }

  /// A source knows its shape with its first frame, and keeps it.
  Status learn_shape() {
    if (shape_) return Done{};
    const std::optional<FrameShape> sent = source_->shape();
    if (!sent) return failed("'" + name_ + "': has frames without a shape");
    if (const Result<FrameShape> turned = order_.turned(*sent); !turned) {
      return bad_input("'" + name_ + "': " + turned.error().message);
    }
    places_ = order_.sent_places(*sent);
    shape_ = sent;
    return Done{};
  }

  std::unique_ptr<FrameSource> source_;
  LineOrder order_;
  std::string name_;
  std::optional<FrameShape> shape_;  // as it is sent
  std::vector<std::size_t> places_;  // where each taxel stands in sent_
  std::vector<float> sent_;
};

}  // namespace

std::unique_ptr<FrameSource> turned_source(std::unique_ptr<FrameSource> source, const LineOrder& order,
                                           const std::string& name) {
  if (order.is_plain()) return source;
  return std::make_unique<TurnedSource>(std::move(source), order, name);
}

}  // namespace dermis
