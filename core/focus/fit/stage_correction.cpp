#include "core/focus/fit/stage_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

namespace fvd {

namespace {

constexpr int kMaxSamples = 512;  // the offsets' covariance is a full matrix
constexpr std::size_t kMinTuples = 1000;
constexpr int kFractionsPerStep = 4;        // bins of a step; peaks must lie in nearly all of them
constexpr int kMinTuplesPerFraction = 10;   // for such a bin to count as covered
constexpr double kMinCoverage = 0.9;        // share of the bins between the lowest and the highest peak
constexpr int kMinSteps = 6;                // between the lowest and the highest peak
constexpr double kPriorError_steps = 0.2;   // expected size of a stage's errors
constexpr double kMinStandardErrors = 3.0;  // that the offsets must exceed
constexpr int kIterations = 3;
constexpr double kMaxResidualShare = 0.6;  // of the curves' departure from a parabola that the offsets may leave
constexpr std::size_t kSubsetDivisor = 6;  // a sixth of the curves is fitted first, to see whether offsets explain any
constexpr double kMaxSubsetResidualShare = 0.85;  // above it, all curves would not come below kMaxResidualShare either
constexpr double kMinInformation = 50.0;          // over that of the prior, for a sample to count as measured
constexpr double kMinOffset_steps = 0.015;        // smaller offsets come from the shape of the curves

StageCorrection off(const std::string& reason) {
  StageCorrection correction;
  correction.reason = reason;
  return correction;
}

/// The share of fractions of a step between the peaks' 2nd and 98th percentile that enough peaks lie in, and how many
/// steps that is.
struct Coverage {
  double share = 0.0;
  double steps = 0.0;
};

Coverage coverage(std::span<const CurveTuple> tuples, const std::vector<double>& z_um) {
  std::vector<double> places;  // in samples, with fraction
  places.reserve(tuples.size());
  for (const CurveTuple& tuple : tuples) {
    const auto i = static_cast<std::size_t>(tuple.index);
    const double off_um = static_cast<double>(tuple.height_um) - z_um[i];
    const double towards = (z_um[i + 1] - z_um[i]) * off_um > 0.0 ? z_um[i + 1] - z_um[i] : z_um[i] - z_um[i - 1];
    places.push_back(static_cast<double>(i) + off_um / towards);
  }
  const auto ordered = [&](std::size_t rank) {
    const auto place = places.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(places.begin(), place, places.end());
    return *place;
  };
  const double low = ordered(places.size() / 50);
  const double high = ordered(places.size() - 1 - places.size() / 50);
  Coverage result;
  result.steps = high - low;
  if (!(result.steps > 0.0)) return result;
  const int bins = std::max(1, static_cast<int>(result.steps * kFractionsPerStep));
  std::vector<int> counts(static_cast<std::size_t>(bins));
  for (const double place : places) {
    const int bin = static_cast<int>((place - low) / result.steps * bins);
    if (bin >= 0 && bin < bins) ++counts[static_cast<std::size_t>(bin)];
  }
  const auto seen =
      std::count_if(counts.begin(), counts.end(), [](int count) { return count >= kMinTuplesPerFraction; });
  result.share = static_cast<double>(seen) / bins;
  return result;
}

constexpr std::size_t kSamples = std::tuple_size_v<decltype(CurveTuple::share)>;
using Samples = std::array<double, kSamples>;

double dot(const Samples& a, const Samples& b) noexcept {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The parabola of least squares through one curve's samples of G, each with its weight, by orthonormal columns:
/// weighted powers of u = w, w u, w u^2 = Q R (Gram and Schmidt; u is within some samples of 0, so it loses nothing).
struct Parabola {
  std::array<Samples, 3> q{};
  Samples residual{};      // weighted
  double slope0 = 0.0;     // of the parabola at u = 0
  double curvature = 0.0;  // its second derivative

  /// weighted: w G. False where the samples determine none.
  bool fit(const Samples& u, const Samples& weights, const Samples& weighted) noexcept {
    std::array<double, 3> along{};  // of `weighted`, on the columns
    std::array<double, 3> r{};      // the diagonal of R
    double r12 = 0.0;
    Samples column = weights;
    residual = weighted;
    for (std::size_t n = 0; n < q.size(); ++n) {
      q[n] = column;
      for (std::size_t m = 0; m < n; ++m) {
        const double part = dot(q[m], q[n]);
        for (std::size_t j = 0; j < kSamples; ++j) q[n][j] -= part * q[m][j];
        if (m == 1) r12 = part;
      }
      r[n] = std::sqrt(dot(q[n], q[n]));
      if (!(r[n] > kLeastIndependent)) return false;
      const double to_unit = 1.0 / r[n];
      for (double& value : q[n]) value *= to_unit;
      along[n] = dot(q[n], residual);
      for (std::size_t j = 0; j < kSamples; ++j) {
        residual[j] -= along[n] * q[n][j];
        column[j] *= u[j];
      }
    }
    curvature = 2.0 * along[2] / r[2];
    slope0 = (along[1] - 0.5 * r12 * curvature) / r[1];
    return true;
  }

 private:
  static constexpr double kLeastIndependent = 1e-6;
};

/// The least-squares system for the offsets, in steps, as far as curves have been added. A curve ties samples that are
/// up to four apart: the normal matrix, which is symmetric, has five diagonals.
struct Equations {
  Eigen::Matrix<double, kSamples, Eigen::Dynamic> diagonals;  // (d, k): row k + d, column k
  Eigen::VectorXd right;
  double left_over = 0.0;  // by the curves' parabolas, in squares of their noise

  explicit Equations(std::size_t samples)
      : diagonals(decltype(diagonals)::Zero(kSamples, static_cast<Eigen::Index>(samples))),
        right(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(samples))) {}

  Equations& operator+=(const Equations& other) {
    diagonals += other.diagonals;
    right += other.right;
    left_over += other.left_over;
    return *this;
  }

  void add(const CurveTuple& tuple, const std::vector<double>& z_um, double step) {
    Samples u{};
    Samples weights{};
    Samples weighted{};
    const int first = tuple.index - 2;  // may lie before the first sample, as the last behind the end
    for (std::size_t j = 0; j < kSamples; ++j) {
      const int k = first + static_cast<int>(j);
      const auto share = static_cast<double>(tuple.share[j]);
      if (!(share > 0.0) || k < 0 || k >= static_cast<int>(z_um.size())) continue;
      u[j] = (z_um[static_cast<std::size_t>(k)] - z_um[static_cast<std::size_t>(tuple.index)]) / step;
      weights[j] = share * share;
      weighted[j] = -share * std::sqrt(share);  // of G = -share^-1/2
    }
    Parabola parabola;
    if (!parabola.fit(u, weights, weighted) || !(parabola.curvature < 0.0)) return;
    // What an offset of each sample moves, less what the parabola takes up of it: a projection, its own square.
    const auto noise = static_cast<double>(tuple.noise);
    const double information = 1.0 / (0.25 * noise * noise + 1e-6);
    Samples slope{};
    for (std::size_t j = 0; j < kSamples; ++j) slope[j] = weights[j] * (parabola.slope0 + parabola.curvature * u[j]);
    const auto& [q0, q1, q2] = parabola.q;
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (weights[i] == 0.0) continue;
      const int column = first + static_cast<int>(i);
      const double pull = slope[i] * information;
      right(column) += pull * parabola.residual[i];
      for (std::size_t j = i; j < kSamples; ++j) {
        if (weights[j] == 0.0) continue;
        const double taken_up = q0[i] * q0[j] + q1[i] * q1[j] + q2[i] * q2[j];
        diagonals(static_cast<Eigen::Index>(j - i), column) += pull * slope[j] * ((i == j ? 1.0 : 0.0) - taken_up);
      }
    }
    left_over += dot(parabola.residual, parabola.residual) * information;
  }

