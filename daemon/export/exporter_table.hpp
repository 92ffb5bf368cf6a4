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
  kEachSection,    ///< a measurement with a cross section: one file per measurement, none where there is none
  kCuttingEdges,   ///< the measurements of cutting edges: one file, none where there is none
};

/// Whether a verdict waits for the file.
enum class ExportTime {
  kVerdict,  ///< it does: what other files are made of, and what is in memory alone
  kFollows,  ///< it does not: made afterwards, of the files of the first kind
};

/// Planes of a result, as bits: what a file holds, or is made of.
using ResultPlanes = unsigned;
namespace result_planes {
inline constexpr ResultPlanes kHeights = 1U;
inline constexpr ResultPlanes kSigma = 2U;
inline constexpr ResultPlanes kMask = 4U;
inline constexpr ResultPlanes kTexture = 8U;
}  // namespace result_planes

/// Slow exporters begin first, so that at the end none runs alone.
enum class ExportCost { kQuick, kSlow };

struct Exporter {
  std::string_view name;  ///< of the file, with its suffix; "*" stands for the map's peak method, or the measurement
  ExportNeed need = ExportNeed::kResult;
  ExportCost cost = ExportCost::kQuick;
  /// The bytes of the file. Called on any thread, beside other exporters.
  std::string (*encode)(const ExportInput& input) = nullptr;
  /// In place of encode: the bytes one after the other, for files that are large against the result.
  void (*stream)(const ExportInput& input, const ByteSink& sink) = nullptr;
  std::string_view format = {};  ///< a name that stands for all files of a format; several rows may share it
  bool on_request = false;       ///< made only where it is named
  ExportTime time = ExportTime::kVerdict;
  ResultPlanes reads = 0;  ///< of one that follows
  ResultPlanes holds = 0;  ///< what can be read back from the file, bit for bit
};

/// A file that an exporter makes.
struct ExportFile {
  std::string name;
  ExportInput input;
};

/// The files that the exporter makes of a result. of_result: what export_input() gives.
[[nodiscard]] std::vector<ExportFile> export_files(const Exporter& exporter, const ExportInput& of_result);

/// Exporters by when their files are made.
struct DividedExporters {
  std::vector<Exporter> first;
  std::vector<Exporter> following;
};

/// An exporter follows where the table says so and all that it reads is held by files of the first ones. Where no
/// other holds heights or standard errors, the first one that does is taken to the first ones.
[[nodiscard]] DividedExporters divided(const std::vector<Exporter>& exporters);

/// The bytes of the exporter's file.
[[nodiscard]] std::string bytes_of(const Exporter& exporter, const ExportInput& input);

/// All exporters, in the order in which result.json lists their files. A new one is a row here and a source of its own.
[[nodiscard]] std::span<const Exporter> exporter_table();

/// The exporters of these names or formats in the order of the table; all that are not only made on request where no
/// names are given. A name that no exporter has chooses nothing.
[[nodiscard]] std::vector<Exporter> chosen_exporters(const std::optional<std::vector<std::string>>& names);

}  // namespace fvd
