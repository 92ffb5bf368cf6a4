#include "daemon/transport/line_mistakes.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fvd {
namespace {

using testing::HasSubstr;

std::string told(std::string_view line, LineEnd end = LineEnd::kBreak) {
  return std::string(mistake_in(line, end).value_or("nothing"));
}

TEST(LineMistakes, KnowUtf16ByItsMarkAndByHalfACharacter) {
  EXPECT_THAT(told("\xff\xfe{", LineEnd::kNul), HasSubstr("UTF-16"));
  EXPECT_THAT(told("\xfe\xff", LineEnd::kNul), HasSubstr("UTF-16"));
  EXPECT_THAT(told("{", LineEnd::kNul), HasSubstr("UTF-16"));
  EXPECT_THAT(told("[", LineEnd::kNul), HasSubstr("UTF-16"));
}

TEST(LineMistakes, KnowLengthsBeforeTheText) {
  for (const char* line : {"46{\"jsonrpc\"", "0046 {\"", "46:{\"", "4711", "Content-Length: 46", "\x01\x2e{\"json",
                           "\x2e{\"jsonrpc\"", "\x01\x02\x03\x04[{"}) {
    EXPECT_THAT(told(line), HasSubstr("length")) << line;
  }
  EXPECT_THAT(told("\x2e", LineEnd::kNul), HasSubstr("length")) << "little endian: the high byte ended the line";
  EXPECT_THAT(told("46{\"jsonrpc\"", LineEnd::kNone), HasSubstr("length")) << "the end of such a text never comes";
}

TEST(LineMistakes, LetJsonAndWhatMayStillBecomeJsonPass) {
  for (const char* line : {"{\"jsonrpc\":\"2.0\"}", " \t{\"a\":1}", "[{\"a\":1}]", "\xef\xbb\xbf{\"a\":1}", "\"a{b\"",
                           "nonsense with {\"a\":1}", "{", "null", ""}) {
    EXPECT_EQ(told(line, LineEnd::kNone), "nothing") << line;
  }
  EXPECT_EQ(told("{\"a\":1}", LineEnd::kNul), "nothing");
  EXPECT_EQ(told("46", LineEnd::kNone), "nothing");
}

TEST(LineMistakes, TellAWholeTextWithoutAnEndFromHalfAText) {
  EXPECT_THAT(missing_end("{\"a\":1}"), HasSubstr("no end of line"));
  EXPECT_THAT(missing_end("{\"a\":"), HasSubstr("within a line"));
}

}  // namespace
}  // namespace fvd
