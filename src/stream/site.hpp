// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <boost/beast/http.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/stream/server.hpp"

namespace dermis::stream {

using Request = boost::beast::http::request<boost::beast::http::empty_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;

[[nodiscard]] inline std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

/// One line of text that says why not.
[[nodiscard]] Response make_refusal(const Request& request, boost::beast::http::status status, const std::string& line);

/// What is given over HTTP, and to whom. Thread-safe.
class Site {
 public:
  /// `options` must outlive it.
  Site(const ServerOptions& options, std::vector<Asset> assets) : options_(options), assets_(std::move(assets)) {}

  void set_document(std::string path, std::string content_type, std::string content);
  [[nodiscard]] Response answer(const Request& request) const;
  /// Nothing: who asks may have the stream.
  [[nodiscard]] std::optional<Response> refuse_upgrade(const Request& request) const;

 private:
  struct Document {
    std::string content_type;
    std::string content;
  };

  [[nodiscard]] bool names_other_host(const Request& request) const;
  [[nodiscard]] bool has_token(const Request& request) const;
  [[nodiscard]] Response answer_with(const Request& request, const Asset& asset) const;
  [[nodiscard]] std::shared_ptr<const Document> find_document(std::string_view path) const;

  const ServerOptions& options_;
  const std::vector<Asset> assets_;
  mutable std::mutex mutex_;  // Of documents_.
  std::map<std::string, std::shared_ptr<const Document>, std::less<>> documents_;
};

}  // namespace dermis::stream
