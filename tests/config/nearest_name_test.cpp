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
  EXPECT_EQ(did_you_mean("sigma_u", kKnownNames), "; did you mean 'sigma_um'?");
  EXPECT_EQ(did_you_mean("ab", {"ac", "ad"}), "; did you mean 'ac'?") << "of several the first";
}

TEST(NearestName, IsTheLongerOneWhereAWordOfItIsLeftOut) {
  EXPECT_EQ(did_you_mean("sigma", kKnownNames), "; did you mean 'sigma_um'?");
  EXPECT_EQ(did_you_mean("sig", kKnownNames), "") << "half a word";
  EXPECT_EQ(did_you_mean("serial", {"serial_baud", "serial_device", "serialization"}),
            "; did you mean 'serial_baud' or 'serial_device'?");
  EXPECT_EQ(did_you_mean("q", {"q_1234", "q_2345", "q_3456", "q_4567"}),
            "; did you mean 'q_1234' or 'q_2345' or 'q_3456'?");
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
