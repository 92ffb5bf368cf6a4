#include "core/focus/streaming_focus_stack.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/focus/focus_point.hpp"
#include "core/focus/peak_accumulator.hpp"
#include "core/focus/sharpness_rows.hpp"
#include "core/pipeline/worker_pool.hpp"

namespace fvd {

namespace {

/// The stack for one pixel type. The image is cut into as many bands of rows as there are threads; a band recomputes
/// the few rows of its neighbours that its windows reach into, so no thread waits for another.
template <typename Pixel>
class TypedStack {
 public:
  TypedStack(int width, int height, const FocusSettings& settings, int bands) : height_(height), peaks_(width, height) {
    for (int band = 0; band < bands; ++band) scanners_.emplace_back(width, settings.window_px, settings.distance_px);
  }

  void push(PlaneView<const Pixel> slice, int saturation, int index, WorkerPool& pool) {
    const int bands = static_cast<int>(scanners_.size());
    const auto scan_band = [&](int band) {
      const int first = height_ * band / bands;
      const int end = height_ * (band + 1) / bands;
      if (first == end) return;
      auto& scanner = scanners_[static_cast<std::size_t>(band)];
      scanner.begin(slice, first, saturation);
      for (int y = first; y < end; ++y) {
        scanner.next();
        if (index == 0) {
          start_peaks(peaks_.row(y), scanner.sharpness(), scanner.saturated(), slice.row(y), slice.width);
        } else {
          update_peaks(peaks_.row(y), scanner.sharpness(), scanner.saturated(), slice.row(y), slice.width, index);
        }
      }
    };
    pool.run(bands, std::ref(scan_band));  // by reference: a copy of the captures would be allocated
  }

  void resolve_row(int y, const std::vector<double>& z_um, PeakMethod method, double min_prominence, HeightMap& map) {
    const auto row = peaks_.row(y);
    for (int x = 0; x < map.height_m.width(); ++x) {
      const FocusPoint point = resolve_point(
          {row.left[x], row.peak[x], row.right[x], row.minimum[x], row.peak_index[x], row.saturated[x] != 0}, z_um,
          method, min_prominence);
      map.height_m.at(x, y) = point.height_m;
      map.mask.at(x, y) = point.mask;
      map.prominence.at(x, y) = point.prominence;
      map.texture.at(x, y) = row.texture[x];
    }
  }

  [[nodiscard]] std::size_t state_bytes() const { return peaks_.memory_bytes(); }

  [[nodiscard]] static std::size_t memory_bytes(int width, int height, int window, int bands) {
    return PeakAccumulator<Pixel>::memory_bytes(width, height) +
           static_cast<std::size_t>(bands) * SharpnessRows<Pixel>::memory_bytes(width, window);
  }

 private:
  int height_;
  PeakAccumulator<Pixel> peaks_;
  std::vector<SharpnessRows<Pixel>> scanners_;  // one a band
};

std::string shape(int width, int height, PixelFormat format) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
         std::to_string(significant_bits(format)) + " bit";
}

constexpr std::size_t kMapBytesPerPixel =
    sizeof(float) + sizeof(std::uint8_t) + sizeof(float) + sizeof(std::uint16_t);  // HeightMap's planes

}  // namespace

struct StreamingFocusStack::Impl {
  using Typed = std::variant<TypedStack<std::uint8_t>, TypedStack<std::uint16_t>>;

  static Typed make(int width, int height, PixelFormat format, const FocusSettings& settings, int bands) {
    if (format == PixelFormat::kMono8) return TypedStack<std::uint8_t>(width, height, settings, bands);
    return TypedStack<std::uint16_t>(width, height, settings, bands);
  }

  Impl(int w, int h, PixelFormat f, const FocusSettings& s, WorkerPool& p)
      : width(w), height(h), format(f), settings(s), pool(&p), stack(make(w, h, f, s, p.threads())) {
    z_um.reserve(kMaxSlices);
  }

