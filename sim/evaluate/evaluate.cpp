#include "sim/evaluate/evaluate.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <map>
#include <ostream>
#include <sstream>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "sim/evaluate/truth_file.hpp"
#include "sim/world/surface.hpp"

namespace fvd::sim {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Figures of one region and one height map, in um.
struct RegionFigures {
  int points = 0;
  int valid = 0;
  double sum = 0.0;
  double squares = 0.0;

  void add(float height_m, float truth_um) {
    ++points;
    if (!std::isfinite(height_m)) return;
    const double error = static_cast<double>(height_m) * 1e6 - static_cast<double>(truth_um);
    ++valid;
    sum += error;
    squares += error * error;
  }
  void add(const RegionFigures& other) {
    points += other.points;
    valid += other.valid;
    sum += other.sum;
    squares += other.squares;
  }
  [[nodiscard]] double bias_um() const { return valid > 0 ? sum / valid : std::nan(""); }
  [[nodiscard]] double rms_um() const { return valid > 0 ? std::sqrt(squares / valid) : std::nan(""); }
  [[nodiscard]] double valid_fraction() const {
    return points > 0 ? static_cast<double>(valid) / points : std::nan("");
  }
};
using Figures = std::map<Region, RegionFigures>;

cv::Mat read_image(const std::filesystem::path& file, int type, const Surface& surface) {
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (image.empty()) throw Error(ErrorCode::kBadInput, file.string() + " is missing or no image");
  if (image.type() != type || image.cols != surface.height_um.width() || image.rows != surface.height_um.height()) {
    throw Error(ErrorCode::kBadInput, file.string() + " is " + std::to_string(image.cols) + " x " +
                                          std::to_string(image.rows) + " pixels, or of another type; the world is " +
                                          std::to_string(surface.height_um.width()) + " x " +
                                          std::to_string(surface.height_um.height()));
  }
  return image;
}

Figures compare(const Surface& surface, const std::filesystem::path& file) {
  const cv::Mat heights = read_image(file, CV_32F, surface);
  Figures figures;
  for (int region = 0; region <= static_cast<int>(Region::kSurface); ++region) {
    figures[static_cast<Region>(region)];  // also those that the world has not
  }
  for (int y = 0; y < heights.rows; ++y) {
    for (int x = 0; x < heights.cols; ++x) {
      figures[static_cast<Region>(surface.region.at(x, y))].add(heights.at<float>(y, x), surface.height_um.at(x, y));
    }
  }
  return figures;
}

RegionFigures joined(const Figures& figures, std::initializer_list<Region> regions) {
  RegionFigures sum;
  for (const Region region : regions) sum.add(figures.at(region));
  return sum;
}

ordered_json rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

/// The shortest decimal form that reads back.
std::string metres(double um) {
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), um / 1e6).ptr;
  return {std::begin(text), end};
}

/// One evaluation: the world's surface, the result's record, a height map per method.
class Evaluation {
 public:
  Evaluation(const WorldParameters& world, const std::filesystem::path& result_dir)
      : chapter_(world.surface == SurfaceKind::kChapter), surface_(make_surface(world)) {
    Problems problems;
    const auto record = parse_strict_json(read_text_file(result_dir / "result.json"), problems);
    throw_if_any(problems, ErrorCode::kBadInput, (result_dir / "result.json").string());
    record_ = *record;
    main_ = record_.at("focus").at("peak").get<std::string>();
    maps_[main_] = compare(surface_, result_dir / "height.tiff");
    for (const json& extra : record_.at("focus").at("extra_peaks")) {
      const auto method = extra.at("peak").get<std::string>();
      maps_[method] = compare(surface_, result_dir / ("height_" + method + ".tiff"));
    }
  }

  void print(std::ostream& out) const {
    out << std::fixed << std::setprecision(3);
    if (chapter_) {
      print_chapter(out);
    } else {
      for (const auto& [method, figures] : maps_) {
        const RegionFigures& surface = figures.at(Region::kSurface);
        out << std::left << std::setw(14) << method << "RMS " << surface.rms_um() << " um, bias " << surface.bias_um()
            << " um, valid " << 100 * surface.valid_fraction() << " %\n";
      }
    }
    const json& frames = record_.at("frames");
    const json& steps = record_.at("steps");
    const json& times = record_.at("times");
    out << "frames        " << frames.at("ok") << " of " << frames.at("expected") << " good; incomplete "
        << frames.at("incomplete") << ", missing " << frames.at("missing") << ", stale " << frames.at("stale")
        << ", underrun " << frames.at("underrun") << '\n'
        << "stage         step error sd " << steps.at("error_sd_um") << " um, largest " << steps.at("error_max_um")
        << " um over " << steps.at("steps") << " steps; move and settle " << steps.at("move_median_ms") << " ms\n"
        << "time          prepare " << times.at("prepare_ms") << " ms, scan " << times.at("scan_ms") << " ms, finish "
        << times.at("finish_ms") << " ms\n"
        << "memory        " << record_.at("focus").at("state_bytes_per_pixel") << " bytes per pixel\n";
  }

