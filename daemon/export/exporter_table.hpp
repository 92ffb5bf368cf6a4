#pragma once

/// The files of a result, one row per kind of file.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/export/durable_file.hpp"
#include "daemon/export/export_input.hpp"

namespace fvd {

/// What an exporter reads, which also decides how many files it makes.
enum class ExportNeed {
  kResult,         ///< the result with its height map: one file
  kSmoothedMap,    ///< the smoothed heights: one file, none where they were not asked for
  kRepeatedScans,  ///< the scatter of several scans: one file, none where there was one scan
  kEachExtraMap,   ///< a height map of another peak method: one file per map, none where there is none
};

/// Slow exporters begin first, so that at the end none runs alone.
enum class ExportCost { kQuick, kSlow };

struct Exporter {
  std::string_view name;  ///< of the file, with its suffix; "*" stands for the map's peak method
  ExportNeed need = ExportNeed::kResult;
  ExportCost cost = ExportCost::kQuick;
  /// The bytes of the file. Called on any thread, beside other exporters.
  std::string (*encode)(const ExportInput& input) = nullptr;
  /// In place of encode: the bytes one after the other, for files that are large against the result.
  void (*stream)(const ExportInput& input, const ByteSink& sink) = nullptr;
  std::string_view format = {};  ///< a name that stands for all files of a format; several rows may share it
  bool on_request = false;       ///< made only where it is named
};

/// The bytes of the exporter's file.
[[nodiscard]] std::string bytes_of(const Exporter& exporter, const ExportInput& input);

/// All exporters, in the order in which result.json lists their files. A new one is a row here and a source of its own.
[[nodiscard]] std::span<const Exporter> exporter_table();

/// The exporters of these names or formats in the order of the table; all that are not only made on request where no
/// names are given. A name that no exporter has chooses nothing.
[[nodiscard]] std::vector<Exporter> chosen_exporters(const std::optional<std::vector<std::string>>& names);

}  // namespace fvd
