#include "drivers/replay/recorded_stack.hpp"

#include <string>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

namespace {

std::string shape_text(int width, int height, PixelFormat format) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
         std::to_string(significant_bits(format)) + " bit";
}

}  // namespace

RecordedStack::RecordedStack(SliceList list) : list_(std::move(list)) {
  SliceImage first;
  read_slice(list_.slices.front(), first);
  width_ = first.width;
  height_ = first.height;
  format_ = first.format;
  colour_ = !first.colour.empty();
}

void RecordedStack::read(int index, SliceImage& slice) const {
  const SliceLocation& location = list_.slices.at(static_cast<std::size_t>(index));
  read_slice(location, slice);
  if (slice.width != width_ || slice.height != height_ || slice.format != format_) {
    throw Error(ErrorCode::kBadInput, "slice " + location.name() + " in " + location.file.parent_path().string() +
                                          " has " + shape_text(slice.width, slice.height, slice.format) +
                                          ", the first slice " + list_.slices.front().name() + " has " +
                                          shape_text(width_, height_, format_) + ": all must be equal");
  }
}

}  // namespace fvd
