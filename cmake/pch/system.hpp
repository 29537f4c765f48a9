// Precompiled for components that work on the assembled system and its model.
#include "numbers.hpp"
#include <fmt/format.h>
#include <model/model.hpp>
#include <system/system.hpp>
