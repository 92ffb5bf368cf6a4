#include "core/metrology/edge/section_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fvd::metrology::edge {
namespace {

// A flank or an apex is measured if at least this share of its points is there.
constexpr double kLeastShare = 0.5;
// No point counts for more than so many of the middle ones.
constexpr double kMostWeight = 10.0;

struct RawPoint {
  int column, row;
  double s, h, weight;
};

struct RawSection {
  std::vector<RawPoint> points;
  long possible = 0;
};

double typical_weight(const HeightField& field) {
  if (!field.has_sigma()) return 1.0;
  std::vector<double> sample;
  const auto pixels = field.sigma_um.pixels();
  const std::size_t stride = std::max<std::size_t>(1, pixels.size() / 4000);
  for (std::size_t i = 0; i < pixels.size(); i += stride) {
    if (pixels[i] > 0.0F) sample.push_back(1.0 / std::pow(static_cast<double>(pixels[i]), 2));
  }
  return sample.empty() ? 1.0 : median(std::move(sample));
}

class Cutter {
 public:
  Cutter(const HeightField& field, const Region& region, const EdgeCurve& curve, const EdgeOptions& options)
      : field_(field), region_(region), curve_(curve), options_(options), typical_(typical_weight(field)) {
    const double whole = curve.whole_length_um();
    // A hundredth of a section may be missing at the ends.
    const auto count = static_cast<std::size_t>(std::floor(whole / options.sections_every_um + 0.01));
    first_um_ = (whole - static_cast<double>(count) * options.sections_every_um) / 2.0;
    raw_.resize(count);
  }

  std::vector<SectionData> run() {
    if (raw_.empty()) return {};
    for (int row = 0; row < field_.height(); ++row) {
      for (int column = 0; column < field_.width(); ++column) {
        if (is_inside(region_, column, row)) sort_in(column, row);
      }
    }
    std::vector<SectionData> sections;
    for (std::size_t i = 0; i < raw_.size(); ++i) {
      const double along = first_um_ + (static_cast<double>(i) + 0.5) * options_.sections_every_um;
      sections.push_back(average(raw_[i], along));
    }
    return sections;
  }

 private:
  void sort_in(int column, int row) {
    const double x = field_.x_um(column);
    const double y = field_.y_um(row);
    if (!curve_.may_be_within(x, y, options_.flank_to_um)) return;
    const EdgePlace place = curve_.place_of(x, y);
    if (std::abs(place.s_um) > options_.flank_to_um) return;
    const EdgeFrame frame = curve_.frame(place.place_um);
    const bool hole = field_.is_hole(column, row);
    const double rise = hole ? 0.0 : field_.z_um.at(column, row) - frame.z;
    // A section is at right angles to the edge in space: what lies deeper belongs to a place further along.
    const double along = curve_.length_um(place.place_um) + frame.tilt * rise / frame.stretch;
    const double index = std::floor((along - first_um_) / options_.sections_every_um);
    if (index < 0.0 || index >= static_cast<double>(raw_.size())) return;
    RawSection& section = raw_[static_cast<std::size_t>(index)];
    ++section.possible;
    if (hole) return;
    double weight = 1.0;
    if (field_.has_sigma()) {
      const auto sigma = static_cast<double>(field_.sigma_um.at(column, row));
      if (!(sigma > 0.0)) return;
      weight = std::min(kMostWeight, 1.0 / (sigma * sigma * typical_));
    }
    section.points.push_back({column, row, place.s_um, rise / frame.stretch, weight});
  }

  [[nodiscard]] SectionData average(const RawSection& raw, double along_um) const {
    SectionData section;
    section.along_um = along_um;
    section.frame = curve_.frame(curve_.place_at_length(along_um));
    section.possible = raw.possible;
    section.state = state_of(raw, section.frame);
    const double step = std::min(field_.pitch_x_um, field_.pitch_y_um) / 2.0;
    const auto bins = static_cast<std::size_t>(std::ceil(2.0 * options_.flank_to_um / step)) + 1;
    std::vector<double> weight(bins, 0.0);
    std::vector<double> s(bins, 0.0);
    std::vector<double> h(bins, 0.0);
    const auto bin_of = [&](const RawPoint& p) {
      return static_cast<std::size_t>((p.s + options_.flank_to_um) / step);
    };
    for (const RawPoint& p : raw.points) {
      const std::size_t bin = bin_of(p);
      weight[bin] += p.weight;
      s[bin] += p.weight * p.s;
      h[bin] += p.weight * p.h;
    }
    std::vector<int> node(bins, 0);
    for (std::size_t i = 0; i < bins; ++i) {
      if (weight[i] == 0.0) continue;
      node[i] = static_cast<int>(section.s_um.size());
      section.s_um.push_back(s[i] / weight[i]);
      section.h_um.push_back(h[i] / weight[i]);
      section.weight.push_back(weight[i]);
    }
    section.points.reserve(raw.points.size());
    for (const RawPoint& p : raw.points) {
      const std::size_t bin = bin_of(p);
      section.points.push_back({p.column, p.row, node[bin], p.weight / weight[bin] / section.frame.stretch});
    }
    return section;
  }

  [[nodiscard]] EdgeReason state_of(const RawSection& raw, const EdgeFrame& frame) const {
    double rake = 0.0;
    double clearance = 0.0;
    double apex = 0.0;
    for (const RawPoint& p : raw.points) {
      (std::abs(p.s) < options_.flank_from_um ? apex : p.s < 0.0 ? rake : clearance) += 1.0;
    }
    const double points_per_um = options_.sections_every_um / frame.stretch / (field_.pitch_x_um * field_.pitch_y_um);
    const double least = kLeastShare * (options_.flank_to_um - options_.flank_from_um) * points_per_um;
    if (rake < least || clearance < least) return EdgeReason::kFlankUnmeasured;
    if (apex < kLeastShare * 2.0 * options_.flank_from_um * points_per_um) return EdgeReason::kApexUnmeasured;
    return EdgeReason::kNone;
  }

  const HeightField& field_;
  const Region& region_;
  const EdgeCurve& curve_;
  const EdgeOptions& options_;
  double typical_;
  double first_um_ = 0.0;
  std::vector<RawSection> raw_;
};

}  // namespace

std::vector<SectionData> cut_sections(const HeightField& field, const Region& region, const EdgeCurve& curve,
                                      const EdgeOptions& options) {
  return Cutter(field, region, curve, options).run();
}

}  // namespace fvd::metrology::edge
