#include "daemon/surface_files/map_rows.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "daemon/surface_files/surface_files.hpp"

namespace fvd {

namespace {

/// A map whose format has no places that could be read alone.
class HeldRows final : public MapRows {
 public:
  explicit HeldRows(Plane<float>&& plane) : plane_(std::move(plane)) {}
  [[nodiscard]] GridSize size() const noexcept override { return {plane_.width(), plane_.height()}; }
  [[nodiscard]] std::size_t bytes() const noexcept override { return plane_.pixels().size_bytes(); }
  void read(int x, int y, int count, float* to) const override { std::copy_n(plane_.row(y) + x, count, to); }

 private:
  const Plane<float> plane_;
};

constexpr SurfaceReadOptions kAnyPitch{1.0, 1.0};  // where the file tells none: it is not looked at here

bool is_tiff(const std::string& head) {
  return head.starts_with("II*") || head.starts_with("II+") || head.starts_with("MM");
}

}  // namespace

std::shared_ptr<const MapRows> open_map_rows(const std::filesystem::path& path) {
  const std::string head = FileBytes(path).text(0, 8);
  if (head.starts_with("Gwyddion")) return open_gsf_rows(path);
  if (!is_tiff(head)) return std::make_shared<HeldRows>(read_surface(path).height_m);
  if (auto rows = open_tiff_rows(path)) return rows;
  return std::make_shared<HeldRows>(read_surface(path, kAnyPitch).height_m);
}

}  // namespace fvd