  /// The lower half.
  [[nodiscard]] Eigen::SparseMatrix<double> normal_matrix() const {
    std::vector<Eigen::Triplet<double>> elements;
    for (Eigen::Index k = 0; k < diagonals.cols(); ++k) {
      for (Eigen::Index d = 0; d < diagonals.rows() && k + d < diagonals.cols(); ++d) {
        elements.emplace_back(static_cast<int>(k + d), static_cast<int>(k), diagonals(d, k));
      }
    }
    Eigen::SparseMatrix<double> lower(diagonals.cols(), diagonals.cols());
    lower.setFromTriplets(elements.begin(), elements.end());
    return lower;
  }
};

using BandSolver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// What `number` of the curves say, spread over all. Always in as many pieces, so that the sum does not depend on the
/// number of threads.
Equations equations_of(std::span<const CurveTuple> tuples, std::size_t number, const std::vector<double>& z_um,
                       double step, WorkerPool& pool) {
  constexpr std::size_t kPieces = 8;
  std::vector<Equations> pieces(kPieces, Equations(z_um.size()));
  pool.run(kPieces, [&](int piece) {
    Equations& sum = pieces[static_cast<std::size_t>(piece)];
    for (auto i = static_cast<std::size_t>(piece); i < number; i += kPieces) {
      sum.add(tuples[number == tuples.size() ? i : spread_index(i, tuples.size())], z_um, step);
    }
  });
  for (std::size_t piece = 1; piece < kPieces; ++piece) pieces[0] += pieces[piece];
  return pieces[0];
}

/// What no scan can tell: a shift and a stretch leave no trace, and curves that lean to one side, for reasons of
/// optics, look exactly like an offset that grows with the square of z. Projects it out.
class SlowPart {
 public:
  SlowPart(const std::vector<double>& z_um, const std::vector<std::size_t>& seen) {
    const auto rows = static_cast<Eigen::Index>(seen.size());
    Eigen::MatrixXd powers(rows, kPowers);
    const double middle = (z_um[seen.front()] + z_um[seen.back()]) / 2;
    const double half = std::max(1e-9, std::abs(z_um[seen.back()] - z_um[seen.front()]) / 2);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const double x = (z_um[seen[static_cast<std::size_t>(row)]] - middle) / half;
      powers.row(row) << 1.0, x, x * x;
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(powers);
    basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(rows, kPowers);
  }
  [[nodiscard]] Eigen::MatrixXd removed_from(const Eigen::MatrixXd& columns) const {
    return columns - basis_ * (basis_.transpose() * columns);
  }