  /// Throws Error kBadSlice for a slice that cannot be the next one.
  void check(const ImageView& slice, double z) const {
    if (slice.width != width || slice.height != height || slice.format != format) {
      throw Error(ErrorCode::kBadSlice, "slice " + std::to_string(z_um.size()) + " has " +
                                            shape(slice.width, slice.height, slice.format) + ", the stack " +
                                            shape(width, height, format));
    }
    if (!(std::abs(z) <= kMaxHeight_um)) {
      throw Error(ErrorCode::kBadSlice, "slice " + std::to_string(z_um.size()) + " has a z of " + std::to_string(z) +
                                            " um: must be a number within +-1e9 um");
    }
    if (z_um.size() == kMaxSlices) {
      throw Error(ErrorCode::kBadSlice,
                  "the stack holds its " + std::to_string(kMaxSlices) + " slices; scan in larger steps");
    }
  }

  int width;
  int height;
  PixelFormat format;
  FocusSettings settings;
  WorkerPool* pool;
  Typed stack;
  std::vector<double> z_um;
};

StreamingFocusStack::StreamingFocusStack(int width, int height, PixelFormat format, const FocusSettings& settings,
                                         WorkerPool& pool) {
  check_focus_settings(settings);
  if (width < 1 || height < 1) {
    throw Error(ErrorCode::kBadInput,
                "slices of " + shape(width, height, format) + ": width and height must be at least 1");
  }
  impl_ = std::make_unique<Impl>(width, height, format, settings, pool);
}

StreamingFocusStack::~StreamingFocusStack() = default;
StreamingFocusStack::StreamingFocusStack(StreamingFocusStack&&) noexcept = default;
StreamingFocusStack& StreamingFocusStack::operator=(StreamingFocusStack&&) noexcept = default;

void StreamingFocusStack::push(const ImageView& slice, double z_um) {
  impl_->check(slice, z_um);
  const int index = slices();
  const int saturation = max_grey_level(slice.format);
  if (auto* narrow = std::get_if<TypedStack<std::uint8_t>>(&impl_->stack)) {
    narrow->push(slice.as<std::uint8_t>(), saturation, index, *impl_->pool);
  } else {
    std::get<TypedStack<std::uint16_t>>(impl_->stack).push(slice.as<std::uint16_t>(), saturation, index, *impl_->pool);
  }
  impl_->z_um.push_back(z_um);
}

int StreamingFocusStack::slices() const noexcept { return static_cast<int>(impl_->z_um.size()); }

double StreamingFocusStack::state_bytes_per_pixel() const noexcept {
  const auto bytes = std::visit([](const auto& stack) { return stack.state_bytes(); }, impl_->stack);
  return static_cast<double>(bytes) / (static_cast<double>(impl_->width) * impl_->height);
}

std::size_t StreamingFocusStack::memory_bytes(int width, int height, PixelFormat format, const FocusSettings& settings,
                                              int threads) {
  const std::size_t typed = format == PixelFormat::kMono8
                                ? TypedStack<std::uint8_t>::memory_bytes(width, height, settings.window_px, threads)
                                : TypedStack<std::uint16_t>::memory_bytes(width, height, settings.window_px, threads);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return typed + pixels * kMapBytesPerPixel + kMaxSlices * sizeof(double);
}

HeightMap StreamingFocusStack::finish(PeakMethod method) const {
  if (impl_->z_um.empty()) throw Error(ErrorCode::kBadSlice, "a height map needs slices; there are none");
  const int width = impl_->width;
  const int height = impl_->height;
  HeightMap map{Plane<float>(width, height), Plane<std::uint8_t>(width, height), Plane<float>(width, height),
                impl_->format, Plane<std::uint16_t>(width, height)};
  const int bands = impl_->pool->threads();
  impl_->pool->run(bands, [&](int band) {
    for (int y = height * band / bands; y < height * (band + 1) / bands; ++y) {
      std::visit([&](auto& stack) { stack.resolve_row(y, impl_->z_um, method, impl_->settings.min_prominence, map); },
                 impl_->stack);
    }
  });
  return map;
}

}  // namespace fvd
