#include "daemon/export/ome_xml.hpp"

#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "daemon/export/xml_text.hpp"
#include "daemon/report/time_text.hpp"

namespace fvd {

namespace {

constexpr const char* kNamespace = "http://www.openmicroscopy.org/Schemas/OME/2016-06";

std::string number_text(double number) {
  char text[32];
  return {std::begin(text), std::to_chars(std::begin(text), std::end(text), number).ptr};
}

/// ' Name="text"'.
std::string attribute(std::string_view name, std::string_view text) {
  return " " + std::string(name) + "=\"" + xml_attribute_text(text) + "\"";
}
std::string attribute(std::string_view name, int number) { return attribute(name, std::to_string(number)); }

std::string length_um(const std::string& name, double um) {
  return attribute(name, number_text(um)) + attribute(name + "Unit", "µm");
}

std::string pixels_head(const OmeStack& stack) {
  std::string xml = "<Pixels" + attribute("ID", "Pixels:0") + attribute("DimensionOrder", "XYZCT") +
                    attribute("Type", bytes_per_pixel(stack.format) == 1 ? "uint8" : "uint16") +
                    attribute("SignificantBits", significant_bits(stack.format)) + attribute("BigEndian", "false") +
                    attribute("SizeX", stack.width) + attribute("SizeY", stack.height) +
                    attribute("SizeZ", stack.slices()) + attribute("SizeC", 1) + attribute("SizeT", 1);
  if (stack.pitch_x_um && stack.pitch_y_um) {
    xml += length_um("PhysicalSizeX", *stack.pitch_x_um) + length_um("PhysicalSizeY", *stack.pitch_y_um);
  }
  // The schema allows no sign: which way the scan went is told by the planes.
  if (stack.step_um && *stack.step_um != 0.0) xml += length_um("PhysicalSizeZ", std::abs(*stack.step_um));
  return xml + ">";
}

std::string plane(const OmeStack& stack, int index) {
  std::string xml = "<Plane" + attribute("TheZ", index) + attribute("TheC", 0) + attribute("TheT", 0);
  if (stack.exposure_us) {
    xml += attribute("ExposureTime", number_text(*stack.exposure_us)) + attribute("ExposureTimeUnit", "µs");
  }
  return xml + length_um("PositionZ", stack.z_um[static_cast<std::size_t>(index)]) + "/>\n";
}

}  // namespace

std::string ome_xml(const OmeStack& stack) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OME" + attribute("xmlns", kNamespace) +
                    attribute("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance") +
                    attribute("xsi:schemaLocation", std::string(kNamespace) + " " + kNamespace + "/ome.xsd") +
                    attribute("Creator", stack.software) + ">\n<Image" + attribute("ID", "Image:0") +
                    attribute("Name", stack.name) + ">\n<AcquisitionDate>" + iso_time_text(stack.acquired) +
                    "</AcquisitionDate>\n";
  if (!stack.description.empty()) xml += "<Description>" + xml_text(stack.description) + "</Description>\n";
  xml += pixels_head(stack) + "\n<Channel" + attribute("ID", "Channel:0:0") + attribute("SamplesPerPixel", 1) +
         "/>\n<TiffData" + attribute("IFD", 0) + attribute("FirstZ", 0) + attribute("FirstC", 0) +
         attribute("FirstT", 0) + attribute("PlaneCount", stack.slices()) + "/>\n";
  for (int index = 0; index < stack.slices(); ++index) xml += plane(stack, index);
  return xml + "</Pixels>\n</Image>\n</OME>\n";
}

}  // namespace fvd
