#include "core/metrology/operations/form_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace fvd::metrology {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// T_0 to T_order of every coordinate: [coordinate][order].
MatrixXd chebyshev(const VectorXd& coordinates, int order) {
  MatrixXd values(coordinates.size(), order + 1);
  values.col(0).setOnes();
  if (order > 0) values.col(1) = coordinates;
  for (int k = 2; k <= order; ++k) {
    values.col(k) = 2.0 * coordinates.cwiseProduct(values.col(k - 1)) - values.col(k - 2);
  }
  return values;
}

VectorXd to_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The terms T_p(x) T_q(y) with p + q <= degree.
std::vector<std::pair<int, int>> terms_of(int degree) {
  std::vector<std::pair<int, int>> terms;
  for (int sum = 0; sum <= degree; ++sum) {
    for (int q = 0; q <= sum; ++q) terms.emplace_back(sum - q, q);
  }
  return terms;
}

/// Sums over the valid points: of T_m(x) T_n(y) to twice the degree, of z T_p(x) T_q(y), and of z^2.
struct Sums {
  MatrixXd ones;
  MatrixXd heights;
  double squares = 0.0;
};

class PolynomialFit {
 public:
  PolynomialFit(const ChosenPoints& points, int degree)
      : points_(points),
        degree_(degree),
        terms_(terms_of(degree)),
        x_(chebyshev(to_vector(points.x), 2 * degree)),
        y_(chebyshev(to_vector(points.y), 2 * degree)),
        coefficients_(MatrixXd::Zero(degree + 1, degree + 1)) {}

  /// False where the points do not determine the polynomial. The second round removes the rounding of the first.
  bool fit() {
    for (int round = 0; round < 2; ++round) {
      const Sums sums = residual_sums();
      const MatrixXd matrix = normal_matrix(sums.ones);
      const Eigen::LLT<MatrixXd> solver(matrix);
      if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-11)) return false;
      VectorXd right(count());
      for (int i = 0; i < count(); ++i) right[i] = sums.heights(term(i).first, term(i).second);
      const VectorXd change = solver.solve(right);
      for (int i = 0; i < count(); ++i) coefficients_(term(i).first, term(i).second) += change[i];
      inverse_ = solver.solve(MatrixXd::Identity(count(), count()));
      squares_ = round == 0 ? sums.squares : std::max(sums.squares - change.dot(right), 0.0);
    }
    return true;
  }

  [[nodiscard]] int count() const { return static_cast<int>(terms_.size()); }
  [[nodiscard]] const MatrixXd& coefficients() const { return coefficients_; }
  [[nodiscard]] double mean_square() const { return squares_ / static_cast<double>(points_.points); }

  /// c_pq of the monomials with their standard errors.
  [[nodiscard]] std::vector<NamedValue> monomials(double kernel_width_px) const {
    const MatrixXd power = chebyshev_powers();
    MatrixXd change(count(), count());
    VectorXd values(count());
    for (int i = 0; i < count(); ++i) values[i] = coefficients_(term(i).first, term(i).second);
    for (int to = 0; to < count(); ++to) {
      for (int from = 0; from < count(); ++from) {
        change(to, from) = power(term(from).first, term(to).first) * power(term(from).second, term(to).second);
      }
    }
    values = change * values;
    const double freedom = static_cast<double>(points_.points) - count();
    const MatrixXd covariance = change * inverse_ * change.transpose() * (freedom > 0.0 ? squares_ / freedom : 0.0);
    std::vector<NamedValue> named;
    for (int i = 0; i < count(); ++i) {
      const std::string name = "c_" + std::to_string(term(i).first) + std::to_string(term(i).second) + "_um";
      named.push_back({name, values[i], std::sqrt(std::max(covariance(i, i), 0.0)) * kernel_width_px});
    }
    return named;
  }

 private:
  [[nodiscard]] const std::pair<int, int>& term(int i) const { return terms_[static_cast<std::size_t>(i)]; }

  [[nodiscard]] Sums residual_sums() const {
    const int order = 2 * degree_;
    const auto columns = static_cast<Eigen::Index>(points_.x.size());
    Sums sums{MatrixXd::Zero(order + 1, order + 1), MatrixXd::Zero(degree_ + 1, degree_ + 1), 0.0};
    VectorXd valid(columns);
    VectorXd residual(columns);
    for (int row = 0; row < points_.z_um.height(); ++row) {
      const auto z = Eigen::Map<const VectorXd>(points_.z_um.row(row), columns);
      const VectorXd along_x = coefficients_ * y_.row(row).head(degree_ + 1).transpose();
      residual.noalias() = z - x_.leftCols(degree_ + 1) * along_x;
      for (Eigen::Index i = 0; i < columns; ++i) {
        const bool is_valid = residual[i] == residual[i];
        valid[i] = is_valid ? 1.0 : 0.0;
        residual[i] = is_valid ? residual[i] : 0.0;
      }
      const VectorXd ones = x_.transpose() * valid;
      const VectorXd heights = x_.leftCols(degree_ + 1).transpose() * residual;
      sums.ones.noalias() += ones * y_.row(row);
      sums.heights.noalias() += heights * y_.row(row).head(degree_ + 1);
      sums.squares += residual.squaredNorm();
    }
    return sums;
  }

  /// T_i T_j = (T_(i + j) + T_|i - j|) / 2, for x and for y.
  [[nodiscard]] MatrixXd normal_matrix(const MatrixXd& ones) const {
    MatrixXd matrix(count(), count());
    for (int row = 0; row < count(); ++row) {
      for (int column = 0; column < count(); ++column) {
        const auto [i, k] = term(row);
        const auto [j, l] = term(column);
        matrix(row, column) = 0.25 * (ones(i + j, k + l) + ones(i + j, std::abs(k - l)) + ones(std::abs(i - j), k + l) +
                                      ones(std::abs(i - j), std::abs(k - l)));
      }
    }
    return matrix;
  }

  /// [order][power]: T_order as a sum of powers.
  [[nodiscard]] MatrixXd chebyshev_powers() const {
    MatrixXd power = MatrixXd::Zero(degree_ + 1, degree_ + 1);
    power(0, 0) = 1.0;
    power(1, 1) = 1.0;
    for (int k = 2; k <= degree_; ++k) {
      power.row(k).tail(degree_) = 2.0 * power.row(k - 1).head(degree_);
      power.row(k) -= power.row(k - 2);
    }
    return power;
  }

  const ChosenPoints& points_;
  int degree_;
  std::vector<std::pair<int, int>> terms_;
  MatrixXd x_;             ///< [column][order]
  MatrixXd y_;             ///< [row][order]
  MatrixXd coefficients_;  ///< [order in x][order in y]
  MatrixXd inverse_;
  double squares_ = 0.0;
};

