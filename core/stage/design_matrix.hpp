#pragma once

/// A least-squares problem that accepts a column only if the data can tell it from the columns before it.

#include <optional>

#include <Eigen/Core>

namespace fvd {

/// Columns are of the order of 1: the caller scales them. context: one thread at a time.
class DesignMatrix {
 public:
  /// Starts with the constant column. rows >= 1.
  explicit DesignMatrix(Eigen::Index rows);

  /// The part of the column's variance that the columns so far explain, 0..1; 1 for a constant column.
  [[nodiscard]] double explained(const Eigen::VectorXd& column) const;

  /// The column's index if it is accepted; nothing if the columns before explain more than 0.99 of it, or if it would
  /// leave no degree of freedom (except the second column: two points make a line).
  std::optional<Eigen::Index> add(const Eigen::VectorXd& column);

  [[nodiscard]] Eigen::Index columns() const { return columns_.cols(); }
  [[nodiscard]] Eigen::Index rows() const { return columns_.rows(); }

  struct Solution {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd covariance;   ///< of the coefficients; empty without a degree of freedom
    double sum_of_squares = 0.0;  ///< of the residuals
  };
  [[nodiscard]] Solution solve(const Eigen::VectorXd& values) const;

 private:
  [[nodiscard]] Eigen::VectorXd remainder(const Eigen::VectorXd& column) const;

  Eigen::MatrixXd columns_;
  Eigen::MatrixXd basis_;  // the same space, orthonormal
};

}  // namespace fvd
