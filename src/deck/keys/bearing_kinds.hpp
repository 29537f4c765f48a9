// The kinds of bearing of [[bearing]], each described in the file of its family.
#pragma once
#include <deck/visitor.hpp>

namespace whirl::deck {

/// The words of 'type' and the law each stands for.
class Kinds {
 public:
  explicit Kinds(model::BearingLaw& law) : law_(law) {}
  /// A word whose keys are those of describe(Visitor&, Law&).
  template <class Law>
  void add(const char* word, const char* doc) {
    list_.push_back(Visitor::alternative<Law>(word, law_, doc));
  }
  /// A word of several for one law: body(visitor, law) describes it.
  template <class Law, class Body>
  void add(const char* word, const char* doc, Body body) {
    list_.push_back({word, doc, [&law = law_, body](Visitor& v) {
                       if (!std::holds_alternative<Law>(law)) law = Law{};
                       body(v, std::get<Law>(law));
                     }});
  }
  const std::vector<Alternative>& list() const { return list_; }

 private:
  model::BearingLaw& law_;
  std::vector<Alternative> list_;
};

// One a law, beside its describe(): the list of kinds asks for every law of the model.
template <class Law>
using As = std::type_identity<Law>;
void add_kinds(Kinds&, As<model::LinearBearing>);  // bearings.cpp
void add_kinds(Kinds&, As<model::SpringBlock>);
void add_kinds(Kinds&, As<model::TableBearing>);
void add_kinds(Kinds&, As<model::RigidSupport>);
void add_kinds(Kinds&, As<model::NonlinearSpring>);  // bearings_contact.cpp
void add_kinds(Kinds&, As<model::Rub>);
void add_kinds(Kinds&, As<model::ShortJournal>);  // bearings_film.cpp
void add_kinds(Kinds&, As<model::FiniteJournal>);
void add_kinds(Kinds&, As<model::TiltingPadJournal>);
void add_kinds(Kinds&, As<model::FloatingRing>);
void add_kinds(Kinds&, As<model::SqueezeFilm>);
void add_kinds(Kinds&, As<model::AnnularSeal>);
void add_kinds(Kinds&, As<model::CrossCoupling>);
void add_kinds(Kinds&, As<model::BallBearing>);  // bearings_rolling.cpp
void add_kinds(Kinds&, As<model::RollerBearing>);
void add_kinds(Kinds&, As<model::RollingEstimate>);
void add_kinds(Kinds&, As<model::MagneticBearing>);  // bearings_magnetic.cpp
void add_kinds(Kinds&, As<model::Coupling>);         // bearings_shafts.cpp
void add_kinds(Kinds&, As<model::GearPair>);

/// Entries kxx, kyy, ... of a 6x6 matrix: prefix 'k', 'c' or 'm'; rows force, columns motion.
void describe_entries(Visitor&, Matrix<6>& m, char prefix);
/// The full matrix is given: an error, and false, when an entry is given beside it.
bool only_matrix(Visitor&, char prefix);

/// Whether a viscosity is known at T, K; if not, an error at the key.
bool check_oil_temperature(Visitor& v, const char* key, double T);

}  // namespace whirl::deck