  [[nodiscard]] ordered_json figures() const {
    ordered_json figures;
    if (chapter_) {
      ordered_json plateaus = ordered_json::object();
      ordered_json ramp = ordered_json::object();
      for (const auto& [method, map] : maps_) {
        plateaus[method] = rounded(plateau_figures(map).rms_um(), 4);
        ramp[method] = rounded(map.at(Region::kRamp).rms_um(), 4);
      }
      figures["plateau_rms_um"] = plateaus;
      figures["ramp_rms_um"] = ramp;
      const auto steps = step_heights_um();
      figures["steps_um"] = {rounded(steps[0], 4), rounded(steps[1], 4), rounded(steps[2], 4)};
      figures["valid_textured"] = rounded(textured().valid_fraction(), 6);
      figures["valid_texture_poor"] = rounded(main_map().at(Region::kPoor).valid_fraction(), 6);
    } else {
      const RegionFigures& surface = main_map().at(Region::kSurface);
      figures["rms_um"] = rounded(surface.rms_um(), 4);
      figures["bias_um"] = rounded(surface.bias_um(), 4);
      figures["valid"] = rounded(surface.valid_fraction(), 6);
    }
    figures["frames_expected"] = record_.at("frames").at("expected");
    figures["frames_ok"] = record_.at("frames").at("ok");
    figures["state_bytes_per_pixel"] = record_.at("focus").at("state_bytes_per_pixel");
    figures["scan_s"] = rounded(record_.at("times").at("scan_ms").get<double>() / 1000, 3);
    figures["finish_ms"] = record_.at("times").at("finish_ms");
    return figures;
  }

 private:
  static RegionFigures plateau_figures(const Figures& map) {
    return joined(map, {Region::kPlateauA, Region::kPlateauB, Region::kPlateauC});
  }
  [[nodiscard]] const Figures& main_map() const { return maps_.at(main_); }
  [[nodiscard]] RegionFigures textured() const {
    return joined(main_map(), {Region::kPlateauA, Region::kPlateauB, Region::kPlateauC, Region::kRamp});
  }
  /// Plateau B over A, C over B, C over A: differences of mean heights.
  [[nodiscard]] std::array<double, 3> step_heights_um() const {
    const double a = main_map().at(Region::kPlateauA).bias_um();
    const double b = 50.0 + main_map().at(Region::kPlateauB).bias_um();
    const double c = 100.0 + main_map().at(Region::kPlateauC).bias_um();
    return {b - a, c - b, c - a};
  }

  void print_chapter(std::ostream& out) const {
    const auto steps = step_heights_um();
    out << "plateaus      A " << main_map().at(Region::kPlateauA).bias_um() << " um, B "
        << 50.0 + main_map().at(Region::kPlateauB).bias_um() << " um, C "
        << 100.0 + main_map().at(Region::kPlateauC).bias_um() << " um (true: 0, 50, 100; " << main_ << ")\n"
        << "steps         B-A " << steps[0] << " um, C-B " << steps[1] << " um, C-A " << steps[2]
        << " um (true: 50, 50, 100)\n"
        << "RMS error     plateaus      ramp\n";
    for (const auto& [method, map] : maps_) {
      out << "  " << std::left << std::setw(12) << method << std::right << std::setw(8) << plateau_figures(map).rms_um()
          << " um" << std::setw(9) << map.at(Region::kRamp).rms_um() << " um\n";
    }
    out << "valid         textured " << 100 * textured().valid_fraction() << " %, texture-poor patch "
        << 100 * main_map().at(Region::kPoor).valid_fraction() << " %\n";
  }

  bool chapter_;
  Surface surface_;
  json record_;
  std::string main_;
  std::map<std::string, Figures> maps_;  // by method
};

}  // namespace

void write_truth(const WorldParameters& world, const std::filesystem::path& folder) {
  const Surface surface = make_surface(world);
  const int width = surface.height_um.width();
  const int height = surface.height_um.height();
  std::string header = "Gwyddion Simple Field 1.0\nXRes = " + std::to_string(width) +
                       "\nYRes = " + std::to_string(height) + "\nXReal = " + metres(width * world.pixel_pitch_um) +
                       "\nYReal = " + metres(height * world.pixel_pitch_um) +
                       "\nXYUnits = m\nZUnits = m\nTitle = truth\n";
  header.append(4 - header.size() % 4, '\0');
  std::ofstream out(folder / "truth.gsf", std::ios::binary);
  out << header;
  for (const float height_um : surface.height_um.pixels()) {
    const float height_m = height_um * 1e-6F;
    out.write(reinterpret_cast<const char*>(&height_m), sizeof(height_m));
  }
  out.close();
  const cv::Mat regions(surface.region.height(), surface.region.width(), CV_8U,
                        const_cast<std::uint8_t*>(surface.region.row(0)));
  if (!out || !cv::imwrite((folder / "regions.png").string(), regions)) {
    throw Error(ErrorCode::kStorageWrite, "cannot write the truth into " + folder.string());
  }
  WorldParameters sized = world;  // a height map brings its own size
  sized.width_px = width;
  sized.height_px = height;
  write_truth_file(sized, folder);
}

void evaluate(const WorldParameters& world, const std::filesystem::path& result_dir, bool with_json,
              std::ostream& out) {
  try {
    const Evaluation evaluation(world, result_dir);
    evaluation.print(out);
    if (with_json) out << evaluation.figures().dump() << '\n';
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::kBadInput,
                (result_dir / "result.json").string() + " is not what fvd writes: " + error.what());
  }
}

}  // namespace fvd::sim
