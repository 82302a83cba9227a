// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "dermis/live/sources/open_source.hpp"
#include "dermis/out/serve/session.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::out::serve {

/// The description by a client.
struct DescribedArray {
  std::string from{};   ///< URI of its source.
  std::string suit{};   ///< NAME/array.suit.toml, which has both, where its places were pressed; else empty.
  std::string model{};  ///< Its NAME/array.toml, or a model or array.toml from last time.
  bool is_new = false;  ///< It was written now.
};

/// An array of which nothing is written yet. Serves a page that shows what its source sends, and asks for the rest: the
/// source itself, rows and columns, and their directions. The answers of a client become an array.toml with circuit =
/// "auto", as soon as the source has sent a frame of that shape. Until then the page keeps asking.
class ArraySetup {
 public:
  /// Reads the first frame of the source that the URI `from` names, for at most 8 s, and begins to answer clients.
  /// Bytes that make no frame are no error: the page says what they lack. Fails where the URI is wrong, its device is
  /// not there, or the port cannot be bound.
  ///
  /// Where `from` is empty, clients choose: a serial port of this machine, an address, a recording of the current
  /// folder, or the simulator. Only clients of this machine may: a server that others can reach needs `from`. Nothing
  /// is opened that a client did not choose.
  [[nodiscard]] static Result<std::unique_ptr<ArraySetup>> create(const std::string& from,
                                                                  const SessionOptions& options,
                                                                  live::sources::SourceOptions source_options);
  ArraySetup(const ArraySetup&) = delete;
  ArraySetup& operator=(const ArraySetup&) = delete;
  ~ArraySetup();

  [[nodiscard]] std::uint16_t port() const noexcept;

  /// Waits until a client has described the array; all are empty where `stop` was set before. Call it once.
  [[nodiscard]] DescribedArray run(const std::atomic<bool>& stop);

  /// In the place of run(), where there is one thread: empty as long as no client has described the array.
  [[nodiscard]] std::optional<DescribedArray> described();
  /// The source that is being described, with its layout; empty: none. For that one thread.
  [[nodiscard]] std::string source() const;

 private:
  class Implementation;
  explicit ArraySetup(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::out::serve
