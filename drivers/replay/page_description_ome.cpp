#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <tuple>

#include <tinyxml2.h>

#include "drivers/replay/page_description.hpp"

namespace fvd {

namespace {

using tinyxml2::XMLElement;

/// The name without its namespace.
bool is_named(const XMLElement& element, const char* name) {
  const char* const colon = std::strrchr(element.Name(), ':');
  return std::strcmp(colon == nullptr ? element.Name() : colon + 1, name) == 0;
}

std::vector<const XMLElement*> children(const XMLElement& parent, const char* name) {
  std::vector<const XMLElement*> found;
  for (const XMLElement* child = parent.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (is_named(*child, name)) found.push_back(child);
  }
  return found;
}

std::string text_of(const XMLElement& element, const char* attribute) {
  const char* const text = element.Attribute(attribute);
  return text == nullptr ? "" : text;
}

std::string file_of(const XMLElement& tiff_data) {
  for (const XMLElement* uuid : children(tiff_data, "UUID")) return text_of(*uuid, "FileName");
  return {};
}

/// Pixels in the order of its pages.
class Pixels {
 public:
  Pixels(const XMLElement& element, int samples_per_page) : element_(element) {
    description_.written_by = "OME-XML";
    description_.by_directory = true;
    description_.slices = std::clamp(element.IntAttribute("SizeZ", 1), 1, kMaxPages);
    description_.times = std::clamp(element.IntAttribute("SizeT", 1), 1, kMaxPages);
    read_channels(samples_per_page);
    read_order();
    if (1LL * description_.slices * description_.channels * description_.times > kMaxPages) {
      description_.problem = "it tells of more than a million pages";
    }
  }

  PageDescription read(const std::string& filename) {
    if (!description_.problem.empty()) return description_;
    description_.spacing_um = physical_size_um("PhysicalSizeZ");
    description_.pixel_pitch_x_um = physical_size_um("PhysicalSizeX");
    description_.pixel_pitch_y_um = physical_size_um("PhysicalSizeY");
    for (auto* const pitch_um : {&description_.pixel_pitch_x_um, &description_.pixel_pitch_y_um}) {
      if (*pitch_um && **pitch_um < 0.0) pitch_um->reset();
    }
    read_pages(filename);
    read_positions();
    return description_;
  }

 private:
  /// Never 0.
  [[nodiscard]] std::optional<double> physical_size_um(const std::string& name) const {
    const std::string unit = text_of(element_, (name + "Unit").c_str());
    const double unit_um = unit.empty() ? 1.0 : described_unit_um(unit);  // um is the schema's default
    const double size_um = element_.DoubleAttribute(name.c_str(), 0.0) * unit_um;
    return std::isfinite(size_um) && size_um != 0.0 ? std::optional(size_um) : std::nullopt;
  }

  /// Samples of one page are one channel, whatever SizeC counts.
  void read_channels(int samples_per_page) {
    std::int64_t samples = 0;
    const auto channels = children(element_, "Channel");
    for (const XMLElement* channel : channels) {
      samples += std::max(1, channel->IntAttribute("SamplesPerPixel", 1));
      description_.channel_names.push_back(text_of(*channel, "Name"));
    }
    const int size = std::clamp(element_.IntAttribute("SizeC", 1), 1, kMaxPages);
    const bool names_all = !channels.empty() && samples == size;
    description_.channels = names_all ? static_cast<int>(channels.size()) : std::max(1, size / samples_per_page);
    if (!names_all || std::all_of(description_.channel_names.begin(), description_.channel_names.end(),
                                  [](const std::string& name) { return name.empty(); })) {
      description_.channel_names.clear();
    }
  }

  /// "XYZCT": z changes fastest from page to page.
  void read_order() {
    order_ = text_of(element_, "DimensionOrder");
    order_ = order_.starts_with("XY") ? order_.substr(2) : "";
    std::string sorted = order_;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != "CTZ") description_.problem = "its DimensionOrder is none";
  }

  [[nodiscard]] int size_of(char dimension) const {
    return dimension == 'Z' ? description_.slices : dimension == 'C' ? description_.channels : description_.times;
  }

  /// The place that comes `count` pages after the first.
  [[nodiscard]] PagePlace place_at(int count) const {
    PagePlace place;
    for (const char dimension : order_) {
      (dimension == 'Z' ? place.z : dimension == 'C' ? place.channel : place.time) = count % size_of(dimension);
      count /= size_of(dimension);
    }
    return place;
  }

