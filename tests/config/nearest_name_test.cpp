/// What somebody may have meant by an unknown name.

#include "config/nearest_name.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fvd {
namespace {

const std::vector<std::string> kKnownNames{"width_um", "height_um", "sigma_um"};

TEST(NearestName, IsTheOneWithTheFewestChanges) {
  EXPECT_EQ(did_you_mean("hight_um", kKnownNames), "; did you mean 'height_um'?");
  EXPECT_EQ(did_you_mean("sigma", kKnownNames), "");
  EXPECT_EQ(did_you_mean("sigma_u", kKnownNames), "; did you mean 'sigma_um'?");
  EXPECT_EQ(did_you_mean("ab", {"ac", "ad"}), "; did you mean 'ac'?") << "of several the first";
}

TEST(NearestName, IsNoneWhereAllAreTooDifferent) {
  EXPECT_EQ(did_you_mean("exposure", kKnownNames), "");
  EXPECT_EQ(did_you_mean("", kKnownNames), "");
  EXPECT_EQ(did_you_mean("width_um", {}), "");
}

TEST(NearestName, IsNotSoughtForWhatIsTooLong) {
  const std::string longest(128, 'a');
  EXPECT_EQ(did_you_mean(longest, {longest + "b"}), "; did you mean '" + longest + "b'?");
  EXPECT_EQ(did_you_mean(longest + "a", {longest + "b"}), "");
  EXPECT_EQ(did_you_mean(std::string(1'000'000, 'a'), std::vector<std::string>(1000, "width_um")), "");
}

}  // namespace
}  // namespace fvd
