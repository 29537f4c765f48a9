// The same mesh with every element of some lines divided into two: what a mesh twice as fine says.
#pragma once
#include <meshes/mesh.hpp>

namespace whirl::meshes {

struct Halved {
  Mesh mesh;
  std::vector<Index> node;  ///< new number of each node
  /// A new node between two old ones, all by their new numbers.
  struct Middle {
    Index node = 0;
    std::array<Index, 2> between{};
  };
  std::vector<Middle> middles;
};

/// @pre one flag a line of the mesh.
Halved halve(const Mesh& mesh, const std::vector<bool>& lines);

}  // namespace whirl::meshes
