// [sweep]
#include <deck/visitor.hpp>

namespace whirl::deck {

void describe(Visitor& v, model::SweepPlan& s) {
  static constexpr Option samplings[] = {
      {"random", "independent points"},
      {"lhs", "Latin hypercube"},
      {"sobol", "Sobol's sequence, ten distributions at most"},
      {"saltelli", "for Sobol's indices: samples times (distributions + 2) runs"},
      {"morris", "for elementary effects: samples times (distributions + 1) runs"},
      {"one_at_a_time", "for a tornado: each key at its 5 % and 95 % quantiles"},
  };
  int sampling = 0;
  for (int k = 0; k < static_cast<int>(std::size(samplings)); ++k)
    if (s.sampling == samplings[k].name) sampling = k;
  v.texts(optional("vary", "none"), s.vary,
          "keys and their values, as --vary has them: \"bearing.NDE.clearance=60um:90um:7\"; "
          "\"@runs.csv\", a table of runs, stands beside the deck");
  v.texts(optional("response", "none"), s.response,
          "numbers and words of the tables and the summary of a run, as --response has them: "
          "\"first=critical_damped:speed:1\"");
  v.integer("samples", s.samples, between(1, 1000000000), "samples of the distributions");
  v.option("sampling", sampling, samplings, "how they are laid");
  v.integer("seed", s.seed, at_least(0), "of the samples: the same gives the same runs");
  v.texts(optional("correlation", "none"), s.correlation,
          "of two distributions: \"bearing.DE.clearance,bearing.NDE.clearance=0.8\"");
  v.texts(optional("exceed", "none"), s.exceed,
          "limits of responses whose probability is asked for: \"peak>40\", in the unit of the "
          "response");
  v.texts(optional("worst", "none"), s.worst,
          "responses whose worst runs are made again with their reports: \"peak:largest:10\"");
  v.quantity(optional("limit", "none"), s.limit, "s", positive, "wall time a run may take");
  s.sampling = samplings[sampling].name;
}

}  // namespace whirl::deck
