// Stations to nodes and elements. A node stands at every section end, at everything attached to a
// shaft, and where refinement asks for one; stretches of rigid sections are one node, and every
// place on them is that node and an axial offset.
//
// Nodes are numbered along each line from left to right, lines one after another, then pedestals,
// then ground points: the matrices of a line are block tridiagonal in this order.
#pragma once
#include <core/types.hpp>
#include <meshes/surface.hpp>
#include <model/model.hpp>
#include <string>
#include <vector>

namespace whirl::meshes {

enum class NodeKind { shaft, pedestal, ground };

struct Node {
  Vec3 position = Vec3::Zero();  ///< m, global axes
  NodeKind kind = NodeKind::shaft;
  Index line = -1;   ///< -1: pedestal or ground
  double s = 0;      ///< m from the left end of its line
  std::string name;  ///< "node at 0.25 m of shaft 'hp'"
};

/// A flexible element from s1 to s2 of its line: the part xi1 to xi2 of one section.
struct Element {
  Index line = 0;
  std::size_t section = 0;  ///< index into Shaft::sections
  Place left, right;        ///< end point = node + offset along its director
  double s1 = 0, s2 = 0;    ///< m
  double xi1 = 0, xi2 = 1;  ///< fractions of the section
};

/// A rigid section: a body on its node.
struct RigidPart {
  Index line = 0;
  std::size_t section = 0;
  Index node = 0;
  double o1 = 0, o2 = 0;  ///< its ends from the node, m
};

/// A place with a name or a node, or both.
struct Station {
  Index line = 0;
  double s = 0;  ///< m from the left end of the line
  std::vector<std::string>
      labels;  ///< "body:start", "disk 'impeller'"; empty at nodes made by refinement
  Vec3 position = Vec3::Zero();  ///< m
  Place at;
  Index element =
      -1;  ///< element to its right (at the right end: to its left); -1: rigid on both sides
  std::string label() const;  ///< labels joined by ", "
};

struct Line {
  std::string name;
  Vec3 origin = Vec3::Zero();  ///< position of s = 0, m
  double length = 0;           ///< m
  bool rotating = true;
  Index first_node = 0, nodes = 0;
  Index first_element = 0, elements = 0;
  Index first_station = 0, stations = 0;
};

/// Where the ends of a bearing are. A bearing acts between `shaft` and `other`; a pedestal between
/// its node and `ground`.
struct BearingNodes {
  Place shaft;
  Place other;  ///< second shaft station, pedestal or ground; node -1: none (acts on the shaft node
                ///< alone)
  Index pedestal = -1, ground = -1;
};

struct Mesh {
  std::vector<Node> nodes;
  std::vector<Element> elements;
  std::vector<RigidPart> rigid_parts;
  std::vector<Station> stations;       ///< by line, then by s
  std::vector<Line> lines;             ///< one a shaft of the model
  std::vector<BearingNodes> bearings;  ///< one a bearing of the model

  /// The station at a location of the model. Every location of the model is a station.
  const Station& station(const model::Location& at) const;
  /// On the shaft, or on the support of the bearing the location names.
  Place place(const model::Location& at) const {
    return at.housing >= 0 ? Place{bearings[static_cast<std::size_t>(at.housing)].pedestal, 0.0}
                           : station(at).at;
  }
  /// Outer radius of the shaft at a place of a line (the larger of both sides at a step), m; 0
  /// where it has no diameter.
  double radius(const model::Model& m, std::size_t line, double s) const;
};

/// @throws Error (all of a model at once, Exit::deck) E19 attachment beyond its shaft; E14, E23
/// impossible section dimensions; E35 no shaft.
Mesh make_mesh(const model::Model& m);

}  // namespace whirl::meshes
