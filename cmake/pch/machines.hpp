// Precompiled for tests of machines read from decks: what they are built of, analyses and transients.
#include "tests.hpp"
#include <analysis/spectra/whirl_modes.hpp>
#include <analysis/transient/transient.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>
#include <fmt/format.h>