  [[nodiscard]] int count_at(const PagePlace& place) const {
    int count = 0;
    for (auto dimension = order_.rbegin(); dimension != order_.rend(); ++dimension) {
      count = count * size_of(*dimension) + (*dimension == 'Z'   ? place.z
                                             : *dimension == 'C' ? place.channel
                                                                 : place.time);
    }
    return count;
  }

  void read_pages(const std::string& filename) {
    const int all = description_.slices * description_.channels * description_.times;
    std::set<std::string> files;
    const auto blocks = children(element_, "TiffData");
    for (const XMLElement* block : blocks) files.insert(file_of(*block));
    for (const XMLElement* block : blocks) {
      if (files.size() > 1 && file_of(*block) != filename) continue;
      const PagePlace first{0, std::clamp(block->IntAttribute("FirstZ", 0), 0, description_.slices - 1),
                            std::clamp(block->IntAttribute("FirstC", 0), 0, description_.channels - 1),
                            std::clamp(block->IntAttribute("FirstT", 0), 0, description_.times - 1), std::nullopt};
      const int begin = count_at(first);
      const int directory = std::clamp(block->IntAttribute("IFD", 0), 0, kMaxPages);
      const bool whole = block->Attribute("IFD") == nullptr && block->Attribute("PlaneCount") == nullptr;
      const int pages = std::clamp(block->IntAttribute("PlaneCount", whole ? all : 1), 0, all - begin);
      if (description_.pages.size() + static_cast<std::size_t>(pages) > kMaxPages) {
        description_.problem = "its TiffData elements tell of more than a million pages";
        return;
      }
      for (int i = 0; i < pages; ++i) {
        PagePlace place = place_at(begin + i);
        place.page = directory + i;
        description_.pages.push_back(place);
      }
    }
    if (description_.pages.empty()) {
      description_.problem = blocks.empty() ? "it does not tell which pages hold the planes"
                                            : "its planes stand in other files: give their folder";
    }
  }

  /// Positions count only in a unit of length; the schema's default is an unknown one of the microscope's.
  void read_positions() {
    std::map<std::tuple<int, int, int>, double> positions_um;
    for (const XMLElement* plane : children(element_, "Plane")) {
      const double unit_um = described_unit_um(text_of(*plane, "PositionZUnit"));
      const double position_um = plane->DoubleAttribute("PositionZ") * unit_um;
      if (unit_um == 0.0 || plane->Attribute("PositionZ") == nullptr || !std::isfinite(position_um)) continue;
      positions_um[{plane->IntAttribute("TheZ", -1), plane->IntAttribute("TheC", -1),
                    plane->IntAttribute("TheT", -1)}] = position_um;
    }
    for (PagePlace& place : description_.pages) {
      const auto found = positions_um.find({place.z, place.channel, place.time});
      if (found != positions_um.end()) place.z_um = found->second;
    }
  }

  const XMLElement& element_;
  std::string order_;
  PageDescription description_;
};

}  // namespace

std::optional<PageDescription> read_ome_description(std::string_view text, const std::string& filename,
                                                    int samples_per_page) {
  if (text.find("<OME") == std::string_view::npos && text.find(":OME") == std::string_view::npos) return std::nullopt;
  PageDescription damaged;
  damaged.written_by = "OME-XML";
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr) {
    damaged.problem = "it is no well-formed XML";
    return damaged;
  }
  if (!is_named(*document.RootElement(), "OME")) return std::nullopt;
  std::vector<const XMLElement*> stacks;
  for (const XMLElement* image : children(*document.RootElement(), "Image")) {
    for (const XMLElement* pixels : children(*image, "Pixels")) stacks.push_back(pixels);
  }
  // Labels and overviews stand beside the stack as images of one slice.
  if (stacks.size() > 1) std::erase_if(stacks, [](const XMLElement* p) { return p->IntAttribute("SizeZ", 1) < 2; });
  if (stacks.size() != 1) {
    damaged.problem = "it tells of " + std::to_string(stacks.size()) + " stacks (Image elements), one is wanted";
    return damaged;
  }
  return Pixels(*stacks.front(), std::max(1, samples_per_page)).read(filename);
}

}  // namespace fvd
