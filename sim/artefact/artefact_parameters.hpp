#pragma once

/// Virtual artefacts as plain values: surfaces whose every dimension is known.
///
/// Lengths in um. Places are told from the middle of the image, x right, y down. A direction is that of a line in the
/// image, from x towards y: 0 lies along x, 90 runs down. Along it is (cos, sin), across it (sin, -cos): a line that
/// runs down has across = x.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fvd::sim {

/// Rise over run of the plane that an artefact lies on. Heights are added to the plane, so that depths stay what they
/// are along z; an edge and a ball are turned as rigid bodies, so that angle and radius stay.
struct Tilt {
  double slope_x = 0.0;
  double slope_y = 0.0;
};

/// A rectangle, turned to a direction about the middle of the image, with a share of the texture's contrast.
struct ContrastRegion {
  double direction_deg = 0.0;
  double along_from_um = -1e6;
  double along_to_um = 1e6;
  double across_from_um = -1e6;
  double across_to_um = 1e6;
  double contrast_percent = 3.0;
};

/// The share of the texture's contrast in every place: the picture's, or everywhere 1; then the regions', the last one
/// counts.
struct ContrastMap {
  std::filesystem::path picture_file;  ///< grey, 8 bits, of the sensor's size: 255 is the whole contrast; empty: none
  std::vector<ContrastRegion> regions;
};

/// ISO 5436-1 type A1. Land at 0.
struct Groove {
  double width_um = 90.0;        ///< at half the depth
  double depth_um = 50.0;        ///< along z
  double wall_angle_deg = 90.0;  ///< of the walls against the land, up to 90
  double direction_deg = 90.0;   ///< of the groove
};

struct Tread {
  double width_um = 120.0;
  double height_um = 0.0;
};

/// Treads side by side about the middle, across the direction of their edges; the outer ones reach to the border.
struct Stairs {
  std::vector<Tread> treads{{120.0, 0.0}, {120.0, 20.0}, {120.0, 50.0}, {120.0, 100.0}};
  double direction_deg = 90.0;  ///< of the edges
};

/// ISO 5436-1 type C1: amplitude sin(2 pi across / wavelength + phase).
struct Sinusoid {
  double amplitude_um = 5.0;
  double wavelength_um = 120.0;
  double phase_deg = 0.0;
  double direction_deg = 90.0;  ///< of the crests
};

/// Siemens star: sectors of equal angle, raised and not in turn, within a radius; 0 beyond.
struct Star {
  int pairs = 18;
  double height_um = 20.0;
  double radius_um = 170.0;
  double direction_deg = 0.0;  ///< of the middle of one raised sector
};

/// Raised lines in two directions, a crossing in the middle.
struct CrossGrid {
  double pitch_x_um = 60.0;     ///< from crossing to crossing along the first axis
  double pitch_y_um = 60.0;     ///< along the second
  double angle_deg = 90.0;      ///< from the first axis to the second
  double direction_deg = 0.0;   ///< of the first axis
  double line_width_um = 24.0;  ///< along the axis that crosses the line
  double height_um = 20.0;
};

/// A raised letter F, upright, 5 strokes high and 3 wide, in the middle of the image: no turn or mirror image is like
/// it.
struct LetterF {
  double size_um = 250.0;  ///< height of the letter in the image
  double height_um = 20.0;
};

enum class Rounding { kSharp, kCircle, kConic };

/// A chip out of an edge. Its floor is flat across the edge and perpendicular to the direction of the least distance
/// from apex to contour, so that this distance grows by depth cos^2(pi (v - position) / (2 width)) within +-width.
struct Notch {
  double position_um = 0.0;  ///< along the edge from the middle, as the image shows it
  double width_um = 20.0;    ///< at half the depth
  double depth_um = 5.0;
};

/// A cutting edge; rake on the side where across is negative (left of an edge that runs down, below one that lies along
/// x). Flanks are planes that end at the border of the image. The apex passes through the middle at height 0.
struct CuttingEdge {
  double direction_deg = 0.0;
  double beta_deg = 90.0;  ///< wedge angle; without a tilt the bisector is along z
  Rounding rounding = Rounding::kCircle;
  double radius_um = 10.0;       ///< kCircle
  double s_gamma_um = 20.0;      ///< kConic: from apex to where the rounding leaves the rake
  double s_alpha_um = 20.0;      ///< kConic: ... the clearance
  std::optional<double> weight;  ///< kConic: of the apex as a control point; without one sin(beta / 2)
  std::vector<Notch> notches;
  std::optional<double> bend_radius_um;  ///< the apex line is an arc; its centre is on the clearance's side if positive
};

/// What may lie under the microscope; a world's kind tells which one does.
struct Artefacts {
  Tilt tilt;
  ContrastMap contrast;
  Groove groove;
  Stairs stairs;
  Sinusoid sinusoid;
  Star star;
  CrossGrid cross_grid;
  LetterF letter_f;
  CuttingEdge edge;
};

}  // namespace fvd::sim
