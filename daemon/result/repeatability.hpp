#pragma once

/// How far values scatter when the same part is measured again, as gauge studies found it.

#include <map>
#include <string>

#include "config/fields.hpp"

namespace fvd {

/// Of one value of one recipe.
struct Repeatability {
  double sd = 0.0;    ///< standard deviation of repeated measurements, in the value's unit; everything that varies
  double dof = 1.0;   ///< its degrees of freedom, > 0
  std::string study;  ///< identifier of the study
  bool operator==(const Repeatability&) const = default;
};

/// By measurement and value: "step.height_um".
using RepeatabilityMap = std::map<std::string, Repeatability>;

/// Written and read back by config/field_writer.hpp and field_reader.hpp.
void describe(Repeatability& repeatability, Fields& fields);

}  // namespace fvd
