#include "core/metrology/edge/whitening.hpp"

#include <algorithm>
#include <cmath>

namespace fvd::metrology::edge {
namespace {

constexpr double kIndependent = 0.3;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

Whitening::Whitening(std::span<const double> s_um, double window_um) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < s_um.size(); ++i) {
    while (first < i && s_um[i] - s_um[first] >= window_um) ++first;
    first_.push_back(first);
    lower_.emplace_back(i - first + 1, 0.0);
    // Cholesky's factor has no elements left of the first one of the matrix.
    for (std::size_t j = first; j <= i; ++j) {
      double sum = i == j ? 1.0 + kIndependent : 1.0 - (s_um[i] - s_um[j]) / window_um;
      for (std::size_t k = std::max(first, first_[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
      at(i, j) = i == j ? std::sqrt(sum) : sum / at(j, j);
    }
  }
}

void Whitening::apply(Eigen::Ref<Eigen::MatrixXd> values) const {
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (std::size_t i = 0; i < lower_.size(); ++i) {
      double sum = values(index(i), column);
      for (std::size_t k = first_[i]; k < i; ++k) sum -= at(i, k) * values(index(k), column);
      values(index(i), column) = sum / at(i, i);
    }
  }
}

void Whitening::apply_transposed(Eigen::Ref<Eigen::MatrixXd> values) const {
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (std::size_t i = lower_.size(); i-- > 0;) {
      const double solved = values(index(i), column) / at(i, i);
      values(index(i), column) = solved;
      for (std::size_t k = first_[i]; k < i; ++k) values(index(k), column) -= at(i, k) * solved;
    }
  }
}

}  // namespace fvd::metrology::edge
