#include "daemon/export/xml_text.hpp"

namespace fvd {

namespace {

std::string escaped(std::string_view text, bool quotes) {
  std::string xml;
  for (const char c : text) {
    if (c == '<') {
      xml += "&lt;";
    } else if (c == '>') {
      xml += "&gt;";
    } else if (c == '&') {
      xml += "&amp;";
    } else if (quotes && c == '"') {
      xml += "&quot;";
    } else {
      xml += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return xml;
}

}  // namespace

std::string xml_text(std::string_view text) { return escaped(text, false); }

std::string xml_attribute_text(std::string_view text) { return escaped(text, true); }

}  // namespace fvd
