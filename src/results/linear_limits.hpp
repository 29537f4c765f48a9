// Where results leave what they stand on: linear responses larger than the gaps of supports, tables
// asked beyond their ends or between rows far apart, bearings too long for the theory of short ones.
// Each is said once a step, with place and size (W11, W12, W13, W16, W03). Motions in time: limits_output.cpp.
#pragma once
#include <results/frequency.hpp>
#include <results/support_bends.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace whirl::results {

/// Share of the film left by the equilibrium up to which coefficients of small motions are believed.
/// A circle of 0.3 in the middle of a short film meets 1.15 times the damping of a small one, of 0.5
/// 1.5 times, (1 - e^2)^-1.5.
inline constexpr double small_in_film = 0.3;

/// Largest share of each support's gap (journal bearings, squeeze films, seals, stops, rubs) that a
/// steady harmonic response takes, the static displacement included, and how far it tilts the shaft.
class GapCheck {
 public:
  explicit GapCheck(FrequencyStep& s) : step_(s) {}
  /// amplitudes: of all unknowns, one for each frequency of the response, about the equilibrium at
  /// the reference speed Omega, rad/s. frequency: of the excitation where it is not the speed,
  /// rad/s.
  void look(double Omega, std::span<const VecXc> amplitudes, double frequency = nan);
  /// W11 for every gap that a response oversteps, for tilts that are not small, for every film of
  /// which it takes so much that coefficients of small motions mislead, for every other support
  /// whose force or moment leaves its linear part (play that closes or opens, magnets that
  /// saturate), and for every amplifier that gives less than the currents of the response; all
  /// shares into the summary ("gaps"), and as a clearance diagram into the report. of: "response to
  /// unbalance".
  void report(const std::string& of);

 private:
  struct Worst {
    double displacement = 0, gap = 0;  ///< m
    double speed = 0, frequency = nan;
    bool film = false;
    double film_share = 0;  ///< of what the equilibrium leaves of the clearance
    Where where;
    std::size_t bearing = 0;  ///< of the model
    std::string text() const;
  };
  struct Tilt {
    double largest = 0;  ///< rad
    double speed = 0, frequency = nan;
    Index node = 0;
  };
  /// at_rest: displacement in the equilibrium, m.
  void look_at(const Worst& seen, const std::string& name, double at_rest);
  void look_at_tilts(double Omega, std::span<const VecXc> amplitudes, double frequency);
  void report_tilt();
  /// Where a support leaves its linear part furthest.
  struct Bent {
    SupportBend bend;
    double speed = 0, frequency = nan;
  };
  /// How far the place of a support has come, m and rad.
  struct Way {
    double along = 0, tilt = 0;
  };
  /// Where the response goes further than before.
  bool goes_further(std::span<const VecXc> amplitudes);
  void look_at_forces(double Omega, std::span<const VecXc> amplitudes, double frequency);
  void report_forces();
  void look_at_currents(double Omega, std::span<const VecXc> amplitudes, double frequency);
  void report_currents();
  bool is_named(std::size_t bearing) const;
  FrequencyStep& step_;
  std::vector<double> reach_;  ///< of every station, m
  std::map<std::string, Worst> worst_;
  Tilt tilt_;
  std::vector<Way> ways_;   ///< of the supports
  std::vector<Bent> bent_;  ///< of the supports
  MostLinear most_;
  std::vector<CurrentNeed> currents_;              ///< of the magnetic bearings
  std::vector<std::pair<double, double>> places_;  ///< speed and frequency, by number of the look
};

/// Where the tables that are not held beyond their edges begin: reference speed, rad/s, and what to
/// say of a search that begins there; 0 where all of them know the rotor next to standstill.
struct TablesBegin {
  double speed = 0;
  std::string said;
};
TablesBegin where_tables_begin(const run::Job& job);

/// Bearings whose table ends within low .. high (reference speed, rad/s) and whose edge coefficients
/// are held beyond (W12), and whose rows there are too far apart (W16).
void warn_of_tables(run::Job& job, const std::string& step, double low, double high);
/// The same of single speeds, ascending: where all of them are rows of a table nothing lies between.
void warn_of_tables(run::Job& job, const std::string& step, std::span<const double> speeds);
/// A bearing of the model, perhaps with a table, and the speeds of its shaft, rad/s.
struct UsedTable {
  std::size_t bearing = 0;
  double low = 0, high = 0;
};
/// W16: tables whose rows within these speeds are too far apart.
void warn_of_coarse_tables(run::Job& job, const std::string& step,
                           std::span<const UsedTable> tables);

/// W14: an equilibrium at speed is that of the mean stiffness of a cracked shaft over a revolution.
void warn_of_mean_crack(run::Job& job, const std::string& step, bool turns);

/// A free motion that grows.
struct FreeGrowth {
  double rate = 0;   ///< 1/s; 0: nothing grows, as far as is known
  std::string text;  ///< "the rotor is unstable at 5000 rpm (..)"
  std::string open;  ///< what is not known where nothing grows: "growth above 540 Hz not excluded"
  bool judged = true;  ///< false: at one of the speeds nothing is known
};
/// At one of these speeds (reference, rad/s), the first found. W13 where nothing is known.
FreeGrowth find_growth(FrequencyStep& s, std::vector<double> speeds,
                       analysis::Motion motion = analysis::Motion::all);
/// W13: where one does the steady response is never reached. Whether one does.
bool warn_of_growth(FrequencyStep& s, std::vector<double> speeds,
                    analysis::Motion motion = analysis::Motion::all);
/// Reference speeds between two, ascending, at which what is given in a table has a say of its own: the rows of
/// tables of supports, and places between those of torques; of many a few, evenly.
std::vector<double> table_speeds_between(const run::Job& job, double first, double last);
/// Speeds within those of a response, ascending, at which free motions are looked at: both ends and the
/// middle; all of them where a deck lists a few; table_speeds_between() them.
std::vector<double> speeds_to_judge(const run::Job& job, const std::vector<double>& speeds);

/// Where motions grow: loads with a moment along a shaft, which can be the cause. "" without one.
std::string moments_along_shafts(const model::Model& m);

/// Rounding of the speeds at the ends of a table, rad/s.
double table_slack(const model::TableBearing& table);

/// A journal in its bearing.
struct ShortFilm {
  std::size_t bearing = 0;  ///< of the model
  double eccentricity = 0;  ///< displacement over clearance
};

/// L/D up to which the usual rule takes a bearing for short, at eccentricities to 0.7.
inline constexpr double longest_short_bearing = 0.5;
/// What that rule admits: the excess at its corner.
double admitted_excess();

/// W03: bearings of the short theory that are longer than the rule has it, or whose films carry more
/// than admitted_excess() times those of finite length. Other films are passed over.
void warn_of_short_bearings(run::Job& job, const std::string& step,
                            std::span<const ShortFilm> films);
/// The same of all journals of a state.
void warn_of_short_bearings(run::Job& job, const std::string& step, const system::State& s);

/// A warning of a step: terminal, report and summary.
void warn(run::Job& job, Diagnostic d);

}  // namespace whirl::results
