/// How near heights come to the truth: the chapter's scene and the generated stacks, over peak methods and neighbour
/// distances. The last line is one JSON object of the figures of the default settings.

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/pipeline/worker_pool.hpp"
#include "drivers/replay/recorded_stack.hpp"
#include "sim/axis_model.hpp"
#include "sim/sim_world.hpp"

namespace {

using namespace fvd;
namespace fs = std::filesystem;

constexpr std::array kMethods{PeakMethod::kParabola, PeakMethod::kLogParabola, PeakMethod::kInverseRoot};

/// Mean and RMS of height minus truth.
struct ErrorSum {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;

  void add(double error) {
    sum += error;
    squares += error * error;
    count += 1.0;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
  [[nodiscard]] double bias() const { return sum / count; }
};

struct ChapterFigures {
  ErrorSum plateaus;
  ErrorSum ramp;
};

/// The default world on an ideal axis, 21 slices of 10 um from -7 um: what the streaming stack itself contributes.
class ChapterScan {
 public:
  ChapterScan(double noise, int distance) : world_(parameters(noise), axis_) {
    stack_.emplace(world_.sensor_width(), world_.sensor_height(), PixelFormat::kMono8,
                   FocusSettings{.distance_px = distance}, pool_);
    for (int k = 0; k < 21; ++k) expose(-7.0 + 10.0 * k, static_cast<std::uint64_t>(k));
  }

  [[nodiscard]] ChapterFigures figures(PeakMethod method) const {
    ChapterFigures figures;
    const HeightMap map = stack_->finish(method);
    for (std::size_t i = 0; i < map.mask.pixels().size(); ++i) {
      const auto region = static_cast<sim::Region>(world_.surface().region.pixels()[i]);
      if (map.mask.pixels()[i] != 0 || region == sim::Region::kNone || region == sim::Region::kPoor) continue;
      const double truth_um = static_cast<double>(world_.surface().height_um.pixels()[i]);
      const double error_um = static_cast<double>(map.height_m.pixels()[i]) * 1e6 - truth_um;
      (region == sim::Region::kRamp ? figures.ramp : figures.plateaus).add(error_um);
    }
    return figures;
  }

 private:
  static sim::WorldParameters parameters(double noise) {
    sim::WorldParameters world;
    world.readout_noise = noise;
    return world;
  }
  static sim::AxisParameters ideal_axis() {
    sim::AxisParameters axis;
    axis.power_on_position_um = 0.0;
    return axis;
  }

  void expose(double z_um, std::uint64_t index) {
    time_ += std::chrono::seconds(5);
    axis_.move_to(time_, static_cast<std::int32_t>(std::lround(z_um * 100)), 1e6, 1e7, 1e7);
    time_ += std::chrono::seconds(5);
    sim::ExposureRequest request;
    request.width = world_.sensor_width();
    request.height = world_.sensor_height();
    request.start = time_;
    request.end = time_ + std::chrono::milliseconds(5);
    request.exposure_index = index;
    std::vector<std::byte> pixels(static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height));
    world_.render(request, pixels);
    stack_->push({PixelFormat::kMono8, request.width, request.height, request.width, pixels.data()}, z_um);
  }

