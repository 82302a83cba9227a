// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <boost/beast/http.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/out/websocket/server.hpp"

namespace dermis::out::websocket {

using Request = boost::beast::http::request<boost::beast::http::empty_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;
/// The head before a file.
using FileHead = boost::beast::http::response<boost::beast::http::empty_body>;

[[nodiscard]] inline std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

/// One line of text that says why not.
[[nodiscard]] Response make_refusal(const Request& request, boost::beast::http::status status, const std::string& line);

/// `name`: the name under which a browser saves it.
[[nodiscard]] FileHead make_file_head(const Request& request, const std::string& name, std::uint64_t bytes);

/// The files over HTTP, and who may have them. Thread-safe.
class Site {
 public:
  /// `options` must outlive it.
  Site(const ServerOptions& options, std::vector<Asset> assets) : options_(options), assets_(std::move(assets)) {}

  void set_document(std::string path, std::string content_type, std::string content);
  void set_file(std::string path, std::string file);
  [[nodiscard]] Response answer(const Request& request) const;
  /// The requested file, where the client may have it. Nothing: answer() replies.
  [[nodiscard]] std::optional<std::string> file(const Request& request) const;
  /// Nothing: the client may have the stream.
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
  [[nodiscard]] std::optional<std::string> find_file(std::string_view path) const;

  const ServerOptions& options_;
  const std::vector<Asset> assets_;
  mutable std::mutex mutex_;  // Guards the members below.
  std::map<std::string, std::shared_ptr<const Document>, std::less<>> documents_;
  std::map<std::string, std::string, std::less<>> files_;
};

}  // namespace dermis::out::websocket
