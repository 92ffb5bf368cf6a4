#pragma once

/// Virtual artefacts in a world's file.

#include "config/fields.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// The keys that a world of this kind of surface (world.surface, as read) has: the artefact's own group, `tilt`,
/// `contrast_map`. Groups of other artefacts are unknown keys.
void describe_artefact(WorldParameters& world, Fields& fields);

}  // namespace fvd::sim
