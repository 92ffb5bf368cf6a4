/// The order and the types of main.xml's elements, as the schema iso5436_2.xsd of ISO 5436-2:2012 (openGPS) has them:
/// its types are sequences, so that the order is part of the format.

#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "daemon/export/surface_writers.hpp"

namespace fvd {
namespace {

struct Element {
  std::string name;
  std::string type;  ///< a regular expression of the whole text; of an element with children empty
  std::vector<Element> children = {};
  bool optional = false;
};

const std::string kText = "[^]+";
const std::string kNumber = "[-+]?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([eE][-+]?[0-9]+)?";
const std::string kSize = "[1-9][0-9]*";
const std::string kDateTime =
    "-?[0-9]{4,}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}(\\.[0-9]+)?(Z|[-+][0-9]{2}:[0-9]{2})?";
const std::string kMd5 = "[0-9a-fA-F]{32}";

Element axis(const std::string& name, const std::string& type) {
  return {name,
          "",
          {{"AxisType", type},
           {"DataType", "I|L|F|D", {}, true},
           {"Increment", kNumber, {}, true},
           {"Offset", kNumber, {}, true},
           {"Rotation", "", {}, true}}};
}

std::vector<Element> schema() {
  return {{"Record1",
           "",
           {{"Revision", "ISO5436 - 2000"},
            {"FeatureType", "PRF|SUR|PCL"},
            {"Axes", "", {axis("CX", "I|A"), axis("CY", "I|A"), axis("CZ", "A")}}}},
          {"Record2",
           "",
           {{"Date", kDateTime},
            {"Creator", kText, {}, true},
            {"Instrument", "", {{"Manufacturer", kText}, {"Model", kText}, {"Serial", kText}, {"Version", kText}}},
            {"CalibrationDate", kDateTime},
            {"ProbingSystem", "", {{"Type", "Contacting|NonContacting|Software"}, {"Identification", kText}}},
            {"Comment", kText, {}, true}}},
          {"Record3",
           "",
           {{"MatrixDimension", "", {{"SizeX", kSize}, {"SizeY", kSize}, {"SizeZ", kSize}}},
            {"DataLink",
             "",
             {{"PointDataLink", kText},
              {"MD5ChecksumPointData", kMd5},
              {"ValidPointsLink", kText, {}, true},
              {"MD5ChecksumValidPoints", kMd5, {}, true}}}}},
          {"Record4", "", {{"ChecksumFile", kText}}}};
}

void expect_sequence(const pugi::xml_node& parent, const std::vector<Element>& sequence) {
  SCOPED_TRACE(parent.name());
  pugi::xml_node node = parent.first_child();
  for (const Element& element : sequence) {
    if (node.name() != element.name) {
      EXPECT_TRUE(element.optional) << element.name << " is missing, there is <" << node.name() << ">";
      continue;
    }
    if (element.children.empty()) {
      EXPECT_TRUE(std::regex_match(node.child_value(), std::regex(element.type)))
          << element.name << ": " << node.child_value();
    } else {
      expect_sequence(node, element.children);
    }
    node = node.next_sibling();
  }
  EXPECT_TRUE(node.empty()) << "<" << node.name() << "> is not of the schema";
}

/// The first entry of the archive, which is stored and not compressed.
std::string main_xml_of(const Surface& surface, const SurfaceOrigin& origin) {
  const std::string bytes = surface_bytes(*find_surface_writer("x3p"), surface_view(surface, origin));
  const std::size_t begin = bytes.find("<?xml");
  const std::size_t end = bytes.find("</p:ISO5436_2>");
  return bytes.substr(begin, end + std::string("</p:ISO5436_2>").size() - begin);
}

TEST(X3pOrder, IsThatOfThePublishedSchema) {
  Surface surface;
  surface.height_m = Plane<float>(4, 3, 1e-6F);
  surface.pitch_x_um = 0.48;
  surface.pitch_y_um = 0.51;
  SurfaceOrigin full;
  full.title = "<part> & more";
  full.source = "camera \xC3\xA9";
  full.software_version = "1.2";
  full.simulated = true;
  for (const SurfaceOrigin& origin : {SurfaceOrigin{}, full}) {
    pugi::xml_document document;
    const std::string xml = main_xml_of(surface, origin);

    ASSERT_TRUE(document.load_buffer(xml.data(), xml.size())) << xml;

    const pugi::xml_node root = document.document_element();
    EXPECT_STREQ(root.name(), "p:ISO5436_2");
    EXPECT_STREQ(root.attribute("xmlns:p").value(), "http://www.opengps.eu/2008/ISO5436_2");
    expect_sequence(root, schema());
  }
}

}  // namespace
}  // namespace fvd
