#include "daemon/surface_files/x3p_main.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <pugixml.hpp>

#include "daemon/export/length_text.hpp"

namespace fvd {

namespace {

/// An element with its place for messages.
class Element {
 public:
  Element(const std::filesystem::path& path, pugi::xml_node node, std::string place)
      : path_(path), node_(node), place_(std::move(place)) {}

  /// The only child of this name; an error where there are several.
  [[nodiscard]] std::optional<Element> find(const char* name) const {
    const pugi::xml_node found = node_.child(name);
    if (found.next_sibling(name)) fail_at(name, "it stands there twice");
    if (!found) return std::nullopt;
    return Element(path_, found, place_of(name));
  }
  [[nodiscard]] Element at(const char* name) const {
    auto found = find(name);
    if (!found) fail_at(name, "it is missing");
    return *found;
  }
  [[nodiscard]] std::string_view text() const { return trimmed(node_.text().get()); }
  [[nodiscard]] double number() const {
    const auto value = number_of(text());
    if (!value || !std::isfinite(*value)) fail("'" + shown() + "' is no number");
    return *value;
  }
  [[nodiscard]] std::int64_t integer() const {
    const auto value = integer_of(text());
    if (!value) fail("'" + shown() + "' is no integer");
    return *value;
  }
  /// 32 hexadecimal digits, in lower case.
  [[nodiscard]] std::string md5() const {
    std::string digits(text());
    for (char& digit : digits) digit = static_cast<char>(std::tolower(static_cast<unsigned char>(digit)));
    if (digits.size() != 32 || digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
      fail("'" + shown() + "' is no MD5 sum");
    }
    return digits;
  }
  [[nodiscard]] std::string shown() const { return std::string(text().substr(0, 80)); }
  [[nodiscard]] const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& reason) const { refuse(path_, place_, reason); }

 private:
  [[nodiscard]] std::string place_of(const char* name) const { return place_ + "/" + name; }
  [[noreturn]] void fail_at(const char* name, const std::string& reason) const {
    refuse(path_, place_of(name), reason);
  }

  const std::filesystem::path& path_;
  pugi::xml_node node_;
  std::string place_;
};

/// The root element. Entities of a document type are neither needed nor read.
pugi::xml_node root_of(const std::filesystem::path& path, pugi::xml_document& document, std::string_view xml) {
  const pugi::xml_parse_result parsed =
      document.load_buffer(xml.data(), xml.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  for (const pugi::xml_node& node : document.children()) {
    if (node.type() == pugi::node_doctype) refuse(path, "main.xml", "a document type, which could hold entities");
  }
  if (!parsed) {
    refuse(path, "main.xml, " + byte_place(static_cast<std::uint64_t>(parsed.offset)), parsed.description());
  }
  const pugi::xml_node root = document.document_element();
  const std::string_view name = root.name();
  if (name.substr(name.find(':') + 1) != "ISO5436_2") {
    refuse(path, "main.xml", "its root is not ISO5436_2 but '" + std::string(name.substr(0, 80)) + "'");
  }
  return root;
}

/// um; axes that list every position are refused.
double lateral_pitch(const std::filesystem::path& path, const Element& axis, const std::optional<double>& given_um) {
  if (axis.at("AxisType").text() != "I") axis.at("AxisType").fail("only axes of equal steps (I) are read");
  const Element increment = axis.at("Increment");
  const auto pitch_um = micrometres_of_text(increment.text());
  if (!pitch_um) increment.fail("'" + increment.shown() + "' is no number");
  if (const auto offset = axis.find("Offset")) static_cast<void>(offset->number());
  return pitch_of(path, increment.place(), pitch_um, given_um);
}

X3pDescription::Type type_of(const Element& axis) {
  const Element type = axis.at("DataType");
  constexpr std::array<std::string_view, 4> kNames{"I", "L", "F", "D"};
  const auto found = std::find(kNames.begin(), kNames.end(), type.text());
  if (found == kNames.end()) type.fail("'" + type.shown() + "' is none of I, L, F and D");
  return static_cast<X3pDescription::Type>(found - kNames.begin());
}

/// Only the matrix that changes nothing.
void check_rotation(const Element& rotation) {
  for (int row = 1; row <= 3; ++row) {
    for (int column = 1; column <= 3; ++column) {
      const std::string name = "r" + std::to_string(row) + std::to_string(column);
      const Element entry = rotation.at(name.c_str());
      if (entry.number() != (row == column ? 1.0 : 0.0)) entry.fail("rotated surfaces are not read");
    }
  }
}

void read_axes(const std::filesystem::path& path, const Element& axes, const SurfaceReadOptions& options,
               X3pDescription& to) {
  if (const auto rotation = axes.find("Rotation")) check_rotation(*rotation);
  to.pitch_x_um = lateral_pitch(path, axes.at("CX"), options.pitch_x_um);
  to.pitch_y_um = lateral_pitch(path, axes.at("CY"), options.pitch_y_um);
  const Element heights = axes.at("CZ");
  if (heights.at("AxisType").text() != "A") heights.at("AxisType").fail("heights must be absolute (A)");
  to.type = type_of(heights);
  const bool is_integer = to.type == X3pDescription::Type::kInt16 || to.type == X3pDescription::Type::kInt32;
  if (is_integer || heights.find("Increment")) to.z_increment_m = heights.at("Increment").number();
  if (to.z_increment_m <= 0.0) heights.at("Increment").fail("it is not above 0");
  if (const auto offset = heights.find("Offset")) to.z_offset_m = offset->number();
}

void read_record_3(const std::filesystem::path& path, const Element& record, X3pDescription& to) {
  if (record.find("ListDimension")) record.at("ListDimension").fail("point lists are not read");
  if (record.find("DataList")) record.at("DataList").fail("heights inside main.xml are not read");
  const Element matrix = record.at("MatrixDimension");
  if (matrix.at("SizeZ").integer() != 1) matrix.at("SizeZ").fail("more than one layer is not read");
  to.size = grid_size(path, matrix.place(), matrix.at("SizeX").integer(), matrix.at("SizeY").integer());
  const Element link = record.at("DataLink");
  to.points_link = link.at("PointDataLink").text();
  to.points_md5 = link.at("MD5ChecksumPointData").md5();
  if (const auto valid = link.find("ValidPointsLink")) {
    to.valid_link = valid->text();
    to.valid_md5 = link.at("MD5ChecksumValidPoints").md5();
    if (to.valid_link.empty()) valid->fail("it is empty");
  }
}

}  // namespace

X3pDescription read_x3p_main(const std::filesystem::path& path, std::string_view xml,
                             const SurfaceReadOptions& options) {
  pugi::xml_document document;
  const Element root(path, root_of(path, document, xml), "main.xml");
  const Element record_1 = root.at("Record1");
  if (const Element revision = record_1.at("Revision"); revision.text() != "ISO5436 - 2000") {
    revision.fail("'" + revision.shown() + "' is not 'ISO5436 - 2000'");
  }
  if (const Element feature = record_1.at("FeatureType"); feature.text() != "SUR") {
    feature.fail("'" + feature.shown() + "' is no surface (SUR)");
  }
  X3pDescription description;
  read_axes(path, record_1.at("Axes"), options, description);
  read_record_3(path, root.at("Record3"), description);
  description.checksum_file = root.at("Record4").at("ChecksumFile").text();
  return description;
}

}  // namespace fvd
