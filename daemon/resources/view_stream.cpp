#include "daemon/resources/view_stream.hpp"

#include <algorithm>

namespace fvd {

namespace {

constexpr int kPiece_bytes = 256 << 10;

}  // namespace

std::string ViewStream::next() {
  if (!begun_) {
    begun_ = true;
    return view_.header();
  }
  if (plane_ == view_.planes()) return {};
  const int row_bytes = static_cast<int>(sizeof(float)) * view_.width();
  const int end = std::min(view_.height(), row_ + std::max(1, kPiece_bytes / row_bytes));
  std::string piece = view_.rows(plane_, row_, end);
  row_ = end;
  if (row_ == view_.height()) {
    row_ = 0;
    ++plane_;
  }
  return piece;
}

}  // namespace fvd
