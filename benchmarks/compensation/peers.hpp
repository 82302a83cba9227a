// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>
#include <string>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::benchmarks {

/// The grounded divider by other means than dermis: the same fixed point, and a forward solution. Matrices are
/// [rows, cols], row-major.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// Formula (4) of docs/reasons/derivations-circuits.md from where `siemens` is, until the certificate is `tolerance`.
  virtual void invert(std::span<const double> ratio, double tolerance, std::span<double> siemens) = 0;
  virtual void start(std::span<const double> ratio, std::span<double> siemens) = 0;
  virtual void forward(std::span<const double> siemens, std::span<double> ratio) = 0;
  virtual void forward(std::span<const float> siemens, std::span<float> ratio) = 0;
};

[[nodiscard]] std::unique_ptr<Peer> scalar_peer(const ArrayDescription& array);
// In a library of its own, with all else hidden: Eigen, compiled for this machine, must not mix with that of dermis.
[[nodiscard, gnu::visibility("default")]] std::unique_ptr<Peer> eigen_peer(const ArrayDescription& array);

}  // namespace dermis::benchmarks
