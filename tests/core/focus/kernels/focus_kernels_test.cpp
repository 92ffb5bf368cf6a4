/// Every compilation of the kernels against the one without vector code, bit for bit, and what they leave alone.

#include "core/focus/kernels/focus_kernels.hpp"

#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/focus/fit/sample_heights.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

/// Ends the program before its tests where this processor cannot run the kernels that were asked for; CTest knows the
/// message and takes it for a skip. Without it a worker thread of some test would meet the error first, and abort.
class ForcedKernels : public ::testing::Environment {
 public:
  void SetUp() override { ASSERT_NO_THROW(static_cast<void>(focus_kernels())); }
};
[[maybe_unused]] const auto* const forced_kernels = ::testing::AddGlobalTestEnvironment(new ForcedKernels);

constexpr int kGuard = 40;  // elements behind a row that nobody may write

/// A row of random values in a store that ends with a guard.
template <typename T>
std::vector<T> random_row(int width, std::mt19937& random) {
  std::vector<T> row(static_cast<std::size_t>(width + kGuard));
  for (T& value : row) value = static_cast<T>(random());
  return row;
}

/// Calls body(kernels, random) with the same random numbers for each compilation; its results must be the same.
template <typename Body>
void expect_same(const std::string& what, Body body) {
  const auto all = all_focus_kernels();
  ASSERT_GE(all.size(), 2U);
  ASSERT_EQ(all[0]->name, "scalar");
  for (int width = 1; width <= 100; ++width) {
    std::mt19937 first(static_cast<unsigned>(width));
    const auto expected = body(*all[0], width, first);
    for (const FocusKernels* kernels : all.subspan(1)) {
      std::mt19937 same(static_cast<unsigned>(width));
      const auto actual = body(*kernels, width, same);
      ASSERT_EQ(expected.size(), actual.size());
      ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(expected[0])), 0)
          << what << " of " << kernels->name << ", width " << width;
    }
  }
}

template <typename Pixel, typename Out, typename Kernel>
auto three_rows(Kernel kernel) {
  return [kernel](const FocusKernels& kernels, int width, std::mt19937& random) {
    const auto above = random_row<Pixel>(width, random);
    const auto row = random_row<Pixel>(width, random);
    const auto below = random_row<Pixel>(width, random);
    auto all = std::vector<Out>();
    for (int distance = 1; distance <= 7; ++distance) {
      std::vector<Out> out(static_cast<std::size_t>(width + kGuard), 0x5A);
      kernel(kernels, above.data(), row.data(), below.data(), width, distance, out.data());
      all.insert(all.end(), out.begin(), out.end());
    }
    return all;
  };
}

TEST(FocusKernels, GiveTheSameLaplacian) {
  expect_same("laplacian_u16", three_rows<std::uint16_t, std::uint32_t>(
                                   [](const FocusKernels& k, const std::uint16_t* above, const std::uint16_t* row,
                                      const std::uint16_t* below, int width, int distance, std::uint32_t* out) {
                                     k.laplacian_u16(above, row, below, width, distance, distance % 4, out);
                                   }));
}

TEST(FocusKernels, GiveTheSameTenengrad) {
  expect_same("tenengrad_u8", three_rows<std::uint8_t, std::uint32_t>(
                                  [](const FocusKernels& k, const std::uint8_t* above, const std::uint8_t* row,
                                     const std::uint8_t* below, int width, int distance, std::uint32_t* out) {
                                    k.tenengrad_u8(above, row, below, width, distance, distance % 3, out);
                                  }));
  expect_same("tenengrad_u16", three_rows<std::uint16_t, std::uint32_t>(
                                   [](const FocusKernels& k, const std::uint16_t* above, const std::uint16_t* row,
                                      const std::uint16_t* below, int width, int distance, std::uint32_t* out) {
                                     k.tenengrad_u16(above, row, below, width, distance, distance, out);
                                   }));
}