VectorXd normal_coordinates(int count, double pitch_um, double centre_um, double half_um) {
  VectorXd coordinates(count);
  for (int i = 0; i < count; ++i) coordinates[i] = ((i + 0.5) * pitch_um - centre_um) / half_um;
  return coordinates;
}

}  // namespace

OperationReport remove_polynomial(HeightField& field, const ChosenPoints& points, int degree) {
  PolynomialFit fit(points, degree);
  if (points.points < static_cast<std::size_t>(fit.count()) || !fit.fit()) {
    return refusal("the points of the region do not determine a polynomial of degree " + std::to_string(degree));
  }
  const MatrixXd x =
      chebyshev(normal_coordinates(field.width(), field.pitch_x_um, points.centre_x_um, points.half_x_um), degree);
  const MatrixXd y =
      chebyshev(normal_coordinates(field.height(), field.pitch_y_um, points.centre_y_um, points.half_y_um), degree);
  for (int row = 0; row < field.height(); ++row) {
    auto z = Eigen::Map<VectorXd>(field.z_um.row(row), field.width());
    z.noalias() -= x * (fit.coefficients() * y.row(row).transpose());
  }
  OperationReport report;
  report.points_used = points.points;
  report.values = fit.monomials(field.kernel.width_px());
  report.values.push_back({"centre_x_um", points.centre_x_um, std::nullopt});
  report.values.push_back({"centre_y_um", points.centre_y_um, std::nullopt});
  report.values.push_back({"half_x_um", points.half_x_um, std::nullopt});
  report.values.push_back({"half_y_um", points.half_y_um, std::nullopt});
  report.values.push_back({"rms_um", std::sqrt(fit.mean_square()), std::nullopt});
  return report;
}

}  // namespace fvd::metrology
