// Precompiled for test programs.
#include "numbers.hpp"
#include <gtest/gtest.h>
