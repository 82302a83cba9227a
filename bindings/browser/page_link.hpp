// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/websocket/outgoing_queue.hpp"

namespace dermis::browser {

/// The end of the server for the one page that has it: in the place of connections.
class PageLink {
 public:
  PageLink() = default;
  virtual ~PageLink() = default;
  PageLink(const PageLink&) = delete;
  PageLink& operator=(const PageLink&) = delete;

  /// A client begins anew; what waited for the last one is gone.
  virtual void connect() = 0;
  /// A message of the client. Errors: it does not speak the protocol.
  [[nodiscard]] virtual Status receive(std::span<const std::uint8_t> bytes, bool is_text) = 0;
  /// Asks again for the answer to what the client has asked, if one is due; the client's next messages wait for it.
  /// Errors: as receive().
  [[nodiscard]] virtual Status work() = 0;
  /// A line that the client shows to its user; `level` as that of Server::status().
  virtual void tell(int level, std::string_view line) = 0;
  /// The next message for the client; empty: none waits.
  [[nodiscard]] virtual std::optional<out::websocket::OutgoingMessage> next() = 0;
  /// "/suit.json"; null: there is none of that name.
  [[nodiscard]] virtual const std::string* document(const std::string& path) const = 0;
  /// "/recordings/walk.mcap": the place of that file; null: there is none of that name.
  [[nodiscard]] virtual const std::string* file(const std::string& path) const = 0;
};

/// That of the server that was made last; null: there is none.
[[nodiscard]] PageLink* page_link() noexcept;

/// Served in the place of what is live, from the next work on.
void serve_next(out::serve::ServedSuit suit);

}  // namespace dermis::browser
