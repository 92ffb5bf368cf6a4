#include "daemon/result/repeatability.hpp"

namespace fvd {

void describe(Repeatability& repeatability, Fields& fields) {
  fields.number("sd", repeatability.sd, {0.0, 1e12},
                "standard deviation of repeated measurements, in the value's unit");
  fields.require("sd");
  fields.number("dof", repeatability.dof, positive(1e12), "its degrees of freedom");
  fields.require("dof");
  fields.text("study", repeatability.study, 256, "that found it");
}

}  // namespace fvd
