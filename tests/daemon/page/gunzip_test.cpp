#include "daemon/page/gunzip.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/daemon/page/packed_text.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

TEST(Gunzip, GivesBackWhatWasPacked) {
  for (const std::size_t size : {0U, 1U, 16383U, 16384U, 16385U, 500'000U}) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(i * i % 251);
    EXPECT_EQ(unpacked(test::packed(text)), text) << size;
  }
}

TEST(Gunzip, RefusesWhatIsNone) {
  const std::string whole = test::packed("a page");
  for (const std::string& bad : {std::string(), std::string("no gzip"), whole.substr(0, whole.size() - 1),
                                 whole.substr(0, 12), whole.substr(1)}) {
    test::expect_error(ErrorCode::kInternal, {"cannot be unpacked"}, [&bad] { (void)unpacked(bad); });
  }
  std::string changed = whole;
  changed[changed.size() - 6] = static_cast<char>(changed[changed.size() - 6] ^ 1);
  test::expect_error(ErrorCode::kInternal, {"cannot be unpacked"}, [&changed] { (void)unpacked(changed); });
}

}  // namespace
}  // namespace fvd
