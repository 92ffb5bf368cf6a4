#include "config/relation.hpp"

#include <cmath>
#include <sstream>

namespace fvd {

bool holds(double value, Relation relation, double bound) {
  switch (relation) {
    case Relation::kBelow:
      return value < bound;
    case Relation::kAtMost:
      return value <= bound;
    case Relation::kAbove:
      return value > bound;
    case Relation::kAtLeast:
      return value >= bound;
  }
  return false;
}

std::string relation_text(Relation relation, std::string_view other, double offset) {
  std::ostringstream text;
  text.precision(15);
  switch (relation) {
    case Relation::kBelow:
      text << "below ";
      break;
    case Relation::kAtMost:
      text << "at most ";
      break;
    case Relation::kAbove:
      text << "above ";
      break;
    case Relation::kAtLeast:
      text << "at least ";
      break;
  }
  text << other;
  if (offset != 0.0) text << (offset < 0.0 ? " - " : " + ") << std::abs(offset);
  return text.str();
}

}  // namespace fvd
