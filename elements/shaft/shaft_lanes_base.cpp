// Shaft element force for the instruction set the whole program is built for.
#define WHIRL_LANES_TABLE base_kernels
#define WHIRL_LANES_ISA "baseline"
#include <elements/shaft/shaft_lanes.inl>
