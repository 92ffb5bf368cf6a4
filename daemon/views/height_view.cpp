#include "daemon/views/height_view.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

namespace fvd {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");

constexpr std::uint32_t kVersion1 = 1;

int rounded_up(int points, int factor) { return (points + factor - 1) / factor; }

}  // namespace

HeightView::HeightView(std::shared_ptr<const MapRows> map, const ViewWindow& window, int most, BlockValue value)
    : map_(std::move(map)),
      window_(window),
      value_(value),
      factor_(rounded_up(std::max(window.width, window.height), most)),
      width_(rounded_up(window.width, factor_)),
      height_(rounded_up(window.height, factor_)) {}

std::uint64_t HeightView::bytes() const noexcept {
  return kHeader_bytes + sizeof(float) * static_cast<std::uint64_t>(planes()) * static_cast<std::uint64_t>(width_) *
                             static_cast<std::uint64_t>(height_);
}

std::string HeightView::header() const {
  const auto number = [](int value) { return static_cast<std::uint32_t>(value); };
  const GridSize size = map_->size();
  const std::array<std::uint32_t, 7> numbers{kVersion1,        number(width_),     number(height_),    number(factor_),
                                             number(planes()), number(size.width), number(size.height)};
  std::string header(kHeader_bytes, '\0');
  std::memcpy(header.data(), "FVDH", 4);
  std::memcpy(header.data() + 4, numbers.data(), sizeof numbers);
  return header;
}

template <typename Put>
void HeightView::make(int first, int end, const Put& put) const {
  std::vector<float> points(static_cast<std::size_t>(window_.width));
  if (factor_ == 1) {
    for (int y = first; y < end; ++y) {
      map_->read(window_.x, window_.y + y, window_.width, points.data());
      put(0, y, points);
    }
    return;
  }
  const auto reducer = make_block_reducer(value_, window_.width, factor_);
  std::array<std::vector<float>, 3> planes;
  for (std::vector<float>& plane : planes) plane.resize(static_cast<std::size_t>(width_));
  for (int y = first; y < end; ++y) {
    reducer->begin();
    const int last = std::min(window_.height, (y + 1) * factor_);
    for (int row = y * factor_; row < last; ++row) {
      map_->read(window_.x, window_.y + row, window_.width, points.data());
      reducer->add(points.data());
    }
    reducer->finish(planes[0].data(), planes[1].data(), planes[2].data());
    for (int plane = 0; plane < 3; ++plane) put(plane, y, planes[static_cast<std::size_t>(plane)]);
  }
}

std::string HeightView::whole() const {
  std::string view = header();
  view.resize(static_cast<std::size_t>(bytes()));
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(width_);
  make(0, height_, [&](int plane, int y, const std::vector<float>& values) {
    const auto row = static_cast<std::size_t>(plane) * static_cast<std::size_t>(height_) + static_cast<std::size_t>(y);
    std::memcpy(view.data() + kHeader_bytes + row * row_bytes, values.data(), row_bytes);
  });
  return view;
}

std::string HeightView::rows(int plane, int first, int end) const {
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(width_);
  std::string made_rows;
  made_rows.reserve(row_bytes * static_cast<std::size_t>(end - first));
  make(first, end, [&](int made, int /*y*/, const std::vector<float>& values) {
    if (made == plane) made_rows.append(reinterpret_cast<const char*>(values.data()), row_bytes);
  });
  return made_rows;
}

}  // namespace fvd
