#pragma once

/// Text inside of XML.

#include <string>
#include <string_view>

namespace fvd {

/// For an element, XML 1.0, 2.4. Control characters, of which XML allows few, become blanks. text: UTF-8. context:
/// pure, as the next.
[[nodiscard]] std::string xml_text(std::string_view text);

/// For an attribute between double quotes, XML 1.0, 2.3.
[[nodiscard]] std::string xml_attribute_text(std::string_view text);

}  // namespace fvd
