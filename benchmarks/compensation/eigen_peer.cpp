// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Eigen: the fixed point with its matrix products; forward by the textbook, one dense LDLT of all lines a driven row.
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "compensation/peers.hpp"

namespace dermis::benchmarks {
namespace {

constexpr int kMostSteps = 200;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class EigenPeer final : public Peer {
 public:
  explicit EigenPeer(const ArrayDescription& array)
      : rows_(static_cast<Eigen::Index>(array.rows)),
        cols_(static_cast<Eigen::Index>(array.cols)),
        drive_(Eigen::Map<const Eigen::VectorXd>(array.readout.drive_ohm.data(), rows_)),
        load_(Eigen::Map<const Eigen::RowVectorXd>(array.readout.load_ohm.data(), cols_).cwiseInverse()) {}

  [[nodiscard]] std::string name() const override { return "eigen_ldlt"; }

  void start(std::span<const double> ratio, std::span<double> siemens) override {
    const Matrix positive = Eigen::Map<const Matrix>(ratio.data(), rows_, cols_).cwiseMax(0.0);
    Eigen::Map<Matrix> g(siemens.data(), rows_, cols_);
    const Eigen::RowVectorXd scale = load_.array() / (1.0 - positive.colwise().sum().array());
    g = positive * scale.asDiagonal();
    const Eigen::VectorXd gain = (1.0 - drive_.array() * g.rowwise().sum().array()).inverse();
    g = (gain.asDiagonal() * g).eval();
  }

  void invert(std::span<const double> ratio, double tolerance, std::span<double> siemens) override {
    const Eigen::Map<const Matrix> measured(ratio.data(), rows_, cols_);
    Eigen::Map<Matrix> g(siemens.data(), rows_, cols_);
    explained_ = measured;
    for (int step = 0; step < kMostSteps; ++step) {
      gain_ = 1.0 + drive_.array() * g.rowwise().sum().array();
      column_ = load_ + g.colwise().sum();
      dropped_.noalias() = drive_.asDiagonal() * explained_;
      coupling_.noalias() = g.transpose() * dropped_;
      coupling_ = column_.cwiseInverse().asDiagonal() * coupling_;
      returned_.noalias() = g * coupling_;
      undriven_ = gain_.asDiagonal() * explained_;
      undriven_ -= returned_;
      residual_ = (undriven_ - g * column_.cwiseInverse().asDiagonal()).cwiseAbs();
      const Eigen::VectorXd off_diagonal = 1.0 - gain_.array().inverse();
      const Eigen::RowVectorXd spread = off_diagonal.transpose() * residual_;
      if ((residual_.colwise().maxCoeff() + spread).maxCoeff() <= tolerance) return;
      const Eigen::RowVectorXd scale = load_.array() / (1.0 - undriven_.colwise().sum().array());
      undriven_ = gain_.asDiagonal() * measured;
      undriven_ -= returned_;
      g = undriven_.cwiseMax(0.0) * scale.asDiagonal();
      explained_ = measured.cwiseMax(gain_.cwiseInverse().asDiagonal() * returned_);
    }
  }

  void forward(std::span<const double> siemens, std::span<double> ratio) override { solve<double>(siemens, ratio); }
  void forward(std::span<const float> siemens, std::span<float> ratio) override { solve<float>(siemens, ratio); }

 private:
  template <typename Real>
  void solve(std::span<const Real> siemens, std::span<Real> ratio) const {
    using Square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    using Line = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
    using Table = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Table> g(siemens.data(), rows_, cols_);
    Eigen::Map<Table> out(ratio.data(), rows_, cols_);
    const Line driver = drive_.cwiseInverse().cast<Real>();
    for (Eigen::Index driven = 0; driven < rows_; ++driven) {
      Square nodes = Square::Zero(rows_ + cols_, rows_ + cols_);
      nodes.topRightCorner(rows_, cols_) = -g;
      nodes.bottomLeftCorner(cols_, rows_) = -g.transpose();
      nodes.diagonal().head(rows_) = driver + g.rowwise().sum();
      nodes.diagonal().tail(cols_) = (load_.cast<Real>() + g.colwise().sum()).transpose();
      Line source = Line::Zero(rows_ + cols_);
      source(driven) = driver(driven);
      out.row(driven) = nodes.ldlt().solve(source).tail(cols_).transpose();
    }
  }

  Eigen::Index rows_;
  Eigen::Index cols_;
  Eigen::VectorXd drive_;
  Eigen::RowVectorXd load_;
  Eigen::VectorXd gain_;
  Eigen::RowVectorXd column_;
  Matrix explained_;
  Matrix dropped_;
  Matrix coupling_;
  Matrix returned_;
  Matrix undriven_;
  Matrix residual_;
};

}  // namespace

std::unique_ptr<Peer> eigen_peer(const ArrayDescription& array) {
  return std::make_unique<EigenPeer>(array);
}

}  // namespace dermis::benchmarks
