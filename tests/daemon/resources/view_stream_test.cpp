#include "daemon/resources/view_stream.hpp"

#include "tests/daemon/views/made_maps.hpp"

namespace fvd {
namespace {

TEST(ViewStream, GivesTheViewInPieces) {
  const auto map = test::rows_of(test::rough(900, 700, 0.2));
  for (const int most : {1, 300, 500, 900}) {
    const HeightView view(map, {0, 0, 900, 700}, most, BlockValue::kMean);
    ViewStream stream(view);
    std::string bytes;
    for (std::string piece = stream.next(); !piece.empty(); piece = stream.next()) {
      EXPECT_LE(piece.size(), 256U << 10U);
      bytes += piece;
    }
    EXPECT_TRUE(bytes == view.whole()) << most;
    EXPECT_EQ(stream.next(), "");
  }
}

}  // namespace
}  // namespace fvd
