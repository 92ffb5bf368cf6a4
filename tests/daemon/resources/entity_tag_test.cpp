#include "daemon/resources/entity_tag.hpp"

#include <string>

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(EntityTag, IsNamedInAList) {
  const std::string tag = R"("12-ab")";
  for (const std::string list : {R"("12-ab")", R"(W/"12-ab")", R"("x", "12-ab")", R"("x","y" , W/"12-ab")",
                                 R"( "12-ab" )", "*", " * ", R"(,, "12-ab")", R"("a,b", "12-ab")", R"("", "12-ab")"}) {
    EXPECT_TRUE(names_entity(list, tag)) << list;
  }
}

TEST(EntityTag, IsNotNamedByWhatOnlyLooksLikeIt) {
  const std::string tag = R"("12-ab")";
  for (const std::string list :
       {"", "12-ab", R"("12-AB")", R"("12-ab)", R"("12-ab" "x")", R"(w/"12-ab")", R"("x"; "12-ab")", R"("12-abc")",
        "**", R"(*, "x")", R"("x" x, "12-ab")", R"(W/)", ","}) {
    // The whole of "12-ab" at the beginning is named before anything is wrong.
    const bool begins = list.rfind(tag, 0) == 0;
    EXPECT_EQ(names_entity(list, tag), begins) << list;
  }
  EXPECT_FALSE(names_entity(std::string(10240, '"'), tag));
  EXPECT_FALSE(names_entity(std::string(10240, ','), tag));
}

TEST(EntityTag, OfARangeIsTheSameStrongOne) {
  const std::string tag = R"("12-ab")";
  EXPECT_TRUE(is_same_entity(R"("12-ab")", tag));
  EXPECT_TRUE(is_same_entity(R"( "12-ab" )", tag));
  EXPECT_FALSE(is_same_entity(R"(W/"12-ab")", tag));
  EXPECT_FALSE(is_same_entity("Mon, 30 Nov 2026 10:00:00 GMT", tag));
  EXPECT_FALSE(is_same_entity("*", tag));
  EXPECT_FALSE(is_same_entity("", tag));
}

}  // namespace
}  // namespace fvd
