#pragma once

/// The files of a result, one row each.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/export/export_input.hpp"

namespace fvd {

/// What an exporter needs, and with it how many files it makes.
enum class ExportNeed {
  kResult,        ///< the result with its height map: one file
  kEachExtraMap,  ///< a height map of another peak method: one file for each there is
};

/// Exporters that take long begin before the others, so that none is left to be waited for at the end.
enum class ExportCost { kQuick, kSlow };

struct Exporter {
  std::string_view name;  ///< of the file, with its suffix; "*" stands for the map's peak method
  ExportNeed need = ExportNeed::kResult;
  ExportCost cost = ExportCost::kQuick;
  /// The bytes of the file. Called on any thread, beside other exporters.
  std::string (*encode)(const ExportInput& input) = nullptr;
};

/// All exporters, in the order in which result.json lists their files. A new one is a row here and a source of its own.
[[nodiscard]] std::span<const Exporter> exporter_table();

/// Those of these names, in the order of the table; all of them where no names are given. Names that no exporter has
/// choose nothing.
[[nodiscard]] std::vector<Exporter> chosen_exporters(const std::optional<std::vector<std::string>>& names);

}  // namespace fvd
