#include "daemon/export/xml_text.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(XmlText, EscapesWhatMarkupIsMadeOf) {
  EXPECT_EQ(xml_text("a < b && \"c\" > 'd' µm"), "a &lt; b &amp;&amp; \"c\" &gt; 'd' µm");
  EXPECT_EQ(xml_attribute_text("\"c\" & <d>"), "&quot;c&quot; &amp; &lt;d&gt;");
}

TEST(XmlText, HasNoControlCharacters) {
  EXPECT_EQ(xml_text(std::string_view("a\0b\x01"
                                      "c\n\x1f"
                                      "d",
                                      8)),
            "a b c  d");
  EXPECT_EQ(xml_attribute_text("part\t7\r"), "part 7 ");
}

}  // namespace
}  // namespace fvd
