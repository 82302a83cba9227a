// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/site.hpp"

#include <algorithm>
#include <utility>

#include "out/websocket/access.hpp"
#include "out/websocket/foxglove_protocol.hpp"

namespace dermis::out::websocket {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr const char* kContentSecurityPolicy =
    "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
    "frame-ancestors 'none'";
constexpr const char* kOtherHost = "the Host is not this machine's loopback";
constexpr const char* kNoPage = "there is no such page";
constexpr const char* kNoToken = "the token is missing or wrong";

void set_head(http::fields& head, std::string_view type) {
  head.set(http::field::server, "dermis");
  head.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  head.set("X-Content-Type-Options", "nosniff");
  head.set("Content-Security-Policy", kContentSecurityPolicy);
  head.set("Referrer-Policy", "no-referrer");
  head.set(http::field::cache_control, "no-cache");
}

Response make_response(const Request& request, http::status status, std::string_view type, std::string body) {
  Response response(status, request.version());
  set_head(response, type);
  response.keep_alive(request.keep_alive());
  response.content_length(body.size());
  if (request.method() != http::verb::head) response.body() = std::move(body);
  return response;
}

}  // namespace

Response make_refusal(const Request& request, http::status status, const std::string& line) {
  return make_response(request, status, "text/plain; charset=utf-8", line + "\n");
}

FileHead make_file_head(const Request& request, const std::string& name, std::uint64_t bytes) {
  FileHead head(http::status::ok, request.version());
  set_head(head, "application/octet-stream");
  head.set(http::field::content_disposition, "attachment; filename=\"" + name + "\"");
  head.keep_alive(false);
  head.content_length(bytes);
  return head;
}

void Site::set_document(std::string path, std::string content_type, std::string content) {
  auto document = std::make_shared<const Document>(Document{std::move(content_type), std::move(content)});
  const std::lock_guard lock(mutex_);
  documents_.insert_or_assign(std::move(path), std::move(document));
}

void Site::set_file(std::string path, std::string file) {
  const std::lock_guard lock(mutex_);
  files_.insert_or_assign(std::move(path), std::move(file));
}

bool Site::names_other_host(const Request& request) const {
  return is_loopback(options_.host) && !is_loopback_authority(view(request[http::field::host]));
}

bool Site::has_token(const Request& request) const {
  if (options_.token.empty()) return true;
  const std::string_view bearer = bearer_token(view(request[http::field::authorization]));
  const std::string_view query = query_value(view(request.target()), "token");
  return equal_in_constant_time(bearer.empty() ? query : bearer, options_.token);
}

Response Site::answer(const Request& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    Response refusal = make_refusal(request, http::status::method_not_allowed, "only GET and HEAD");
    refusal.set(http::field::allow, "GET, HEAD");
    return refusal;
  }
  if (names_other_host(request)) return make_refusal(request, http::status::forbidden, kOtherHost);
  const std::string_view asked = path_of(view(request.target()));
  const std::string_view path = asked == "/" ? "/index.html" : asked;
  const auto asset = std::find_if(assets_.begin(), assets_.end(), [&](const Asset& a) { return a.path == path; });
  if (asset != assets_.end()) return answer_with(request, *asset);

  const std::shared_ptr<const Document> document = find_document(path);
  if (!document && !find_file(path)) return make_refusal(request, http::status::not_found, kNoPage);
  if (!has_token(request)) return make_refusal(request, http::status::unauthorized, kNoToken);
  if (!document) return make_refusal(request, http::status::not_found, kNoPage);  // a file that is gone
  return make_response(request, http::status::ok, document->content_type, document->content);
}

Response Site::answer_with(const Request& request, const Asset& asset) const {
  Response response = make_response(request, http::status::ok, asset.content_type,
                                    {reinterpret_cast<const char*>(asset.bytes.data()), asset.bytes.size()});
  if (asset.is_gzip) response.set(http::field::content_encoding, "gzip");
  // The build names these by their content.
  if (asset.path.starts_with("/assets/")) {
    response.set(http::field::cache_control, "public, max-age=31536000, immutable");
  }
  return response;
}

std::shared_ptr<const Site::Document> Site::find_document(std::string_view path) const {
  const std::lock_guard lock(mutex_);
  const auto found = documents_.find(path);
  return found == documents_.end() ? nullptr : found->second;
}

std::optional<std::string> Site::file(const Request& request) const {
  const bool may_have = request.method() == http::verb::get && !names_other_host(request) && has_token(request);
  return may_have ? find_file(path_of(view(request.target()))) : std::nullopt;
}

std::optional<std::string> Site::find_file(std::string_view path) const {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(path);
  return found == files_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Response> Site::refuse_upgrade(const Request& request) const {
  if (names_other_host(request)) return make_refusal(request, http::status::forbidden, kOtherHost);
  if (!has_token(request)) return make_refusal(request, http::status::unauthorized, kNoToken);
  const std::string_view origin = view(request[http::field::origin]);
  const bool is_welcome = is_same_origin(origin, view(request[http::field::host])) || is_known_tool(origin);
  if (options_.token.empty() && !is_welcome) {
    return make_refusal(request, http::status::forbidden,
                        "a page of another origin; to allow it, serve with a token and give it to the page");
  }
  if (choose_subprotocol(view(request[http::field::sec_websocket_protocol])).empty()) {
    return make_refusal(request, http::status::bad_request,
                        "the subprotocol must be foxglove.sdk.v1 or foxglove.websocket.v1");
  }
  return std::nullopt;
}

}  // namespace dermis::out::websocket
