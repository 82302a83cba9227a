// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dermis::touch::compensation {

/// Anderson's mixing (J. ACM 12:547, 1965): speeds up, and often makes convergent, a fixed-point iteration x <- x +
/// f(x). It takes the step that would bring f to zero, were it linear in the span of the last steps.
class AndersonMixing {
 public:
  AndersonMixing(std::size_t unknowns, std::size_t depth);

  void forget() noexcept { steps_ = 0; }

  /// The next x, from f(x) = residual; `x` is replaced. Allocates nothing.
  void advance(std::span<double> x, std::span<const double> residual) noexcept;

 private:
  void remember(std::span<const double> x, std::span<const double> residual) noexcept;
  void orthogonalise() noexcept;

  std::size_t unknowns_;
  std::size_t depth_;
  std::size_t steps_ = 0;  // since forget()
  std::vector<double> last_x_;
  std::vector<double> last_residual_;
  std::vector<double> x_change_;         // the last `depth` steps [depth, unknowns], a ring
  std::vector<double> residual_change_;  // what they changed of the residual
  std::vector<double> x_basis_;          // the same, newest first, the changes of the residual orthogonal
  std::vector<double> residual_basis_;
  std::vector<double> square_;  // of the rows of residual_basis_; 0: left out
};

}  // namespace dermis::touch::compensation
