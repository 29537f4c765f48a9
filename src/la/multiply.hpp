// Products of 6x6 block matrices with vectors, in the instruction set of the machine.
#pragma once
#include <la/block.hpp>

namespace whirl::la {

/// y = A x. x of length 6 * nodes, y (resized) not overlapping it.
/// @pre as said of x and y, here and below.
void multiply(const BlockMatrix<6>& a, const VecX& x, VecX& y);
void multiply(const BlockMatrix<6>& a, const VecXc& x, VecXc& y);
/// The same with sums in twice the working precision: the error is that of rounding the result.
void multiply_exact(const BlockMatrix<6>& a, const VecX& x, VecX& y);
void multiply_exact(const BlockMatrix<6>& a, const VecXc& x, VecXc& y);
/// Mx = M x, Cx = C x, Kx = K x in one pass.
void multiply(const MCK& m, const VecXc& x, VecXc& Mx, VecXc& Cx, VecXc& Kx);
/// y += s A x.
void add_multiply(const BlockMatrix<6>& a, double s, const Eigen::Ref<const VecX>& x,
                  Eigen::Ref<VecX> y);
/// y += M a + C v + K q in one pass.
void add_forces(const MCK& m, const VecX& q, const VecX& v, const VecX& a, Eigen::Ref<VecX> y);
/// y += C v + K q in one pass.
void add_forces(const MCK& m, const VecX& q, const VecX& v, Eigen::Ref<VecX> y);
/// y += s |A| x with the absolute values of the entries of A.
void add_multiply_size(const BlockMatrix<6>& a, double s, const VecX& x, VecX& y);

}  // namespace whirl::la