 private:
  static constexpr Eigen::Index kPowers = 3;
  Eigen::MatrixXd basis_;
};

}  // namespace

StageCorrection solve_stage_correction(std::span<const CurveTuple> tuples, const std::vector<double>& z_um,
                                       WorkerPool& pool) {
  std::ostringstream why;
  if (z_um.size() > static_cast<std::size_t>(kMaxSamples)) {
    why << z_um.size() << " samples, at most " << kMaxSamples << " are solved for: sum slices to bins";
    return off(why.str());
  }
  const bool upwards = z_um.back() > z_um.front();
  const auto out_of_order = [upwards](double a, double b) { return upwards ? !(a < b) : !(a > b); };
  if (std::adjacent_find(z_um.begin(), z_um.end(), out_of_order) != z_um.end()) {
    return off("the samples' heights do not run one way");
  }
  if (tuples.size() < kMinTuples) {
    why << "only " << tuples.size() << " of the points looked at are valid, " << kMinTuples << " are needed";
    return off(why.str());
  }
  const Coverage seen = coverage(tuples, z_um);
  if (seen.steps < kMinSteps) {
    why << "the surface spans " << std::round(10.0 * seen.steps) / 10.0 << " steps, " << kMinSteps << " are needed";
    return off(why.str());
  }
  if (seen.share < kMinCoverage) {
    why << "the surface covers " << std::round(100.0 * seen.share) << " % of the heights between its ends, "
        << 100.0 * kMinCoverage << " % are needed";
    return off(why.str());
  }
  const auto count = static_cast<Eigen::Index>(z_um.size());
  const double step = std::abs(z_um.back() - z_um.front()) / static_cast<double>(z_um.size() - 1);
  constexpr double kPriorWeight = 1.0 / (kPriorError_steps * kPriorError_steps);
  std::vector<double> corrected = z_um;
  Equations equations(z_um.size());
  BandSolver solver;
  double left_over_before = 0.0;
  double left_over = 0.0;
  double least_information = kMinInformation * kPriorWeight;
  const auto solve = [&](std::size_t number) {
    equations = equations_of(tuples, number, corrected, step, pool);
    equations.diagonals.row(0).array() += kPriorWeight;
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      equations.right(k) -= (corrected[i] - z_um[i]) / step * kPriorWeight;
    }
    solver.compute(equations.normal_matrix());
    left_over = equations.left_over;
    return Eigen::VectorXd(solver.solve(equations.right));
  };
  const auto correct = [&](const Eigen::VectorXd& change) {
    for (Eigen::Index k = 0; k < count; ++k) corrected[static_cast<std::size_t>(k)] += step * change(k);
  };
  Eigen::VectorXd change = solve(tuples.size() / kSubsetDivisor);
  left_over_before = left_over;
  const double foreseen = left_over - equations.right.dot(change);
  if (foreseen > kMaxSubsetResidualShare * left_over_before) {
    correct(change);
    left_over = foreseen;
    least_information /= kSubsetDivisor;
  } else {
    change = solve(tuples.size());
    left_over_before = left_over;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      correct(change);
      change = solve(tuples.size());  // the last one only to see what is left over now
    }
  }

  std::vector<std::size_t> samples;  // that the curves say something about
  for (Eigen::Index k = 0; k < count; ++k) {
    if (equations.diagonals(0, k) > least_information) samples.push_back(static_cast<std::size_t>(k));
  }
  if (samples.size() < static_cast<std::size_t>(kMinSteps)) return off("too few samples lie near a peak");
  const SlowPart slow(z_um, samples);
  const auto rows = static_cast<Eigen::Index>(samples.size());
  const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(count, count));
  Eigen::MatrixXd seen_covariance(rows, rows);
  Eigen::MatrixXd offsets(rows, 1);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::size_t k = samples[static_cast<std::size_t>(row)];
    offsets(row, 0) = corrected[k] - z_um[k];
    for (Eigen::Index column = 0; column < rows; ++column) {
      seen_covariance(row, column) = covariance(static_cast<Eigen::Index>(k),
                                                static_cast<Eigen::Index>(samples[static_cast<std::size_t>(column)]));
    }
  }
  offsets = slow.removed_from(offsets);
  const Eigen::MatrixXd fast = slow.removed_from(slow.removed_from(seen_covariance).transpose());

  StageCorrection correction;
  correction.standard_error_um = step * std::sqrt(std::max(0.0, fast.trace()) / static_cast<double>(rows));
  correction.rms_um = std::sqrt(offsets.squaredNorm() / static_cast<double>(rows));
  const double least = std::max(kMinStandardErrors * correction.standard_error_um, kMinOffset_steps * step);
  if (correction.rms_um < least) {
    why << "offsets of " << correction.rms_um << " um rms are within what curves of another shape and noise make, "
        << least << " um";
    correction.reason = why.str();
    return correction;
  }
  if (left_over > kMaxResidualShare * left_over_before) {
    why << "offsets of " << correction.rms_um << " um rms would explain only "
        << std::round(100.0 * (1.0 - left_over / left_over_before)) << " % of what the curves leave over, "
        << 100.0 * (1.0 - kMaxResidualShare) << " % are needed";
    correction.reason = why.str();
    return correction;
  }
  correction.applied = true;
  correction.offsets_um.assign(z_um.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    correction.offsets_um[samples[i]] = offsets(static_cast<Eigen::Index>(i), 0);
  }
  return correction;
}

}  // namespace fvd
