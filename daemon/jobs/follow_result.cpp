#include "daemon/jobs/follow_result.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "core/surface/mask_reason.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/export/replace_file.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/sha256.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "daemon/surface_files/texture_image.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

/// Heights, errors, reasons, image; and a file of four bytes a point with what a picture is drawn from.
constexpr std::size_t kPlaneBytesPerPixel = 2 * sizeof(float) + sizeof(MaskReasons) + sizeof(std::uint16_t);
constexpr std::size_t kEncodingBytesPerPixel = 12;

bool is_of_storage(const Error& error) {
  return error.code() == ErrorCode::kStorageFull || error.code() == ErrorCode::kStorageWrite;
}

std::string sha256_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20U);
  Sha256 digest;
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    digest.update({piece.data(), static_cast<std::size_t>(file.gcount())});
  }
  return file.eof() ? digest.digits() : std::string();
}

/// The data of a result as its folder has it.
ResultData data_in(const fs::path& folder, const Result& result) {
  const auto stand_in = [](const std::optional<double>& told) { return told ? std::nullopt : std::optional(1.0); };
  ResultSurface read =
      read_result_surface(folder, {stand_in(result.focus.pixel_pitch_x_um), stand_in(result.focus.pixel_pitch_y_um)});
  Surface& surface = read.surface;
  TextureImage texture = read_texture(folder, surface, result);
  ResultData data = result_data(result);
  HeightMap& map = data.map;
  // Exporters that need a plane which is not here are not among those that follow.
  constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
  map.sigma_m =
      surface.has_sigma() ? std::move(surface.sigma_m) : Plane<float>(surface.width(), surface.height(), kHole);
  map.mask = std::move(surface.mask);
  if (map.mask.empty()) {
    map.mask = Plane<MaskReasons>(surface.width(), surface.height());
    std::transform(surface.height_m.pixels().begin(), surface.height_m.pixels().end(), map.mask.pixels().begin(),
                   [](float height) {
                     return std::isnan(height) ? static_cast<MaskReasons>(mask_reason::kLowProminence) : MaskReasons{0};
                   });
  }
  map.height_m = std::move(surface.height_m);
  map.texture = std::move(texture.grey);
  map.colour = std::move(texture.colour);
  map.texture_format = texture.format;
  return data;
}

/// The exporters' files by name, with the data that they are made of.
class FollowingExports {
 public:
  FollowingExports(const fs::path& folder, const Result& result)
      : data_(data_in(folder, result)), input_(export_input(data_, result)) {}

  struct Found {
    const Exporter* exporter;
    ExportInput input;
  };
  [[nodiscard]] std::optional<Found> find(const std::string& name) const {
    for (const Exporter& exporter : exporter_table()) {
      for (const ExportFile& file : export_files(exporter, input_)) {
        if (file.name == name) return Found{&exporter, file.input};
      }
    }
    return std::nullopt;
  }

 private:
  ResultData data_;
  ExportInput input_;
};

class Follower {
 public:
  Follower(ResultToFollow task, const std::stop_token& stop)
      : task_(std::move(task)), stop_(stop), result_(read_result_json(task_.text)) {}

  FollowedResult run() {
    const auto start = std::chrono::steady_clock::now();
    if (!fs::is_directory(task_.folder)) {
      give_up("the folder of the result is not there any more");
      for (ResultFile& file : result_.files) {  // or somebody would look for them at every start
        if (needs_digest(file)) not_made(file, "it was written, but the folder of the result is not there any more");
      }
      return finished(start);
    }
    add_digests();
    make_files();
    FollowedResult followed = finished(start);
    replace_file(task_.folder / "result.json", [&followed](const ByteSink& sink) { sink(followed.text); });
    return followed;
  }

 private:
  [[nodiscard]] FollowedResult finished(std::chrono::steady_clock::time_point start) {
    const double took_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    FollowedResult followed;
    followed.pending = std::any_of(result_.files.begin(), result_.files.end(), is_unfinished);
    followed.reason = reason_;
    followed.text = result_json_with_files(task_.text, result_.files, result_.times.follow_ms.value_or(0.0) + took_ms);
    return followed;
  }

  static bool is_unfinished(const ResultFile& file) { return file.state == FileState::kPending || needs_digest(file); }
  static bool needs_digest(const ResultFile& file) {
    return file.state == FileState::kWritten && !file.files && file.sha256.empty();
  }

  void give_up(const std::string& reason) {
    for (ResultFile& file : result_.files) {
      if (file.state == FileState::kPending) not_made(file, reason);
    }
  }

  static void not_made(ResultFile& file, const std::string& reason) {
    file.state = FileState::kNotMade;
    file.reason = reason;
  }

  void add_digests() {
    for (ResultFile& file : result_.files) {
      if (stop_.stop_requested()) return;
      if (!needs_digest(file)) continue;
      const auto kept = std::find_if(task_.written.begin(), task_.written.end(),
                                     [&file](const WrittenBytes& written) { return written.name == file.name; });
      if (kept == task_.written.end()) {
        file.sha256 = sha256_of_file(task_.folder / file.name);
        if (file.sha256.empty()) not_made(file, "it was written, but cannot be read any more");
      } else {
        file.sha256 = sha256_of(kept->bytes);
        task_.written.erase(kept);  // gives its memory back
      }
    }
    task_.written.clear();
  }

  void make_files() {
    const auto is_pending = [](const ResultFile& file) { return file.state == FileState::kPending; };
    if (std::none_of(result_.files.begin(), result_.files.end(), is_pending)) return;
    if (stop_.stop_requested()) return;  // before whole maps are read
    std::optional<FollowingExports> exports;
    try {
      exports.emplace(task_.folder, result_);
    } catch (const Error& error) {
      return give_up(std::string("the files that it is made of cannot be read: ") + error.what());
    }
    for (ResultFile& file : result_.files) {
      if (stop_.stop_requested()) return;
      if (!is_pending(file)) continue;
      const auto found = exports->find(file.name);
      if (!found) {
        not_made(file, "this version makes no such file of what is in the folder");
        continue;
      }
      if (!make(*found->exporter, found->input, file)) return;
    }
  }

  /// False where the rest waits for another time.
  [[nodiscard]] bool make(const Exporter& exporter, const ExportInput& input, ResultFile& file) {
    try {
      Sha256 digest;
      file.size_bytes = replace_file(task_.folder / file.name, [&](const ByteSink& sink) {
        const auto take = [&](std::string_view bytes) {
          if (stop_.stop_requested()) throw Error(ErrorCode::kAborted, "the daemon stops");
          digest.update(bytes);
          sink(bytes);
        };
        if (exporter.stream != nullptr) {
          exporter.stream(input, take);
        } else {
          take(exporter.encode(input));
        }
      });
      file.sha256 = digest.digits();
      file.state = FileState::kWritten;
      return true;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kAborted) return false;
      if (is_of_storage(error)) {
        reason_ = file.name + ": " + error.what();
        return false;
      }
      not_made(file, error.what());
    } catch (const std::exception& error) {
      not_made(file, error.what());
    }
    return true;
  }

  ResultToFollow task_;
  const std::stop_token& stop_;
  Result result_;
  std::string reason_;
};

}  // namespace

FollowedResult follow_result(ResultToFollow result, const std::stop_token& stop) {
  return Follower(std::move(result), stop).run();
}

std::size_t follow_bytes(const Result& result) {
  return (kPlaneBytesPerPixel + kEncodingBytesPerPixel) * static_cast<std::size_t>(result.focus.width_px) *
         static_cast<std::size_t>(result.focus.height_px);
}

}  // namespace fvd
