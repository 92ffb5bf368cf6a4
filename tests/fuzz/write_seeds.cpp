/// write_seeds FOLDER: what the fuzzers begin with. Good inputs by the project's own writers and files in
/// FOLDER/<fuzzer>/, and the words of what is JSON in FOLDER/<fuzzer>.dict.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "daemon/api/dispatcher.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "tests/daemon/api/fake_job_service.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void write(const fs::path& folder, const std::string& fuzzer, const std::string& bytes,
           const std::string& name = "seed") {
  fs::create_directories(folder / fuzzer);
  std::ofstream(folder / fuzzer / name, std::ios::binary) << bytes;
}

void write_surfaces(const fs::path& folder) {
  fvd::Surface surface;
  surface.height_m = fvd::Plane<float>(3, 2, 1e-6F);
  surface.height_m.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
  surface.pitch_x_um = surface.pitch_y_um = 0.5;
  const fvd::SurfaceView view = fvd::surface_view(surface, {});
  for (const std::string format : {"x3p", "gsf", "sdf", "csv"}) {
    write(folder, format, fvd::surface_bytes(*fvd::find_surface_writer(format), view));
  }
  const std::string x3p = fvd::surface_bytes(*fvd::find_surface_writer("x3p"), view);
  const auto xml = x3p.find("<?xml");
  constexpr std::string_view kRootEnd = "</p:ISO5436_2>\n";
  write(folder, "x3p_main", x3p.substr(xml, x3p.find(kRootEnd) + kRootEnd.size() - xml));
  write(folder, "tiff", fvd::encode_height_tiff(surface.height_m, {"", "", {}, {}}));
  write(folder, "sdf",
        "aISO-1.0\nNumPoints = 3\nNumProfiles = 2\nXscale = 5e-7\nYscale = 5e-7\nZscale = 1e-9\nDataType = 6\n*\n"
        "1 2 BAD\n4 5 6\n*\n",
        "ascii");
}

/// The project's own files of a folder.
void write_files(const fs::path& folder, const std::string& fuzzer, const fs::path& from) {
  for (const auto& entry : fs::directory_iterator(from)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream file(entry.path(), std::ios::binary);
    write(folder, fuzzer, {std::istreambuf_iterator<char>(file), {}}, entry.path().stem());
  }
}

/// Names of keys and texts to choose from, wherever they stand in a JSON schema.
void collect_words(const json& schema, std::set<std::string>& words) {
  for (const auto& [key, value] : schema.items()) {
    if (key == "properties") {
      for (const auto& [name, unused] : value.items()) words.insert(name);
    } else if (key == "name" && value.is_string()) {
      words.insert(value);
    } else if (key == "enum") {
      for (const json& choice : value) words.insert(choice.is_string() ? choice.get<std::string>() : choice.dump());
    }
    if (value.is_structured()) collect_words(value, words);
  }
}

void write_dictionary(const fs::path& folder, const std::string& fuzzer, const json& schema) {
  std::set<std::string> words;
  collect_words(schema, words);
  std::ofstream file(folder / (fuzzer + ".dict"));
  for (const std::string& word : words) {
    if (!word.empty()) file << json('"' + word + '"').dump() << '\n';
  }
}

std::string request(const std::string& method) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", json::object()}}.dump();
}

void write_requests(const fs::path& folder) {
  fvd::FakeJobService service;
  const fvd::Services services = service.services();
  const fvd::Dispatcher dispatcher(fvd::all_methods(services), services);
  for (const auto& [name, unused] : dispatcher.methods()) write(folder, "dispatcher", request(name), name);
  const fvd::Caller caller{.who = {"seeds", fvd::Role::kAdminister}};
  write_dictionary(folder, "dispatcher", json::parse(*dispatcher.handle(request("rpc.discover"), caller).reply));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_seeds FOLDER\n";
    return 64;
  }
  spdlog::set_level(spdlog::level::off);
  const fs::path folder = argv[1];
  const fs::path config = fs::path(FVD_SOURCE_DIR) / "config";
  write_surfaces(folder);
  write_requests(folder);
  write(folder, "config", fvd::config_text({}));
  write_files(folder, "config", config);
  write_dictionary(folder, "config", json::parse(fvd::config_schema_text()));
  write_files(folder, "recipe", config / "recipes");
  write_dictionary(folder, "recipe", json::parse(fvd::recipe_schema_text()));
  write_files(folder, "drive", config / "drives");
  write_dictionary(folder, "drive", json::parse(fvd::drive_profile_schema_text()));
  return 0;
}
