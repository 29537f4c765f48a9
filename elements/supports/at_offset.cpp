#include <elements/supports/at_offset.hpp>

namespace whirl::elements {

template <std::size_t Nodes, int Size>
void add_at_offset(const std::array<double, Nodes>& offset, const Matrix<Size>& g,
                   Matrix<7 * static_cast<int>(Nodes)>& t) {
  constexpr int nodes = Nodes, inner = Size / nodes;
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j) {
      const double arm_i = offset[static_cast<std::size_t>(i)];
      const double arm_j = offset[static_cast<std::size_t>(j)];
      const auto block = g.template block<inner, inner>(inner * i, inner * j);
      auto carried = t.template block<7, 7>(7 * i, 7 * j);
      carried.template topLeftCorner<inner, inner>() += block;
      carried.template block<3, inner>(3, 0) += arm_i * block.template topRows<3>();
      carried.template block<inner, 3>(0, 3) += arm_j * block.template leftCols<3>();
      carried.template block<3, 3>(3, 3) += arm_i * arm_j * block.template topLeftCorner<3, 3>();
    }
}

template void add_at_offset(const std::array<double, 1>&, const Matrix<3>&, Matrix<7>&);
template void add_at_offset(const std::array<double, 1>&, const Matrix<7>&, Matrix<7>&);
template void add_at_offset(const std::array<double, 2>&, const Matrix<6>&, Matrix<14>&);
template void add_at_offset(const std::array<double, 2>&, const Matrix<14>&, Matrix<14>&);

}  // namespace whirl::elements
