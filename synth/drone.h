// Inside the synth room: from clean models to what drone photogrammetry makes of them.
#pragma once

#include "parts.h"
#include "synth.h"

namespace colod::synth {

/// How one building came out: what a flight, its overlap and the weather decide.
struct Flight {
  double edge = 0.6;     ///< median length of the mesh's edges [m]
  double melt = 0.4;     ///< radius that edges and recesses are rounded to [m]
  double bulge = 0.12;   ///< sigma of waves of 1 to 5 m [m]
  double jitter = 0.02;  ///< sigma of single vertices [m]
  double skirt = 1.5;    ///< ground around the foot [m]
  bool is_height_field = false;
  std::array<double, 8> lean = {};  ///< of walls by their direction, rise over run outwards
  std::vector<Vec2> missing;        ///< directions of sides that no picture shows
  double missing_depth = 0.6;       ///< 0..1 of a side's height that is not there
  int trees = 0;
};
Flight draw_flight(Random& random, double edge, bool is_height_field);

/// A closed surface around a soup, which nothing passes that is narrower than `alpha`.
Mesh wrap_soup(const Mesh& soup, double alpha, double offset);

/// The building on its ground with trees, as triangles that need not fit together; walls lean.
Mesh make_soup(const Mesh& building, const std::vector<int>& face_object, const Ground& ground,
               const Flight& flight, Random& random);

/// The soup seen from straight above: a jittered grid with its heights, walls aslant between two
/// neighbours.
Mesh make_field(const Mesh& soup, const Flight& flight, Random& random);

/// Edges longer than `longest` are halved until there are none, all over.
void refine(Mesh& mesh, double longest);
/// Rounds what is sharper than `radius`; `edge`: the mesh's own edges.
void smooth(Mesh& mesh, double radius, double edge);
/// Moves vertices by waves and by chance, those of a height field up and down.
void bulge(Mesh& mesh, const Flight& flight, std::uint64_t seed);
/// Uneven triangles whose edges have the median length.
Mesh thin_to_edge(const Mesh& mesh, double edge);
double median_edge(const Mesh& mesh);

constexpr double kMostSkirt = 2.2;  ///< metres

/// A clean building's mesh.
struct NumberedModel {
  int number;
  Mesh mesh;
};
/// Replaces the buildings' clean models by what a drone's pictures give of them. `number`: of the
/// first one. `around`, rising: all that stands within kMostSkirt of their boxes, and themselves.
void fly_over(std::vector<SynthBuilding>& buildings, int number,
              const std::vector<NumberedModel>& around, const SynthOptions& options);

}  // namespace colod::synth
