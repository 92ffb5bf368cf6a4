#include "core/stage/design_matrix.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace fvd {

namespace {

constexpr double kMaxExplained = 0.99;
constexpr double kMinRms = 1e-6;  // of a column of the order of 1: less is rounding

void append(Eigen::MatrixXd& matrix, const Eigen::VectorXd& column) {
  matrix.conservativeResize(Eigen::NoChange, matrix.cols() + 1);
  matrix.rightCols<1>() = column;
}

}  // namespace

DesignMatrix::DesignMatrix(Eigen::Index rows)
    : columns_(Eigen::MatrixXd::Ones(rows, 1)),
      basis_(Eigen::MatrixXd::Constant(rows, 1, 1.0 / std::sqrt(static_cast<double>(rows)))) {}

Eigen::VectorXd DesignMatrix::remainder(const Eigen::VectorXd& column) const {
  Eigen::VectorXd rest = column - basis_ * (basis_.transpose() * column);
  rest -= basis_ * (basis_.transpose() * rest);  // twice is enough (Kahan, Parlett)
  return rest;
}

double DesignMatrix::explained(const Eigen::VectorXd& column) const {
  const double total = (column.array() - column.mean()).square().sum();
  const double rest = remainder(column).squaredNorm();
  if (rest <= kMinRms * kMinRms * static_cast<double>(rows())) return 1.0;
  return 1.0 - rest / total;
}

std::optional<Eigen::Index> DesignMatrix::add(const Eigen::VectorXd& column) {
  const Eigen::Index needed = columns() == 1 ? 2 : columns() + 2;
  if (rows() < needed || explained(column) > kMaxExplained) return std::nullopt;
  append(basis_, remainder(column).normalized());
  append(columns_, column);
  return columns() - 1;
}

DesignMatrix::Solution DesignMatrix::solve(const Eigen::VectorXd& values) const {
  Solution solution;
  solution.coefficients = columns_.colPivHouseholderQr().solve(values);
  solution.sum_of_squares = (values - columns_ * solution.coefficients).squaredNorm();
  const Eigen::Index freedom = rows() - columns();
  if (freedom > 0) {
    const Eigen::MatrixXd normal = columns_.transpose() * columns_;
    solution.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(columns(), columns())) *
                          (solution.sum_of_squares / static_cast<double>(freedom));
  }
  return solution;
}

}  // namespace fvd