  sim::AxisModel axis_{ideal_axis()};
  HostTime time_ = HostClock::now();
  sim::SimWorld world_;
  WorkerPool pool_{2};
  std::optional<StreamingFocusStack> stack_;
};

struct Reference {
  const char* key;
  const char* folder;
  double slices_per_truth;  ///< what one unit of truth.tiff is in slices
  double first_slice;       ///< what truth.tiff gives the first slice, in slices
};
constexpr std::array<Reference, 3> kReferences{{{"cou1_rms", "generated-cou1", 1.0, 0.0},
                                                {"cou6_rms", "generated-cou6", 1.0, 0.0},
                                                {"cone31_rms", "generated-cone31", 1 / 0.002, 0.09 / 0.002}}};

/// A stack with truth from the folder of reference data; z counts slices.
class ReferenceScan {
 public:
  /// A 16-bit stack is taken as 8 bit, divided by 256.
  ReferenceScan(const fs::path& folder, const Reference& reference, int distance)
      : truth_slices_(cv::imread((folder / "truth.tiff").string(), cv::IMREAD_UNCHANGED)) {
    truth_slices_.convertTo(truth_slices_, CV_64F, reference.slices_per_truth, -reference.first_slice);
    const RecordedStack recording(folder);
    stack_.emplace(recording.width(), recording.height(), PixelFormat::kMono8,
                   FocusSettings{.distance_px = distance, .min_prominence = 0.0}, pool_);
    for (int k = 0; k < recording.slices(); ++k) {
      const SliceImage slice = recording.read(k);
      Plane<std::uint8_t> narrow(slice.width, slice.height);
      for (std::size_t i = 0; i < narrow.pixels().size(); ++i) {
        narrow.pixels()[i] =
            std::to_integer<std::uint8_t>(slice.pixels[slice.format == PixelFormat::kMono8 ? i : 2 * i + 1]);
      }
      stack_->push(image_view(narrow.view(), PixelFormat::kMono8), k);
    }
  }

  [[nodiscard]] ErrorSum figures(PeakMethod method) const {
    ErrorSum errors;
    const HeightMap map = stack_->finish(method);
    for (int y = 0; y < map.mask.height(); ++y) {
      for (int x = 0; x < map.mask.width(); ++x) {
        const double truth = truth_slices_.at<double>(y, x);
        const double measured = static_cast<double>(map.height_m.at(x, y)) * 1e6;
        if (!std::isnan(truth) && !std::isnan(measured)) errors.add(measured - truth);
      }
    }
    return errors;
  }

 private:
  cv::Mat truth_slices_;
  WorkerPool pool_{2};
  std::optional<StreamingFocusStack> stack_;
};

bool is_default(PeakMethod method, int distance) {
  return method == PeakMethod::kInverseRoot && distance == FocusSettings{}.distance_px;
}

void chapter_table(nlohmann::ordered_json& json) {
  std::puts("Chapter's scene, 9 x 9, step 10 um, um: RMS and bias on the plateaus, RMS on the ramp");
  for (const double noise : {0.5, 1.5, 3.0}) {
    for (const int distance : {1, 2, 3, 4}) {
      const ChapterScan scan(noise, distance);
      for (const PeakMethod method : kMethods) {
        const ChapterFigures figures = scan.figures(method);
        std::printf("noise %.1f  distance %d  %-12s  %.3f  %+.3f  %.3f\n", noise, distance,
                    std::string(peak_method_name(method)).c_str(), figures.plateaus.rms(), figures.plateaus.bias(),
                    figures.ramp.rms());
        if (noise != 1.5 || !is_default(method, distance)) continue;
        json["chapter_plateau_rms_um"] = figures.plateaus.rms();
        json["chapter_ramp_rms_um"] = figures.ramp.rms();
        json["chapter_plateau_bias_um"] = figures.plateaus.bias();
      }
    }
  }
}

void reference_table(const fs::path& data, nlohmann::ordered_json& json) {
  std::puts("Generated stacks, 9 x 9, nothing masked, slices: RMS, bias, points");
  for (const Reference& reference : kReferences) {
    const fs::path folder = data / reference.folder;
    if (!fs::exists(folder)) {
      std::printf("%s is not there: left out\n", folder.c_str());
      continue;
    }
    for (const int distance : {1, 2, 3, 4}) {
      const ReferenceScan scan(folder, reference, distance);
      for (const PeakMethod method : kMethods) {
        const ErrorSum errors = scan.figures(method);
        std::printf("%-16s  distance %d  %-12s  %.4f  %+.4f  %.0f\n", reference.folder, distance,
                    std::string(peak_method_name(method)).c_str(), errors.rms(), errors.bias(), errors.count);
        if (is_default(method, distance)) json[reference.key] = errors.rms();
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  nlohmann::ordered_json json;
  chapter_table(json);
  reference_table(argc > 1 ? argv[1] : FVD_SOURCE_DIR "/../shared/data", json);
  std::puts(json.dump().c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
  return 1;
}
