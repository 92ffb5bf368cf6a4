#pragma once

/// Takes the correlation out of the errors along a section.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fvd::metrology::edge {

/// Errors of nodes at a distance d are taken to be correlated by 1 - d / window (white noise averaged over a box), and
/// each has an independent part of 0.3 of their variance. That part keeps small faults of the window's model from being
/// amplified, and makes a sharp edge's squared radius vary 1.2 times as much as a full inverse would. With C = L L^T,
/// apply() multiplies by the inverse of L: least squares of what it gives are those of C. Own definition.
class Whitening {
 public:
  /// s_um: rising. window_um: 0 = nothing is correlated.
  Whitening(std::span<const double> s_um, double window_um);
  /// values: one row a node; further rows are left as they are.
  void apply(Eigen::Ref<Eigen::MatrixXd> values) const;
  void apply_transposed(Eigen::Ref<Eigen::MatrixXd> values) const;

 private:
  [[nodiscard]] double& at(std::size_t row, std::size_t column) { return lower_[row][column - first_[row]]; }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return lower_[row][column - first_[row]]; }

  std::vector<std::size_t> first_;          ///< column of the first element of each row
  std::vector<std::vector<double>> lower_;  ///< L by rows, from first_ to the diagonal
};

}  // namespace fvd::metrology::edge
