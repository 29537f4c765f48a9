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

/// Error left on the mesh at hand over the change to the halved one, of what falls with the square of
/// the elements' length; too large of what falls faster.
inline constexpr double error_of_change = 4.0 / 3.0;

/// @pre one flag a line of the mesh.
Halved halve(const Mesh& mesh, const std::vector<bool>& lines);
/// Unknowns of the nodes, six each, and of what comes behind them, on the halved mesh: in the middle
/// of elements the mean of their ends.
VecX spread(const Halved& fine, const VecX& x);

}  // namespace whirl::meshes
