#pragma once

/// ZIP archives made by libzip, good and bad.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <glib.h>
#include <zip.h>

namespace fvd::test {

using ZipEntries = std::vector<std::pair<std::string, std::string>>;

inline void build_zip(const std::filesystem::path& path, const ZipEntries& entries, bool deflate = true) {
  int error = 0;
  zip_t* const archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  if (archive == nullptr) throw std::runtime_error("no archive " + path.string());
  for (const auto& [name, content] : entries) {
    zip_source_t* const source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) throw std::runtime_error(zip_strerror(archive));
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), deflate ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 9);
  }
  if (zip_close(archive) != 0) throw std::runtime_error(zip_strerror(archive));
}

inline std::string md5_of(const std::string& bytes) {
  char* const text =
      g_compute_checksum_for_data(G_CHECKSUM_MD5, reinterpret_cast<const guchar*>(bytes.data()), bytes.size());
  std::string digits = text;
  g_free(text);
  return digits;
}

/// What main.xml tells, each as text so that it can be wrong.
struct X3pText {
  std::string prologue = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  std::string revision = "ISO5436 - 2000";
  std::string feature = "SUR";
  std::string axis_x = "<AxisType>I</AxisType><Increment>5e-07</Increment>";
  std::string axis_y = "<AxisType>I</AxisType><DataType>D</DataType><Increment>0.25E-6</Increment><Offset>0.1</Offset>";
  std::string axis_z = "<AxisType>A</AxisType><DataType>D</DataType>";
  std::string rotation;
  std::string matrix = "<SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>";
  std::string points_link = "bindata/data.bin";
  std::string points_md5;  ///< empty: the right one
  std::string valid_md5;   ///< likewise
  std::string more_in_record_3;
  std::string main_md5;  ///< empty: the right one

  [[nodiscard]] std::string xml(const std::string& points, const std::string* valid) const {
    const std::string md5 = points_md5.empty() ? md5_of(points) : points_md5;
    std::string text = prologue + "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><Revision>" +
                       revision + "</Revision><FeatureType>" + feature + "</FeatureType><Axes><CX>" + axis_x +
                       "</CX><CY>" + axis_y + "</CY><CZ>" + axis_z + "</CZ>" + rotation +
                       "</Axes></Record1><Record3><MatrixDimension>" + matrix +
                       "</MatrixDimension><DataLink><PointDataLink>" + points_link +
                       "</PointDataLink><MD5ChecksumPointData>" + md5 + "</MD5ChecksumPointData>";
    if (valid != nullptr) {
      text += "<ValidPointsLink>bindata/valid.bin</ValidPointsLink><MD5ChecksumValidPoints>" +
              (valid_md5.empty() ? md5_of(*valid) : valid_md5) + "</MD5ChecksumValidPoints>";
    }
    return text + "</DataLink>" + more_in_record_3 +
           "</Record3><Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>\n";
  }

  /// The entries of the whole file.
  [[nodiscard]] ZipEntries entries(const std::string& points, const std::string* valid = nullptr) const {
    const std::string text = xml(points, valid);
    ZipEntries all{{"main.xml", text},
                   {"bindata/data.bin", points},
                   {"md5checksum.hex", (main_md5.empty() ? md5_of(text) : main_md5) + " *main.xml\n"}};
    if (valid != nullptr) all.emplace_back("bindata/valid.bin", *valid);
    return all;
  }
};

}  // namespace fvd::test
