#include "daemon/recipes/recipe_masks.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxMask_bytes = std::uintmax_t{64} << 20U;
constexpr std::uint64_t kMaxMaskPoints = std::uint64_t{1} << 26U;

/// Why a mask cannot be used.
struct MaskRefusal {
  std::string why;
};

std::string bytes_of_mask(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) throw MaskRefusal{"there is no such file"};
  if (fs::file_size(file, error) > kMaxMask_bytes) throw MaskRefusal{"it is above 64 MiB"};
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (error || stream.bad() || bytes.empty()) throw MaskRefusal{"it cannot be read, or is empty"};
  return bytes;
}

/// The decoder takes memory for whatever size the head tells.
void check_head(const std::string& bytes) {
  constexpr std::size_t kPlace = 16;  // of width and height, big-endian, behind signature and chunk head
  const auto side = [&bytes](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
    return value;
  };
  if (bytes.size() < kPlace + 8 || bytes.compare(1, 3, "PNG") != 0) throw MaskRefusal{"it is no PNG"};
  if (side(kPlace) * side(kPlace + 4) > kMaxMaskPoints) throw MaskRefusal{"it has above 2^26 points"};
}

std::shared_ptr<const RegionMask> read_mask(const fs::path& file) {
  const std::string bytes = bytes_of_mask(file);
  check_head(bytes);
  ImageFile image;
  try {
    read_png(file, image);
  } catch (const ImageFileError& error) {
    throw MaskRefusal{error.what()};
  }
  if (bytes_of_mask(file) != bytes) throw MaskRefusal{"it was changed while it was read; ask again"};
  if (image.channels != 1 || image.bytes_per_sample != 1) {
    throw MaskRefusal{"it has " + std::to_string(image.channels) + " channel(s) of " +
                      std::to_string(8 * image.bytes_per_sample) + " bit"};
  }
  auto mask = std::make_shared<RegionMask>();
  mask->points = Plane<std::uint8_t>::unset(image.width, image.height);
  std::memcpy(mask->points.row(0), image.samples.data(), image.samples.size());
  const auto points = mask->points.pixels();
  if (std::all_of(points.begin(), points.end(), [](std::uint8_t point) { return point == 0; })) {
    throw MaskRefusal{"all of its points are 0, so that the region is empty"};
  }
  mask->sha256 = recipe_sha256(bytes);
  return mask;
}

}  // namespace

void read_masks(const fs::path& folder, EvaluationPlan& plan, Problems& problems) {
  const Problems read = problems;
  for (const auto& [name, region] : plan.regions) {
    const std::string pointer = "/evaluation/regions/" + name + "/mask_png";
    const bool is_known = plan.masks.contains(region.mask_png);
    if (region.shape != "mask_png" || is_known || is_reported(read, pointer)) continue;
    const fs::path file = folder / "masks" / region.mask_png;
    try {
      plan.masks[region.mask_png] = read_mask(file);
    } catch (const MaskRefusal& refusal) {
      problems.push_back(
          {pointer, file.string() + ": " + refusal.why + "; expected a PNG of 8 bit grey, 0 = outside of the region"});
    }
  }
}

Recipe read_recipe_file(const fs::path& file, const StageLimits* stage) {
  const std::string id = file.stem().string();
  Problems problems;
  Recipe recipe = read_recipe(read_text_file(file), id, problems);
  read_masks(file.parent_path(), recipe.evaluation, problems);
  if (stage != nullptr) {
    for (Problem& found : check_stage_limits(recipe, *stage, problems)) problems.push_back(std::move(found));
  }
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  return recipe;
}

}  // namespace fvd