TEST(FocusKernels, GiveTheSameSumsOfColumns) {
  for (int shift = 0; shift <= 6; ++shift) {
    expect_same("enter_laplacian_u8", [shift](const FocusKernels& kernels, int width, std::mt19937& random) {
      const auto above = random_row<std::uint8_t>(width, random);
      const auto row = random_row<std::uint8_t>(width, random);
      const auto below = random_row<std::uint8_t>(width, random);
      auto columns = random_row<std::uint16_t>(width, random);
      auto slot = random_row<std::uint16_t>(width, random);
      std::vector<std::uint16_t> scaled(columns.size(), 0x5A5A);
      kernels.enter_laplacian_u8(above.data(), row.data(), below.data(), width, 1 + width % 7, shift, columns.data(),
                                 slot.data(), scaled.data());
      columns.insert(columns.end(), slot.begin(), slot.end());
      columns.insert(columns.end(), scaled.begin(), scaled.end());
      return columns;
    });
  }
  expect_same("slide_u32", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    auto columns = random_row<std::uint32_t>(width, random);
    const auto entering = random_row<std::uint32_t>(width, random);
    auto leaving = random_row<std::uint32_t>(width, random);
    kernels.slide_u32(columns.data(), entering.data(), leaving.data(), width);
    columns.insert(columns.end(), leaving.begin(), leaving.end());
    return columns;
  });
}

TEST(FocusKernels, SumEveryOddWindow) {
  for (const FocusKernels* kernels : all_focus_kernels()) {
    std::mt19937 random(2);
    for (int window = 1; window <= 63; window += 2) {
      for (const int width : {window, window + 1, window + 37}) {
        const auto values = random_row<std::uint32_t>(width, random);
        std::vector<std::uint32_t> sums(static_cast<std::size_t>(width + kGuard), 7);
        kernels->window_sums_u32(values.data(), window, width, sums.data());
        for (int x = 0; x < width + kGuard; ++x) {
          std::uint32_t expected = 0;
          for (int i = x; i < x + window && x <= width - window; ++i) expected += values[static_cast<std::size_t>(i)];
          if (x > width - window) expected = 7;
          ASSERT_EQ(sums[static_cast<std::size_t>(x)], expected)
              << kernels->name << " window " << window << " of " << width << " at " << x;
        }
      }
    }
  }
}

TEST(FocusKernels, GiveTheSameWindowSumsOf16Bit) {
  expect_same("window_sums_u16", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    const auto values = random_row<std::uint16_t>(width, random);
    std::vector<std::uint16_t> all;
    for (int window = 1; window <= std::min(width, 63); window += 2) {
      std::vector<std::uint16_t> sums(static_cast<std::size_t>(width + kGuard), 7);
      kernels.window_sums_u16(values.data(), window, width, sums.data());
      all.insert(all.end(), sums.begin(), sums.end());
    }
    return all;
  });
}

TEST(FocusKernels, GiveTheSameCodesBinsAndMaxima) {
  expect_same("root_code", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    auto sums = random_row<std::uint32_t>(width, random);
    for (auto& sum : sums) sum >>= 1U;
    std::vector<std::uint16_t> codes(sums.size(), 0x5A5A);
    kernels.root_code(sums.data(), 1.4F, width, codes.data());
    return codes;
  });
  expect_same("add_to_bin", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    auto sums = random_row<std::uint16_t>(width, random);
    const auto codes = random_row<std::uint16_t>(width, random);
    kernels.add_to_bin(sums.data(), codes.data(), 1 + width % 6, width);
    return sums;
  });
  expect_same("maxima", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    const auto narrow = random_row<std::uint8_t>(width, random);
    const auto wide = random_row<std::uint16_t>(width, random);
    return std::vector<unsigned>{kernels.maximum_u8(narrow.data(), width), kernels.maximum_u16(wide.data(), width)};
  });
}

TEST(FocusKernels, WidenEveryPixelAndNothingBehind) {
  for (const FocusKernels* kernels : all_focus_kernels()) {
    for (const int width : {1, 15, 64, 65, 130}) {
      std::mt19937 random(2);
      const auto values = random_row<std::uint8_t>(width, random);
      std::vector<std::uint16_t> out(static_cast<std::size_t>(width + kGuard), 0x5A5A);
      kernels->widen_u8(values.data(), 0, width, out.data());
      for (std::size_t x = 0; x < out.size(); ++x) {
        ASSERT_EQ(out[x], x < static_cast<std::size_t>(width) ? values[x] : 0x5A5A) << kernels->name << ' ' << width;
      }
    }
  }
}

TEST(FocusKernels, GiveTheSameNoise) {
  expect_same("noise", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    std::vector<std::uint64_t> sums;
    const auto narrow = random_row<std::uint8_t>(3 * width, random);
    const auto wide = random_row<std::uint16_t>(3 * width, random);
    sums.push_back(kernels.noise_u8(narrow.data(), narrow.data() + width, narrow.data() + 2 * width, width));
    sums.push_back(kernels.noise_u16(wide.data(), wide.data() + width, wide.data() + 2 * width, width));
    return sums;
  });
}

