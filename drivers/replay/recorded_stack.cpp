#include "drivers/replay/recorded_stack.hpp"

#include <sstream>
#include <string>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

namespace {

std::string shape_text(int width, int height, PixelFormat format) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
         std::to_string(significant_bits(format)) + " bit";
}

/// ", 12 significant bits"; nothing where the files' levels are the slices' as they are.
std::string mapping_text(const GreyMapping& mapping) {
  std::ostringstream text;
  if (mapping.real()) {
    text << ", levels from " << mapping.offset << " to "
         << mapping.offset + max_grey_level(PixelFormat::kMono16) / mapping.scale << " made 16 bit";
  } else if (mapping.bytes_per_sample == 2 && mapping.bits < 16) {
    text << ", " << mapping.bits << " significant bits";
  }
  return text.str();
}

}  // namespace

RecordedStack::RecordedStack(SliceList list, int significant_bits)
    : list_(std::move(list)), mapping_(survey_slices(list_.slices, significant_bits)) {
  list_.description += mapping_text(mapping_);
  SliceImage first;
  read_slice(list_.slices.front(), mapping_, first);
  width_ = first.width;
  height_ = first.height;
  format_ = first.format;
  colour_ = !first.colour.empty();
}

void RecordedStack::read(int index, SliceImage& slice) const {
  const SliceLocation& location = list_.slices.at(static_cast<std::size_t>(index));
  read_slice(location, mapping_, slice);
  if (slice.width != width_ || slice.height != height_ || slice.format != format_) {
    throw Error(ErrorCode::kBadInput, "slice " + location.name() + " in " + location.file.parent_path().string() +
                                          " has " + shape_text(slice.width, slice.height, slice.format) +
                                          ", the first slice " + list_.slices.front().name() + " has " +
                                          shape_text(width_, height_, format_) + ": all must be equal");
  }
}

}  // namespace fvd
