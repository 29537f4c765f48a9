// The loop for the instruction set the whole program is built for.
#define WHIRL_LANES_TABLE base_kernels
#define WHIRL_LANES_ISA "baseline"
#include <time/stage_lanes.inl>
