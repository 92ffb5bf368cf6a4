/// Writes X3P (ISO 5436-2:2012, openGPS specification rev 110).

#include <cmath>

#include "daemon/export/binary_text.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/export/length_text.hpp"
#include "daemon/export/stored_zip.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/export/xml_text.hpp"

namespace fvd {

namespace {

constexpr const char* kPoints = "bindata/data.bin";
constexpr const char* kValid = "bindata/valid.bin";
constexpr const char* kChecksum = "md5checksum.hex";
/// Stands where a date is not known: the format demands one.
constexpr const char* kNoDate = "1970-01-01T00:00:00Z";

void write_points(const PlaneView<const float>& height_m, const ByteSink& sink) {
  BinaryText bytes(sink);
  for (int y = 0; y < height_m.height; ++y) {
    for (int x = 0; x < height_m.width; ++x) bytes.add(static_cast<double>(height_m.at(x, y)));
  }
  bytes.flush();
}

/// One bit for a point, the lowest of a byte first; the bits behind the last point are 1.
void write_valid(const PlaneView<const float>& height_m, const ByteSink& sink) {
  BinaryText bytes(sink);
  unsigned bits = 0;
  unsigned filled = 0;
  for (int y = 0; y < height_m.height; ++y) {
    for (int x = 0; x < height_m.width; ++x) {
      bits |= (std::isnan(height_m.at(x, y)) ? 0U : 1U) << filled++;
      if (filled < 8) continue;
      bytes.add(static_cast<std::uint8_t>(bits));
      bits = filled = 0;
    }
  }
  if (filled > 0) bytes.add(static_cast<std::uint8_t>(bits | 0xFFU << filled));
  bytes.flush();
}

std::string element(const std::string& name, std::string_view text) {
  return "<" + name + ">" + xml_text(text) + "</" + name + ">";
}

/// One JSON object in ASCII: what is not known is left out.
std::string comment(const SurfaceOrigin& origin) {
  nlohmann::ordered_json json;
  const auto add = [&json](const char* key, const std::string& value) {
    if (!value.empty()) json[key] = value;
  };
  add("title", origin.title);
  add("part_id", origin.part_id);
  add("job_id", origin.job_id);
  add("recipe", origin.recipe_id);
  add("recipe_sha256", origin.recipe_sha256);
  add("peak", origin.peak);
  add("software", origin.software_version);
  add("source", origin.source);
  json["simulated"] = origin.simulated;
  json["rows"] = "row 0 is the top of the image";
  return json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
}

std::string record_1(const SurfaceView& surface) {
  const auto lateral = [](const char* name, double pitch_um) {
    return std::string("<") + name + ">" + element("AxisType", "I") + element("DataType", "D") +
           element("Increment", metres_text(pitch_um)) + element("Offset", "0") + "</" + name + ">\n";
  };
  return "<Record1>\n" + element("Revision", "ISO5436 - 2000") + "\n" + element("FeatureType", "SUR") + "\n<Axes>\n" +
         lateral("CX", surface.pitch_x_um.value()) + lateral("CY", surface.pitch_y_um.value()) + "<CZ>" +
         element("AxisType", "A") + element("DataType", "D") + element("Increment", "1") + element("Offset", "0") +
         "</CZ>\n</Axes>\n</Record1>\n";
}

std::string record_2(const SurfaceOrigin& origin) {
  const auto known = [](const std::string& text) { return text.empty() ? std::string("unknown") : one_line(text); };
  // A printable text in UTF-8 or not: JSON makes ASCII of it, XML must not hold broken UTF-8.
  const auto ascii = [&known](const std::string& text) {
    std::string plain = known(text);
    for (char& c : plain) {
      if (static_cast<unsigned char>(c) > '~') c = '?';
    }
    return plain;
  };
  // The schema demands a date of calibration too; none is known here, and the result's stands in for it.
  const std::string date = origin.created ? iso8601_utc(*origin.created) : kNoDate;
  return "<Record2>\n" + element("Date", date) + "\n" + element("Creator", "fvd") + "\n<Instrument>" +
         element("Manufacturer", "fvd") + element("Model", "focus variation") +
         element("Serial", ascii(origin.source)) + element("Version", ascii(origin.software_version)) +
         "</Instrument>\n" + element("CalibrationDate", date) + "\n<ProbingSystem>" +
         element("Type", origin.simulated ? "Software" : "NonContacting") +
         element("Identification", "focus variation") + "</ProbingSystem>\n" + element("Comment", comment(origin)) +
         "\n</Record2>\n";
}

std::string record_3(const SurfaceView& surface, const ContentDigest& points, const ContentDigest& valid) {
  return "<Record3>\n<MatrixDimension>" + element("SizeX", std::to_string(surface.height_m.width)) +
         element("SizeY", std::to_string(surface.height_m.height)) + element("SizeZ", "1") +
         "</MatrixDimension>\n<DataLink>" + element("PointDataLink", kPoints) +
         element("MD5ChecksumPointData", points.md5) + element("ValidPointsLink", kValid) +
         element("MD5ChecksumValidPoints", valid.md5) + "</DataLink>\n</Record3>\n";
}

std::string main_xml(const SurfaceView& surface, const ContentDigest& points, const ContentDigest& valid) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\" "
         "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xsi:schemaLocation=\"http://www.opengps.eu/2008/ISO5436_2 "
         "http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd\">\n" +
         record_1(surface) + record_2(surface.origin) + record_3(surface, points, valid) + "<Record4>" +
         element("ChecksumFile", kChecksum) + "</Record4>\n</p:ISO5436_2>\n";
}

}  // namespace

void write_x3p(const SurfaceView& surface, const ByteSink& sink) {
  const ByteProducer points = [&surface](const ByteSink& to) { write_points(surface.height_m, to); };
  const ByteProducer valid = [&surface](const ByteSink& to) { write_valid(surface.height_m, to); };
  const ContentDigest points_digest = digest_of(points);
  const ContentDigest valid_digest = digest_of(valid);
  const std::string xml = main_xml(surface, points_digest, valid_digest);
  const ByteProducer main = [&xml](const ByteSink& to) { to(xml); };
  const ContentDigest main_digest = digest_of(main);
  const std::string sum = main_digest.md5 + " *main.xml\n";
  const ByteProducer checksum = [&sum](const ByteSink& to) { to(sum); };
  StoredZip zip(sink);
  zip.add("main.xml", main_digest, main);  // first: programs look for it in the head of the file
  zip.add(kChecksum, digest_of(checksum), checksum);
  zip.add(kPoints, points_digest, points);
  zip.add(kValid, valid_digest, valid);
  zip.finish();
}

}  // namespace fvd
