#include "core/focus/streaming_focus_stack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/colour_texture.hpp"
#include "core/focus/fit/map_finish.hpp"
#include "core/focus/measure/noise_probe.hpp"
#include "core/focus/measure/peak_accumulator.hpp"
#include "core/focus/measure/sharpness_rows.hpp"
#include "core/focus/measure/slice_binner.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

namespace {

/// The stack for one pixel type. The image is cut into as many bands of rows as there are threads; a band recomputes
/// the few rows of its neighbours that its windows reach into, so no thread waits for another. Slices that come
/// together go row by row: the state of a row stays in the cache while all of them are taken in.
template <typename Pixel>
class TypedStack {
 public:
  TypedStack(int width, int height, PixelFormat format, const FocusSettings& settings, WorkerPool& pool, bool colour,
             const KeptPagesPtr& pages)
      : height_(height),
        parts_(state_parts(settings, format)),
        peaks_(width, height, parts_, pages),
        colour_(colour ? width : 0, colour ? height : 0, settings.bin_slices),
        settings_(settings) {
    const int bands = pool.threads();
    for (int band = 0; band < bands; ++band) {
      auto& lanes = bands_.emplace_back(SliceBinner<Pixel>(width, settings.bin_slices));
      for (int k = 0; k < StreamingFocusStack::kMaxBatch; ++k) lanes.scanners.emplace_back(width, settings, format);
    }
    pool.run(bands, [&](int band) { peaks_.touch_rows(height * band / bands, height * (band + 1) / bands); });
  }

  void push(std::span<const ZSlice> slices, int index, WorkerPool& pool) {
    const int bands = static_cast<int>(bands_.size());
    const auto scan_band = [&](int number) {
      const int first = height_ * number / bands;
      const int end = height_ * (number + 1) / bands;
      if (first == end) return;
      Band& band = bands_[static_cast<std::size_t>(number)];
      for (std::size_t k = 0; k < slices.size(); ++k) {
        band.scanners[k].begin(slices[k].image.as<Pixel>(), first, slices[k].gain);
      }
      for (int y = first; y < end; ++y) {
        const auto row = peaks_.row(y);
        std::array<Sample<Pixel>, StreamingFocusStack::kMaxBatch> samples;
        for (std::size_t k = 0; k < slices.size(); ++k) {
          auto& scanner = band.scanners[k];
          scanner.next();
          samples[k] = {scanner.codes(), scanner.clipped(), slices[k].image.as<Pixel>().row(y)};
        }
        band.binner.add(row, std::span(samples).first(slices.size()), index);
        colour_.add_row(y, row.curve.peak_index, slices, index);
      }
    };
    pool.run(bands, std::ref(scan_band));  // by reference: a copy of the captures would be allocated
  }

  HeightMap finish(const SampleHeights& heights, PeakMethod method, const NoiseProbe& noise, HeightMap map,
                   WorkerPool& pool) {
    const int width = map.height_m.width();
    if (!colour_.empty()) map.colour = Plane<std::uint8_t>::unset(3 * width, height_);
    // An incomplete last bin is taken in on a copy: more slices may come.
    struct Lane {
      PeakAccumulator<Pixel> copy;
      SliceBinner<Pixel> binner;
    };
    std::vector<Lane> lanes;
    if (heights.pending() > 0) {
      for (int i = 0; i < pool.threads(); ++i) lanes.push_back({{width, 1, parts_}, {width, settings_.bin_slices}});
    }
    const auto curves = [&](int thread, int y, std::uint16_t* texture) {
      StateRow<Pixel> row = peaks_.row(y);
      if (!lanes.empty()) {
        Lane& lane = lanes[static_cast<std::size_t>(thread)];
        lane.copy.copy_row(peaks_, y);
        row = lane.copy.row(0);
        lane.binner.close(row, heights.samples(), heights.pending());
      }
      if (texture != nullptr) {
        if constexpr (sizeof(Pixel) == 1) {
          focus_kernels().widen_u8(row.texture, row.curve.pitch_bytes, width, texture);
        } else {
          std::copy_n(row.texture, width, texture);
        }
        const int pending = lanes.empty() ? -1 : heights.samples() - 1;
        if (!colour_.empty()) colour_.copy_row(y, row.curve.peak_index, pending, map.colour.row(y));
      }
      return row.curve;
    };
    finish_map(curves, heights.means_um(), settings_, method, noise, pool, map);
    return map;
  }

  [[nodiscard]] std::size_t state_bytes() const { return peaks_.memory_bytes() + colour_.memory_bytes(); }
  [[nodiscard]] bool colour() const { return !colour_.empty(); }

  [[nodiscard]] static std::size_t memory_bytes(int width, int height, PixelFormat format,
                                                const FocusSettings& settings, int bands) {
    return PeakAccumulator<Pixel>::memory_bytes(width, height, state_parts(settings, format)) +
           static_cast<std::size_t>(bands) * StreamingFocusStack::kMaxBatch *
               SharpnessRows<Pixel>::memory_bytes(width, settings);
  }

 private:
  struct Band {
    explicit Band(SliceBinner<Pixel> b) : binner(std::move(b)) {}
    SliceBinner<Pixel> binner;
    std::vector<SharpnessRows<Pixel>> scanners;  // one per slice of a batch
  };

  int height_;
  StateParts parts_;
  PeakAccumulator<Pixel> peaks_;
  ColourTexture colour_;
  FocusSettings settings_;
  std::vector<Band> bands_;  // one per thread
};

std::string shape(int width, int height, PixelFormat format) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
         std::to_string(significant_bits(format)) + " bit";
}

