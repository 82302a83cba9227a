// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/normal_equations.hpp"

#include <Eigen/Cholesky>

namespace dermis::learn::calibration {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NormalEquations::NormalEquations(std::size_t taxels, Index law_terms, Index columns)
    : global(MatrixXd::Zero(columns, columns)),
      local(taxels, MatrixXd::Zero(law_terms, law_terms + columns)),
      readings(taxels) {}

void NormalEquations::add_local(std::size_t taxel, const VectorXd& basis, const Eigen::Ref<const VectorXd>& row,
                                double weight) {
  MatrixXd& sums = local[taxel];
  const Index terms = basis.size();
  for (Index k = 0; k < terms; ++k) {
    const double weighted = weight * basis[k];
    for (Index j = 0; j < terms; ++j) sums(j, k) += weighted * basis[j];
  }
  for (Index k = 0; k < row.size(); ++k) {
    const double weighted = weight * row[k];
    for (Index j = 0; j < terms; ++j) sums(j, terms + k) += weighted * basis[j];
  }
  readings[taxel] += 1.0;
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  global += other.global;
  for (std::size_t k = 0; k < local.size(); ++k) {
    local[k] += other.local[k];
    readings[k] += other.readings[k];
  }
  return *this;
}

NormalEquations& NormalEquations::operator*=(double factor) {
  global *= factor;
  for (MatrixXd& sums : local) sums *= factor;
  return *this;
}

Elimination eliminate_laws(const NormalEquations& equations, const MatrixXd& prior_precision) {
  Elimination result;
  result.normal = equations.global.selfadjointView<Eigen::Lower>();
  const Index terms = prior_precision.rows();
  const Index columns = result.normal.cols();
  result.laws.resize(equations.local.size());
  result.covariance.resize(equations.local.size());
  for (std::size_t taxel = 0; taxel < equations.local.size(); ++taxel) {
    if (equations.readings[taxel] == 0.0) continue;
    const MatrixXd& local = equations.local[taxel];
    MatrixXd own = local.leftCols(terms);
    own.diagonal() += prior_precision.col(static_cast<Index>(taxel));
    const Eigen::LDLT<MatrixXd> factors(own);
    result.laws[taxel] = factors.solve(local.rightCols(columns));
    result.covariance[taxel] = factors.solve(MatrixXd::Identity(terms, terms));
    result.normal.noalias() -= local.rightCols(columns).transpose() * result.laws[taxel];
    result.readings += equations.readings[taxel];
    result.taxels += 1.0;
  }
  return result;
}

}  // namespace dermis::learn::calibration