/// The columns of a row's state in one store.
struct Curves {
  Curves(int width, std::mt19937& random) : clipped(static_cast<std::size_t>(width + kGuard)) {
    for (auto& column : columns) column = random_row<std::uint16_t>(width, random);
    for (auto& state : clipped) state = random() % 16 == 0 ? static_cast<std::uint8_t>(random()) : std::uint8_t{0};
  }
  [[nodiscard]] CurveRow row() {
    return {columns[0].data(), columns[1].data(), columns[2].data(), columns[3].data(), columns[4].data(),
            columns[5].data(), columns[6].data(), columns[7].data(), columns[8].data(), clipped.data()};
  }
  [[nodiscard]] CurveRow row_with_second_peak() {
    CurveRow with = row();
    with.second = columns[9].data();
    with.valley_share = 39322;
    return with;
  }
  std::array<std::vector<std::uint16_t>, 10> columns;
  std::vector<std::uint8_t> clipped;
};

TEST(FocusKernels, TakeASampleInAlike) {
  const auto body = [](auto pixel, bool second, auto update) {
    using Texture = decltype(pixel);
    return [second, update](const FocusKernels& kernels, int width, std::mt19937& random) {
      Curves curves(width, random);
      for (auto& index : curves.columns[8]) index = static_cast<std::uint16_t>(random() % 7);
      auto texture = random_row<Texture>(width, random);
      std::vector<std::vector<Texture>> pixels;
      std::vector<std::vector<std::uint8_t>> clipped;
      std::vector<std::vector<std::uint16_t>> codes;
      std::vector<Sample<Texture>> samples;
      for (int k = 0; k < 5; ++k) {
        pixels.push_back(random_row<Texture>(width, random));
        clipped.push_back(random_row<std::uint8_t>(width, random));
        for (auto& level : clipped.back()) level &= clipping::kLevelBits;
        codes.push_back(random_row<std::uint16_t>(width, random));
        for (std::size_t x = 0; x < codes[0].size(); x += 3) codes.back()[x] = curves.columns[2][x];  // ties
      }
      for (std::size_t k = 0; k < codes.size(); ++k) {
        samples.push_back({codes[k].data(), k == 2 ? nullptr : clipped[k].data(), pixels[k].data()});
      }
      const CurveRow row = second ? curves.row_with_second_peak() : curves.row();
      update(kernels, row, samples.data(), 1, texture.data(), width, 7);
      update(kernels, row, samples.data() + 1, 4, texture.data(), width, 8);
      std::vector<unsigned> all(texture.begin(), texture.end());
      for (const auto& column : curves.columns) all.insert(all.end(), column.begin(), column.end());
      all.insert(all.end(), curves.clipped.begin(), curves.clipped.end());
      return all;
    };
  };
  for (const bool second : {false, true}) {
    expect_same("update_u8", body(std::uint8_t{}, second,
                                  [](const FocusKernels& k, auto... arguments) { k.update_u8(arguments...); }));
    expect_same("update_u16", body(std::uint16_t{}, second,
                                   [](const FocusKernels& k, auto... arguments) { k.update_u16(arguments...); }));
  }
}

TEST(FocusKernels, FitAlike) {
  for (const bool root : {false, true}) {
    expect_same("fit_five", [root](const FocusKernels& kernels, int width, std::mt19937& random) {
      std::vector<double> z_um;
      for (int i = 0; i < 12; ++i) z_um.push_back(i * 10.0 + static_cast<double>(random() % 7));
      const auto table = height_table(z_um);
      Curves curves(width, random);
      for (std::size_t x = 0; x < curves.clipped.size(); ++x) {
        auto& columns = curves.columns;
        for (const std::size_t field : {3U, 4U, 5U, 6U}) columns[field][x] = std::min(columns[field][x], columns[2][x]);
        columns[7][x] = static_cast<std::uint16_t>(columns[7][x] % (columns[2][x] / 2 + 1));
        columns[8][x] = static_cast<std::uint16_t>(columns[8][x] % z_um.size());
        if (x % 11 == 0) columns[2][x] = columns[7][x] = 0;
      }
      const std::vector<float> noise(static_cast<std::size_t>(width), 0.01F);
      const std::vector<float> least(static_cast<std::size_t>(width), 0.02F);
      std::vector<float> floats(static_cast<std::size_t>(3 * width + kGuard), 5.0F);
      std::vector<MaskReasons> mask(static_cast<std::size_t>(width + kGuard), 0x5A5A);
      kernels.fit_five(curves.row(), table, noise.data(), least.data(), width,
                       {0.4F, 3.0F, 0.05F, 0.02F, 1.0F / 65535.0F, root, {-0.1F, 0.4F}},
                       {floats.data(), floats.data() + width, floats.data() + 2 * width, mask.data()});
      std::vector<std::uint32_t> all(floats.size());
      std::memcpy(all.data(), floats.data(), floats.size() * sizeof(float));
      all.insert(all.end(), mask.begin(), mask.end());
      return all;
    });
  }
}