constexpr std::size_t kMapBytesPerPixel =
    3 * sizeof(float) + sizeof(MaskReasons) + sizeof(std::uint16_t);  // HeightMap's planes

}  // namespace

struct StreamingFocusStack::Impl {
  using Typed = std::variant<TypedStack<std::uint8_t>, TypedStack<std::uint16_t>>;

  static Typed make(int width, int height, PixelFormat format, const FocusSettings& settings, WorkerPool& pool,
                    bool colour, const KeptPagesPtr& pages) {
    if (format == PixelFormat::kMono8)
      return TypedStack<std::uint8_t>(width, height, format, settings, pool, colour, pages);
    return TypedStack<std::uint16_t>(width, height, format, settings, pool, colour, pages);
  }

  Impl(int w, int h, PixelFormat f, const FocusSettings& s, WorkerPool& p, bool colour, KeptPagesPtr kept)
      : width(w),
        height(h),
        format(f),
        settings(s),
        pool(&p),
        pages(std::move(kept)),
        stack(make(w, h, f, s, p, colour, pages)),
        heights(s.bin_slices, kMaxSlices),
        noise(w, h) {}

  /// Throws Error kBadSlice for a slice that cannot be the one of this number.
  void check(const ImageView& slice, double z, int number) const {
    if (slice.width != width || slice.height != height || slice.format != format) {
      throw Error(ErrorCode::kBadSlice, "slice " + std::to_string(number) + " has " +
                                            shape(slice.width, slice.height, slice.format) + ", the stack " +
                                            shape(width, height, format));
    }
    if (!(std::abs(z) <= kMaxHeight_um)) {
      throw Error(ErrorCode::kBadSlice, "slice " + std::to_string(number) + " has a z of " + std::to_string(z) +
                                            " um: must be a number within +-1e9 um");
    }
    if (number >= kMaxSlices) {
      throw Error(ErrorCode::kBadSlice,
                  "the stack holds its " + std::to_string(kMaxSlices) + " slices; scan in larger steps");
    }
  }

  int width;
  int height;
  PixelFormat format;
  FocusSettings settings;
  WorkerPool* pool;
  KeptPagesPtr pages;
  Typed stack;
  SampleHeights heights;
  NoiseProbe noise;
};

StreamingFocusStack::StreamingFocusStack(int width, int height, PixelFormat format, const FocusSettings& settings,
                                         WorkerPool& pool, bool colour, KeptPagesPtr pages) {
  check_focus_settings(settings);
  if (width < 1 || height < 1) {
    throw Error(ErrorCode::kBadInput,
                "slices of " + shape(width, height, format) + ": width and height must be at least 1");
  }
  impl_ = std::make_unique<Impl>(width, height, format, settings, pool, colour, std::move(pages));
}

StreamingFocusStack::~StreamingFocusStack() = default;
StreamingFocusStack::StreamingFocusStack(StreamingFocusStack&&) noexcept = default;
StreamingFocusStack& StreamingFocusStack::operator=(StreamingFocusStack&&) noexcept = default;

void StreamingFocusStack::push(const ImageView& slice, double z_um) {
  const ZSlice one{slice, z_um};
  push(std::span(&one, 1));
}

void StreamingFocusStack::push(std::span<const ZSlice> slices) {
  for (std::size_t k = 0; k < slices.size(); ++k) {
    impl_->check(slices[k].image, slices[k].z_um, this->slices() + static_cast<int>(k));
    if (slices[k].colour == nullptr && std::visit([](const auto& stack) { return stack.colour(); }, impl_->stack)) {
      throw Error(ErrorCode::kBadSlice, "slice " + std::to_string(this->slices() + static_cast<int>(k)) +
                                            " is grey, the ones before it are in colour");
    }
  }
  for (std::size_t first = 0; first < slices.size(); first += kMaxBatch) {
    const auto batch = slices.subspan(first, std::min<std::size_t>(kMaxBatch, slices.size() - first));
    std::visit([&](auto& stack) { stack.push(batch, this->slices(), *impl_->pool); }, impl_->stack);
    for (const ZSlice& slice : batch) {
      impl_->noise.add(slice.image, *impl_->pool);
      impl_->heights.push(slice.z_um);
    }
  }
}

int StreamingFocusStack::slices() const noexcept { return impl_->heights.slices(); }

double StreamingFocusStack::state_bytes_per_pixel() const noexcept {
  const auto bytes = std::visit([](const auto& stack) { return stack.state_bytes(); }, impl_->stack);
  return static_cast<double>(bytes) / (static_cast<double>(impl_->width) * impl_->height);
}

std::size_t StreamingFocusStack::memory_bytes(int width, int height, PixelFormat format, const FocusSettings& settings,
                                              int threads) {
  const std::size_t typed = format == PixelFormat::kMono8
                                ? TypedStack<std::uint8_t>::memory_bytes(width, height, format, settings, threads)
                                : TypedStack<std::uint16_t>::memory_bytes(width, height, format, settings, threads);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return typed + pixels * kMapBytesPerPixel + kMaxSlices * sizeof(double);
}

HeightMap StreamingFocusStack::finish(PeakMethod method) const {
  if (slices() == 0) throw Error(ErrorCode::kBadSlice, "a height map needs slices; there are none");
  return std::visit(
      [&](auto& stack) {
        return stack.finish(impl_->heights, method, impl_->noise,
                            empty_map(impl_->width, impl_->height, impl_->format, impl_->pages), *impl_->pool);
      },
      impl_->stack);
}

}  // namespace fvd
