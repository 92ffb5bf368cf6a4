#pragma once

/// Maps that tests make, and views of them as viewers read them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/export/result_writer.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/surface_files/map_rows.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

inline constexpr float kNoPoint = std::numeric_limits<float>::quiet_NaN();

/// A map in memory.
class PlaneRows final : public MapRows {
 public:
  explicit PlaneRows(Plane<float> plane) : plane_(std::move(plane)) {}
  [[nodiscard]] GridSize size() const noexcept override { return {plane_.width(), plane_.height()}; }
  void read(int x, int y, int count, float* to) const override { std::copy_n(plane_.row(y) + x, count, to); }
  [[nodiscard]] const Plane<float>& plane() const { return plane_; }

 private:
  Plane<float> plane_;
};

inline std::shared_ptr<const PlaneRows> rows_of(Plane<float> plane) {
  return std::make_shared<const PlaneRows>(std::move(plane));
}

/// Heights of 0 with an upright F of height 1e-5: a stem on the left, a long bar on top, a short one in the middle.
inline Plane<float> letter_f(int width, int height) {
  Plane<float> plane(width, height, 0.0F);
  const auto fill = [&plane](int left, int top, int right, int bottom) {
    for (int y = top; y < bottom; ++y) std::fill(plane.row(y) + left, plane.row(y) + right, 1e-5F);
  };
  fill(width / 8, height / 8, width / 4, height * 7 / 8);
  fill(width / 8, height / 8, width * 7 / 8, height / 4);
  fill(width / 8, height * 7 / 16, width * 5 / 8, height * 9 / 16);
  return plane;
}

/// Numbers that look like noise, the same each time: 0..1.
class Noise {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11U) / 9007199254740992.0;
  }

 private:
  std::uint64_t state_ = 42;
};

/// Rough heights of some um, a share of the points missing.
inline Plane<float> rough(int width, int height, double holes) {
  Plane<float> plane(width, height);
  Noise noise;
  for (float& value : plane.pixels()) {
    value = noise.next() < holes ? kNoPoint : static_cast<float>(1e-5 * (noise.next() - 0.3));
  }
  return plane;
}

/// A view as the page reads it.
struct ReadView {
  std::uint32_t version = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t factor = 0;
  std::uint32_t planes = 0;
  std::uint32_t map_width = 0;
  std::uint32_t map_height = 0;
  std::vector<float> values;

  [[nodiscard]] float at(std::size_t plane, int x, int y) const {
    const std::size_t row = plane * height + static_cast<std::size_t>(y);
    return values.at(row * width + static_cast<std::size_t>(x));
  }
};

inline ReadView read_view(const std::string& bytes) {
  ReadView view;
  if (bytes.size() < 32 || !bytes.starts_with("FVDH")) {
    ADD_FAILURE() << "no view: " << bytes.substr(0, 100);
    return view;
  }
  std::uint32_t* const words[] = {&view.version, &view.width,     &view.height,    &view.factor,
                                  &view.planes,  &view.map_width, &view.map_height};
  for (std::size_t i = 0; i < 7; ++i) {
    const auto byte = [&](std::size_t at) { return std::uint32_t{static_cast<unsigned char>(bytes[4 + 4 * i + at])}; };
    *words[i] = byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U;
  }
  view.values.resize((bytes.size() - 32) / sizeof(float));
  std::memcpy(view.values.data(), bytes.data() + 32, view.values.size() * sizeof(float));
  EXPECT_EQ(view.values.size(), std::size_t{view.planes} * view.width * view.height);
  return view;
}

/// A result whose heights are these; sigma 0.2 um where there is a height.
inline ResultData result_with(const Plane<float>& heights) {
  ResultData data = sample_result();
  data.map = sample_map(heights.width(), heights.height());
  for (int y = 0; y < heights.height(); ++y) {
    for (int x = 0; x < heights.width(); ++x) {
      data.map.height_m.at(x, y) = heights.at(x, y);
      if (std::isnan(heights.at(x, y))) make_hole(data.map, x, y, mask_reason::kLowProminence);
    }
  }
  data.exports = {"tiff", "mask.png", "texture.png"};
  return data;
}

/// Writes it, and tells it as the database would.
inline StoredJob stored_result(const std::filesystem::path& folder, const ResultData& data) {
  write_result(folder, data);
  StoredJob job;
  job.status.job_id = folder.filename();
  job.status.state = JobState::kCompleted;
  job.result_dir = folder;
  job.result_json = read_text(folder / "result.json");
  return job;
}

}  // namespace fvd::test
