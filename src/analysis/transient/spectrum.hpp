// Spectra of a long motion, block by block: uniform samples of probes, Hann window, complex FFT of
// y + iz less the straight line through the block. Blocks overlap by half; where the speed changes
// within a block by several lines, by so much more that it changes by about one from block to block
// (at most 32 overlap).
//
// The two-sided spectrum of z = y + iz separates forward (positive frequencies) from backward whirl
// (negative ones): a motion r exp(i w t) of radius r gives r at +w. Amplitudes are 0-peak,
// corrected for the window's mean (1/2).
//
// Where the speed changes within a block by more than a line, samples at equal times smear what turns
// with the shaft over several lines. Such a block has a second spectrum, from samples at equal angles
// of the reference (a Lagrange polynomial through the twelve samples about each), whose frequencies are
// orders times the mean speed: there orders are sharp, and a fixed frequency is spread.
#pragma once
#include <analysis/transient/observer.hpp>
#include <functional>
#include <string>
#include <vector>

namespace whirl::analysis {

/// In place, length a power of two: X_k = sum_n x_n exp(-2 pi i k n / N).
/// @pre not empty.
void fft(std::vector<Complex>& x);

struct SpectrumOptions {
  double max_frequency = 0;  ///< rad/s: highest one reported
  int lines =
      400;  ///< frequencies from 0 to the highest; a block lasts lines * 2 pi / max_frequency
};

/// The strongest component of a block, interpolated between the lines of a Hann window; of the two
/// spectra it is taken from that in which it is higher (smearing lowers it).
struct Ridge {
  double frequency = 0, amplitude = 0;  ///< rad/s, signed as `full`; m, 0-peak
  bool at_equal_angles = false;
};

/// One block of one probe: amplitudes at frequencies k dw, k = -lines .. lines, 0-peak, m.
struct SpectrumBlock {
  double t = 0, speed = 0;  ///< middle of the block; mean spin of the reference, rad/s
  double resolution = 0;    ///< dw, rad/s
  double change = 0;        ///< of the spin within the block, rad/s
  std::vector<std::vector<double>> full;  ///< [probe][2 lines + 1]: |amplitude| of y + iz
  std::vector<std::vector<double>> y, z;  ///< [probe][lines + 1]: one-sided, of the two directions
  std::vector<std::vector<double>> ordered;  ///< as `full`, at equal angles; empty: no need of it
  std::vector<Ridge> ridge;                  ///< one a probe
};

/// The highest line of a full spectrum but those next to zero, where a sag that moves leaks to.
Ridge strongest(const std::vector<double>& full, double resolution);

class Spectra final : public Observer {
 public:
  using Sink = std::function<void(const SpectrumBlock&)>;
  Spectra(std::vector<Point> probes, Index reference, double t_begin, SpectrumOptions options,
          Sink sink);
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  /// Seconds of motion in a block.
  double block_seconds() const { return static_cast<double>(length_) * interval_; }

 private:
  void take(const Snapshot& s);
  void transform(double t_end);
  void find_change(double span);
  void take_equal_angles();
  struct Drift {
    double mean = 0, slope = 0; /**< slope: a half block */
  };
  Drift drift_of(const std::vector<double>& values) const;
  std::size_t hop() const;
  void keep_all_but(std::size_t first);
  static constexpr std::size_t most_overlapping = 32;
  /// Amplitudes of the samples into what is not null.
  void spectrum_of(const std::vector<double>& y, const std::vector<double>& z,
                   std::vector<double>& full, std::vector<double>* one_sided_y,
                   std::vector<double>* one_sided_z);
  std::vector<Point> probes_;
  Index reference_;
  SpectrumOptions options_;
  Sink sink_;
  std::size_t length_;  ///< samples a block, a power of two
  double interval_;     ///< s
  Ticker ticker_;
  std::size_t filled_ = 0;
  std::vector<std::vector<double>> y_, z_;
  std::vector<double> phi_;                             ///< angle of the reference at the samples
  std::vector<std::vector<double>> angle_y_, angle_z_;  ///< samples at equal angles
  std::vector<double> window_;
  std::vector<Complex> work_;
  SpectrumBlock block_;
};

}  // namespace whirl::analysis
