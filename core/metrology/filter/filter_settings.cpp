#include "core/metrology/filter/filter_settings.hpp"

#include <array>
#include <cstddef>

namespace fvd::metrology {
namespace {

constexpr std::array<std::string_view, 2> kSideNames{"S", "L"};
constexpr std::array<std::string_view, 3> kMethodNames{"gaussian", "gaussian_regression_1", "gaussian_regression_2"};

template <typename Enum, std::size_t N>
std::optional<Enum> from_name(const std::array<std::string_view, N>& names, std::string_view name) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == name) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

std::string_view filter_side_name(FilterSide side) noexcept { return kSideNames[static_cast<std::size_t>(side)]; }

std::optional<FilterSide> filter_side_from_name(std::string_view name) noexcept {
  return from_name<FilterSide>(kSideNames, name);
}

std::string_view filter_method_name(FilterMethod method) noexcept {
  return kMethodNames[static_cast<std::size_t>(method)];
}

std::optional<FilterMethod> filter_method_from_name(std::string_view name) noexcept {
  return from_name<FilterMethod>(kMethodNames, name);
}

}  // namespace fvd::metrology
