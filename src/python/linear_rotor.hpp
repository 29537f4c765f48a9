// Small motions of a deck's machine about its spinning equilibrium, for programs of one's own: the
// matrices of analysis::Linearizer on the unknowns that are free, as compressed rows, and modes.
#pragma once
#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/build_system.hpp>
#include <cstdint>
#include <deck/deck.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace whirl::python {

/// A square matrix in compressed rows, columns sorted.
struct SparseRows {
  std::vector<double> values;
  std::vector<std::int32_t> columns, starts;
};

/// M x'' + (C + G) x' + K x = f about the state at one speed, on the unknowns that are free.
struct Matrices {
  SparseRows M, C, G, K;  ///< C symmetric, G skew-symmetric: the two parts of what multiplies x'
  double speed = 0;       ///< rad/s
};

class LinearRotor {
 public:
  /// step: whose drives act ("": only those without a step). undeformed: about the reference
  /// configuration instead of the static equilibrium.
  /// @throws Error as make_mesh() and build_system().
  LinearRotor(std::shared_ptr<const deck::Deck> deck, const std::string& step, bool undeformed);
  LinearRotor(const LinearRotor&) = delete;
  LinearRotor& operator=(const LinearRotor&) = delete;

  /// speed: of the reference line, rad/s. frequency, rad/s: that of the motion, which supports with
  /// tables against frequency answer to; none: that of the spin.
  /// @throws Error as analysis::Linearizer::at().
  Matrices matrices(double speed, std::optional<double> frequency);
  /// @throws Error as analysis::whirl_modes().
  std::vector<analysis::WhirlMode> modes(double speed, const analysis::ModesOptions& options,
                                         analysis::SpectrumCertificate& certificate);

  std::size_t size() const { return free_.size(); }
  /// "node at 0.25 m of shaft 'hp': y" of every free unknown.
  std::vector<std::string> names() const;
  /// Position along its line, m, of every free unknown's node, NaN off the lines; its component, 0
  /// to 5: x, y, z, spin, tilt gamma2, tilt gamma3 (0 of scalars, which belong to supports).
  std::vector<double> stations() const;
  std::vector<std::int32_t> components() const;
  /// The state at the last speed, on the free unknowns: m, rad.
  std::vector<double> equilibrium() const;
  /// Entries of x on the free unknowns, in their order.
  VecXc free_part(const VecXc& x) const;
  /// What a user must know of these matrices: means over a revolution, motions that are held.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  SparseRows rows_of(const la::BlockMatrix<6>& m, double own, double transposed) const;

  std::shared_ptr<const deck::Deck> deck_;
  meshes::Mesh mesh_;
  assembly::Built built_;
  analysis::Linearizer linear_;
  std::vector<Index> free_;           ///< unknowns
  std::vector<std::int32_t> row_of_;  ///< of every unknown, -1: held
  std::vector<std::string> notes_;
};

}  // namespace whirl::python
