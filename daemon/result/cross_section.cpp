#include "daemon/result/cross_section.hpp"

#include <cmath>

namespace fvd {

double CrossSection::length_um() const { return std::hypot(to_x_um - from_x_um, to_y_um - from_y_um); }

}  // namespace fvd
