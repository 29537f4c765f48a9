// The kinds of bearing of [[bearing]], each described in the file of its family.
#pragma once
#include <deck/visitor.hpp>

namespace whirl::deck {

void describe(Visitor&, model::SpringBlock&);  // bearings.cpp
void describe(Visitor&, model::LinearBearing&);
void describe(Visitor&, model::TableBearing&);
void describe(Visitor&, model::RigidSupport&);
void describe(Visitor&, model::Rub&);  // bearings_contact.cpp
void describe_spring(Visitor&, model::NonlinearSpring&, bool angular);
void describe(Visitor&, model::ShortJournal&);  // bearings_film.cpp
void describe(Visitor&, model::FiniteJournal&);
void describe(Visitor&, model::SqueezeFilm&);
void describe(Visitor&, model::AnnularSeal&);
void describe(Visitor&, model::CrossCoupling&);
void describe(Visitor&, model::BallBearing&);  // bearings_rolling.cpp
void describe(Visitor&, model::RollerBearing&);
void describe_rolling_estimate(Visitor&, model::RollingEstimate&);
void describe(Visitor&, model::Coupling&);  // bearings_shafts.cpp
void describe(Visitor&, model::GearPair&);

/// Entries kxx, kyy, ... of a 6x6 matrix: prefix 'k', 'c' or 'm'; rows force, columns motion.
void describe_entries(Visitor&, Matrix<6>& m, char prefix);
/// The full matrix is given: an error, and false, when an entry is given beside it.
bool only_matrix(Visitor&, char prefix);

}  // namespace whirl::deck
