// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/patience.hpp"

namespace dermis::live::sources {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // at the other flag

}  // namespace

Patience::Patience(const std::atomic<bool>* stop, std::chrono::milliseconds patience)
    : thread_([this, stop, patience](const std::stop_token& token) {
        const auto end = std::chrono::steady_clock::now() + patience;
        const auto is_over = [&] { return std::chrono::steady_clock::now() >= end || (stop != nullptr && *stop); };
        while (!token.stop_requested() && !is_over()) std::this_thread::sleep_for(kLook);
        over_ = true;
      }) {}

}  // namespace dermis::live::sources
