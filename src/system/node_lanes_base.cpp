// Node states for the instruction set the whole program is built for.
#define WHIRL_LANES_TABLE base_kernels
#define WHIRL_LANES_ISA "baseline"
#include <system/node_lanes.inl>
