/// The configuration file and the parts of conf.d, which NUL bytes separate in the input.

#include <fstream>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/config/config_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace fvd::test {

namespace {

namespace fs = std::filesystem;

/// A folder of this process, with nothing but what an input puts there.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("fuzz_config." + std::to_string(::getpid()))) {
    fs::create_directories(parts());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] fs::path file() const { return path_ / "fvd.json"; }
  [[nodiscard]] fs::path parts() const { return path_ / "conf.d"; }
  [[nodiscard]] const fs::path& path() const { return path_; }

  void fill(std::string_view input) const {
    for (const auto& old : fs::directory_iterator(parts())) fs::remove(old.path());
    constexpr std::size_t kMostParts = 8;
    const auto texts = parts_of(input, '\0');
    for (std::size_t i = 0; i < std::min(texts.size(), kMostParts); ++i) {
      std::ofstream(i == 0 ? file() : parts() / (std::to_string(i) + ".json"), std::ios::binary) << texts[i];
    }
  }

 private:
  fs::path path_;
};

/// What is shown of a configuration is read as the same one; with origins, its paths are absolute.
void check_shown(const LoadedConfig& loaded, const fs::path& base) {
  const std::string shown = config_text(loaded.config);
  const LoadedConfig again = parse_config(shown, base);
  require(again.problems.empty() && config_text(again.config) == shown);
  const LoadedConfig absolute = parse_config(config_text_with_origins(loaded), base);
  require(absolute.problems.empty());
  require(config_text_with_origins(again) ==
          config_text_with_origins(parse_config(config_text(absolute.config), base)));
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  using namespace fvd::test;
  spdlog::set_level(spdlog::level::off);
  static const Folder folder;
  folder.fill(text_of({bytes, size}));
  const LoadedConfig loaded = merge_config(folder.file(), folder.parts(), folder.path());
  for (const Problem& problem : loaded.problems) require(!problem.message.empty());
  for (const Problem& problem : check_config(loaded.config, loaded.problems)) require(!problem.message.empty());
  if (loaded.problems.empty()) check_shown(loaded, folder.path());
  return 0;
}