TEST(FocusKernels, FindTheSameAmplitudesAndSlopes) {
  for (const bool root : {false, true}) {
    expect_same("raise_amplitudes", [root](const FocusKernels& kernels, int width, std::mt19937& random) {
      const auto peak = random_row<std::uint16_t>(width, random);
      auto minimum = random_row<std::uint16_t>(width, random);
      for (std::size_t x = 0; x < minimum.size(); ++x) minimum[x] = std::min(minimum[x], peak[x]);
      std::vector<std::uint32_t> highest(static_cast<std::size_t>(width + kGuard), 30000U);
      kernels.raise_amplitudes(peak.data(), minimum.data(), root, width, highest.data());
      return highest;
    });
  }
  expect_same("any_apart", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    auto a = random_row<std::uint16_t>(width, random);
    auto b = random_row<std::uint16_t>(width, random);
    std::vector<MaskReasons> mask(a.size(), mask_reason::kSaturated);
    for (std::size_t x = 0; x < a.size(); ++x) a[x] = static_cast<std::uint16_t>((b[x] = b[x] % 60000U) + random() % 6);
    std::vector<unsigned> all;
    for (const std::size_t place : {std::size_t{0}, static_cast<std::size_t>(width) / 2, a.size() - 1}) {
      const auto apart = [&] {
        return kernels.any_apart(a.data(), b.data(), mask.data(), mask.data(), width, 5) ? 1U : 0U;
      };
      all.push_back(apart());
      const std::uint16_t before = a[place];
      a[place] = static_cast<std::uint16_t>(b[place] + 6);
      all.push_back(apart());
      mask[place] |= mask_reason::kInsignificant;
      all.push_back(apart());
      mask[place] = 0;
      a[place] = before;
    }
    EXPECT_EQ(all[0], 0U);
    EXPECT_EQ(all[1], 1U);
    EXPECT_EQ(all[2], 0U);
    return all;
  });
  expect_same("finish_sigma", [](const FocusKernels& kernels, int width, std::mt19937& random) {
    std::array<std::vector<float>, 4> rows;
    for (auto& row : rows) {
      for (int x = 0; x < width + kGuard; ++x) {
        row.push_back(random() % 9 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                        : static_cast<float>(random() % 1000) * 1e-6F);
      }
    }
    const bool inside = random() % 4 != 0;
    kernels.finish_sigma(rows[0].data(), inside ? rows[1].data() : nullptr, inside ? rows[2].data() : nullptr, 4, 0.3F,
                         width, rows[3].data());
    return rows[3];
  });
}

TEST(FocusKernels, AddWhatASlopeAddsToSigma) {
  constexpr int kWidth = 40;
  constexpr int kReach = 4;
  const auto plane = [](int x, int y) { return 3e-7F * static_cast<float>(x) - 4e-7F * static_cast<float>(y); };
  std::vector<float> rows[3];
  for (int row = 0; row < 3; ++row) {
    for (int x = 0; x < kWidth; ++x) rows[row].push_back(plane(x, kReach * (row - 1)));
  }
  for (const FocusKernels* kernels : all_focus_kernels()) {
    std::vector<float> sigma(kWidth, 4e-14F);  // variance
    kernels->finish_sigma(rows[1].data(), rows[0].data(), rows[2].data(), kReach, 0.5F, kWidth, sigma.data());
    // A gradient of 5e-7 per pixel, of which half counts, and 2e-7 of its own.
    EXPECT_NEAR(static_cast<double>(sigma[20]), std::hypot(2e-7, 2.5e-7), 1e-12) << kernels->name;
    EXPECT_NEAR(static_cast<double>(sigma[3]), 2e-7, 1e-12) << kernels->name << ": too near the end for a gradient";
  }
}

TEST(FocusKernels, AreThoseThatTheEnvironmentNames) {
  const char* forced = std::getenv("FVD_FORCE_KERNEL");
  if (forced != nullptr && *forced != '\0') {
    EXPECT_EQ(focus_kernels().name, forced);
  } else {
    EXPECT_EQ(focus_kernels().name, all_focus_kernels().back()->name) << "the fastest";
  }
}

}  // namespace
}  // namespace fvd
