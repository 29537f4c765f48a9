// The mesh as tables: CSV with units in the column heads, and text for the terminal.
#pragma once
#include <meshes/mesh.hpp>
#include <string>

namespace whirl::meshes {

/// node, name, kind, line, s[m], x[m], y[m], z[m]
std::string nodes_csv(const Mesh& mesh);
/// element, line, section, left node, right node, s1[m], s2[m], left offset[m], right offset[m],
/// outer and inner diameters of both ends [m] (of mass; empty where the section has none)
std::string elements_csv(const model::Model& m, const Mesh& mesh);
/// station, line, s[m], node, offset[m], element, labels
std::string stations_csv(const Mesh& mesh);
/// The named stations of all lines, one a row: line, s, diameters, node, offset, what is there.
std::string station_table(const model::Model& m, const Mesh& mesh);

}  // namespace whirl::meshes
